// Two layers whose solids are grains dispersed in the water: where they touch all is as with a skeleton, and
// above the porosity at which they do they carry no stress. Demands stand beside what was measured when they
// were set.
#include <doctest/doctest.h>

#include <cmath>

#include "core/threads.hpp"
#include "tests/verify/cut_run.hpp"
#include "tests/verify/one_layer_consolidation.hpp"
#include "tests/verify/one_layer_rest.hpp"
#include "tests/verify/two_layer_scenes.hpp"
#include "tests/verify/water_lift.hpp"

using namespace polder;
using namespace polder::verify;

namespace {

Choice mixture(double cell = 0.1) {
  return {.formulation = "mixture", .cell = cell};
}

Scene slope_of(const Choice& c, double porosity) {
  Scene s = open_sides_scene(c, 0.3);
  s.materials[0] = loose_sand(porosity, 2e-3, 0.5);
  return s;
}

}  // namespace

TEST_CASE("mixture: grains that touch are a skeleton, to the bit") {
  set_threads(1);
  Choice c = mixture();
  const Consolidation a = terzaghi(c, {0.05, 0.2, 0.5}, 100);
  c.formulation = "two-layer";
  const Consolidation b = terzaghi(c, {0.05, 0.2, 0.5}, 100);
  CHECK(a.pressure_error[1] < 0.003);
  CHECK(a.settlement_ratio == b.settlement_ratio);
  for (int i = 0; i < 3; ++i) CHECK(a.pressure_error[i] == b.pressure_error[i]);
}

TEST_CASE("mixture: above the porosity of contact a bed sinks until it is dense, where a skeleton stands") {
  set_threads(1);
  // Sand of porosity 0.4 whose grains touch below 0.38, its own weight on it.
  const coupling::Material sand = loose_sand(0.4, 1e-3, 0.38);
  Choice c = mixture();
  const Lifting loose = lifting(c, sand, 0.1);
  c.formulation = "two-layer";
  const Lifting skeleton = lifting(c, sand, 0.1);
  CHECK(skeleton.fluidised < 0.11);  // the surface
  CHECK(skeleton.settled_height > 0.995);
  CHECK(loose.fluidised > 0.95);
  CHECK(loose.settled_share < 0.2);  // 0.15: near the surface grains come to rest slowly
  CHECK(loose.settled_height == doctest::Approx(0.6 / 0.62).epsilon(0.01));
  // Mean over the height of the weight under water.
  CHECK(loose.settled_compression == doctest::Approx(0.5 * 0.6 * 1650 * kGravity).epsilon(0.1));
  CHECK(std::abs(loose.water_error) < 1e-12);
  CHECK(std::abs(loose.solid_error) < 1e-12);
}

TEST_CASE("mixture: a suspension sinks as its drag law says") {
  set_threads(1);
  const Settling r = settling(mixture(0.05), loose_sand(0.9, 1e-3, 0.5), 1);
  CHECK(r.grains == doctest::Approx(r.exact).epsilon(0.01));
  CHECK(r.velocity == doctest::Approx(r.exact).epsilon(0.04));
  CHECK(r.sediment < 0.51);
}

TEST_CASE("mixture: a run cut at any step goes on with the same bits, on any number of threads") {
  check_cut_and_threads(slope_of(mixture(), 0.51), "fluidised_0");
}
