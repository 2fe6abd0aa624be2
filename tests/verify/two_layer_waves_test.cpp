// Two layers: free water (sloshing, dam break) and waves in saturated columns.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "core/threads.hpp"
#include "tests/unit/reference_csv.hpp"
#include "tests/verify/two_layer_scenes.hpp"
#include "tests/verify/two_layer_waves.hpp"

using namespace polder;
using namespace polder::verify;

TEST_CASE("the closed form of the harmonic column is that of the reference") {
  for (const char* name : {"harmonic_Pi1_0.1_Pi2_0.1.csv", "harmonic_Pi1_1_Pi2_1.csv"}) {
    const ReferenceCsv csv(name);
    HarmonicGroups g;
    g.pi1 = csv.get("Pi1"), g.pi2 = csv.get("Pi2");
    // Three forms of 5 columns each: |p|, Re p, Im p, |u|, |w|.
    constexpr ColumnEquations kForms[] = {ColumnEquations::uw, ColumnEquations::up,
                                          ColumnEquations::consolidation};
    for (const std::vector<double>& row : csv.rows)
      for (int f = 0; f < 3; ++f) {
        const std::complex<double> p = harmonic_pressure(kForms[f], g, row[0]);
        CHECK(p.real() == doctest::Approx(row[2 + 5 * f]).epsilon(1e-6).scale(1));
        CHECK(p.imag() == doctest::Approx(row[3 + 5 * f]).epsilon(1e-6).scale(1));
      }
  }
}

TEST_CASE("the second wave: two layers show it, one does not") {
  set_threads(1);
  const Choice c{.formulation = "two-layer", .cell = 1.0 / 160, .courant = 0.1};
  const TwoWaves two = two_waves(c, ColumnEquations::uw);
  CHECK(two.speed == doctest::Approx(1).epsilon(0.03));
  CHECK(two.amplitude == doctest::Approx(1).epsilon(0.03));
  CHECK(two.stress < 0.03);
  CHECK(two.pressure < 0.03);
  Choice one = c;
  one.formulation = "one-layer";
  CHECK(two_waves(one, ColumnEquations::uw).stress > 5 * two.stress);
}

TEST_CASE("sloshing: period of the first mode") {
  set_threads(1);
  const ReferenceCsv csv("sloshing.csv");
  Choice c{.formulation = "two-layer", .cell = 0.025, .per_axis = 4};
  const Sloshing r = sloshing(c, 0.02, 6);
  CHECK(r.exact == doctest::Approx(csv.rows[0][4]).epsilon(1e-6));
  CHECK(r.half_swings >= 8);
  CHECK(std::abs(r.period / r.exact - 1) < 0.01);
  CHECK(r.amplitude > 0.9);
  c.cell = 0.05;
  CHECK(std::abs(sloshing(c, 0.02, 6).period / r.exact - 1) > 2 * std::abs(r.period / r.exact - 1));
}
