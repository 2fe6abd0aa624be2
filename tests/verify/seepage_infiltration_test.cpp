// Infiltration into unsaturated columns: profiles, mass balance, orders of convergence.
#include "tests/verify/seepage_infiltration.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "core/threads.hpp"

using namespace polder;
using namespace polder::verify;

TEST_CASE("Celia's New Mexico column: profile within a per cent, balance to rounding, whatever the step") {
  set_threads(1);
  for (const double step : {3600.0, 600.0, 0.0}) {
    CAPTURE(step);
    const Infiltration r = celia_new_mexico({.cells = 100, .step = step});
    CHECK(r.profile_error < 0.01);
    CHECK(std::abs(r.inflow_error) < 0.01);
    CHECK(std::abs(r.defect) < 1e-6);
    CHECK(r.rejected == 0);
    CHECK(r.iterations < 18);
  }
}

TEST_CASE("Celia's column in space: towards second order as the cells resolve the front") {
  set_threads(1);
  const Infiltration coarse = celia_new_mexico({.cells = 100, .step = 60});
  const Infiltration fine = celia_new_mexico({.cells = 400, .step = 60});
  CHECK(std::log2(coarse.inflow_error / fine.inflow_error) / 2 > 1.5);
  CHECK(fine.profile_error < 1.5e-3);
  // Upstream weighting spreads the front, but keeps the balance.
  const Infiltration upstream = celia_new_mexico({.cells = 100, .step = 600, .upstream = true});
  CHECK(upstream.profile_error < 0.03);
  CHECK(std::abs(upstream.defect) < 1e-6);
}

TEST_CASE("Haverkamp's sand: a profile within a per cent, first order in time, second in space") {
  set_threads(1);
  const Infiltration r = celia_haverkamp({.cells = 80, .step = 1});
  CHECK(r.profile_error < 0.01);
  CHECK(std::abs(r.inflow_error) < 0.01);
  CHECK(std::abs(r.defect) < 1e-6);
  const double coarse = celia_haverkamp({.cells = 20, .step = 1}).profile_error;
  CHECK(std::log2(coarse / r.profile_error) / 2 > 1.4);
  const double slow = celia_haverkamp({.cells = 160, .step = 20}).profile_error;
  const double quick = celia_haverkamp({.cells = 160, .step = 5}).profile_error;
  CHECK(std::log2(slow / quick) / 2 > 0.85);
}
