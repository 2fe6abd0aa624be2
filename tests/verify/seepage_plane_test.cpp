// Plane seepage against exact and converged solutions: infiltration, recharge, seepage faces, a dam, a sheet
// pile.
#include "tests/verify/seepage_plane.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "core/threads.hpp"

using namespace polder;
using namespace polder::verify;

TEST_CASE("infiltration into a dry square: Tracy") {
  set_threads(1);
  const Tracy coarse = tracy(20), fine = tracy(40);
  const double demands[] = {0.02, 0.01, 0.004, 0.004, 0.004};
  for (int i = 0; i < 5; ++i) {
    CAPTURE(i);
    CHECK(fine.head_error[i] < demands[i]);
    CHECK(fine.head_error[i] < 0.8 * coarse.head_error[i]);
  }
  CHECK(std::log2(coarse.head_error[0] / fine.head_error[0]) > 1.2);
  CHECK(std::abs(fine.defect) < 1e-6);
  CHECK(fine.steady_iterations < 100);
}

TEST_CASE("recharge of a water table by rain on a part of the surface: Vauclin's set-up") {
  set_threads(1);
  const Recharge r = vauclin(20);
  const double tables[] = {0.012, 0.01, 0.007, 0.006};
  for (int i = 0; i < 4; ++i) {
    CAPTURE(i);
    CHECK(r.table_error[i] < tables[i]);  // [m], cells of 0.1 m
    CHECK(r.head_error[i] < 0.015);
    CHECK(std::abs(r.outflow_error[i]) < 0.008);
  }
  CHECK(std::abs(r.defect) < 1e-6);
  CHECK(r.cost.iterations < 10);
  CHECK(r.cost.rejected <= 2);
}

TEST_CASE("a level rises on an unsaturated block with a seepage face") {
  set_threads(1);
  const Wetting coarse = block_wetting(15), fine = block_wetting(30);
  for (std::size_t i = 0; i < fine.table_error.size(); ++i) {
    CAPTURE(i);
    CHECK(fine.table_error[i] < 0.004);  // [m]; the reference itself 3.6e-3
    CHECK(std::abs(fine.inflow_error[i]) < 0.004);
    CHECK(std::abs(fine.face_error[i]) < 0.004);
    CHECK(fine.table_error[i] < 0.6 * coarse.table_error[i]);
  }
  CHECK(std::abs(fine.defect) < 1e-6);
  CHECK(fine.cost.rejected == 0);
}

TEST_CASE("steady seepage through a dam: Charny's discharge as the capillary fringe gets thin") {
  set_threads(1);
  double before = 1;
  for (const double fringe : {0.5, 0.1, 0.05}) {
    CAPTURE(fringe);
    const Dam r = dam(40, fringe);
    CHECK(r.report.converged);
    CHECK(r.report.iterations < 250);
    CHECK(r.discharge > 1);  // the fringe carries water, too
    CHECK(r.discharge - 1 < 0.5 * before);
    before = r.discharge - 1;
  }
  CHECK(before < 0.005);
  CHECK(std::abs(dam(40, 0.05, fdm::FaceWeighting::upstream).discharge - 1) < 0.01);
}

TEST_CASE("flow under a sheet pile and its exit gradient: Harr") {
  set_threads(1);
  for (const double depth : {0.2, 0.5, 0.8}) {
    CAPTURE(depth);
    const SheetPile coarse = sheet_pile(20, depth), fine = sheet_pile(40, depth);
    // The tip is a singular point: first order.
    CHECK(std::abs(fine.discharge_error) < 0.019);
    CHECK(std::abs(fine.gradient_error) < (depth < 0.3 ? 0.05 : 0.025));
    CHECK(coarse.discharge_error / fine.discharge_error > 1.8);
    CHECK(coarse.gradient_error / fine.gradient_error > 1.8);
  }
}
