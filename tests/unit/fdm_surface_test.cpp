// Conditions named on the soil's free surface, the laws of boundary faces, and unsaturated flow in space and
// about an axis.
#include <doctest/doctest.h>

#include <set>

#include "fdm/unsaturated_field.hpp"
#include "tests/unit/fdm_scene.hpp"

using namespace polder;
using namespace polder::fdm;
using namespace polder::fdm::test;
using Kind2 = WaterBoundary<2>::Kind;

TEST_CASE("the first condition that fits names a face of the free surface; distances follow the fill") {
  UnsaturatedScene<2> s({0, 0}, {12, 10}, 0.5);
  s.fill_cells([](const auto& x) {
    return x[0] > 5 ? 0.0 : std::clamp((3.1 + (x[0] < 2 ? 1 : 0) - x[1]) / 0.5 + 0.5, 0.0, 1.0);
  });
  auto crest = boundary<2>(Kind2::atmosphere, kFreeSurface, 1e-6),
       closed = boundary<2>(Kind2::impermeable, kFreeSurface, 0);
  auto level = boundary<2>(Kind2::head, kFreeSurface, 2.2);
  crest.from[1] = 3.6;
  closed.to[0] = 3.0;
  s.conditions.boundaries = {crest, closed, level, boundary<2>(Kind2::pressure, 0, 0)};
  s.set_conductivity(1e-5);
  s.update();
  int count[4] = {0, 0, 0, 0};
  for (const auto& f : s.cells.boundary_faces()) {
    REQUIRE(f.boundary >= 0);
    ++count[f.boundary];
    const auto x = s.cells.centre(s.cells.cells()[f.cell].index);
    CHECK(f.free_surface == (f.boundary < 3));
    if (f.boundary == 0) CHECK((x[1] > 3.3 && x[0] < 2));
    if (f.boundary == 1) CHECK_FALSE(f.open);
    if (f.boundary == 2 && f.axis == 0) {
      CHECK(x[0] == 4.75);
      CHECK(f.open == (x[1] <= 2.2));
      CHECK(f.distance == doctest::Approx(0.25));
      CHECK(f.pressure == doctest::Approx(f.open ? kGamma * (2.2 - x[1]) : 0));
    }
    if (f.boundary < 3 && f.axis == 1)  // the surface where the fill says
      CHECK(x[1] + f.distance == doctest::Approx(x[0] < 2 ? 4.1 : 3.1));
  }
  CHECK(count[0] >= 4);
  CHECK(count[1] >= 2);
  CHECK(count[2] >= 8);
}

TEST_CASE("rain on a slope counts by its plan, whatever the staircase; evaporation too") {
  for (const double rate : {2e-7, -1e-7}) {
    UnsaturatedScene<2> s({0, 0}, {40, 24}, 0.25);
    s.fill_cells([](const auto& x) { return std::clamp((4.5 - 0.35 * x[0] - x[1]) / 0.25 + 0.5, 0.0, 1.0); });
    s.conditions.boundaries = {boundary<2>(Kind2::atmosphere, kFreeSurface, rate)};
    s.set_conductivity(1e-5);
    s.update();
    UnsaturatedField<2> field(s.cells, water2(), {van_genuchten<2>(3)});
    field.refresh();
    for (const auto& c : s.cells.cells()) field.pressure()[c.slot] = -1.0 * kGamma;
    REQUIRE(field.solve(s.unsaturated(3600)).converged);
    CHECK(field.discharge().boundary[0] == doctest::Approx(-rate * 10).epsilon(1e-9));
    CHECK(field.discharge().surface == 0);
  }
}

TEST_CASE("the law of a complementary face between its limits, and on them") {
  BoundaryLaw law;
  law.kind = BoundaryLaw::Kind::complementary;
  law.upper = 500, law.lower = -20000, law.upper_conductivity = 1, law.lower_conductivity = 1e-3;
  law.gravity = 100;
  const double kappa = 1e-9;
  law.inflow = 2e-7;
  const BoundaryFlow free = boundary_flow(law, kappa, -1000, 0.5);
  CHECK(free.inflow == 2e-7);
  CHECK(free.conductance == 0);
  CHECK_FALSE(free.prescribed);
  law.inflow = 2e-5;  // more than 1e-9 (500 + 1000 + 100): ponds
  const BoundaryFlow ponded = boundary_flow(law, kappa, -1000, 0.5);
  CHECK(ponded.inflow == doctest::Approx(1.6e-6));
  CHECK(ponded.conductance == doctest::Approx(1e-9));
  CHECK(ponded.pressure == 500);
  law.inflow = -2e-5;  // more than the soil gives
  const BoundaryFlow dry = boundary_flow(law, kappa, -1000, 0.5);
  const double mean = (0.5 - 1e-3) / std::log(0.5 / 1e-3);
  CHECK(dry.inflow == doctest::Approx(kappa * mean * (-20000 + 1000 + 100)));
  CHECK(dry.pressure == -20000);
  law.inflow = 0, law.upper = 0;  // seepage face
  CHECK(boundary_flow(law, kappa, 50, 1).inflow == 0);
  CHECK(boundary_flow(law, kappa, 150, 1).inflow == doctest::Approx(-kappa * 50));
  CHECK(logarithmic_mean(2, 2) == 2);
  CHECK(logarithmic_mean(1, 1 + 1e-6) == doctest::Approx(1 + 5e-7).epsilon(1e-12));
  CHECK(logarithmic_mean(1, 1.001) == doctest::Approx(1.0005).epsilon(1e-6));
  CHECK(logarithmic_mean(0, 1) < 2e-3);
}

TEST_CASE("a seepage face that is not named lets water out and none in") {
  UnsaturatedScene<2> s({0, 0}, {10, 12}, 0.25);
  s.fill_below(2.0);
  s.conditions.boundaries = {boundary<2>(Kind2::pressure, 2, 2.5 * kGamma)};
  s.set_conductivity(1e-5);
  s.update();
  UnsaturatedField<2> field(s.cells, water2(), {van_genuchten<2>(3)});
  field.refresh();
  for (const auto& c : s.cells.cells()) field.pressure()[c.slot] = -kGamma;
  REQUIRE(field.steady(s.unsaturated(100)).converged);
  CHECK(field.discharge().surface == doctest::Approx(1e-5 * 0.5 / 2 * 2.5).epsilon(1e-5));
  s.conditions.boundaries[0].value = 1.0 * kGamma;
  s.set_conductivity(1e-5);
  s.update();
  REQUIRE(field.steady(s.unsaturated(100)).converged);
  CHECK(std::abs(field.discharge().surface) < 1e-18);
  for (const auto& c : s.cells.cells())
    CHECK(field.pressure()[c.slot] ==
          doctest::Approx(kGamma * (1 - s.cells.centre(c.index)[1])).epsilon(1e-5));
}

TEST_CASE("infiltration is the same in the plane, about the axis and in space") {
  std::vector<double> plane;
  const auto run = [&](auto& scene, auto& field, int last) {
    constexpr int D = std::tuple_size_v<std::remove_cvref_t<decltype(scene.centre(0))>>;
    field.refresh();
    for (const auto& c : scene.cells.cells()) field.pressure()[c.slot] = -2 * kGamma;
    for (int i = 0; i < 20; ++i) REQUIRE(field.solve(scene.unsaturated(300)).converged);
    for (const auto& c : scene.cells.cells()) {
      const std::size_t layer = c.index[D - 1];
      if (plane.size() <= layer) plane.resize(layer + 1, 0);
      if (last == 0)
        plane[layer] = field.pressure()[c.slot];
      else
        CHECK(field.pressure()[c.slot] == doctest::Approx(plane[layer]).epsilon(1e-4));
    }
    CHECK(std::abs(field.balance().defect()) < 1e-6 * field.balance().magnitude);
  };
  UnsaturatedScene<2> a({0, 0}, {3, 16}, 0.1), b({0, 0}, {5, 16}, 0.1, Space::axisymmetric);
  int number = 0;
  for (UnsaturatedScene<2>* s : {&a, &b}) {
    s->fill_below(1.5);
    s->conditions.boundaries = {boundary<2>(Kind2::atmosphere, kFreeSurface, 5e-6)};
    s->set_conductivity(1e-5);
    s->update();
    UnsaturatedField<2> field(s->cells, water2(), {van_genuchten<2>(3)});
    run(*s, field, number++);
  }
  UnsaturatedScene<3> c({0, 0, 0}, {4, 3, 16}, 0.1);
  c.fill_below(1.5);
  c.conditions.boundaries = {boundary<3>(WaterBoundary<3>::Kind::atmosphere, kFreeSurface, 5e-6)};
  c.set_conductivity(1e-5);
  c.update();
  UnsaturatedField<3> field(c.cells, water3(), {van_genuchten<3>(3)});
  run(c, field, 2);
  CHECK(std::set<double>(plane.begin(), plane.end()).size() > 10);
}

TEST_CASE("state moves with the grid's numbering, and a new cell takes its neighbours' head") {
  Grid<2> grid({0, 0}, {32, 16}, 0.1);
  WaterCells<2> cells(grid, Space::plane_strain);
  WaterConditions<2> conditions;
  UnsaturatedField<2> field(cells, water2(), {van_genuchten<2>(3)});
  const auto set = [&](const std::vector<int>& blocks, double right) {
    const bool renumbered = grid.activate(blocks);
    std::vector<double> fill(grid.slots(), 0);
    for (int s = 0; s < grid.slots(); ++s) {
      const auto x = grid.position(grid.index(s));
      if (grid.is_cell(grid.index(s)) && x[0] + 0.05 < right && x[1] + 0.05 < 1) fill[s] = 1;
    }
    if (renumbered) field.carry();
    cells.update(fill, conditions);
    field.refresh();
  };
  const double table = 0.4;
  set({grid.block_number({0, 0}), grid.block_number({0, 8})}, 0.8);
  REQUIRE(cells.count() == 80);
  for (const auto& c : cells.cells()) {
    field.pressure()[c.slot] = kGamma * (table - cells.centre(c.index)[1]);
    field.saturation()[c.slot] = 0.5;
  }
  set({grid.block_number({0, 0}), grid.block_number({0, 8}), grid.block_number({8, 0}),
       grid.block_number({8, 8})},
      1.1);
  REQUIRE(cells.count() == 110);
  for (const auto& c : cells.cells()) {
    CHECK(field.pressure()[c.slot] == doctest::Approx(kGamma * (table - cells.centre(c.index)[1])));
    CHECK(field.saturation()[c.slot] == (c.index[0] < 8 ? 0.5 : UnsaturatedField<2>::kFromPressure));
  }
}
