// Small dense systems whose size is known when the program is built.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace polder {

// x of A x = b by Cholesky's factors, A symmetric and positive definite, of which the lower triangle of the
// first n rows and columns counts. A pivot that rounding has left without a positive value is lifted to
// 1e-300.
template <std::size_t N>
std::array<double, N> solve_positive_definite(std::array<std::array<double, N>, N> a, std::array<double, N> b,
                                              std::size_t n = N) {
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j <= i; ++j) {
      for (std::size_t k = 0; k < j; ++k) a[i][j] -= a[i][k] * a[j][k];
      a[i][j] = i == j ? std::sqrt(std::max(a[i][i], 1e-300)) : a[i][j] / a[j][j];
    }
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < i; ++k) b[i] -= a[i][k] * b[k];
    b[i] /= a[i][i];
  }
  for (std::size_t i = n; i-- > 0;) {
    for (std::size_t k = i + 1; k < n; ++k) b[i] -= a[k][i] * b[k];
    b[i] /= a[i][i];
  }
  return b;
}

}  // namespace polder
