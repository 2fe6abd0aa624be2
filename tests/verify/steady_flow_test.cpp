// Steady flow does not depend on where the search begins, and is found quickly.
#include "tests/verify/steady_flow.hpp"

#include <doctest/doctest.h>

#include "core/threads.hpp"

using namespace polder;
using namespace polder::verify;

TEST_CASE("steady flow through dams and levees of any soil, with drains: the same from three starts") {
  set_threads(1);
  for (const SteadyScene& scene : steady_scenes()) {
    CAPTURE(scene.name);
    CAPTURE(scene.levee);
    CAPTURE(scene.drain);
    double first = 0;
    for (const SteadyStart start : {SteadyStart::near, SteadyStart::still, SteadyStart::dry}) {
      const SteadyFlow flow = steady_flow(scene, start, true);
      CHECK(flow.converged);
      CHECK(flow.iterations <= 80);
      CHECK(flow.inflow == doctest::Approx(flow.outflow).epsilon(2e-6));
      if (first > 0)
        CHECK(flow.outflow == doctest::Approx(first).epsilon(1e-5));
      else
        first = flow.outflow;
    }
  }
}

TEST_CASE("steady flow with curves at the centres of cells: loams with a drain from a dry levee") {
  set_threads(1);
  for (const SteadyScene& scene : steady_scenes()) {
    if (scene.n < 1.2)
      continue;  // the slope of k_r is unbounded at p = 0: see docs/validation/free_surface.md
    CAPTURE(scene.name);
    CAPTURE(scene.levee);
    CAPTURE(scene.drain);
    const SteadyFlow flow = steady_flow(scene, SteadyStart::dry, false);
    CHECK(flow.converged);
    CHECK(flow.iterations <= 100);
    CHECK(flow.inflow == doctest::Approx(flow.outflow).epsilon(2e-6));
    // The cells look different inside, the flow is the same but for that.
    CHECK(flow.outflow ==
          doctest::Approx(steady_flow(scene, SteadyStart::near, true).outflow).epsilon(0.005));
  }
}
