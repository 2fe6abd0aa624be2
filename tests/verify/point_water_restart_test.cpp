// Water on the soil's points: the same bits for any number of threads, and for a run that is cut at any step
// and goes on from its state, over the ends of stages, with water held and flowing, through a side too.
#include <doctest/doctest.h>

#include <string>

#include "core/threads.hpp"
#include "tests/verify/cut_run.hpp"
#include "tests/verify/one_layer_rest.hpp"

using namespace polder;
using namespace polder::verify;

namespace {

// Soft soil slumps, first with its pore pressure held; a pressure at its foot.
Scene slumping(const char* formulation) {
  Scene s = slump_scene(
      {.formulation = formulation, .courant = 0.4, .conductivity = 1e-3, .bulk_modulus = 2.2e6}, 0.3);
  s.bodies[0].jitter = 0.2;
  s.numerics.locking = coupling::LockingCure::automatic;
  coupling::WaterBoundary side;
  side.name = "side";
  side.kind = coupling::WaterBoundary::Kind::head;
  side.side = 0;
  side.value = {{0, 1}, {0.3, 0.6}};
  s.water_boundaries = {side};
  coupling::Stage held = s.stages[0];
  held.name = "held", held.duration = 0.1, held.water_flows = false, held.reset_velocity = true;
  s.stages.insert(s.stages.begin(), held);
  return s;
}

}  // namespace

TEST_CASE("water on points: a run cut at any step goes on with the same bits") {
  set_threads(1);
  for (const char* f : {"v-w", "u-p"}) {
    CAPTURE(f);
    const Scene scene = slumping(f);
    const WholeRun whole = run_whole(scene);
    MESSAGE(f << ": " << whole.steps << " steps, " << whole.sorts << " sorts");
    CHECK(whole.sorts > 2);
    CHECK(whole.state.numbers.at("outflow") != 0);
    for (const long at : {1L, whole.steps / 4, whole.steps / 2 + 3, 4 * whole.steps / 5})
      check_cut_run(scene, at, whole.state, whole.steps);
  }
}

TEST_CASE("water on points: the same bits with 1, 2 and 4 threads") {
  for (const char* f : {"v-w", "u-p"}) {
    CAPTURE(f);
    set_threads(1);
    const WholeRun one = run_whole(slumping(f));
    for (const int n : {2, 4}) {
      CAPTURE(n);
      set_threads(n);
      check_same_bits(run_whole(slumping(f)).state, one.state);
    }
  }
  set_threads(1);
}
