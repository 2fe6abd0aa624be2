// Reproducible random numbers for tests.
#pragma once

namespace polder::verify {

// Numbers in [0, 1).
class Random {
 public:
  explicit Random(unsigned long long seed) : state_(seed) {}
  double operator()() {
    state_ = state_ * 6364136223846793005ull + 1442695040888963407ull;
    return static_cast<double>(state_ >> 11) * 0x1p-53;
  }

 private:
  unsigned long long state_;
};

}  // namespace polder::verify
