// Upward flow to fluidisation and back, hindered settling, and their restart.
#include <doctest/doctest.h>

#include <cmath>

#include "core/threads.hpp"
#include "tests/verify/cut_run.hpp"
#include "tests/verify/two_layer_scenes.hpp"
#include "tests/verify/water_lift.hpp"

using namespace polder;
using namespace polder::verify;

namespace {

Choice layers(double cell = 0.1) {
  return {.formulation = "two-layer", .cell = cell};
}

}  // namespace

TEST_CASE("fluidisation: upward flow lifts sand at the critical gradient, and it settles again") {
  set_threads(1);
  const Lifting below = lifting(layers(), loose_sand(0.4, 1e-3, 0.42), 0.9);
  CHECK(below.critical == 0);
  CHECK(below.fluidised == 0);
  CHECK(below.height < 1.005);
  const Lifting r = lifting(layers(), loose_sand(0.4, 1e-3, 0.42), 1.1);
  CHECK(r.critical == doctest::Approx(1).epsilon(0.03));
  CHECK(r.fluidised > 0.05);
  CHECK(r.height > 1.01);
  CHECK(r.settled_share == 0);
  CHECK(r.settled_stress == doctest::Approx(1).epsilon(0.1));
  CHECK(std::abs(r.water_error) < 1e-12);
  CHECK(std::abs(r.solid_error) < 1e-12);
}

TEST_CASE("fluidisation: grains without contact carry no stress, and lose it only with their stress") {
  set_threads(1);
  // A porosity above the threshold alone does not fluidise: the soil stands under its own weight.
  Lifting r = lifting(layers(), loose_sand(0.4, 1e-3, 0.39), 0.9);
  CHECK(r.fluidised < 0.11);  // no more than the surface, where stress is next to nothing
  CHECK(r.settled_stress == doctest::Approx(1).epsilon(0.1));
  // Grains in suspension do not know the stiffness of the skeleton.
  coupling::Material soft = loose_sand(0.9, 1e-3, 0.5), stiff = soft;
  stiff.young *= 4;
  const Settling a = settling(layers(), soft, 1), b = settling(layers(), stiff, 1);
  CHECK(b.grains == doctest::Approx(a.grains).epsilon(0.01));
}

TEST_CASE("settling: a suspension sinks as its drag law says") {
  set_threads(1);
  for (const coupling::DragLaw law : {coupling::DragLaw::gidaspow, coupling::DragLaw::di_felice}) {
    coupling::Material m = loose_sand(0.9, 1e-3, 0.5);
    m.drag_law = law;
    const Settling r = settling(layers(0.05), m, 1);
    CAPTURE(static_cast<int>(law));
    CHECK(r.grains == doctest::Approx(r.exact).epsilon(0.01));
    CHECK(r.velocity == doctest::Approx(r.exact).epsilon(0.04));
    CHECK(r.exact == doctest::Approx(r.richardson_zaki).epsilon(0.1));
    CHECK(r.sediment < 0.51);
  }
}

TEST_CASE("fluidisation: a run cut at any step goes on with the same bits, on any number of threads") {
  Scene scene = open_sides_scene(layers(), 0.3);
  scene.materials[0] = loose_sand(0.6, 2e-3, 0.5);
  check_cut_and_threads(scene, "fluidised_0");
}
