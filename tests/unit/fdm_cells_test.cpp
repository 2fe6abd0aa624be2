#include <doctest/doctest.h>

#include "core/error.hpp"
#include "tests/unit/fdm_scene.hpp"

using namespace polder;
using namespace polder::fdm;
using namespace polder::fdm::test;

TEST_CASE("a column has one face between neighbours, walls without faces and a surface at theta h") {
  Scene<2> s({0, 0}, {1, 12}, 0.5);
  for (double top : {2.36, 2.4, 2.5, 2.7, 2.84}) {
    s.fill_below(top);
    s.cells.update(s.fill, s.conditions);
    CHECK(s.cells.count() == 5);
    CHECK(s.cells.interior_faces().size() == 4);
    REQUIRE(s.cells.boundary_faces().size() == 1);
    const auto& f = s.cells.boundary_faces()[0];
    CHECK(f.axis == 1);
    CHECK(f.outward == 1);
    CHECK(f.boundary == -1);
    CHECK(f.distance == doctest::Approx(top - 2.25).epsilon(1e-12));  // from the centre of the fifth cell
  }
  s.fill_below(2.3499);  // the surface never comes near the centre of the last active cell
  s.cells.update(s.fill, s.conditions);
  CHECK(s.cells.count() == 4);
  CHECK(s.cells.boundary_faces()[0].distance == doctest::Approx(2.3499 - 1.75));
}

TEST_CASE("water that passes from a cell into the one above leaves the surface where it is") {
  Scene<2> s({0, 0}, {1, 12}, 0.5);
  s.cells.set_inclined_surfaces(true);
  for (const double passed : {0.0, 0.05, 0.1, 0.2}) {
    s.fill_cells([&](const auto& x) {
      return x[1] < 2 ? 1.0 : x[1] < 2.5 ? 1 - passed : x[1] < 3 ? 0.4 + passed : 0.0;
    });
    s.cells.update(s.fill, s.conditions);
    CHECK(s.cells.count() == 5);
    CHECK(s.cells.boundary_faces()[0].distance == doctest::Approx(0.45).epsilon(1e-12));
  }
}

TEST_CASE("lists are rebuilt when mask, grid or boundary geometry change, and only then") {
  Scene<2> s({0, 0}, {16, 16}, 1.0);
  s.fill_below(5.75);
  CHECK(s.cells.update(s.fill, s.conditions));
  CHECK_FALSE(s.cells.update(s.fill, s.conditions));
  s.fill_below(5.9);
  CHECK_FALSE(s.cells.update(s.fill, s.conditions));
  s.fill_below(6.75);
  CHECK(s.cells.update(s.fill, s.conditions));
  s.conditions.boundaries = {boundary<2>(WaterBoundary<2>::Kind::head, 0, 5.0)};
  CHECK(s.cells.update(s.fill, s.conditions));
  s.conditions.boundaries[0].value = 6.0;
  s.conditions.outside_level = 7.0;
  CHECK_FALSE(s.cells.update(s.fill, s.conditions));
  s.conditions.boundaries[0].to[1] = 2.0;
  CHECK(s.cells.update(s.fill, s.conditions));
  s.grid.activate({0});
  s.fill.assign(s.grid.slots(), 1.0);
  CHECK(s.cells.update(s.fill, s.conditions));
}

TEST_CASE("prescribed pressures follow the water level; above it a side is closed") {
  Scene<2> s({0, 1}, {4, 8}, 0.5);
  s.fill_cells([](const auto&) { return 1.0; });
  auto left = boundary<2>(WaterBoundary<2>::Kind::head, 0, 3.1);
  left.from[1] = 1.5;
  s.conditions.boundaries = {left, boundary<2>(WaterBoundary<2>::Kind::pressure, 3, 250.0)};
  s.cells.update(s.fill, s.conditions);
  int open = 0, closed = 0, top = 0;
  for (const auto& f : s.cells.boundary_faces()) {
    const double z = s.cells.centre(s.cells.cells()[f.cell].index)[1];
    CHECK(f.distance == doctest::Approx(0.25));
    if (f.boundary == 1) {
      CHECK(f.pressure == 250.0);
      ++top;
    } else if (z <= 3.1) {
      CHECK(f.pressure == doctest::Approx(9810 * (3.1 - z)));
      CHECK(f.open);
      ++open;
    } else {
      CHECK_FALSE(f.open);
      ++closed;
    }
  }
  CHECK(top == 4);
  CHECK(open == 3);    // centres 1.75, 2.25, 2.75
  CHECK(closed == 4);  // 3.25 .. 4.75
}

TEST_CASE("a submerged surface carries the pressure of the water over it") {
  Scene<2> s({0, 0}, {3, 8}, 0.5);
  s.fill_below(1.9);
  s.conditions.outside_level = 2.5;
  s.cells.update(s.fill, s.conditions);
  REQUIRE(s.cells.boundary_faces().size() == 3);
  for (const auto& f : s.cells.boundary_faces()) CHECK(f.pressure == doctest::Approx(9810 * 0.6));
  s.conditions.outside_level = 1.0;
  s.cells.update(s.fill, s.conditions);
  for (const auto& f : s.cells.boundary_faces()) CHECK(f.pressure == 0);
}

TEST_CASE("axisymmetric areas and volumes are those of one radian, and the axis has no face") {
  Scene<2> s({0, 0}, {4, 3}, 0.5, Space::axisymmetric);
  s.fill_cells([](const auto&) { return 1.0; });
  s.conditions.boundaries = {boundary<2>(WaterBoundary<2>::Kind::pressure, 0, 0.0),
                             boundary<2>(WaterBoundary<2>::Kind::pressure, 1, 0.0)};
  s.cells.update(s.fill, s.conditions);
  double volume = 0, rim = 0;
  for (const auto& c : s.cells.cells()) volume += c.volume;
  for (const auto& f : s.cells.boundary_faces()) rim += f.area;
  CHECK(volume == doctest::Approx(0.5 * 2.0 * 2.0 * 1.5));
  CHECK(rim == doctest::Approx(2.0 * 1.5));
  CHECK(s.cells.boundary_faces().size() == 3);
}

TEST_CASE("overlapping boundary conditions and a negative radius are refused") {
  Scene<2> s({0, 0}, {4, 4}, 0.5);
  s.fill_cells([](const auto&) { return 1.0; });
  s.conditions.boundaries = {boundary<2>(WaterBoundary<2>::Kind::head, 0, 1.0),
                             boundary<2>(WaterBoundary<2>::Kind::pressure, 0, 1.0)};
  CHECK_THROWS_AS(s.cells.update(s.fill, s.conditions), InputError);
  CHECK_THROWS_AS(Scene<2>({-1, 0}, {4, 4}, 0.5, Space::axisymmetric), InputError);
}

TEST_CASE("a cell whose corner nodes are not stored stays inactive") {
  Scene<2> s({0, 0}, {40, 8}, 1.0);
  s.grid.activate({0});  // block 0 and its neighbours: cells 0 .. 15 along x
  s.fill.assign(s.grid.slots(), 1.0);
  s.cells.update(s.fill, s.conditions);
  for (const auto& c : s.cells.cells()) CHECK(c.index[0] < 15);
  CHECK(s.cells.count() == 15 * 8);
}

TEST_CASE("a cell that becomes active continues a hydrostatic pressure up to the surface") {
  Scene<2> s({0, 0}, {5, 12}, 0.5);
  s.fill_below(2.3);
  s.cells.update(s.fill, s.conditions);
  PressureField<2> field(s.cells, water2());
  field.refresh();
  const auto hydrostatic = [&](const ActiveCell<2>& c, double top) {
    return 9810 * (top - s.cells.centre(c.index)[1]);
  };
  for (const auto& c : s.cells.cells()) field.pressure()[c.slot] = hydrostatic(c, 2.4);
  const int before = s.cells.count();
  s.fill_below(2.4);  // the surface rises through the threshold with the pressure below already in place
  CHECK(s.cells.update(s.fill, s.conditions));
  field.refresh();
  CHECK(s.cells.count() == before + 5);
  for (const auto& c : s.cells.cells())
    CHECK(field.pressure()[c.slot] == doctest::Approx(hydrostatic(c, 2.4)).epsilon(1e-12));
}
