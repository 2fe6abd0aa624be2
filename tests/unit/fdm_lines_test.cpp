// Wells, drains and sheets: which cells and faces they take, and what they do to the flow.
#include <doctest/doctest.h>

#include <numeric>

#include "fdm/unsaturated_field.hpp"
#include "tests/unit/fdm_scene.hpp"

using namespace polder;
using namespace polder::fdm;
using namespace polder::fdm::test;
using Kind2 = WaterBoundary<2>::Kind;

namespace {

constexpr double kConductivity = 1e-4;

struct Ground : UnsaturatedScene<2> {
  Ground(Index<2> size, double h) : UnsaturatedScene<2>({0, 0}, size, h) {
    fill_cells([](const auto&) { return 1.0; });
    set_conductivity(kConductivity);
  }
};

Soil<2> sand() {
  return van_genuchten<2>(3, 2.5);
}

}  // namespace

TEST_CASE("a line is split over the active cells by its length in each") {
  Ground s({10, 10}, 0.1);
  s.fill_cells([](const auto& x) { return x[0] < 0.8 ? 1.0 : 0.0; });
  s.cells.update(s.fill, s.conditions);
  const auto find = [&](const std::vector<CrossedCell>& list, Index<2> index) {
    for (const CrossedCell& c : list)
      if (s.cells.cells()[c.cell].index == index) return c.share;
    return 0.0;
  };
  const auto level = crossed_cells<2>(s.cells, {{0.05, 0.33}, {0.4, 0.33}, {0.4, 0.35}});
  REQUIRE(level.size() == 5);
  CHECK(find(level, {0, 3}) == doctest::Approx(0.05 / 0.37));
  CHECK(find(level, {2, 3}) == doctest::Approx(0.1 / 0.37));
  CHECK(find(level, {4, 3}) == doctest::Approx(0.02 / 0.37));
  const auto slanted = crossed_cells<2>(s.cells, {{0.02, 0.01}, {0.72, 0.71}});
  CHECK(slanted.size() > 7);
  double total = 0;
  for (const CrossedCell& c : slanted) total += c.share;
  CHECK(total == doctest::Approx(1));
  const auto half = crossed_cells<2>(s.cells, {{0.7, 0.55}, {0.9, 0.55}});  // one of its two cells has soil
  REQUIRE(half.size() == 1);
  CHECK(half[0].share == doctest::Approx(1));
  const auto point = crossed_cells<2>(s.cells, {{0.21, 0.99}});
  REQUIRE(point.size() == 1);
  CHECK(s.cells.cells()[point[0].cell].index == Index<2>{2, 9});
  CHECK(crossed_cells<2>(s.cells, {{0.95, 0.5}}).empty());
  CHECK(crossed_cells<2>(s.cells, {{-3, 0.5}, {-2, 0.5}}).empty());

  Scene<3> space({0, 0, 0}, {6, 6, 6}, 0.5);
  space.fill_cells([](const auto&) { return 1.0; });
  space.cells.update(space.fill, space.conditions);
  const auto well = crossed_cells<3>(space.cells, {{1.2, 1.7, 3.0}, {1.2, 1.7, 0.75}});
  REQUIRE(well.size() == 5);
  for (const CrossedCell& c : well) {
    const auto index = space.cells.cells()[c.cell].index;
    CHECK(c.share == doctest::Approx((index[2] == 1 ? 0.25 : 0.5) / 2.25));
  }
}

TEST_CASE("a sheet leaves no gap, wherever it lies") {
  for (const double shift : {0.0, 0.05, 0.031})
    for (const double slope : {0.0, 0.4, -1.0, 7.0}) {
      CAPTURE(shift);
      CAPTURE(slope);
      Ground s({16, 12}, 0.1);
      // A sheet in three pieces from top to bottom: no way from one side of the ground to the other.
      const double x = 0.8 + shift;
      const double lean = std::clamp(slope, -1.0, 1.0) * 0.5;
      s.conditions.sheets = {
          {.name = "cut", .points = {{x + lean, 1.3}, {x, 0.6 + shift}, {x, 0.3}, {x - lean, -0.1}}}};
      s.conditions.boundaries = {boundary<2>(Kind2::head, 0, 3), boundary<2>(Kind2::head, 1, 2)};
      s.cells.update(s.fill, s.conditions);
      const auto blocked = blocked_faces<2>(s.cells, s.conditions.sheets);
      const Basins basins = find_basins(s.cells, blocked);
      CHECK(basins.first_cell.size() == 2);
      CHECK(std::accumulate(blocked.begin(), blocked.end(), 0) < 40);
      UnsaturatedField<2> field(s.cells, water2(), {Soil<2>{}});
      field.refresh();
      REQUIRE(field.steady(s.unsaturated(1)).converged);
      CHECK(std::abs(field.discharge().boundary[1]) < 1e-12);
      // Each side rests under its own level.
      for (const auto& c : s.cells.cells()) {
        const auto at = s.cells.centre(c.index);
        if (std::abs(at[0] - x) < 0.7) continue;
        CHECK(field.pressure()[c.slot] ==
              doctest::Approx(kGamma * ((at[0] < x ? 3 : 2) - at[1])).epsilon(1e-6));
      }
    }
}

TEST_CASE("an upright sheet in space blocks between its heights") {
  Scene<3> s({0, 0, 0}, {8, 6, 8}, 0.5);
  s.fill_cells([](const auto&) { return 1.0; });
  s.cells.update(s.fill, s.conditions);
  WaterSheet<3> sheet;
  sheet.points = {{2, -1, 0}, {2, 2, 0}}, sheet.bottom = 1, sheet.top = 3;
  const auto blocked = blocked_faces<3>(s.cells, {sheet});
  int count = 0;
  for (std::size_t f = 0; f < blocked.size(); ++f) {
    if (!blocked[f]) continue;
    ++count;
    const auto& face = s.cells.interior_faces()[f];
    const auto x = s.cells.centre(s.cells.cells()[face.low].index);
    CHECK(face.axis == 0);
    CHECK(x[0] == 1.75);
    CHECK(x[1] < 2);
    CHECK((x[2] > 1 && x[2] < 3));
  }
  CHECK(count == 4 * 4);
}

TEST_CASE("a well takes its rate until its cell is as dry as it may get; the balance holds") {
  for (const bool deep : {true, false}) {
    CAPTURE(deep);
    Ground s({21, 10}, 0.2);
    const double rate = deep ? 5e-5 : 1.5e-4;
    s.conditions.boundaries = {boundary<2>(Kind2::head, 0, 2), boundary<2>(Kind2::head, 1, 2)};
    WaterWell<2> well;
    well.name = "well", well.rate = rate, well.points = {{2.1, 0.1}, {2.1, 0.5}};
    well.limiting_pressure = (deep ? -2 : 1) * kGamma;
    s.conditions.wells = {well};
    s.cells.update(s.fill, s.conditions);
    UnsaturatedField<2> field(s.cells, water2(), {sand()});
    field.refresh();
    for (const auto& c : s.cells.cells())
      field.pressure()[c.slot] = kGamma * (2 - s.cells.centre(c.index)[1]);
    REQUIRE(field.steady(s.unsaturated(100)).converged);
    const Discharge& q = field.discharge();
    if (deep) {
      CHECK(q.well[0] == doctest::Approx(rate).epsilon(1e-9));
    } else {
      CHECK(q.well[0] > 0);
      CHECK(q.well[0] < 0.9 * rate);
      // The lower of its two cells has a side of the grid below, the upper one four faces.
      const double link = kConductivity / kGamma;
      const double from_lower = 3 * link * (field.pressure()[s.grid.slot({10, 0})] - kGamma);
      const double from_second = 4 * link * (field.pressure()[s.grid.slot({10, 1})] - kGamma);
      const double from_third = 4 * link * (field.pressure()[s.grid.slot({10, 2})] - kGamma);
      double expected = 0;
      const double shares[] = {0.25, 0.5, 0.25}, flows[] = {from_lower, from_second, from_third};
      for (int i = 0; i < 3; ++i) expected += std::clamp(flows[i], 0.0, shares[i] * rate);
      CHECK(q.well[0] == doctest::Approx(expected).epsilon(1e-5));
    }
    CHECK(q.boundary[0] == doctest::Approx(-0.5 * q.well[0]).epsilon(1e-4));
    CHECK(std::abs(q.total()) < 1e-6 * q.well[0]);
    CHECK(std::abs(field.balance().defect()) < 1e-6 * q.well[0]);
  }
}

TEST_CASE("an injecting well gives its rate, up to the limiting pressure") {
  Ground s({21, 10}, 0.2);
  s.conditions.boundaries = {boundary<2>(Kind2::head, 0, 1), boundary<2>(Kind2::head, 1, 1)};
  WaterWell<2> well;
  well.rate = -8e-5, well.points = {{2.1, 0.3}};
  s.conditions.wells = {well};
  for (const double limit : {-kInfinity, 1.2 * kGamma}) {
    s.conditions.wells[0].limiting_pressure = limit;
    s.cells.update(s.fill, s.conditions);
    UnsaturatedField<2> field(s.cells, water2(), {sand()});
    field.refresh();
    for (const auto& c : s.cells.cells())
      field.pressure()[c.slot] = kGamma * (1 - s.cells.centre(c.index)[1]);
    REQUIRE(field.steady(s.unsaturated(100)).converged);
    const double q = field.discharge().well[0], p = field.pressure()[s.grid.slot({10, 1})];
    if (limit > 0) {
      CHECK(q < 0);
      CHECK(q > -0.9 * 8e-5);
      CHECK(q == doctest::Approx(4 * kConductivity / kGamma * (p - limit)).epsilon(1e-5));
    } else {
      CHECK(q == doctest::Approx(-8e-5).epsilon(1e-12));
      CHECK(p > 1.2 * kGamma);
    }
  }
}

TEST_CASE("a drain holds its pressure, takes nothing from dry soil, and counts what it takes") {
  for (const double level : {1.6, 0.3}) {
    CAPTURE(level);
    Ground s({21, 10}, 0.2);
    s.conditions.boundaries = {boundary<2>(Kind2::head, 0, level), boundary<2>(Kind2::head, 1, level)};
    WaterDrain<2> drain;
    drain.points = {{1.7, 0.7}, {2.5, 0.7}};
    s.conditions.drains = {drain};
    s.cells.update(s.fill, s.conditions);
    UnsaturatedField<2> field(s.cells, water2(), {sand()});
    field.refresh();
    for (const auto& c : s.cells.cells())
      field.pressure()[c.slot] = kGamma * (level - s.cells.centre(c.index)[1]);
    REQUIRE(field.steady(s.unsaturated(100)).converged);
    const Discharge& q = field.discharge();
    if (level > 1) {
      CHECK(q.drain[0] > 1e-5);
      for (int i = 9; i < 12; ++i) CHECK(std::abs(field.pressure()[s.grid.slot({i, 3})]) < 2e-3 * kGamma);
    } else {
      CHECK(q.drain[0] == 0);
    }
    CHECK(std::abs(q.total()) < 1e-6 * q.drain[0] + 1e-15);
    if (level < 1) continue;
    const double open = q.drain[0];
    s.conditions.drains[0].conductance =
        0.2 * open / kGamma;  // clogged: a metre of head for a fifth of the flow
    s.cells.update(s.fill, s.conditions);
    REQUIRE(field.steady(s.unsaturated(100)).converged);
    CHECK(field.discharge().drain[0] > 0.05 * open);
    CHECK(field.discharge().drain[0] < 0.2 * open);
  }
}

TEST_CASE("the saturated equation refuses wells, drains and sheets") {
  Ground s({4, 4}, 0.5);
  for (int which = 0; which < 3; ++which) {
    s.conditions = {};
    if (which == 0) s.conditions.wells.push_back({.name = "w", .points = {{1, 1}}});
    if (which == 1) s.conditions.drains.push_back({.name = "d", .points = {{1, 1}}});
    if (which == 2) s.conditions.sheets.push_back({.name = "s", .points = {{1, 1}, {1, 2}}});
    s.cells.update(s.fill, s.conditions);
    PressureField<2> field(s.cells, water2());
    CHECK_THROWS_AS(field.refresh(), std::logic_error);
  }
}
