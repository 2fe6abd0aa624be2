// Columns of unsaturated soil against exact solutions: absorption, sharp fronts, ponding, steady rain and
// evaporation, falling head.
#include "tests/verify/seepage_columns.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "core/threads.hpp"

using namespace polder;
using namespace polder::verify;

TEST_CASE("horizontal absorption: Philip's sorptivity, order above one and a half") {
  set_threads(1);
  const Absorption coarse = sorptivity(60), fine = sorptivity(120);
  CHECK(std::abs(fine.volume_error) < 0.003);
  CHECK(fine.profile_error < 0.003);
  CHECK(std::log2(coarse.volume_error / fine.volume_error) > 1.4);
  CHECK(std::abs(fine.defect) < 1e-6);
}

TEST_CASE("ponded infiltration with a sharp front: Green and Ampt") {
  set_threads(1);
  const SharpFront coarse = green_ampt(50), fine = green_ampt(200);
  CHECK(fine.volume_error < 0.015);
  CHECK(std::log2(coarse.volume_error / fine.volume_error) / 2 > 0.9);  // the front stays one cell wide
  CHECK(std::abs(fine.balance) < 1e-6);
}

TEST_CASE("rain that ponds: time of ponding, infiltration after it, run-off") {
  set_threads(1);
  const SharpFront coarse = ponding(50), fine = ponding(200);
  CHECK(std::abs(fine.ponding_time - 1) < 0.03);
  CHECK(std::abs(coarse.ponding_time - 1) > 2.5 * std::abs(fine.ponding_time - 1));
  CHECK(std::abs(fine.volume_error) < 0.003);
  CHECK(fine.run_off > 0.2);
  CHECK(std::abs(fine.balance) < 1e-6);
}

TEST_CASE("wetting and drying above a water table: Srivastava and Yeh") {
  set_threads(1);
  for (const bool wetting : {true, false}) {
    CAPTURE(wetting);
    const Profiles r = srivastava_yeh(wetting, 50, 120);
    for (const double e : r.error) CHECK(e < 0.002);
    CHECK(r.flux_error < 0.013);
    const Profiles slow = srivastava_yeh(wetting, 100, 960), quick = srivastava_yeh(wetting, 100, 240);
    CHECK(std::log2(slow.error[0] / quick.error[0]) / 2 > 0.7);
  }
}

TEST_CASE("steady rain and evaporation above a water table: Gardner, second order") {
  set_threads(1);
  const Profiles coarse = gardner(20), fine = gardner(40);
  CHECK(coarse.iterations < 350);  // seven states
  for (std::size_t i = 0; i < fine.error.size(); ++i) {
    CAPTURE(i);
    CHECK(fine.error[i] < 6e-3);
    if (coarse.error[i] > 1e-6) CHECK(std::log2(coarse.error[i] / fine.error[i]) > (i < 6 ? 1.8 : 1.2));
  }
  const double limit = limiting_evaporation(40);
  CHECK(std::abs(limit) < 0.015);
  CHECK(std::log2(limiting_evaporation(20) / limit) > 0.95);
}

TEST_CASE("steady flow above a water table in van Genuchten soil, second order") {
  set_threads(1);
  const Profiles coarse = steady_van_genuchten(20), fine = steady_van_genuchten(80);
  CHECK(fine.iterations < 180);  // five states
  for (std::size_t i = 0; i < fine.error.size(); ++i) {
    CAPTURE(i);
    CHECK(fine.error[i] < 3e-4);
    if (coarse.error[i] > 1e-4) CHECK(std::log2(coarse.error[i] / fine.error[i]) / 2 > 1.6);
  }
}

TEST_CASE("falling head, rigid sample and compressible one") {
  set_threads(1);
  const FallingHead r = falling_head(20);
  CHECK(r.rigid_error < 3e-4);
  CHECK(r.compressible_error < 5e-4);
}
