// Two layers: the same bits for any number of threads, and for a run that is cut at any step and goes on from
// its state, with water that comes in on one side and leaves on the other.
#include <doctest/doctest.h>

#include <random>
#include <string>
#include <utility>

#include "core/threads.hpp"
#include "tests/verify/cut_run.hpp"
#include "tests/verify/two_layer_scenes.hpp"

using namespace polder;
using namespace polder::verify;

namespace {

Scene affine(Scene s) {
  s.numerics.water_transfer = coupling::Transfer::apic;
  return s;
}

// A direct and an iterative pressure solver (more than 500 cells), and both ways to carry the water's
// velocity.
const std::pair<std::string, Scene> kScenes[] = {
    {"10 x 9 cells",
     open_sides_scene({.formulation = "two-layer", .courant = 0.5, .conductivity = 1e-2}, 0.5)},
    {"10 x 9 cells, Darcy",
     open_sides_scene({.formulation = "two-layer-darcy", .courant = 0.5, .conductivity = 1e-2}, 0.5)},
    {"10 x 9 cells, explicit pressure", open_sides_scene({.formulation = "two-layer",
                                                          .courant = 0.5,
                                                          .conductivity = 1e-2,
                                                          .bulk_modulus = 1e6,
                                                          .pressure = coupling::PressureMethod::compressible},
                                                         0.5)},
    {"30 x 27 cells, affine water",
     affine(open_sides_scene(
         {.formulation = "two-layer", .cell = 1.0 / 30, .courant = 0.5, .conductivity = 1e-2}, 0.15))}};

}  // namespace

TEST_CASE("two layers: water comes in and leaves, and the points account for it") {
  set_threads(1);
  for (const auto& [name, scene] : kScenes) {
    CAPTURE(name);
    const WholeRun e = run_whole(scene);
    CHECK(e.state.numbers.at("water_added") > 0);
    CHECK(e.state.numbers.at("water_removed") > 0);
    CHECK(e.sorts > 2);
  }
}

TEST_CASE("two layers: a run cut at any step goes on with the same bits") {
  set_threads(1);
  std::mt19937 random(20);
  for (const auto& [name, scene] : kScenes) {
    CAPTURE(name);
    const WholeRun whole = run_whole(scene);
    MESSAGE(name << ": " << whole.steps << " steps, " << whole.sorts << " sorts, solver "
                 << std::string(Simulation(scene).pressure_solver()));
    for (int cut = 0; cut < 4; ++cut) {
      const long at = 1 + static_cast<long>(random() % (whole.steps - 1));
      check_cut_run(scene, at, whole.state, whole.steps);
    }
  }
}

TEST_CASE("two layers: the same bits with 1, 2 and 4 threads") {
  for (const auto& [name, scene] : kScenes) {
    CAPTURE(name);
    set_threads(1);
    const WholeRun one = run_whole(scene);
    for (const int n : {2, 4}) {
      CAPTURE(n);
      set_threads(n);
      check_same_bits(run_whole(scene).state, one.state);
    }
  }
  set_threads(1);
}
