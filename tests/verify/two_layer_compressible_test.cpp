// Two layers whose pressure follows explicitly from the compression of the water: the same answers as with a
// projected pressure, and a step that the waves of the mixture limit. Water is softer than true where that
// saves time. Demands stand beside what was measured when they were set.
#include <doctest/doctest.h>

#include <cmath>

#include "core/threads.hpp"
#include "tests/verify/one_layer_consolidation.hpp"
#include "tests/verify/one_layer_limit.hpp"
#include "tests/verify/one_layer_rest.hpp"
#include "tests/verify/two_layer_scenes.hpp"
#include "tests/verify/two_layer_waves.hpp"

using namespace polder;
using namespace polder::verify;

namespace {

Choice compressible(double conductivity = 1e-3, double bulk_modulus = 2.2e9) {
  return {.formulation = "two-layer",
          .conductivity = conductivity,
          .bulk_modulus = bulk_modulus,
          .pressure = coupling::PressureMethod::compressible};
}

}  // namespace

TEST_CASE("two layers, explicit pressure: Terzaghi's column") {
  set_threads(1);
  const Consolidation r = terzaghi(compressible(), {0.05, 0.2, 0.5}, 100);
  CHECK(r.pressure_error[0] < 0.008);
  CHECK(r.pressure_error[1] < 0.003);
  CHECK(r.pressure_error[2] < 0.002);
  CHECK(r.settlement_ratio == doctest::Approx(1).epsilon(0.005));
  CHECK(r.step < 3e-5);  // 6e-4 with a projected pressure
}

TEST_CASE("two layers, explicit pressure: rest with disordered points, under a pond, with cut cells") {
  set_threads(1);
  const WaterRest jittered = jittered_column(compressible(1e-3, 2.2e8), 0.5, 1);
  CHECK(jittered.pressure_error < 0.005);  // 0.0021
  CHECK(jittered.pressure_largest < 0.008);
  const WaterRest pond = pond_over_soil(compressible(1e-3, 2.2e7), 0, 2);
  CHECK(pond.pressure_error < 1e-12);
  CHECK(pond.speed < 1e-12);
  for (const double offset : {0.1875, 0.4375, 0.8125}) {
    Choice c = compressible(1e-3, 2.2e7);
    c.offset = offset;
    const Rest r = hydrostatic(c, 3);
    CAPTURE(offset);
    CHECK(r.pressure_error < 0.002);
    CHECK(r.speed < 1e-5);
  }
  CHECK(hydrostatic(compressible(1e-6, 2.2e7), 8).speed < 1e-12);
}

TEST_CASE(
    "two layers, explicit pressure: a pond drains through soil, water seeps along a base with friction") {
  set_threads(1);
  const FallingHead r = falling_head(compressible(1e-2, 2.2e7), 0, 10);
  CHECK(std::abs(r.outflow_error) < 0.05);  // 3.5 %
  CHECK(std::abs(r.water_error) < 1e-12);
  CHECK(r.drift_rms < 0.02);
  const LevelSeepage level = level_seepage(compressible(), 1);
  CHECK(std::abs(level.outflow_error) < 0.005);
  CHECK(level.pressure_error < 0.005);
}

TEST_CASE("two layers, explicit pressure: waves are those of all inertia") {
  set_threads(1);
  using enum ColumnEquations;
  HarmonicGroups g;
  g.pi1 = 1, g.pi2 = 0.1;
  Choice c = compressible();
  c.cell = 0.05;
  CHECK(harmonic_column(c, g, 1600, 6).error(uw, g) < 0.015);
  c = compressible();
  c.cell = 1.0 / 160;
  const TwoWaves r = two_waves(c, uw);
  CHECK(r.speed == doctest::Approx(1).epsilon(0.03));
  CHECK(r.amplitude == doctest::Approx(1).epsilon(0.03));
  CHECK(r.pressure < 0.03);  // 0.009
  CHECK(r.stress < 0.03);    // 0.011
}

TEST_CASE(
    "two layers, explicit pressure: the step limit is that of the analysis, the program's is below it") {
  set_threads(1);
  for (const bool musl : {true, false})
    for (const double k : {1e-6, 1e-3, 1.0}) {
      Block b{{12, 8}, compressible(k, 2.2e8)};
      b.choice.musl = musl;
      const double analysed = analysed_mixture_limit(b.choice, 0.4, 2650);
      CAPTURE(musl);
      CAPTURE(k);
      CAPTURE(analysed);
      CHECK(!grows(b, 0.95 * analysed));
      CHECK(grows(b, 1.1 * analysed));
      const double program = 2 * wave_step(b);  // two layers step with half of it at most
      CHECK(program < analysed);
      CHECK(program > 0.55 * analysed);
      for (const double offset : {0.25, 0.5, 0.75})
        for (const bool corner : {false, true}) {
          b.choice.offset = offset, b.free_side = corner;
          CAPTURE(offset);
          CAPTURE(corner);
          CHECK(!grows(b, wave_step(b)));
          CHECK(!grows(b, 1.8 * wave_step(b)));
        }
    }
}
