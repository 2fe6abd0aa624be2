// Linear elasticity through the level-independent interface.
#include <doctest/doctest.h>

#include "mpm/material/array_law.hpp"
#include "mpm/material/material.hpp"

using namespace polder;

TEST_CASE("linear elastic increments obey Hooke's law in 2D and 3D, whatever the number of particles") {
  mpm::MaterialParameters m;
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
      const auto law = mpm::make_array_law(m, dimension);
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
