// What the compiler of Debian 12 gets wrong without the flags of cmake/PolderOptions.cmake.
#include <doctest/doctest.h>

#include <vector>

namespace {

struct Table {
  std::vector<double> time{0.0}, value{0.0};
};

__attribute__((noinline)) void set(Table& t, double turn) {
  constexpr double kBefore = 9810 * 1.5;
  t.time = {0, turn, turn * (1 + 1e-6), 2 * turn};
  t.value = {kBefore, kBefore, 0, 0};
}

}  // namespace

TEST_CASE("a list that ends in zeros is copied with them") {
  Table t;
  set(t, 15);
  CHECK(t.value == std::vector<double>{14715.0, 14715.0, t.time[0], t.time[0]});
}
