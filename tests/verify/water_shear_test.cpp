// Viscous water between plates: Poiseuille, Couette and how they start.
#include <doctest/doctest.h>

#include <cmath>

#include "core/threads.hpp"
#include "tests/verify/cut_run.hpp"
#include "tests/verify/two_layer_scenes.hpp"
#include "tests/verify/water_shear.hpp"

using namespace polder;
using namespace polder::verify;

namespace {

Choice layers(double cell) {
  return {.formulation = "two-layer", .cell = cell};
}

}  // namespace

TEST_CASE("viscous water: flow under a pressure gradient between plates, second order in the cell") {
  set_threads(1);
  double discharge[2], error[2];
  for (int i = 0; i < 2; ++i) {
    const PlateProfile r = plate_flow(layers(0.2 / (1 << i)), {.affine = true});
    discharge[i] = std::abs(r.discharge - 1), error[i] = r.error;
    CHECK(std::abs(r.water_error) < 1e-12);
    CHECK(r.across < 1e-3);
  }
  CHECK(discharge[1] < 0.011);
  CHECK(error[1] < 0.011);
  CHECK(std::log2(discharge[0] / discharge[1]) > 1.9);
  CHECK(std::log2(error[0] / error[1]) > 1.9);
  // The nodes of points that carry their velocity by FLIP do as well; the points beside the plates do not.
  const PlateProfile flip = plate_flow(layers(0.1), {});
  CHECK(std::abs(flip.discharge - 1) < 0.011);
  CHECK(flip.error < 0.1);
}

TEST_CASE("viscous water: a plate drags it along") {
  set_threads(1);
  const PlateProfile r = plate_flow(layers(0.1), {.drive = PlateFlow::Drive::upper_plate, .affine = true});
  CHECK(r.error < 2e-4);
  // nu t / L^2 = 0.03: half of the gap does not know of the plate yet.
  const PlateProfile early =
      plate_flow(layers(0.05), {.drive = PlateFlow::Drive::upper_plate, .duration = 0.03, .affine = true});
  CHECK(early.error < 0.015);
}

TEST_CASE("viscous water: plates that it slips along neither hold nor drive it") {
  set_threads(1);
  CHECK(std::abs(plate_flow(layers(0.2), {.drive = PlateFlow::Drive::upper_plate, .slips = true}).speed) <
        1e-15);
  const PlateFlow pushed{.slips = true};  // G t / rho, as without viscosity
  CHECK(plate_flow(layers(0.2), pushed).speed == doctest::Approx(8 * 1e-3).epsilon(1e-3));
}

TEST_CASE("viscous water: a run cut at any step goes on with the same bits, on any number of threads") {
  Scene scene = open_sides_scene(layers(0.1), 0.3);
  scene.water.viscous = true;
  scene.water.viscosity = 5;
  coupling::Boundary base;
  base.name = "base";
  base.kind = coupling::Boundary::Kind::fixed;
  base.side = 2;
  base.water = coupling::Boundary::WaterContact::no_slip;
  scene.boundaries = {base};
  set_threads(1);
  const WholeRun whole = run_whole(scene);
  check_cut_run(scene, whole.steps / 2, whole.state, whole.steps);
  set_threads(4);
  check_same_bits(run_whole(scene).state, whole.state);
  set_threads(1);
}
