// Formulations v-w and u-p, water and its pressure on the points of the soil: beside exact solutions and
// beside the formulations with pressure in cells. Most cases take softer water than is true, which lengthens
// the step and changes nothing else; point_water_report prints what true water gives.
#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "core/error.hpp"
#include "core/threads.hpp"
#include "tests/verify/one_layer_consolidation.hpp"
#include "tests/verify/one_layer_limit.hpp"
#include "tests/verify/one_layer_rest.hpp"
#include "tests/verify/point_water_scenes.hpp"
#include "tests/verify/two_layer_scenes.hpp"
#include "tests/verify/two_layer_waves.hpp"

using namespace polder;
using namespace polder::verify;

namespace {

constexpr const char* kFormulations[] = {"v-w", "u-p"};

}  // namespace

TEST_CASE("Terzaghi's consolidation on points, from sand to silt") {
  set_threads(1);
  for (const char* f : kFormulations)
    for (const double k : {1e-3, 1e-4}) {
      CAPTURE(f);
      CAPTURE(k);
      const Consolidation r =
          terzaghi({.formulation = f, .conductivity = k, .bulk_modulus = 2.2e8}, {0.05, 0.2, 0.5});
      CHECK(r.pressure_error[0] <= 0.015);
      CHECK(r.pressure_error[1] <= 0.005);
      CHECK(r.pressure_error[2] <= 0.002);
      CHECK(r.settlement_ratio == doctest::Approx(1).epsilon(0.003));
    }
}

TEST_CASE("the second wave: v-w shows it with its speed and height, u-p does not") {
  set_threads(1);
  const TwoWaves r = two_waves({.formulation = "v-w", .cell = 1.0 / 160}, ColumnEquations::uw);
  CHECK(r.speed == doctest::Approx(1).epsilon(0.03));
  CHECK(r.amplitude == doctest::Approx(1).epsilon(0.03));
  CHECK(r.stress < 0.03);
  CHECK(r.pressure < 0.03);
  CHECK(r.water < 0.03);
  const TwoWaves coarse = two_waves({.formulation = "v-w", .cell = 1.0 / 40}, ColumnEquations::uw);
  CHECK(coarse.stress > 4 * r.stress);  // the error is that of the grid
  // Darcy flow limits u-p's step in soil this permeable: large cells.
  CHECK(two_waves({.formulation = "u-p", .cell = 1.0 / 20}, ColumnEquations::uw).stress > 0.3);
}

TEST_CASE("harmonic column: v-w follows the equations with all inertia, u-p its own") {
  set_threads(1);
  using enum ColumnEquations;
  HarmonicGroups g;
  g.pi1 = 1, g.pi2 = 1;  // far beyond the zone in which u-p holds
  const Harmonic all = harmonic_column({.formulation = "v-w", .cell = 0.05}, g, 400, 8);
  CHECK(all.change < 1e-3);
  CHECK(all.error(uw, g) < 0.03);
  CHECK(all.error(up, g) > 0.3);
  // Darcy flow at the old pressure wants 5000 steps of a period here.
  const Harmonic some = harmonic_column({.formulation = "u-p", .cell = 0.05}, g, 6000, 6);
  CHECK(some.change < 1e-3);
  CHECK(some.error(up, g) < 0.04);
  CHECK(some.error(uw, g) > 0.3);
  CHECK(some.error(darcy, g) > 0.3);
}

TEST_CASE("hydrostatic columns rest, with surfaces anywhere in a cell") {
  set_threads(1);
  for (const char* f : kFormulations)
    for (const double offset : {0.0, 0.3, 0.75}) {
      CAPTURE(f);
      CAPTURE(offset);
      const Rest r =
          hydrostatic({.formulation = f, .conductivity = 1e-3, .bulk_modulus = 2.2e7, .offset = offset}, 2);
      CHECK(r.pressure_error < 0.002);
      CHECK(r.speed < 1e-5);
      CHECK(r.point_stress_error < 0.01);
    }
}

TEST_CASE("a prescribed pressure at the base drives Darcy's flow") {
  set_threads(1);
  for (const char* f : kFormulations) {
    CAPTURE(f);
    const Flow r = upward_flow({.formulation = f, .conductivity = 1e-3, .bulk_modulus = 2.2e7}, 0.5);
    CHECK(r.discharge == doctest::Approx(r.exact).epsilon(0.005));
    CHECK(r.pressure_error < 0.003);
    CHECK(std::abs(r.water_error) < 1e-9);
  }
}

TEST_CASE("seepage along a base that holds the soil by friction: water on it is held by drag") {
  set_threads(1);
  for (const char* f : kFormulations)
    for (const double k : {1e-3, 1e-4}) {
      const LevelSeepage r = level_seepage({.formulation = f, .conductivity = k, .bulk_modulus = 2.2e7}, 4);
      CAPTURE(f);
      CAPTURE(k);
      CHECK(std::abs(r.outflow_error) < 0.005);
      CHECK(r.pressure_error < 0.005);
    }
}

TEST_CASE("a slump is that of a projected pressure; without cell means the points' pressures run apart") {
  set_threads(1);
  const Choice projected{.courant = 0.2, .conductivity = 1e-5, .bulk_modulus = 2.2e7};
  const Slump b = slump(projected, 0.5);
  for (const char* f : kFormulations) {
    CAPTURE(f);
    Choice c = projected;
    c.formulation = f, c.courant = 0.4;
    const Slump a = slump(c, 0.5);
    CHECK(a.height == doctest::Approx(b.height).epsilon(0.02));
    CHECK(a.runout == doctest::Approx(b.runout).epsilon(0.02));
    const double shared = pressure_range(slump_scene(c, 0.5));
    c.point_pressure = coupling::PointPressure::points;
    CHECK(pressure_range(slump_scene(c, 0.5)) > 3 * shared);
  }
}

TEST_CASE("the step limit: explicit drag, implicit drag, Darcy flow, and the printed one") {
  set_threads(1);
  struct Case {
    const char* formulation;
    coupling::DragStep drag;
    double conductivity;
  };
  using enum coupling::DragStep;
  for (const Case& c : {Case{"v-w", by_last_velocities, 1e-4}, Case{"v-w", implicit, 1e-4},
                        Case{"u-p", implicit, 1e-3}, Case{"u-p", implicit, 1e-6}}) {
    CAPTURE(c.formulation);
    CAPTURE(c.conductivity);
    Block b{{12, 8}, {.formulation = c.formulation, .conductivity = c.conductivity, .drag = c.drag}};
    const double analysed = analysed_point_limit(b.choice, 0.4, 2650);
    CAPTURE(analysed);
    CHECK(!grows(b, 0.9 * analysed));
    CHECK(grows(b, 1.1 * analysed));
    const double printed = predicted_step(b);
    CHECK(!grows(b, 0.9 * printed));
    CHECK(grows(b, 1.15 * printed));
    CHECK(wave_step(b) < 1.05 * analysed);  // what the program steps with at courant 1
  }
}

TEST_CASE("incompressible water is refused") {
  Scene s = wet_scene({.formulation = "v-w", .bulk_modulus = 1e300 * 1e300}, 0.4, 1, 1);
  s.materials = {elastic_soil(1e7, 0.2, 0.4, 1e-4)};
  s.bodies = {box(0, 0, 0.4, 0.8, {})};
  CHECK_THROWS_AS(Simulation{s}, InputError);
}
