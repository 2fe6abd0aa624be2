#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "core/aligned.hpp"
#include "core/fourier.hpp"
#include "tests/unit/random.hpp"

using namespace polder;

TEST_CASE("cell transforms diagonalise the second difference for every pair of ends") {
  for (int n : {1, 2, 7, 12})
    for (Parity lower : {Parity::even, Parity::odd})
      for (Parity upper : {Parity::even, Parity::odd}) {
        CAPTURE(n);
        const CellTransform::Axis axis{n, lower, upper};
        const CellTransform transform({axis});
        const std::vector<double> eigenvalue = CellTransform::eigenvalues(axis);
        verify::Random random(3);
        Reals x(n), difference(n);
        for (double& v : x) v = random() - 0.5;
        const auto at = [&](int i) {
          if (i < 0) return (lower == Parity::even ? 1 : -1) * x[0];
          if (i >= n) return (upper == Parity::even ? 1 : -1) * x[n - 1];
          return x[i];
        };
        for (int i = 0; i < n; ++i) difference[i] = 2 * x[i] - at(i - 1) - at(i + 1);
        Reals amplitude = x;
        transform.forward(amplitude.data());
        transform.forward(difference.data());
        for (int k = 0; k < n; ++k)
          CHECK(difference[k] == doctest::Approx(eigenvalue[k] * amplitude[k]).epsilon(1e-12));
        transform.backward(amplitude.data());
        for (int i = 0; i < n; ++i)
          CHECK(amplitude[i] / transform.scale() == doctest::Approx(x[i]).epsilon(1e-12));
      }
}

TEST_CASE("the Fourier transform of a wave is one line") {
  const int nx = 6, ny = 10;
  std::vector<std::complex<double>> values(nx * ny);
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i)
      values[j * nx + i] = std::polar(1.0, 2 * std::numbers::pi * (2.0 * i / nx + 3.0 * j / ny));
  fourier_transform({ny, nx}, values);
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i)
      CHECK(std::abs(values[j * nx + i] - (i == 2 && j == 3 ? 60.0 : 0.0)) < 1e-12);
}

TEST_CASE("fast sizes have small prime factors and are the next ones") {
  CHECK(fast_size(1) == 1);
  CHECK(fast_size(11) == 12);
  CHECK(fast_size(97) == 98);
  CHECK(fast_size(1023) == 1024);
}
