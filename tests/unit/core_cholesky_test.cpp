#include "core/cholesky.hpp"

#include <doctest/doctest.h>

using polder::solve_positive_definite;

TEST_CASE("a small positive definite system, and the first rows of a larger one") {
  // A = B^T B of an integer matrix; only its lower triangle is given.
  const std::array<std::array<double, 3>, 3> a{{{14, 99, 99}, {8, 6, 99}, {3, 1, 11}}};
  const std::array<double, 3> x =
      solve_positive_definite(a, {14 * 1. + 8 * 2 + 3 * 3, 8 + 6 * 2 + 1 * 3, 3 + 2 + 11 * 3});
  for (int i = 0; i < 3; ++i) CHECK(x[i] == doctest::Approx(i + 1).epsilon(1e-12));
  const std::array<double, 3> y = solve_positive_definite(a, {14 * 1. + 8 * 2, 8 + 6 * 2, 7}, 2);
  CHECK(y[0] == doctest::Approx(1).epsilon(1e-12));
  CHECK(y[1] == doctest::Approx(2).epsilon(1e-12));
  CHECK(y[2] == 7);  // left alone
}
