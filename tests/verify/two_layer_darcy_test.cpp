// Two layers without the acceleration of water relative to the grains: what they share with two layers that
// keep it, and what distinguishes them. Demands stand beside what was measured when they were set.
#include <doctest/doctest.h>

#include <cmath>

#include "core/threads.hpp"
#include "coupling/step_limit.hpp"
#include "tests/verify/one_layer_consolidation.hpp"
#include "tests/verify/one_layer_rest.hpp"
#include "tests/verify/two_layer_scenes.hpp"
#include "tests/verify/two_layer_waves.hpp"

using namespace polder;
using namespace polder::verify;

namespace {

Choice neglected(double conductivity = 1e-3, double offset = 0) {
  return {.formulation = "two-layer-darcy", .conductivity = conductivity, .offset = offset};
}

}  // namespace

TEST_CASE("two layers, Darcy: Terzaghi's column") {
  set_threads(1);
  for (const double k : {1e-3, 1e-4}) {
    const Consolidation r = terzaghi(neglected(k), {0.05, 0.2, 0.5}, 100);
    CAPTURE(k);
    CHECK(r.pressure_error[0] < 0.008);  // 0.0055, 0.0039
    CHECK(r.pressure_error[1] < 0.003);  // 0.0021, 0.0012
    CHECK(r.pressure_error[2] < 0.002);
    CHECK(r.settlement_ratio == doctest::Approx(1).epsilon(0.005));
  }
}

TEST_CASE(
    "two layers, Darcy: rest with the surface anywhere in a cell, under a pond, with disordered points") {
  set_threads(1);
  // Cut surfaces at k = 1e-2 m/s fly apart where the water feels the grains' acceleration at the nodes in
  // place of that of their strains.
  for (const double k : {1e-2, 1e-4})
    for (const double offset : {0.1875, 0.4375, 0.5625}) {
      const Rest r = hydrostatic(neglected(k, offset), 3);
      CAPTURE(k);
      CAPTURE(offset);
      CHECK(r.pressure_error < 0.002);
      CHECK(r.speed < 1e-5);
      CHECK(r.point_stress_error < 0.01);
    }
  CHECK(hydrostatic(neglected(1e-6), 8).speed < 1e-12);
  const WaterRest jittered = jittered_column(neglected(), 0.5, 1);
  CHECK(jittered.pressure_error < 0.005);  // 0.0021
  CHECK(jittered.drift < 0.002);
  const WaterRest pond = pond_over_soil(neglected(), 0, 2);
  CHECK(pond.pressure_error < 1e-12);
  CHECK(pond.speed < 1e-12);
}

TEST_CASE("two layers, Darcy: a pond drains through soil, water seeps along a base with friction") {
  set_threads(1);
  for (const double h : {0.1, 0.05}) {
    Choice c = neglected(1e-2);
    c.cell = h;
    const FallingHead r = falling_head(c, 0, 10);
    CAPTURE(h);
    CHECK(std::abs(r.outflow_error) < 0.5 * h);  // 3.5 and 1.7 %
    CHECK(std::abs(r.water_error) < 1e-12);
    CHECK(r.drift_rms < 0.02);
  }
  for (const double k : {1e-3, 1e-4}) {
    const LevelSeepage r = level_seepage(neglected(k), 1);
    CAPTURE(k);
    CHECK(std::abs(r.outflow_error) < 0.005);
    CHECK(r.pressure_error < 0.005);
  }
}

TEST_CASE("two layers, Darcy: undrained slump as with relative acceleration") {
  set_threads(1);
  Choice c = neglected(1e-5);
  c.courant = 0.4;
  const Slump tied = slump(c, 2);
  c.formulation = "two-layer";
  const Slump kept = slump(c, 2);
  CHECK(tied.height == doctest::Approx(kept.height).epsilon(0.01));
  CHECK(tied.runout == doctest::Approx(kept.runout).epsilon(0.02));
  CHECK(std::abs(tied.volume - 1) < 0.01);
  CHECK(std::abs(tied.water_error) < 1e-12);
}

TEST_CASE("two layers, Darcy: waves are those of u-p, with no second one") {
  set_threads(1);
  using enum ColumnEquations;
  HarmonicGroups g;
  for (const double pi1 : {1.0, 10.0}) {
    g.pi1 = pi1, g.pi2 = 0.1;
    Choice c = neglected();
    c.cell = 0.05;
    const Harmonic r = harmonic_column(c, g, 400, 6);
    CAPTURE(pi1);
    CHECK(r.error(up, g) < 0.015);                                 // 0.010, 0.004
    CHECK(r.error(uw, g) > 0.8 * harmonic_difference(up, uw, g));  // 0.041, 0.31
  }
  Choice c = neglected();
  c.cell = 1.0 / 80, c.courant = 0.1;
  const TwoWaves r = two_waves(c, up);
  CHECK(r.pressure < 0.04);  // 0.026
  CHECK(r.stress < 0.03);    // 0.015
  CHECK(r.grains < 0.03);    // 0.018
  CHECK(two_waves(c, uw).stress > 10 * r.stress);
}

TEST_CASE("two layers, Darcy: relative motion has no inertia") {
  set_threads(1);
  const Exchange r = exchange_of_momentum(neglected(1e-2), 1e-6, 3);
  CHECK(std::abs(r.relative) < 1e-3);
  Choice c = neglected(1e-2);
  c.formulation = "two-layer";
  CHECK(exchange_of_momentum(c, 1e-6, 3).relative > 0.2);
}

TEST_CASE("two layers, Darcy: the stable step is that of the skeleton's wave with buoyant mass") {
  set_threads(1);
  const auto limit = [](const std::string& formulation, double k) {
    Choice c = neglected(k);
    c.formulation = formulation;
    Scene s = wet_scene(c, 1, 1, 1);
    s.materials = {elastic_soil(1e7, 0.2, 0.4, k)};
    s.bodies = {box(0, 0, 0.5, 0.5, c)};
    return coupling::find_stability_limit(s).courant_number;  // with the inertia of the grains
  };
  const double buoyant = std::sqrt(1.65 / 2.65);
  CHECK(limit("two-layer-darcy", 1) < 0.9 * limit("two-layer", 1));
  CHECK(limit("two-layer-darcy", 1) == doctest::Approx(1.8 * buoyant).epsilon(0.1));
  CHECK(limit("two-layer-darcy", 1e-6) == doctest::Approx(limit("two-layer", 1e-6)).epsilon(0.1));
}
