// Shape functions: partition of unity and linear reproduction everywhere in the grid, also at its sides; the
// stencil of a pack (mpm/stencil.hpp) and that of a point (mpm/point_stencil.hpp) are the same numbers.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "mpm/point_stencil.hpp"
#include "mpm/stencil.hpp"

using namespace polder;
using namespace polder::mpm;
using namespace polder::simd_native;

namespace {

constexpr ShapeKind kShapes[] = {ShapeKind::linear, ShapeKind::gimp, ShapeKind::quadratic_bspline};
constexpr double kSpacing = 0.25;

template <int D>
Grid<D> full_grid(const Index<D>& cells) {
  Point<D> origin;
  for (int d = 0; d < D; ++d) origin[d] = -1.3 + 0.7 * d;
  Grid<D> grid(origin, cells, kSpacing);
  std::vector<int> all(grid.block_numbers());
  for (int b = 0; b < grid.block_numbers(); ++b) all[b] = b;
  grid.activate(all);
  return grid;
}

// Low-discrepancy positions in [0, 1]^D, with the grid's sides among them.
template <int D>
Point<D> sample(int i, const Index<D>& cells) {
  constexpr double kAlpha[] = {0.7548776662466927, 0.5698402909980532, 0.4301597090019468};
  Point<D> x;
  for (int d = 0; d < D; ++d) {
    x[d] = std::fmod(0.5 + kAlpha[d] * (i + 1), 1.0) * cells[d];
    if (i % 7 == d) x[d] = 0;
    if (i % 11 == d) x[d] = cells[d];
    if (i % 5 == d) x[d] = std::fmod(x[d], 0.5);  // the first half cell
    if (i % 13 == d) x[d] = cells[d] - std::fmod(x[d], 0.5);
  }
  return x;
}

template <int D>
void check_point_stencil(const Index<D>& cells) {
  const Grid<D> grid = full_grid<D>(cells);
  double unity = 0, linear = 0, slope_sum = 0, slope_linear = 0;
  for (const ShapeKind shape : kShapes)
    for (int i = 0; i < 3000; ++i) {
      Point<D> x = sample<D>(i, cells), half;
      for (int d = 0; d < D; ++d) {
        x[d] = grid.origin()[d] + x[d] * kSpacing;
        half[d] = kSpacing * (0.05 + 0.45 * std::fmod(0.618 * (i + 3 * d), 1.0));
      }
      const PointStencil<D> s = point_stencil<D>(grid, shape, x, half);
      double sum = 0;
      Point<D> where{}, slopes{};
      double gradient[D][D] = {};
      for (int n = 0; n < s.count; ++n) {
        const Point<D> node = grid.position(grid.index(s.slot[n]));
        sum += s.weight[n];
        for (int d = 0; d < D; ++d) {
          where[d] += s.weight[n] * node[d], slopes[d] += s.slope[n][d];
          for (int e = 0; e < D; ++e) gradient[d][e] += node[d] * s.slope[n][e];
        }
      }
      unity = std::max(unity, std::abs(sum - 1));
      for (int d = 0; d < D; ++d) {
        linear = std::max(linear, std::abs(where[d] - x[d]));
        slope_sum = std::max(slope_sum, std::abs(slopes[d]) * kSpacing);
        for (int e = 0; e < D; ++e)
          slope_linear = std::max(slope_linear, std::abs(gradient[d][e] - (d == e)));
      }
    }
  CHECK(unity < 1e-12);
  CHECK(linear < 1e-12);
  CHECK(slope_sum < 1e-12);
  CHECK(slope_linear < 1e-12);
}

}  // namespace

TEST_CASE("partition of unity and linear reproduction, inside and at the sides") {
  SUBCASE("2D") {
    check_point_stencil<2>({9, 20});
  }
  SUBCASE("3D") {
    check_point_stencil<3>({5, 9, 6});
  }
}

TEST_CASE("the stencils of a pack and of a point agree") {
  constexpr int kCells = 11;
  const Grid<2> grid = full_grid<2>({kCells, kCells});
  double gap = 0;
  for (const ShapeKind shape : kShapes)
    for (int i = 0; i < 4000; i += kLanes) {
      alignas(64) double x[kLanes], l[kLanes];
      for (int lane = 0; lane < kLanes; ++lane) {
        x[lane] = sample<2>(i + lane, {kCells, kCells})[0];
        l[lane] = 0.05 + 0.45 * std::fmod(0.618 * (i + lane), 1.0);
      }
      AxisStencil pack;
      axis_stencil(shape, load(x), load(l), kCells, pack);
      for (int lane = 0; lane < kLanes; ++lane) {
        // A point on the middle node of the other axis: its products are those of the first axis alone for
        // interpolating shapes; summing over that axis gives them for every shape.
        const Point<2> at{grid.origin()[0] + x[lane] * kSpacing, grid.origin()[1] + 5.0 * kSpacing};
        const PointStencil<2> point =
            point_stencil<2>(grid, shape, at, {l[lane] * kSpacing, l[lane] * kSpacing});
        double weight[kCells + 1] = {}, slope[kCells + 1] = {};
        for (int n = 0; n < point.count; ++n) {
          const int column = grid.index(point.slot[n])[0];
          weight[column] += point.weight[n], slope[column] += point.slope[n][0] * kSpacing;
        }
        for (int a = 0; a < 3; ++a) {
          const int column = static_cast<int>(pack.base[lane]) + a;
          REQUIRE(column >= 0);
          REQUIRE(column <= kCells);
          weight[column] -= pack.weight[a][lane], slope[column] -= pack.slope[a][lane];
        }
        // Rounding of the position (origin + x h) decides on which side of a kink the point lies: only slopes
        // of the linear hat jump there, and samples on nodes are the grid's sides, where the fold makes both
        // the same.
        for (int c = 0; c <= kCells; ++c) gap = std::max({gap, std::abs(weight[c]), std::abs(slope[c])});
      }
    }
  CHECK(gap < 1e-12);
}

TEST_CASE("wall functions of the B-spline are non-negative and interpolate at the wall") {
  const Grid<2> grid = full_grid<2>({8, 8});
  for (int i = 0; i <= 100; ++i) {
    const double x = i * 0.02;
    const PointStencil<2> s =
        point_stencil<2>(grid, ShapeKind::quadratic_bspline,
                         {grid.origin()[0] + x * kSpacing, grid.origin()[1] + 4.3 * kSpacing}, {});
    double weight[9] = {};
    for (int n = 0; n < s.count; ++n) weight[grid.index(s.slot[n])[0]] += s.weight[n];
    for (double w : weight) CHECK(w > -1e-12);
    if (i == 0) CHECK(weight[0] == doctest::Approx(1).epsilon(1e-12));
    if (x <= 0.5) CHECK(weight[1] == doctest::Approx(x).epsilon(1e-9));
  }
}
