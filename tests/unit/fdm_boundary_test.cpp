// Conditions on the sides of the water's cells: which faces they open, the pressure there, and the flow.
#include <doctest/doctest.h>

#include "tests/unit/fdm_scene.hpp"

using namespace polder;
using namespace polder::fdm;
using namespace polder::fdm::test;
using Kind2 = WaterBoundary<2>::Kind;
using Kind3 = WaterBoundary<3>::Kind;

namespace {

constexpr double kConductivity = 2e-4;

template <int D>
void flood(Scene<D>& s) {
  s.fill_cells([](const auto&) { return 1.0; });
  s.cells_to(s.darcy_mobility, [](const auto&) { return kConductivity / kGamma; });
}

}  // namespace

TEST_CASE("an impermeable boundary is a wall, and a schedule may close and open it") {
  Scene<2> s({0, 0}, {10, 4}, 0.5);
  flood(s);
  auto left = boundary<2>(Kind2::head, 0, 4.0), top = boundary<2>(Kind2::impermeable, 3, 123.0);
  const auto right = boundary<2>(Kind2::head, 1, 3.0);
  const double open = kConductivity * 1.0 / 5 * 2;
  PressureField<2> field(s.cells, water2());
  for (const bool closed : {false, true, false}) {
    left.kind = closed ? Kind2::impermeable : Kind2::head;
    s.conditions.boundaries = {left, right, top};
    CHECK(s.cells.update(s.fill, s.conditions));  // the faces change
    field.refresh();
    CHECK(s.cells.boundary_faces().size() == (closed ? 4 : 8));
    for (const auto& f : s.cells.boundary_faces()) CHECK(f.boundary != 2);
    field.steady(s.darcy_mobility);
    const Discharge& q = field.discharge();
    CHECK(q.boundary[1] == doctest::Approx(closed ? 0 : open).scale(open).epsilon(1e-10));
    CHECK(q.boundary[0] == (closed ? 0 : doctest::Approx(-open).epsilon(1e-10)));
    CHECK(q.boundary[2] == 0);
    if (closed)  // hydrostatic under the level that is left
      for (const auto& c : s.cells.cells())
        CHECK(field.pressure()[c.slot] == doctest::Approx(kGamma * (3 - s.cells.centre(c.index)[1])));
  }
}

TEST_CASE("a head counts from the faces of a bottom or top side, not from the centres of the cells") {
  Scene<2> s({0, 1}, {3, 4}, 0.5);  // between the heights 1 and 3
  flood(s);
  for (const double level : {0.9, 1.1, 1.4, 2.8, 3.2}) {
    CAPTURE(level);
    s.conditions.boundaries = {boundary<2>(Kind2::head, 2, level), boundary<2>(Kind2::head, 3, level)};
    s.cells.update(s.fill, s.conditions);
    REQUIRE(s.cells.boundary_faces().size() == 6);
    for (const auto& f : s.cells.boundary_faces()) {
      const double height = f.boundary == 0 ? 1.0 : 3.0;
      CHECK(f.axis == 1);
      CHECK(f.outward == (f.boundary == 0 ? -1 : 1));
      CHECK(f.distance == 0.25);
      CHECK(f.open == (level > height));
      CHECK(f.pressure == doctest::Approx(f.open ? kGamma * (level - height) : 0.0));
    }
  }
}

TEST_CASE("a level that rises and falls opens and closes faces without new lists") {
  Scene<2> s({0, 0}, {6, 8}, 0.5);
  flood(s);
  s.conditions.boundaries = {boundary<2>(Kind2::head, 0, 0), boundary<2>(Kind2::pressure, 3, 0)};
  s.cells.update(s.fill, s.conditions);
  const std::uint64_t lists = s.cells.revision();
  PressureField<2> field(s.cells, water2());
  field.refresh();
  for (const double level : {0.2, 1.3, 3.9, 2.2, 0.1}) {
    CAPTURE(level);
    s.conditions.boundaries[0].value = level;
    s.cells.update(s.fill, s.conditions);
    CHECK(s.cells.revision() == lists);
    int open = 0;
    for (const auto& f : s.cells.boundary_faces()) {
      if (f.boundary != 0) continue;
      const double z = s.cells.centre(s.cells.cells()[f.cell].index)[1];
      open += f.open;
      CHECK(f.open == (z <= level));
      CHECK(f.pressure == doctest::Approx(f.open ? kGamma * (level - z) : 0.0));
    }
    CHECK(open == static_cast<int>(std::floor((level + 0.25) / 0.5)));
    // The top stands at its own height, 4 m, so water flows down and out under the level.
    field.steady(s.darcy_mobility);
    const double q = field.discharge().boundary[0];
    if (open > 0) {
      CHECK(q > 0);
      CHECK(field.discharge().boundary[1] == doctest::Approx(-q).epsilon(1e-9));
    } else {
      CHECK(std::abs(q) < 1e-15);
    }
  }
}

TEST_CASE("a side may be the soil's surface: the distance follows the fill, the pressure the open water") {
  Scene<2> s({0, 0}, {6, 6}, 0.5);
  s.conditions.boundaries = {boundary<2>(Kind2::surface, 1, 777), boundary<2>(Kind2::surface, 3, 777),
                             boundary<2>(Kind2::surface, 2, 777)};
  s.conditions.boundaries[2].from[0] = 1.0;
  for (const double fill : {0.72, 0.9, 1.0, 1.2})
    for (const double level : {-kInfinity, 1.6, 5.0}) {
      CAPTURE(fill);
      CAPTURE(level);
      s.fill_cells([&](const auto&) { return fill; });
      s.conditions.outside_level = level;
      s.cells.update(s.fill, s.conditions);
      REQUIRE(s.cells.boundary_faces().size() == 6 + 6 + 4);
      const double distance = 0.5 * (std::min(fill, 1.0) - 0.5);
      for (const auto& f : s.cells.boundary_faces()) {
        double height = s.cells.centre(s.cells.cells()[f.cell].index)[1];
        if (f.axis == 1) height += f.outward * distance;
        CHECK(f.outside == -1);
        CHECK(f.open);
        CHECK(f.distance == doctest::Approx(distance));
        CHECK(f.pressure == doctest::Approx(std::max(0.0, kGamma * (level - height))));
      }
    }
  CHECK(s.cells.is_open_surface({5, 2}, 1));
  CHECK_FALSE(s.cells.is_open_surface({0, 2}, 0));
  CHECK(s.cells.is_open_surface({2, 0}, 2));
  CHECK_FALSE(s.cells.is_open_surface({1, 0}, 2));
  s.conditions.boundaries[0].kind = Kind2::head;
  s.cells.update(s.fill, s.conditions);
  CHECK_FALSE(s.cells.is_open_surface({5, 2}, 1));
}

TEST_CASE("seepage to a submerged side surface is exact, and counts as that boundary's discharge") {
  Scene<2> s({0, 0}, {10, 4}, 0.5);
  flood(s);
  s.conditions.boundaries = {boundary<2>(Kind2::head, 0, 5.0), boundary<2>(Kind2::surface, 1, 0)};
  s.conditions.outside_level = 3.0;
  s.cells.update(s.fill, s.conditions);
  PressureField<2> field(s.cells, water2());
  field.refresh();
  field.steady(s.darcy_mobility);
  for (const auto& c : s.cells.cells()) {
    const auto x = s.cells.centre(c.index);
    CHECK(field.pressure()[c.slot] == doctest::Approx(kGamma * (5 - 2 * x[0] / 5 - x[1])).epsilon(1e-10));
  }
  const double q = kConductivity * 2.0 / 5 * 2;
  CHECK(field.discharge().boundary[1] == doctest::Approx(q).epsilon(1e-10));
  CHECK(field.discharge().boundary[0] == doctest::Approx(-q).epsilon(1e-10));
  CHECK(field.discharge().surface == 0);
}

TEST_CASE("a boundary takes the faces of its part of a side, in 2D and 3D") {
  {
    Scene<2> s({0, 0}, {8, 4}, 0.5);
    flood(s);
    auto drain = boundary<2>(Kind2::pressure, 2, 0);
    drain.from = {1.25, 99}, drain.to = {2.2, 99};  // centres 1.25 and 1.75; the height does not matter
    s.conditions.boundaries = {drain};
    s.cells.update(s.fill, s.conditions);
    REQUIRE(s.cells.boundary_faces().size() == 2);
    for (const auto& f : s.cells.boundary_faces()) {
      const Index<2> i = s.cells.cells()[f.cell].index;
      CHECK(i[1] == 0);
      CHECK((i[0] == 2 || i[0] == 3));
    }
  }
  Scene<3> s({0, 0, 0}, {6, 5, 4}, 0.5);
  flood(s);
  auto window = boundary<3>(Kind3::pressure, 3, 500), rest = boundary<3>(Kind3::head, 3, 1.0);
  window.from = {0.5, 0, 1.0}, window.to = {2.0, 0, 2.0};  // 3 by 2 faces
  rest.to[2] = 0.6;                                        // the lowest row, half of it under the level
  s.conditions.boundaries = {window, rest};
  s.cells.update(s.fill, s.conditions);
  int in_window = 0, in_rest = 0;
  for (const auto& f : s.cells.boundary_faces()) {
    const Index<3> i = s.cells.cells()[f.cell].index;
    CHECK(f.axis == 1);
    CHECK(f.outward == 1);
    CHECK(i[1] == 4);
    CHECK(f.area == 0.25);
    if (f.boundary == 0) {
      ++in_window;
      CHECK((i[0] >= 1 && i[0] <= 3 && i[2] >= 2));
      CHECK(f.pressure == 500);
    } else {
      ++in_rest;
      CHECK(i[2] == 0);
      CHECK(f.pressure == doctest::Approx(kGamma * 0.75));
    }
    for (const int node : f.nodes) CHECK(s.grid.index(node)[1] == 5);
  }
  CHECK(in_window == 6);
  CHECK(in_rest == 6);
  PressureField<3> field(s.cells, water3());
  field.refresh();
  field.steady(s.darcy_mobility);
  // The head of the window, 500 Pa and more than 1 m, is above the other: water goes from it to the rest.
  const double q = field.discharge().boundary[1];
  CHECK(q > 0);
  CHECK(field.discharge().boundary[0] == doctest::Approx(-q).epsilon(1e-9));
}

TEST_CASE("boundaries of one side may touch, not overlap; other sides do not count") {
  Scene<2> s({0, 0}, {4, 4}, 0.5);
  flood(s);
  auto low = boundary<2>(Kind2::head, 0, 1.0), high = boundary<2>(Kind2::pressure, 0, 0);
  low.to[1] = 1.0, high.from[1] = 1.0;  // between the centres 0.75 and 1.25
  s.conditions.boundaries = {low, high, boundary<2>(Kind2::head, 1, 1.0)};
  s.cells.update(s.fill, s.conditions);
  int faces[3] = {0, 0, 0};
  for (const auto& f : s.cells.boundary_faces()) ++faces[f.boundary];
  CHECK(faces[0] == 2);
  CHECK(faces[1] == 2);
  CHECK(faces[2] == 4);
  s.conditions.boundaries[1].from[1] = 0.7;
  CHECK_THROWS_WITH(s.cells.update(s.fill, s.conditions),
                    doctest::Contains("'side 0' and 'side 0' overlap on the same side"));
}
