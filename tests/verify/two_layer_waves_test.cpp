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

TEST_CASE(
    "harmonic column: each formulation follows its own equations, and only two layers those with all "
    "inertia") {
  set_threads(1);
  using enum ColumnEquations;
  const auto errors = [](const HarmonicGroups& g) {
    Choice c{.formulation = "two-layer", .cell = 0.05};
    const Harmonic two = harmonic_column(c, g, 400, 6);
    c.formulation = "one-layer";
    return std::pair{two, harmonic_column(c, g, 400, 6)};
  };
  HarmonicGroups slow;
  slow.pi1 = 1, slow.pi2 = 1e-3;  // consolidation: all agree
  const auto [slow_two, slow_one] = errors(slow);
  CHECK(slow_two.error(uw, slow) < 0.015);
  CHECK(slow_one.error(uw, slow) < 0.015);
  HarmonicGroups fast;
  fast.pi1 = 10, fast.pi2 = 0.1;  // relative inertia counts
  const auto [two, one] = errors(fast);
  CHECK(two.error(uw, fast) < 0.01);
  CHECK(one.error(darcy, fast) < 0.01);
  CHECK(one.error(uw, fast) > 0.2);
}

TEST_CASE(
    "dam break: front and depth at the wall against flow with a potential and Martin and Moyce, profile "
    "against Ritter") {
  set_threads(1);
  const DamBreak r = dam_break({.formulation = "two-layer", .cell = 0.1}, 1, 2, 6, 1.0, 0.01);
  const auto at = [&](const std::vector<double>& values, double time) {
    const auto next = std::lower_bound(r.time.begin(), r.time.end(), time);
    return values[static_cast<std::size_t>(next - r.time.begin())];
  };
  CHECK(std::abs(r.water_error) < 1e-12);
  const ReferenceCsv potential("dam_break_potential_flow_2.csv");
  for (const std::vector<double>& row : potential.rows) {
    const double time = row[0] / std::sqrt(kGravity);
    CHECK(std::abs(at(r.height, time) - row[2]) / 2 < 0.045);
    if (row[0] > 0.6) CHECK(at(r.front, time) == doctest::Approx(row[1]).epsilon(0.03));
  }
  // The experiment's depths are those of flow without friction; its front is late by 0.3 units of time.
  for (const std::vector<double>& row : ReferenceCsv("martin_moyce_height.csv").rows)
    if (row[0] < 3.1) CHECK(std::abs(at(r.height, row[0] / std::sqrt(kGravity)) / 2 - row[1]) < 0.06);
  for (const std::vector<double>& row : ReferenceCsv("martin_moyce_front.csv").rows)
    if (row[0] > 1.4)
      CHECK(at(r.front, (row[0] - 0.3) / std::sqrt(2 * kGravity)) == doctest::Approx(row[1]).epsilon(0.06));
  const DamBreak shallow = dam_break({.formulation = "two-layer", .cell = 0.1}, 5, 1, 12, 1.0, 0.1);
  const ReferenceCsv ritter("dambreak_ritter.csv");
  double difference = 0;
  int columns = 0;
  for (const auto& [x, depth] : shallow.profile) {
    if (x < -3 || x > 4) continue;
    const auto& rows = ritter.rows;
    std::size_t i = 0;
    while (rows[i][0] < x - 0.06) ++i;
    difference += std::abs(depth - 0.5 * (rows[i][5] + rows[i + 1][5])), ++columns;
  }
  CHECK(difference / columns < 0.05);
}
