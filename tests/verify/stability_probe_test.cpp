// The block behind the maps of `polder bench stability`: stable with the step that the program chooses, not
// far beyond its limit; and what the maps mark.
#include "bench/stability_probe.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "bench/stability_maps.hpp"
#include "core/threads.hpp"

using namespace polder::bench;

TEST_CASE(
    "a block of saturated soil is stable with the chosen step and breaks down beyond the printed limit") {
  polder::set_threads(1);
  for (const std::string formulation : {"one-layer", "higo", "u-p", "v-w"})
    for (const double k : {1e-8, 1e-3}) {
      CAPTURE(formulation);
      CAPTURE(k);
      Specimen s;
      s.formulation = formulation, s.conductivity = k;
      const double chosen = chosen_step(s), limit = printed_limit(s);
      CHECK(chosen < limit);
      const Verdict inside = probe(s, chosen), beyond = probe(s, 1.5 * limit);
      CHECK(inside.mark() == Mark::stable);
      CHECK(inside.growth < 1);
      CHECK(inside.noise > 0);
      CHECK(beyond.mark() >= Mark::grows);
      CHECK(beyond.growth > Verdict::kGrowth);
    }
}

TEST_CASE("theory and the limit found by experiment agree where the theory has points in it") {
  polder::set_threads(1);
  for (const std::string formulation : {"higo", "u-p", "v-w", "two-layer"})
    for (const double k : {1e-7, 1e-4, 1e-2}) {
      CAPTURE(formulation);
      CAPTURE(k);
      Specimen s;
      s.formulation = formulation, s.conductivity = k;
      s.pressure = polder::coupling::PressureMethod::compressible;  // of two layers
      const double ratio = printed_limit(s) / theoretical_limit(s);
      CHECK(ratio > 0.6);
      CHECK(ratio < 1.3);
    }
}

TEST_CASE("the printed limit of explicit drag is none that a block breaks down below") {
  polder::set_threads(1);
  for (const double k : {1e-5, 1e-4}) {
    CAPTURE(k);
    Specimen s;
    s.formulation = "v-w", s.conductivity = k;
    s.drag = polder::coupling::DragStep::by_last_velocities;
    const double limit = printed_limit(s);
    CHECK(probe(s, 0.98 * limit).mark() == Mark::stable);
    CHECK(probe(s, 1.05 * limit).mark() >= Mark::grows);
  }
}

TEST_CASE("layers far beyond their cap break down too") {
  polder::set_threads(1);
  Specimen s;
  s.formulation = "two-layer", s.conductivity = 0.1;
  const double chosen = chosen_step(s);
  CHECK(probe(s, chosen).mark() == Mark::stable);
  CHECK(probe(s, 8 * chosen).mark() >= Mark::grows);
}

TEST_CASE("marks, from the worst on") {
  Verdict v;
  CHECK(v.mark() == Mark::stable);
  v.water = -2 * Verdict::kWaterDrift;
  CHECK(v.mark() == Mark::drift);
  v.water = 0, v.gain = 2 * Verdict::kGain;
  CHECK(v.mark() == Mark::drift);
  v.noise = 2 * Verdict::kNoise;
  CHECK(v.mark() == Mark::noise);
  v.growth = 2 * Verdict::kGrowth;
  CHECK(v.mark() == Mark::grows);
  v.broke_down = true;
  CHECK(v.mark() == Mark::broke_down);
}

TEST_CASE("a map changes what its axes say") {
  for (const Map& map : stability_maps()) {
    CAPTURE(map.name);
    REQUIRE(map.x.values.size() > 1);
    const auto differs = [](const Axis& axis, const Specimen& base) {
      Specimen a = base, b = base;
      axis.apply(a, axis.values.front()), axis.apply(b, axis.values.back());
      return a.conductivity != b.conductivity || a.bulk_modulus != b.bulk_modulus ||
             a.porosity != b.porosity || a.density_ratio != b.density_ratio || a.saturation != b.saturation ||
             a.dilation != b.dilation || a.flip != b.flip || a.per_axis != b.per_axis || a.random != b.random;
    };
    CHECK(differs(map.x, map.panels[0].specimen));
    if (!map.varies_step()) CHECK(differs(map.y, map.panels[0].specimen));
    CHECK((map.x.words.empty() || map.x.words.size() == map.x.values.size()));
  }
}
