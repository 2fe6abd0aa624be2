// Two layers: water that rises through soil which retains some of its own and falls again, beside sharp
// fronts; water_physics_report prints the table.
#include <doctest/doctest.h>

#include <cmath>

#include "core/threads.hpp"
#include "tests/verify/cut_run.hpp"
#include "tests/verify/water_wetting.hpp"

using namespace polder;
using namespace polder::verify;

TEST_CASE("water rises through soil that retains some: front, inflow, weight on both sides") {
  set_threads(1);
  for (const double retained : {0.0, 0.5, 0.8}) {
    const Wetting r = rising_front({.formulation = "two-layer", .conductivity = 1e-2}, retained);
    CAPTURE(retained);
    CHECK(r.front_error < 0.4);
    CHECK(std::abs(r.inflow_error) < 0.05);
    CHECK(std::abs(r.stress_before) < 0.005);
    CHECK(std::abs(r.stress_after) < 0.05);
    CHECK(std::abs(r.water_error) < 1e-12);
  }
}

TEST_CASE("and leaves it again") {
  set_threads(1);
  for (const double retained : {0.0, 0.5, 0.8}) {
    const Draining r = falling_front({.formulation = "two-layer", .conductivity = 1e-2}, retained);
    CAPTURE(retained);
    CHECK(r.level_error < 0.4);
    CHECK(std::abs(r.water_error) < 1e-12);
  }
}

TEST_CASE("retained water and points that were split: cut at any step, on any number of threads") {
  const Scene scene = rising_front_scene({.formulation = "two-layer", .conductivity = 1e-2}, 0.8, 0.5);
  check_cut_and_threads(scene, "body_0/retained_water");
  Simulation run(scene);
  const std::size_t first = run.water_points().count();
  while (!run.finished()) run.step();
  CHECK(run.water_points().count() > first + 8);
}
