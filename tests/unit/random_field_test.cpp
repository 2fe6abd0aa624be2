// Random fields against their target: mean, variance and correlation over realisations and points.
#include <doctest/doctest.h>

#include <cmath>

#include "core/error.hpp"
#include "core/threads.hpp"
#include "coupling/random_field.hpp"

using namespace polder;
using namespace polder::coupling;

namespace {

Lattice lattice(int nx, int ny, int nz = 1) {
  Lattice l;
  l.lower = {1, 2, 3};
  l.spacing = {0.1, 0.05, 0.1};
  l.count = {nx, ny, nz};
  return l;
}

// Mean over realisations and points of z(x) z(x + shift), of the values and of their squares, with the
// standard error of each from the scatter between realisations.
struct Moments {
  double mean = 0, mean_error = 0;
  std::vector<double> product, product_error;
};

Moments moments(const RandomField& field, const Lattice& l, const std::vector<std::array<int, 3>>& shifts,
                int realisations) {
  Moments m;
  m.product.assign(shifts.size(), 0);
  m.product_error.assign(shifts.size(), 0);
  for (int r = 0; r < realisations; ++r) {
    const std::vector<double> z = field.sample(1000 + r);
    const auto at = [&](int i, int j, int k) { return z[(k * l.count[1] + j) * l.count[0] + i]; };
    double sum = 0;
    for (double v : z) sum += v;
    sum /= static_cast<double>(z.size());
    m.mean += sum;
    m.mean_error += sum * sum;
    for (std::size_t s = 0; s < shifts.size(); ++s) {
      double product = 0;
      int n = 0;
      for (int k = 0; k + shifts[s][2] < l.count[2]; ++k)
        for (int j = 0; j + shifts[s][1] < l.count[1]; ++j)
          for (int i = 0; i + shifts[s][0] < l.count[0]; ++i, ++n)
            product += at(i, j, k) * at(i + shifts[s][0], j + shifts[s][1], k + shifts[s][2]);
      product /= n;
      m.product[s] += product;
      m.product_error[s] += product * product;
    }
  }
  const auto finish = [&](double& value, double& error) {
    value /= realisations;
    error = std::sqrt(std::max(0.0, error / realisations - value * value) / (realisations - 1));
  };
  finish(m.mean, m.mean_error);
  for (std::size_t s = 0; s < shifts.size(); ++s) finish(m.product[s], m.product_error[s]);
  return m;
}

}  // namespace

TEST_CASE("random fields have mean 0, variance 1 and the correlation asked for") {
  using Correlation = RandomProperty::Correlation;
  const Vector3 length{0.4, 0.15, 0.3};
  const std::vector<std::array<int, 3>> shifts{{0, 0, 0}, {1, 0, 0}, {4, 0, 0},
                                               {0, 3, 0}, {3, 2, 0}, {9, 0, 0}};
  for (Correlation kind : {Correlation::exponential, Correlation::gaussian}) {
    const Lattice l = lattice(40, 24);
    const RandomField field(l, length, kind);
    CHECK(field.covariance_error() < 1e-4);
    const Moments m = moments(field, l, shifts, 400);
    CHECK(std::abs(m.mean) < 4 * m.mean_error);
    CHECK(m.mean_error < 0.02);
    for (std::size_t s = 0; s < shifts.size(); ++s) {
      const double dx = 0.1 * shifts[s][0] / length[0], dy = 0.05 * shifts[s][1] / length[1];
      const double r2 = dx * dx + dy * dy;
      const double target = kind == Correlation::gaussian ? std::exp(-r2) : std::exp(-std::sqrt(r2));
      CAPTURE(s);
      CHECK(std::abs(m.product[s] - target) < 4 * m.product_error[s]);
      CHECK(m.product_error[s] < 0.015);
    }
  }
}

TEST_CASE("random fields in 3D have the variance and correlation asked for") {
  const Lattice l = lattice(12, 10, 8);
  const RandomField field(l, {0.3, 0.1, 0.4}, RandomProperty::Correlation::exponential);
  CHECK(field.covariance_error() < 1e-4);
  const Moments m = moments(field, l, {{0, 0, 0}, {0, 0, 2}, {2, 1, 1}}, 100);
  const double targets[] = {1, std::exp(-0.5), std::exp(-std::sqrt(0.4444444 + 0.25 + 0.0625))};
  for (int s = 0; s < 3; ++s) CHECK(std::abs(m.product[s] - targets[s]) < 4 * m.product_error[s]);
}

TEST_CASE("factors have mean 1 and the coefficient of variation asked for, within their bounds") {
  for (auto distribution : {RandomProperty::Distribution::lognormal, RandomProperty::Distribution::normal}) {
    RandomProperty p;
    p.distribution = distribution;
    p.coefficient_of_variation = distribution == RandomProperty::Distribution::normal ? 0.2 : 0.5;
    const FactorRange range = factor_range(p);
    double sum = 0, squares = 0;
    constexpr int n = 400000;
    for (int i = 0; i < n / 2; ++i)
      for (double z : normal_pair(7, i)) {
        const double f = factor_of(p, z);
        sum += f, squares += f * f;
        if (f < range.lowest || f > range.highest) FAIL("outside its bounds");
      }
    const double mean = sum / n, deviation = std::sqrt(squares / n - mean * mean);
    CHECK(std::abs(mean - 1) < 4 * p.coefficient_of_variation / std::sqrt(1.0 * n));
    CHECK(deviation == doctest::Approx(p.coefficient_of_variation).epsilon(0.01));
    CHECK(range.lowest > 0);
    CHECK(factor_of(p, 100) == range.highest);
    CHECK(factor_of(p, -100) == range.lowest);
  }
}

TEST_CASE("the seed alone decides a field, for any number of threads") {
  const Lattice l = lattice(30, 20);
  const Vector3 length{0.5, 0.5, 1};
  const int before = threads();
  set_threads(1);
  const std::vector<double> one = RandomField(l, length, RandomProperty::Correlation::exponential).sample(5);
  set_threads(3);
  const std::vector<double> three =
      RandomField(l, length, RandomProperty::Correlation::exponential).sample(5);
  set_threads(before);
  CHECK(one == three);
  CHECK(one != RandomField(l, length, RandomProperty::Correlation::exponential).sample(6));
}

TEST_CASE("what cannot be embedded is refused") {
  Lattice l = lattice(8000, 8000);
  CHECK_THROWS_AS(RandomField(l, {1, 1, 1}, RandomProperty::Correlation::exponential), InputError);
}
