// States of rest, steady flow and undrained loading of the one-layer formulation, and an undrained slump.
#include "tests/verify/one_layer_rest.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "core/threads.hpp"

using namespace polder;
using namespace polder::verify;

namespace {

constexpr ShapeKind kShapes[] = {ShapeKind::gimp, ShapeKind::quadratic_bspline};

std::string name_of(ShapeKind shape) {
  return shape == ShapeKind::gimp ? "GIMP" : "B-spline";
}

}  // namespace

TEST_CASE("hydrostatic column under its own weight, its surface anywhere in a cell") {
  set_threads(1);
  for (const ShapeKind shape : kShapes)
    for (int i = 0; i < 8; ++i) {
      const double offset = (i + 0.5) / 8;
      const Rest r = hydrostatic({.shape = shape, .offset = offset}, 8);
      CAPTURE(name_of(shape));
      CAPTURE(offset);
      CHECK(r.pressure_error < 0.002);
      CHECK(r.speed < 1e-6);
      CHECK(r.motion < 1e-8);
      CHECK(r.point_stress_error < 0.01);
    }
}

TEST_CASE("upward seepage at 0.3, 0.6 and 0.9 of the critical gradient") {
  set_threads(1);
  for (const ShapeKind shape : kShapes)
    for (const double share : {0.3, 0.6, 0.9}) {
      const Rest r = upward_seepage({.shape = shape}, share);
      CAPTURE(name_of(shape));
      CAPTURE(share);
      CHECK(r.pressure_error < 1e-3);
      CHECK(r.point_stress_error < 0.03);
      CHECK(r.cell_stress_error < 0.03);
    }
}

TEST_CASE("strip load on undrained soil: smooth pressure") {
  set_threads(1);
  for (const ShapeKind shape : kShapes)
    for (const double jitter : {0.0, 0.3}) {
      const Strip r = strip_load(
          {.cell = 1.0 / 16, .shape = shape, .conductivity = 1e-12, .bulk_modulus = 1e20}, 0.5, jitter);
      CAPTURE(name_of(shape));
      CAPTURE(jitter);
      CHECK(r.roughness < 2e-4);
      CHECK(r.middle == doctest::Approx(0.524).epsilon(0.04));  // with cells of 1/32 m, either shape
    }
}

TEST_CASE("a checkerboard of pressure fades, also without permeability") {
  set_threads(1);
  for (const ShapeKind shape : kShapes)
    for (const double conductivity : {1e-12, 1e-4})
      CHECK(std::abs(checkerboard_left({.shape = shape, .conductivity = conductivity}, 200)) < 0.05);
  // Without the Rhie-Chow term it stays: the term is what this test is about.
  CHECK(std::abs(checkerboard_left({.conductivity = 1e-12, .rhie_chow = 0}, 200)) > 0.5);
}

TEST_CASE("undrained slump of a soft block") {
  set_threads(1);
  for (const ShapeKind shape : kShapes) {
    const Slump r = slump({.shape = shape, .courant = 0.4, .conductivity = 1e-5}, 2);
    CAPTURE(name_of(shape));
    CHECK(r.height == doctest::Approx(0.872).epsilon(0.01));
    CHECK(std::abs(r.volume - 1) < 0.005);
    CHECK(std::abs(r.water_error) < 0.01);
    CHECK(r.roughness < 0.02);
    CHECK(r.largest_speed < 2);           // free fall from the top: 4.4
    CHECK(r.energy < 1.05 * r.released);  // none comes from nowhere
  }
}

TEST_CASE("stable at courant 1 for any conductivity") {
  set_threads(1);
  for (const ShapeKind shape : kShapes)
    for (const double k : {1e-12, 1e-9, 1e-6, 1e-3, 1e-2, 1.0}) {
      CAPTURE(name_of(shape));
      CAPTURE(k);
      const Choice c{.shape = shape, .courant = 1, .conductivity = k};
      const Rest rest = hydrostatic({.shape = shape, .courant = 1, .conductivity = k, .offset = 0.3}, 3);
      CHECK(rest.pressure_error < 0.002);
      CHECK(rest.speed < 1e-6);
      const Slump r = slump(c, 2);
      CHECK(r.largest_speed < 2.5);
      CHECK(r.height > 0.8);
      CHECK(r.height < 1.0);
      const Strip strip = strip_load({.shape = shape, .courant = 1, .conductivity = k}, 2);
      CHECK(strip.largest_speed < 1e-3);
      CHECK(strip.roughness < 2e-3);
    }
}
