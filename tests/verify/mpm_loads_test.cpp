// Boundaries and loads against closed solutions.
#include "tests/verify/mpm_loads.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <string>

#include "core/threads.hpp"
#include "io/csv.hpp"

using namespace polder;
using namespace polder::verify;

TEST_CASE("block on an incline with friction: slides as a rigid one, sticks below the threshold") {
  set_threads(1);
  struct Run {
    double angle, coefficient, speed;
    const char* column;
  };
  const CsvTable table(std::filesystem::path(POLDER_SOURCE_DIR) / "tests" / "reference" /
                       "sliding_block.csv");
  const auto t = table.column("t[s]");
  std::size_t row = 0;
  while (row + 1 < t.size() && t[row] < 0.5 - 1e-9) ++row;
  REQUIRE(t[row] == doctest::Approx(0.5));
  for (const ShapeKind shape : {ShapeKind::gimp, ShapeKind::quadratic_bspline})
    for (const Run& run :
         {Run{20, 0, 0, "th=20;mu=0"}, Run{20, 0.2, 0, "th=20;mu=0.2"}, Run{20, 0.3, 0, "th=20;mu=0.3"},
          Run{20, 0.4, 0, "th=20;mu=0.4"}, Run{45, 0.5, 0, "th=45;mu=0.5"},
          Run{10, 0.3, 2, "th=10;mu=0.3;v0=2"}, Run{0, 0.3, 2, "th=0;mu=0.3;v0=2"}}) {
      CAPTURE(run.column);
      CAPTURE(static_cast<int>(shape));
      const double x = table.column(std::string("x[m]@") + run.column)[row];
      const double v = table.column(std::string("v[m/s]@") + run.column)[row];
      const SlideResult r = slide_block(shape, run.angle, run.coefficient, run.speed, 0.5);
      CHECK(std::abs(r.distance - x) < 0.015 * x + 5e-4);
      CHECK(std::abs(r.velocity - v) < 0.03 * v + 1e-3);
    }
}

TEST_CASE("block on a segment inside the grid slides along it and stays on it") {
  set_threads(1);
  for (const ShapeKind shape : {ShapeKind::gimp, ShapeKind::quadratic_bspline})
    for (const double angle : {20.0, 30.0, 45.0}) {
      const SegmentResult r = slide_on_segment(shape, angle, 0.1);
      CHECK(std::abs(r.acceleration) < 1e-6);
      CHECK(r.depth < 0.02);
      CHECK(std::abs(r.lift) < 0.05);
    }
}

TEST_CASE("traction, pressure and prescribed velocity on the top of a block") {
  set_threads(1);
  CHECK(press_block(ShapeKind::gimp, TopLoad::traction, 0) < 1e-4);
  CHECK(press_block(ShapeKind::gimp, TopLoad::pressure, 0) < 1e-4);
  CHECK(press_block(ShapeKind::gimp, TopLoad::pressure, 0.3) < 2e-3);
  CHECK(press_block(ShapeKind::quadratic_bspline, TopLoad::traction, 0) < 1e-3);
  // A surface inside a cell: the B-spline's two points an axis integrate the stress below it to a few per
  // cent.
  CHECK(press_block(ShapeKind::quadratic_bspline, TopLoad::traction, 0.3) < 0.03);
  CHECK(press_block(ShapeKind::gimp, TopLoad::velocity, 0) < 5e-4);
  CHECK(press_block(ShapeKind::quadratic_bspline, TopLoad::velocity, 0) < 5e-4);
}

TEST_CASE("thick cylinder under inner pressure, axisymmetric") {
  set_threads(1);
  const CylinderResult coarse = press_cylinder(ShapeKind::quadratic_bspline, false, 0.2);
  const CylinderResult fine = press_cylinder(ShapeKind::quadratic_bspline, false, 0.1);
  CHECK(fine.radial < 0.01);
  CHECK(fine.hoop < 0.005);
  CHECK(fine.axial < 0.005);
  CHECK(fine.displacement < 0.002);
  CHECK(coarse.radial / fine.radial > 1.8);
  const CylinderResult gimp = press_cylinder(ShapeKind::gimp, true, 0.1);
  CHECK(gimp.radial < 0.03);
  CHECK(gimp.hoop < 0.015);
  CHECK(gimp.displacement < 0.002);
}

TEST_CASE("strip footing on clay fails at (2 + pi) c") {
  set_threads(1);
  FootingOptions o;
  o.cells = 7;
  o.speed = 0.04;
  for (const ShapeKind shape : {ShapeKind::gimp, ShapeKind::quadratic_bspline}) {
    o.shape = shape;
    const FootingResult r = push_footing(o);
    CHECK(r.factor == doctest::Approx(2 + 3.14159265).epsilon(0.05));
    CHECK(std::abs(r.last_slope) < 0.02 * r.initial_slope);  // a plateau
    CHECK(r.roughness < 0.05);
  }
}
