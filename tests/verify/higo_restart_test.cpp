// Formulation higo: the same bits for any number of threads, and for a run that is cut at any step and goes
// on from its state; saturated and unsaturated, over the ends of stages.
#include <doctest/doctest.h>

#include <string>
#include <utility>

#include "core/threads.hpp"
#include "coupling/memory_state.hpp"
#include "tests/verify/higo_scenes.hpp"
#include "tests/verify/one_layer_rest.hpp"

using namespace polder;
using namespace polder::verify;

namespace {

// Soft soil slumps, first with its pore pressure held; cells come and go.
Scene slumping() {
  Scene s =
      slump_scene({.formulation = "higo", .courant = 0.4, .conductivity = 1e-4, .bulk_modulus = 2.2e7}, 0.3);
  s.bodies[0].jitter = 0.2;
  coupling::Stage held = s.stages[0];
  held.name = "held", held.duration = 0.1, held.water_flows = false;
  s.stages.insert(s.stages.begin(), held);
  return s;
}

// Wet sand slumps in the rain: cells fill and the step becomes that of stiff water.
Scene soaking() {
  Scene s = rain_scene({.formulation = "higo", .cell = 0.1, .bulk_modulus = 2.2e7}, 0.6);
  s.grid.size = {2, 1.4, 0};
  s.bodies[0].box = {{coupling::Vector3{}, coupling::Vector3{0.8, 1, 0}}};
  s.materials[0].young = 5e4;
  s.water.initial_saturation = 0.96;
  s.stages.erase(s.stages.begin());
  return s;
}

coupling::MemoryState run(const Scene& scene, long& steps) {
  Simulation s(scene);
  while (!s.finished()) s.step();
  coupling::MemoryState state;
  state.save(s);
  steps = s.steps();
  return state;
}

const std::pair<std::string, Scene> kScenes[] = {{"slumping", slumping()}, {"soaking", soaking()}};

}  // namespace

TEST_CASE("explicit pressure: a run cut at any step goes on with the same bits") {
  set_threads(1);
  for (const auto& [name, scene] : kScenes) {
    CAPTURE(name);
    long steps = 0;
    const coupling::MemoryState whole = run(scene, steps);
    MESSAGE(name << ": " << steps << " steps");
    CHECK(whole.numbers.at("largest_step") > 3 * whole.numbers.at("smallest_step"));
    long end_of_first = 0;  // where the limit is found anew
    {
      Simulation s(scene);
      while (s.stage() == 0) s.step();
      end_of_first = s.steps();
    }
    for (const long at : {1L, std::min(end_of_first, steps - 1), steps / 2, (4 * steps) / 5}) {
      CAPTURE(at);
      coupling::MemoryState state;
      {
        Simulation first(scene);
        while (first.steps() < at) first.step();
        state.save(first);
      }
      Simulation second(scene);
      state.load(second);
      while (!second.finished()) second.step();
      coupling::MemoryState again;
      again.save(second);
      const std::vector<std::string> different = again.differences(whole);
      if (!different.empty()) MESSAGE("first difference: " << different.front());
      CHECK(different.empty());
      CHECK(second.steps() == steps);
    }
  }
}

TEST_CASE("explicit pressure: the same bits with 1, 2 and 4 threads") {
  for (const auto& [name, scene] : kScenes) {
    CAPTURE(name);
    set_threads(1);
    long steps = 0;
    const coupling::MemoryState one = run(scene, steps);
    for (const int n : {2, 4}) {
      CAPTURE(n);
      set_threads(n);
      CHECK(run(scene, steps).differences(one).empty());
    }
  }
  set_threads(1);
}
