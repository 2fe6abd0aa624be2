#include "bench/precision.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "bench/measure.hpp"
#include "core/error.hpp"
#include "core/threads.hpp"

namespace polder::bench {

double Outcome::error() const {
  double sum = 0;
  for (const double e : errors) sum += e * e;
  return std::sqrt(sum / static_cast<double>(errors.size()));
}

Outcome in_own_process(const Place& place, std::size_t errors, const std::function<Outcome()>& run) {
  constexpr double kEnough = 0.3;  // [s] of all repetitions
  constexpr int kMost = 5;
  const std::vector<double> numbers = in_child([&] {
    set_threads(place.threads);
    Outcome o;
    double sum = 0, least = 1e300;
    for (int i = 0; i < kMost && (i == 0 || sum < kEnough); ++i) try {
        o = run();
        sum += o.seconds, least = std::min(least, o.seconds);
      } catch (const NumericalError& e) {
        std::fprintf(stderr, "broke down: %s\n", e.what());
        o.errors.assign(errors, std::nan(""));
        least = std::nan("");
        break;
      }
    std::vector<double> all{least, o.steps, o.points};
    all.insert(all.end(), o.errors.begin(), o.errors.end());
    return all;
  });
  return {{numbers.begin() + 3, numbers.end()}, numbers[0], numbers[1], numbers[2]};
}

}  // namespace polder::bench
