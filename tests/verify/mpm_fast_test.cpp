// Verification of the soil skeleton in seconds: the same cases as mpm_report prints, on coarse grids.
#include <doctest/doctest.h>

#include "core/threads.hpp"
#include "tests/verify/mpm_collapse.hpp"
#include "tests/verify/mpm_column.hpp"

using namespace polder;
using namespace polder::verify;

TEST_CASE("elastic column under its own weight, from zero stress") {
  set_threads(1);
  ColumnOptions o;
  for (const ShapeKind shape : {ShapeKind::gimp, ShapeKind::quadratic_bspline}) {
    o.shape = shape;
    o.spacing = 0.1;
    const ColumnResult coarse = settle_column(o);
    o.spacing = 0.05;
    const ColumnResult fine = settle_column(o);
    CHECK(fine.unbalanced < 1e-3);
    CHECK(fine.cell_rms < 0.005);
    CHECK(fine.cell_rms < coarse.cell_rms);
    CHECK(fine.rms < coarse.rms);
    // A point sees its cell's strain: with GIMP points off the cell's centre miss up to a quarter cell of
    // weight.
    CHECK(fine.rms < (shape == ShapeKind::gimp ? 0.25 * o.spacing : 0.005));
    CHECK(fine.bottom < 0.27 * o.spacing);
    // The slope of the cells' means mends that, also at the fixed base.
    CHECK(fine.recovered_rms < 0.0015);
    CHECK(fine.recovered_bottom < 0.005);
    CHECK(fine.recovered_rms < 0.6 * coarse.recovered_rms);
    CHECK(std::abs(fine.settlement_error) < 1e-3);
    CHECK(std::abs(fine.reaction_error) < 1e-3);  // what is out of balance at the end
  }
}

TEST_CASE("an exact initial stress stays exact") {
  set_threads(1);
  ColumnOptions o;
  o.from_exact_stress = true;
  CHECK(settle_column(o).rms < 1e-6);
  o.cell_average = true;
  CHECK(settle_column(o).rms < 1e-6);
  o.shape = ShapeKind::quadratic_bspline;
  CHECK(settle_column(o).rms < 0.002);
}

TEST_CASE("the column in 3D equals the column in the plane") {
  set_threads(1);
  ColumnOptions o;
  o.spacing = 0.1;
  const ColumnResult plane = settle_column(o);
  o.three_d = true;
  const ColumnResult space = settle_column(o);
  CHECK(space.unbalanced < 1e-3);
  CHECK(space.rms == doctest::Approx(plane.rms).epsilon(1e-3));
  CHECK(std::abs(space.reaction_error) < 1e-4);
}

TEST_CASE("no point of a collapsing column is lost or ejected") {
  set_threads(1);
  CollapseOptions o;
  o.aspect = 2;
  o.cells_across = 6;
  for (const ShapeKind shape : {ShapeKind::gimp, ShapeKind::quadratic_bspline})
    for (const double cohesion : {0.0, 1.0, 100.0})
      for (const double flip : {0.98, 1.0}) {
        CAPTURE(static_cast<int>(shape));
        CAPTURE(cohesion);
        CAPTURE(flip);
        o.shape = shape, o.cohesion = cohesion, o.flip = flip;
        const CollapseResult r = collapse(o);
        CHECK(r.lost == 0);
        CHECK(r.fastest < 1.5);
        CHECK(std::abs(r.volume_change) < 0.01);
        CHECK(r.kinetic < 0.02);
        if (cohesion < 100) CHECK(r.runout > 1.5);
      }
}
