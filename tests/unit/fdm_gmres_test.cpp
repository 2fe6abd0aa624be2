#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "core/threads.hpp"
#include "fdm/flexible_gmres.hpp"

using namespace polder;
using namespace polder::fdm;

namespace {

// Convection and diffusion along a line, upwind: not symmetric.
void multiply(std::span<const double> v, std::span<double> out) {
  const std::size_t n = v.size();
  for (std::size_t i = 0; i < n; ++i)
    out[i] = 2.7 * v[i] - (i > 0 ? 1.6 * v[i - 1] : 0) - (i + 1 < n ? 0.9 * v[i + 1] : 0);
}

}  // namespace

TEST_CASE("flexible GMRES solves a system that is not symmetric, also when the preconditioner changes") {
  const std::size_t n = 60;
  std::vector<double> b(n), x(n), image(n);
  for (std::size_t i = 0; i < n; ++i) b[i] = std::sin(0.3 * static_cast<double>(i)) + 0.2;
  for (const bool changing : {false, true}) {
    FlexibleGmres gmres;
    int calls = 0;
    const auto report = gmres.solve(
        multiply,
        [&](std::span<const double> in, std::span<double> out) {
          ++calls;
          for (std::size_t i = 0; i < in.size(); ++i)
            out[i] = in[i] / (2.7 + (changing ? 0.5 * (calls % 3) * std::cos(double(i)) : 0.0));
        },
        b, 1e-10, 60, x);
    CHECK(report.iterations == calls);
    CHECK(report.iterations <= 60);
    multiply(x, image);
    double error = 0, norm = 0;
    for (std::size_t i = 0; i < n; ++i) error += std::pow(image[i] - b[i], 2), norm += b[i] * b[i];
    CHECK(std::sqrt(error / norm) <= 1e-9);
    CHECK(report.reduction <= 1e-10);
  }
}

TEST_CASE("flexible GMRES tells how far it came, and does nothing where nothing is to be done") {
  const std::size_t n = 60;
  std::vector<double> b(n, 1.0), x(n, 5.0), image(n);
  const auto copy = [](std::span<const double> in, std::span<double> out) {
    std::copy(in.begin(), in.end(), out.begin());
  };
  FlexibleGmres gmres;
  const auto report = gmres.solve(multiply, copy, b, 1e-12, 4, x);
  CHECK(report.iterations == 4);
  multiply(x, image);
  double error = 0;
  for (std::size_t i = 0; i < n; ++i) error += std::pow(image[i] - b[i], 2);
  CHECK(std::sqrt(error / static_cast<double>(n)) == doctest::Approx(report.reduction).epsilon(1e-9));
  std::fill(b.begin(), b.end(), 0.0);
  CHECK(gmres.solve(multiply, copy, b, 1e-12, 4, x).iterations == 0);
  for (const double v : x) CHECK(v == 0);
}
