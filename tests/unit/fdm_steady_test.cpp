#include <doctest/doctest.h>

#include "tests/unit/fdm_scene.hpp"

using namespace polder;
using namespace polder::fdm;
using namespace polder::fdm::test;
using Kind2 = WaterBoundary<2>::Kind;
using Kind3 = WaterBoundary<3>::Kind;

TEST_CASE("upward seepage through a column is exact, with the surface anywhere in a cell") {
  const double gamma = 9810, k = 2e-4, excess = 3000;
  for (double top : {1.053, 1.07, 1.1, 1.12, 1.149})
    for (Space space : {Space::plane_strain, Space::axisymmetric})
      for (SolverKind kind : {SolverKind::direct, SolverKind::multigrid}) {
        CAPTURE(top);
        Scene<2> s({0, 0}, {3, 14}, 0.1, space);
        s.fill_below(top);
        s.conditions.boundaries = {boundary<2>(Kind2::pressure, 2, gamma * top + excess)};
        s.cells_to(s.darcy_mobility, [&](const auto&) { return k / gamma; });
        s.cells.update(s.fill, s.conditions);
        PressureField<2> field(s.cells, water2(), kind);
        field.refresh();
        field.steady(s.darcy_mobility);
        for (const auto& c : s.cells.cells()) {
          const double z = s.cells.centre(c.index)[1];
          CHECK(field.pressure()[c.slot] ==
                doctest::Approx((gamma + excess / top) * (top - z)).epsilon(1e-10));
        }
        const double width = space == Space::axisymmetric ? 0.5 * 0.3 * 0.3 : 0.3;
        const double q = k / gamma * excess / top * width;
        CHECK(field.discharge().surface == doctest::Approx(q).epsilon(1e-10));
        CHECK(field.discharge().boundary[0] == doctest::Approx(-q).epsilon(1e-10));
        CHECK(std::abs(field.discharge().total()) < 1e-12 * q + 1e-20);
      }
}

TEST_CASE("discharge of a rectangle under a head difference is exact in 2D and 3D") {
  const double k = 5e-4;
  {
    Scene<2> s({0, 0}, {50, 20}, 0.2);
    s.fill_cells([](const auto&) { return 1.0; });
    s.conditions.boundaries = {boundary<2>(Kind2::head, 0, 9.0), boundary<2>(Kind2::head, 1, 6.5)};
    s.cells_to(s.darcy_mobility, [&](const auto&) { return k / 9810; });
    s.cells.update(s.fill, s.conditions);
    PressureField<2> field(s.cells, water2());
    field.refresh();
    field.steady(s.darcy_mobility);
    const double q = k * 2.5 / 10 * 4;
    CHECK(field.discharge().boundary[1] == doctest::Approx(q).epsilon(1e-10));
    CHECK(field.discharge().boundary[0] == doctest::Approx(-q).epsilon(1e-10));
    CHECK(field.discharge().surface == 0);
    for (const auto& c : s.cells.cells()) {
      const auto x = s.cells.centre(c.index);
      CHECK(field.pressure()[c.slot] == doctest::Approx(9810 * (9 - 0.25 * x[0] - x[1])).epsilon(1e-10));
    }
  }
  Scene<3> s({0, 0, 0}, {12, 5, 6}, 0.5);
  s.fill_cells([](const auto&) { return 1.0; });
  s.conditions.boundaries = {boundary<3>(Kind3::head, 0, 9.0), boundary<3>(Kind3::head, 1, 6.0)};
  s.cells_to(s.darcy_mobility, [&](const auto&) { return k / 9810; });
  s.cells.update(s.fill, s.conditions);
  PressureField<3> field(s.cells, water3());
  field.refresh();
  field.steady(s.darcy_mobility);
  CHECK(field.discharge().boundary[1] == doctest::Approx(k * 3 / 6 * 2.5 * 3).epsilon(1e-10));
}

TEST_CASE("radial flow to a well converges with second order to the logarithm") {
  const double k = 1e-4, p_outer = 5000, r0 = 0.5, r1 = 2.5;
  double previous = 0;
  for (int n : {20, 40, 80}) {
    const double h = (r1 - r0) / n;
    Scene<2> s({r0, 0}, {n, 2}, h, Space::axisymmetric);
    s.fill_cells([](const auto&) { return 1.0; });
    s.conditions.boundaries = {boundary<2>(Kind2::pressure, 0, 0), boundary<2>(Kind2::pressure, 1, p_outer)};
    s.cells_to(s.darcy_mobility, [&](const auto&) { return k / 9810; });
    s.cells.update(s.fill, s.conditions);
    PressureField<2> field(s.cells, water2(kInfinity, 0));
    field.refresh();
    field.steady(s.darcy_mobility);
    const double q = k / 9810 * p_outer / std::log(r1 / r0) * 2 * h;  // per radian
    const double error = std::abs(field.discharge().boundary[0] / q - 1);
    CHECK(field.discharge().total() == doctest::Approx(0.0).scale(q).epsilon(1e-10));
    if (previous > 0) CHECK(std::log2(previous / error) > 1.9);
    previous = error;
  }
  CHECK(previous < 2e-4);
}

TEST_CASE("a basin without prescribed pressure is hydrostatic, with zero in its first cell") {
  Scene<2> s({0, 0}, {6, 5}, 0.5);
  s.fill_cells([](const auto&) { return 1.0; });
  s.cells_to(s.darcy_mobility, [](const auto&) { return 1e-8; });
  s.cells.update(s.fill, s.conditions);
  PressureField<2> field(s.cells, water2());
  field.refresh();
  field.steady(s.darcy_mobility);
  CHECK(field.pinned_basins() == 1);
  for (const auto& c : s.cells.cells())
    CHECK(field.pressure()[c.slot] ==
          doctest::Approx(9810 * (0.25 - s.cells.centre(c.index)[1])).epsilon(1e-9));
}
