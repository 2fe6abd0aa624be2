// Errors against seconds: which of many runs no other one beats in both, and what an error costs.
#pragma once

#include <cstddef>
#include <vector>

namespace polder::bench {

struct Cost {
  double seconds = 0, error = 0;  // error NaN: the run broke down, it counts for nothing
};

// Those that none beats in seconds without being worse in error, from cheap to exact. Of equal ones the
// first.
std::vector<std::size_t> front(const std::vector<Cost>& all);

// Least seconds among those with at most this error; infinite if there is none.
double seconds_to_reach(const std::vector<Cost>& all, double error);

// How many times the seconds of the cheapest of `all` with no larger error `some` take that lie on their own
// front: the geometric mean over that front. 1: all of them are on the front of all. NaN without any.
double cost_over_best(const std::vector<Cost>& some, const std::vector<Cost>& all);

}  // namespace polder::bench
