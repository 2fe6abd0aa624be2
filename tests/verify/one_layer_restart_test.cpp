// The same bits for any number of threads, and for a run that is cut at any step and goes on from its state:
// wet soil with suction above a phreatic line, an equilibrium and a dynamic stage, re-sorting on the way.
#include <doctest/doctest.h>

#include <random>
#include <string>
#include <utility>

#include "core/threads.hpp"
#include "tests/verify/cut_run.hpp"
#include "tests/verify/one_layer_rest.hpp"

using namespace polder;
using namespace polder::verify;

namespace {

// Soft soil that settles under its weight, then slumps under a growing load.
Scene scene_with_everything(const Choice& c, double duration) {
  Scene s = slump_scene(c, duration);
  s.water.initial = coupling::WaterSpec::Initial::hydrostatic;
  s.water.phreatic = {{0, 0.9, 0}, {4, 0.6, 0}};
  s.water.saturation_above = 0.6;
  s.water.suction_above = 2000;
  s.bodies[0].jitter = 0.2;
  coupling::Boundary weight = load(0.6, 0, 1, 0);
  weight.pressure.time = {0, 0.5 * duration, duration};
  weight.pressure.value = {0, 500, 4000};
  s.boundaries.push_back(weight);
  coupling::Stage rest = s.stages[0];
  rest.name = "rest";
  rest.mode = coupling::Stage::Mode::equilibrium;
  rest.duration = 20;
  rest.damping = 0.7;
  rest.gravity_ramp = 0.2;
  rest.force_tolerance = rest.energy_tolerance = 0.05;
  rest.reset_displacement = true;
  s.stages[0].damping = 0.02;
  s.stages.insert(s.stages.begin(), rest);
  return s;
}

// A direct and an iterative pressure solver (more than 500 cells), and both shapes.
const std::pair<std::string, Scene> kScenes[] = {
    {"10 x 10 cells, GIMP", scene_with_everything({.courant = 0.5, .conductivity = 1e-4}, 2)},
    {"28 x 28 cells, B-spline",
     scene_with_everything(
         {.cell = 1.0 / 28, .shape = ShapeKind::quadratic_bspline, .courant = 0.8, .conductivity = 1e-4},
         0.7)}};

}  // namespace

TEST_CASE("wet soil: a run cut at any step goes on with the same bits") {
  set_threads(1);
  std::mt19937 random(20);
  for (const auto& [name, scene] : kScenes) {
    CAPTURE(name);
    const WholeRun whole = run_whole(scene);
    REQUIRE(whole.first_stage_ended == "equilibrium");
    MESSAGE(name << ": " << whole.steps << " steps, " << whole.sorts << " sorts, solver "
                 << std::string(Simulation(scene).pressure_solver()));
    CHECK(whole.sorts > 3);
    for (int cut = 0; cut < 4; ++cut) {
      const long at = 1 + static_cast<long>(random() % (whole.steps - 1));
      check_cut_run(scene, at, whole.state, whole.steps);
    }
  }
}

TEST_CASE("wet soil: the same bits with 1, 2 and 4 threads") {
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
