// Linear and neo-Hookean elasticity through the level-independent interface.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "mpm/material/array_law.hpp"
#include "mpm/material/material.hpp"

using namespace polder::mpm;

TEST_CASE("linear elastic increments obey Hooke's law in 2D and 3D, whatever the number of particles") {
  MaterialParameters m;
  m.young = 1e6;
  m.poisson = 0.3;
  const double lambda = m.lame_lambda(), shear = m.shear_modulus();
  for (int dimension : {2, 3})
    for (int count : {1, 3, 100}) {
      const int n = dimension == 2 ? 4 : 6;
      std::vector<double> stress(n * count), strain(n * count);
      for (int i = 0; i < n * count; ++i) {
        stress[i] = -1e4 - i;
        strain[i] = 1e-3 * (i % 7 - 3);
      }
      const std::vector<double> start = stress;
      const auto law = make_array_law(m, dimension);
      law->update(count, stress.data(), strain.data(), nullptr, nullptr);
      for (int i = 0; i < count; ++i) {
        const double volume = strain[i] + strain[count + i] + strain[2 * count + i];
        for (int c = 0; c < n; ++c) {
          const int at = c * count + i;
          const double expected = start[at] + 2 * shear * strain[at] + (c < 3 ? lambda * volume : 0);
          CHECK(stress[at] == doctest::Approx(expected).epsilon(1e-14));
        }
      }
    }
}

namespace {

// Cauchy stress of the neo-Hookean solid from a given deformation gradient.
void neo_hookean_stress(const MaterialParameters& m, const double (&f)[3][3], double (&s)[3][3]) {
  const double j = f[0][0] * (f[1][1] * f[2][2] - f[1][2] * f[2][1]) -
                   f[0][1] * (f[1][0] * f[2][2] - f[1][2] * f[2][0]) +
                   f[0][2] * (f[1][0] * f[2][1] - f[1][1] * f[2][0]);
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) {
      double left = 0;
      for (int k = 0; k < 3; ++k) left += f[a][k] * f[b][k];
      s[a][b] =
          ((a == b) * (m.lame_lambda() * std::log(j) - m.shear_modulus()) + m.shear_modulus() * left) / j;
    }
}

}  // namespace

TEST_CASE(
    "the neo-Hookean solid follows the product of its deformation steps, in 2D with hoop strain and in 3D") {
  MaterialParameters m;
  m.model = MaterialModel::neo_hookean;
  m.young = 1e6, m.poisson = 0.3;
  for (int dimension : {2, 3}) {
    const auto law = make_array_law(m, dimension);
    double f[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, stress[6] = {}, state[9];
    set_initial_state(m, dimension, 0, state);
    for (int step = 0; step < 5; ++step) {
      double g[3][3] = {}, next[3][3] = {}, gradient[9], strain[6] = {};
      for (int a = 0; a < dimension; ++a)
        for (int b = 0; b < dimension; ++b)
          gradient[a * dimension + b] = g[a][b] = 0.2 * std::sin(3.0 * a + 7.0 * b + step);
      // strain refers to the midpoint of the step
      if (dimension == 2) g[2][2] = 0.05 * step, strain[2] = g[2][2] / (1 + 0.5 * g[2][2]);
      for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b) {
          next[a][b] = f[a][b];
          for (int k = 0; k < 3; ++k) next[a][b] += g[a][k] * f[k][b];
        }
      std::copy(&next[0][0], &next[0][0] + 9, &f[0][0]);
      law->update(1, stress, strain, gradient, state);
    }
    double s[3][3];
    neo_hookean_stress(m, f, s);
    const double expected[] = {s[0][0], s[1][1], s[2][2], s[0][1], s[1][2], s[2][0]};
    for (int c = 0; c < (dimension == 2 ? 4 : 6); ++c)
      CHECK(stress[c] == doctest::Approx(expected[c]).epsilon(1e-12).scale(m.young));
  }
}

TEST_CASE("a neo-Hookean particle turned inside out shows as NaN") {
  MaterialParameters m;
  m.model = MaterialModel::neo_hookean;
  m.young = 1e6, m.poisson = 0.3;
  double stress[4] = {}, strain[4] = {}, gradient[4] = {-1.5, 0, 0, 0}, state[5];
  set_initial_state(m, 2, 0, state);
  make_array_law(m, 2)->update(1, stress, strain, gradient, state);
  CHECK(std::isnan(stress[0]));
}
