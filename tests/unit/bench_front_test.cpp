// What `polder bench precision` makes of errors and seconds.
#include "bench/front.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace polder::bench;

TEST_CASE("the front holds what nothing beats in both") {
  const double nan = std::nan("");
  const std::vector<Cost> all{{4, 0.1}, {1, 0.5}, {2, 0.6}, {0.5, nan}, {8, 0.1}, {1, 0.4}, {9, 0.05}};
  CHECK(front(all) == std::vector<std::size_t>{5, 0, 6});
  CHECK(front({}).empty());
  CHECK(front({{1, nan}}).empty());
}

TEST_CASE("seconds to reach an error") {
  const std::vector<Cost> all{{4, 0.1}, {1, 0.5}, {9, 0.05}, {3, std::nan("")}};
  CHECK(seconds_to_reach(all, 0.5) == 1);
  CHECK(seconds_to_reach(all, 0.2) == 4);
  CHECK(seconds_to_reach(all, 0.01) == HUGE_VAL);
}

TEST_CASE("cost over the best") {
  const std::vector<Cost> best{{1, 0.1}, {4, 0.01}}, slow{{2, 0.1}, {32, 0.01}, {40, 0.02}};
  std::vector<Cost> all = best;
  all.insert(all.end(), slow.begin(), slow.end());
  CHECK(cost_over_best(best, all) == doctest::Approx(1));
  CHECK(cost_over_best(slow, all) == doctest::Approx(4));  // root of 2 times 8
  CHECK(std::isnan(cost_over_best({{1, std::nan("")}}, all)));
}
