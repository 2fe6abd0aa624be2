// When something that happens every so often is due: at the first step at or beyond each multiple of an
// interval.
#pragma once

#include <cmath>
#include <limits>

namespace polder::app {

class Ticker {
 public:
  // every <= 0: never.
  explicit Ticker(double every) : every_(every) {}

  // From now on another interval; nothing is due before the next multiple of it.
  void set_interval(double every, double time) {
    if (every == every_) return;
    every_ = every;
    count_ = every > 0 ? std::floor(time / every * (1 + kSlack)) + 1 : 0;
  }

  // Whether a multiple has been reached since the last time; then the next one is waited for.
  bool due(double time) {
    if (!(time >= next())) return false;
    // Counted, not added up, so that a thousand intervals end where they should.
    count_ = std::floor(time / every_ * (1 + kSlack)) + 1;
    return true;
  }

  double next() const {
    return every_ > 0 ? count_ * every_ * (1 - kSlack) : std::numeric_limits<double>::infinity();
  }

  double& count() { return count_; }  // state, for checkpoints

 private:
  static constexpr double kSlack = 1e-12;  // times are sums of steps
  double every_;
  double count_ = 0;
};

}  // namespace polder::app
