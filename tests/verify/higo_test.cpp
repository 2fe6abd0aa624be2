// Formulation higo, the pore pressure advanced explicitly from the bulk modulus: beside exact solutions,
// beside the projected pressure of one-layer, and its step limit. Most cases take softer water than is true,
// which lengthens the step and changes nothing else; higo_report prints what true water gives.
#include <doctest/doctest.h>

#include <cmath>

#include "core/error.hpp"
#include "core/threads.hpp"
#include "tests/verify/higo_scenes.hpp"
#include "tests/verify/one_layer_consolidation.hpp"
#include "tests/verify/one_layer_limit.hpp"
#include "tests/verify/one_layer_rest.hpp"

using namespace polder;
using namespace polder::verify;

namespace {

constexpr ShapeKind kShapes[] = {ShapeKind::gimp, ShapeKind::quadratic_bspline};

}  // namespace

TEST_CASE("Terzaghi's consolidation: as exact as with a projected pressure") {
  set_threads(1);
  for (const ShapeKind shape : kShapes) {
    CAPTURE(static_cast<int>(shape));
    const Choice c{.formulation = "higo", .shape = shape, .bulk_modulus = 2.2e8};
    const Consolidation r = terzaghi(c, {0.05, 0.2, 0.5});
    CHECK(r.pressure_error[0] <= 0.008);
    CHECK(r.pressure_error[1] <= 0.004);
    CHECK(r.pressure_error[2] <= 0.002);
    CHECK(r.settlement_ratio == doctest::Approx(1).epsilon(0.003));
    CHECK(r.step < 5e-5);  // 6.7e-4 with a projected pressure
  }
}

TEST_CASE("the step limit is that of the analysis to 10 %, and the automatic step is below it") {
  set_threads(1);
  for (const bool musl : {true, false})
    for (const double k : {1e-5, 1e-4, 1e-3}) {
      Block b{{12, 8}, {.formulation = "higo", .musl = musl, .conductivity = k}};
      CAPTURE(musl);
      CAPTURE(k);
      const double analysed = analysed_limit(b.choice, 0.4, 1990), formula = wave_step(b);
      CAPTURE(analysed);
      CAPTURE(formula);
      CHECK(!grows(b, 0.9 * analysed));
      CHECK(grows(b, 1.1 * analysed));
      // What the program steps with at courant 1: never far beyond the limit, and sharp where Darcy flow or
      // USL leave no room.
      CHECK(formula < 1.08 * analysed);
      if (!musl || k >= 1e-4) CHECK(formula > 0.9 * analysed);
      for (const bool free_side : {false, true})
        for (const double offset : {0.02, 0.25, 0.5, 0.71, 0.75}) {
          b.choice.offset = offset, b.free_side = free_side;
          CAPTURE(offset);
          CAPTURE(free_side);
          CHECK(!grows(b, 0.75 * wave_step(b)));
          if (!musl || k >= 1e-4) CHECK(grows(b, 1.2 * wave_step(b)));
        }
    }
}

TEST_CASE("the limit that the program prints, from a small patch, holds for blocks") {
  set_threads(1);
  for (const bool musl : {true, false})
    for (const double k : {1e-12, 1e-4, 1e-3}) {
      Block b{{12, 8}, {.formulation = "higo", .musl = musl, .conductivity = k}};
      const double limit = predicted_step(b);
      CAPTURE(musl);
      CAPTURE(k);
      CAPTURE(limit);
      bool unstable = false;
      for (const bool free_side : {false, true})
        for (const double offset : {0.0, 0.25, 0.5, 0.75}) {
          if (free_side && offset < 0.5) continue;
          b.choice.offset = offset, b.free_side = free_side;
          CAPTURE(offset);
          CHECK(!grows(b, 0.9 * limit));
          unstable |= grows(b, 1.1 * limit);
        }
      CHECK(unstable);
    }
}

TEST_CASE("hydrostatic column, its surface anywhere in a cell") {
  set_threads(1);
  for (const ShapeKind shape : kShapes)
    for (const double offset : {0.0625, 0.52, 0.9375}) {
      const Rest r = hydrostatic({.formulation = "higo",
                                  .shape = shape,
                                  .conductivity = 1e-3,
                                  .bulk_modulus = 2.2e7,
                                  .offset = offset},
                                 4);
      CAPTURE(static_cast<int>(shape));
      CAPTURE(offset);
      CHECK(r.pressure_error < 0.002);
      CHECK(r.speed < 1e-6);
      CHECK(r.point_stress_error < 0.01);
    }
}

TEST_CASE("infiltration with a moving skeleton: the same as with implicit steps, no water lost") {
  set_threads(1);
  const Rain a = rain({.formulation = "higo", .cell = 0.2}, 60), b = rain({.cell = 0.2}, 60);
  for (int i = 0; i < 3; ++i) CHECK(a.saturation[i] == doctest::Approx(b.saturation[i]).epsilon(5e-4));
  CHECK(a.saturation[0] > a.saturation[1] + 0.1);
  CHECK(a.settlement == doctest::Approx(b.settlement).epsilon(1e-3));
  CHECK(std::abs(a.settlement) > 1e-4);  // wetting lets soil swell, the weight of the water presses it
  CHECK(std::abs(a.water_error) < 2e-4);
  CHECK(a.steps < 1.2 * static_cast<double>(b.steps));  // air makes the pores soft: no limit by the water
}

TEST_CASE("a slump is that of the projected pressure") {
  set_threads(1);
  const std::vector<double> times{0.25, 0.5, 1};
  const Slumped a = slump_in_time(
      {.formulation = "higo", .courant = 0.4, .conductivity = 1e-5, .bulk_modulus = 2.2e7}, times);
  const Slumped b = slump_in_time({.courant = 0.1, .conductivity = 1e-5, .bulk_modulus = 2.2e7}, times);
  for (std::size_t i = 0; i < times.size(); ++i) {
    CAPTURE(times[i]);
    CHECK(a.height[i] == doctest::Approx(b.height[i]).epsilon(0.01));
    CHECK(a.runout[i] == doctest::Approx(b.runout[i]).epsilon(0.01));
  }
}

TEST_CASE("a stage of seepage, implicit, hands its flow to explicit steps") {
  set_threads(1);
  Scene s = wet_scene({.formulation = "higo", .conductivity = 1e-4, .bulk_modulus = 2.2e7}, 0.4, 1.3, 0.5);
  s.materials = {elastic_soil(1e7, 0.2, 0.4, 1e-4)};
  s.bodies = {box(0, 0, 0.4, 1, {})};
  s.bodies[0].stress.kind = coupling::InitialStress::Kind::k0;
  s.bodies[0].stress.k0 = {0.25};
  coupling::WaterBoundary base;
  base.name = "base";
  base.kind = coupling::WaterBoundary::Kind::pressure;
  base.side = 2;
  base.value.value = {1.2 * kUnitWeight};
  s.water_boundaries = {base};
  coupling::Stage seepage = s.stages[0], rest = s.stages[0];
  seepage.name = "flow", seepage.mode = coupling::Stage::Mode::seepage, seepage.duration = 3600;
  seepage.until = coupling::Stage::Until::steady;
  rest.name = "rest", rest.mode = coupling::Stage::Mode::equilibrium, rest.duration = 50;
  s.stages.insert(s.stages.begin(), {seepage, rest});
  Simulation sim(s);
  while (!sim.finished()) sim.step();
  for (int j = 0; j < 10; ++j) {
    const double y = 0.05 + 0.1 * j;
    CHECK(sim.cell_quantity({0.05, y, 0}, "pore_pressure") ==
          doctest::Approx(1.2 * kUnitWeight * (1 - y)).epsilon(0.005));
  }
  CHECK(column_of(sim, "max_speed[m/s]") < 1e-4);
  CHECK(sim.step_reason() == "end of stage");
}

TEST_CASE("incompressible water is refused") {
  Scene s = wet_scene({.formulation = "higo", .bulk_modulus = 1e300 * 1e300}, 0.4, 1, 1);
  s.materials = {elastic_soil(1e7, 0.2, 0.4, 1e-4)};
  s.bodies = {box(0, 0, 0.4, 0.8, {})};
  Simulation sim(s);
  CHECK_THROWS_AS(sim.step(), InputError);
}
