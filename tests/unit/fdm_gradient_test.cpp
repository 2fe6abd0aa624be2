#include <doctest/doctest.h>

#include "tests/unit/fdm_scene.hpp"

using namespace polder;
using namespace polder::fdm;
using namespace polder::fdm::test;

namespace {

template <int D>
Reals field(const Scene<D>& s, const typename Scene<D>::At& f) {
  Reals p(s.grid.slots(), 0.0);
  for (const auto& c : s.cells.cells()) p[c.slot] = f(s.cells.centre(c.index));
  return p;
}

}  // namespace

TEST_CASE_TEMPLATE("the gradient of hydrostatic pressure is exact at surface, walls and one layer beyond", T,
                   std::integral_constant<int, 2>, std::integral_constant<int, 3>) {
  constexpr int D = T::value;
  Point<D> origin{};
  Index<D> size;
  size.fill(7);
  const double h = 0.25;
  Scene<D> s(origin, size, h);
  for (double top : {1.15, 1.2, 1.25, 1.3, 1.35}) {
    s.fill_below(top);
    s.cells.update(s.fill, s.conditions);
    PressureField<D> field_(s.cells, water<D>());
    field_.refresh();
    const Reals p = field<D>(s, [&](const auto& x) { return 9810 * (top - x[D - 1]); });
    Reals g(s.grid.slots() * 4, 7.0);
    const int surface_node = 1 + s.cells.cells().back().index[D - 1];
    for (WallNormal walls : {WallNormal::none, WallNormal::inward}) {
      field_.node_gradient(p, BoundaryValues::present, walls, g);
      for (int slot = 0; slot < s.grid.slots(); ++slot) {
        const Index<D> i = s.grid.index(slot);
        bool in_grid = true;
        for (int d = 0; d < D; ++d) in_grid = in_grid && i[d] <= size[d];
        if (!in_grid) continue;
        for (int d = 0; d + 1 < D; ++d) CHECK(std::abs(g[slot * 4 + d]) < 1e-9);
        const bool wall = i[D - 1] == 0;
        const bool wet = i[D - 1] <= surface_node + 1 && (!wall || walls == WallNormal::inward);
        CHECK(g[slot * 4 + D - 1] == doctest::Approx(wet ? -9810.0 : 0.0).epsilon(1e-12));
        CHECK(g[slot * 4 + 3] == 0);
      }
    }
  }
}

TEST_CASE("the gradient of a field linear in x and y is exact inside and along walls") {
  Scene<2> s({0, 0}, {9, 6}, 0.5);
  s.fill_cells([](const auto&) { return 1.0; });
  s.cells.update(s.fill, s.conditions);
  PressureField<2> pressure(s.cells, water2());
  pressure.refresh();
  const Reals p = field<2>(s, [](const auto& x) { return 3 + 40 * x[0] - 70 * x[1]; });
  Reals g(s.grid.slots() * 4);
  pressure.node_gradient(p, BoundaryValues::present, WallNormal::none, g);
  for (int i = 0; i <= 9; ++i)
    for (int j = 0; j <= 6; ++j) {
      const int slot = s.grid.slot({i, j});
      CHECK(g[slot * 4] == doctest::Approx(i == 0 || i == 9 ? 0.0 : 40.0));
      CHECK(g[slot * 4 + 1] == doctest::Approx(j == 0 || j == 6 ? 0.0 : -70.0));
    }
  pressure.node_gradient(p, BoundaryValues::present, WallNormal::inward, g);
  for (int i = 0; i <= 9; ++i)
    for (int j = 0; j <= 6; ++j) {
      const int slot = s.grid.slot({i, j});
      CHECK(g[slot * 4] == doctest::Approx(40.0));
      CHECK(g[slot * 4 + 1] == doctest::Approx(-70.0));
    }
}

TEST_CASE("side faces use the prescribed pressure at half a cell, closed ones count as walls") {
  Scene<2> s({0, 0}, {4, 4}, 1.0);
  s.fill_cells([](const auto&) { return 1.0; });
  s.conditions.boundaries = {boundary<2>(WaterBoundary<2>::Kind::head, 0, 2.0)};
  s.cells.update(s.fill, s.conditions);
  PressureField<2> pressure(s.cells, water2());
  pressure.refresh();
  Reals p(s.grid.slots(), 0.0);
  for (const auto& c : s.cells.cells()) p[c.slot] = 1000;
  Reals g(s.grid.slots() * 4);
  pressure.node_gradient(p, BoundaryValues::present, WallNormal::none, g);
  // Faces at height 0.5 (p = 14715 Pa) and 1.5 (p = 4905 Pa) are open, those above closed.
  CHECK(g[s.grid.slot({0, 0}) * 4] == doctest::Approx((1000 - 14715.0) / 0.5));
  CHECK(g[s.grid.slot({0, 1}) * 4] == doctest::Approx((1000 - 0.5 * (14715 + 4905)) / 0.5));
  CHECK(g[s.grid.slot({0, 2}) * 4] == doctest::Approx((1000 - 4905.0) / 0.5));
  CHECK(g[s.grid.slot({0, 3}) * 4] == 0);
  pressure.node_gradient(p, BoundaryValues::homogeneous, WallNormal::none, g);
  CHECK(g[s.grid.slot({0, 1}) * 4] == doctest::Approx(2000.0));
  CHECK(g[s.grid.slot({0, 3}) * 4] == 0);
}

TEST_CASE("beyond a surface on both sides the extension is the mean of the two") {
  Scene<2> s({0, 0}, {10, 2}, 1.0);
  s.fill_cells([](const auto& x) { return x[0] < 4 || x[0] > 6 ? 1.0 : 0.0; });  // a gap of two cells
  s.cells.update(s.fill, s.conditions);
  PressureField<2> pressure(s.cells, water2());
  pressure.refresh();
  const Reals p = field<2>(s, [](const auto& x) { return x[0] < 5 ? 10.0 : 30.0; });
  Reals g(s.grid.slots() * 4);
  pressure.node_gradient(p, BoundaryValues::present, WallNormal::none, g);
  CHECK(g[s.grid.slot({4, 1}) * 4] == doctest::Approx(-20.0));
  CHECK(g[s.grid.slot({6, 1}) * 4] == doctest::Approx(60.0));
  CHECK(g[s.grid.slot({5, 1}) * 4] == doctest::Approx(20.0));
}
