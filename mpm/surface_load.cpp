#include "mpm/surface_load.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "core/threads.hpp"
#include "mpm/plane_patch.hpp"
#include "mpm/point_stencil.hpp"

namespace polder::mpm {
namespace {
// A load has no extent of its own: the linear hat where particles use linear or GIMP shapes.
ShapeKind load_shape(ShapeKind shape) {
  return shape == ShapeKind::quadratic_bspline ? shape : ShapeKind::linear;
}

// The least weight of nodes with mass around a point of a surface that still lies on soil.
constexpr double kOnSoil = 0.05;

// Stencil of a point of a surface over the nodes that have mass. The edge of the particles runs in steps
// along an inclined surface, so a point of it may reach past the last node with mass; what such a node would
// get, a force or a say in the velocity, goes to the others in proportion. Empty where there is no soil.
template <int D>
PointStencil<D> stencil_on_soil(const Grid<D>& grid, ShapeKind shape, const Point<D>& x, const Reals& sums) {
  PointStencil<D> s = point_stencil<D>(grid, load_shape(shape), x, {});
  double kept = 0;
  int count = 0;
  for (int n = 0; n < s.count; ++n) {
    if (!(sums[static_cast<std::size_t>(s.slot[n]) * 8] > 0)) continue;
    s.slot[count] = s.slot[n], s.weight[count] = s.weight[n];
    kept += s.weight[count++];
  }
  const bool all = count == s.count && kept > 0.5;
  s.count = kept >= kOnSoil ? count : 0;
  if (!all)
    for (int n = 0; n < s.count; ++n) s.weight[n] /= kept;
  return s;
}

// A piece as it is now.
template <int D>
struct Piece {
  Point<D> area;    // along the normal into the material, as long as the piece [m] or its area [m2]
  Point<D> middle;  // where its force acts
};

Piece<2> present(const std::vector<Point<2>>& vertices, std::span<const int> corners) {
  const Point<2>&a = vertices[corners[0]], &b = vertices[corners[1]];
  // Material to the left of a -> b.
  return {{-(b[1] - a[1]), b[0] - a[0]}, {0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])}};
}

Piece<3> present(const std::vector<Point<3>>& vertices, std::span<const int> corners) {
  const Point<3>& x0 = vertices[corners[0]];
  // A fan of triangles about the first vertex: 1/2 sum of cross products.
  const auto each_triangle = [&](const auto& visit) {
    for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
      const Point<3>&a = vertices[corners[i]], &b = vertices[corners[i + 1]];
      Point<3> area;
      for (int d = 0; d < 3; ++d) {
        const int e = (d + 1) % 3, f = (d + 2) % 3;
        area[d] = 0.5 * ((a[e] - x0[e]) * (b[f] - x0[f]) - (a[f] - x0[f]) * (b[e] - x0[e]));
      }
      visit(area, a, b);
    }
  };
  Piece<3> r{};
  each_triangle([&](const Point<3>& area, const Point<3>&, const Point<3>&) {
    for (int d = 0; d < 3; ++d) r.area[d] += area[d];
  });
  // The middle is the mean of the triangles' middles, weighted with their areas across the mean normal.
  double total = 0;
  each_triangle([&](const Point<3>& area, const Point<3>& a, const Point<3>& b) {
    const double across = area[0] * r.area[0] + area[1] * r.area[1] + area[2] * r.area[2];
    for (int d = 0; d < 3; ++d) r.middle[d] += across * (x0[d] + a[d] + b[d]) / 3;
    total += across;
  });
  for (int d = 0; d < 3; ++d) r.middle[d] = total > 0 ? r.middle[d] / total : x0[d];
  return r;
}

}  // namespace

template <int D>
SurfaceLoad<D>::SurfaceLoad(std::string name_, std::vector<Point<D>> vertices,
                            const std::vector<std::vector<int>>& pieces, Space space)
    : name(std::move(name_)), vertices_(std::move(vertices)), first_{0}, space_(space) {
  for (const std::vector<int>& p : pieces) {
    corners_.insert(corners_.end(), p.begin(), p.end());
    first_.push_back(static_cast<int>(corners_.size()));
    double square = 0;
    for (const double a : present(vertices_, p).area) square += a * a;
    piece_area_.push_back(std::sqrt(square));
  }
}

template <int D>
Point<D> SurfaceLoad<D>::apply(const Grid<D>& grid, ShapeKind shape, double time, Reals& sums) const {
  Point<D> total{};
  const double p = pressure ? pressure(time) : 0;
  Point<D> t{};
  for (int d = 0; d < D; ++d)
    if (traction[d]) t[d] = traction[d](time);
  for (int i = 0; i < pieces(); ++i) {
    const int first = first_[i];
    const Piece<D> now = present(vertices_, std::span(corners_).subspan(first, first_[i + 1] - first));
    const double width = space_ == Space::axisymmetric ? now.middle[0] : 1;  // one radian, or one metre
    Point<D> force;
    for (int d = 0; d < D; ++d) force[d] = width * (t[d] * piece_area_[i] + p * now.area[d]);
    const PointStencil<D> s = stencil_on_soil<D>(grid, shape, now.middle, sums);
    if (s.count == 0) continue;
    for (int n = 0; n < s.count; ++n)
      for (int d = 0; d < D; ++d)
        sums[static_cast<std::size_t>(s.slot[n]) * 8 + 1 + D + d] += s.weight[n] * force[d];
    for (int d = 0; d < D; ++d) total[d] += force[d];
  }
  return total;
}

template <int D>
void SurfaceLoad<D>::move(const Grid<D>& grid, ShapeKind shape, double dt, const Reals& v,
                          const Reals& sums) {
  parallel_for(static_cast<int>(vertices_.size()), [&](int i) {
    Point<D>& x = vertices_[i];
    const PointStencil<D> s = stencil_on_soil<D>(grid, shape, x, sums);
    Point<D> u{};
    for (int n = 0; n < s.count; ++n)
      for (int d = 0; d < D; ++d) u[d] += s.weight[n] * v[static_cast<std::size_t>(s.slot[n]) * 4 + d];
    for (int d = 0; d < D; ++d) x[d] = std::clamp(x[d] + dt * u[d], grid.origin()[d], grid.upper()[d]);
  });
}

SurfaceLoad<2> line_load(std::string name, const Point<2>& from, const Point<2>& to, double piece,
                         Space space) {
  const double length = std::hypot(to[0] - from[0], to[1] - from[1]);
  const int count = std::max(1, static_cast<int>(std::ceil(length / piece - 1e-9)));
  std::vector<Point<2>> vertices;
  std::vector<std::vector<int>> pieces;
  for (int i = 0; i <= count; ++i) {
    const double s = double(i) / count;
    vertices.push_back({from[0] + s * (to[0] - from[0]), from[1] + s * (to[1] - from[1])});
    if (i < count) pieces.push_back({i, i + 1});
  }
  return {std::move(name), std::move(vertices), pieces, space};
}

SurfaceLoad<3> patch_load(std::string name, const std::vector<Point<3>>& corners, double piece) {
  const PlanePatch patch(corners);
  const PatchPieces cut = cut_patch(patch.corners(), piece);
  std::vector<Point<3>> vertices;
  for (const Point<2>& uv : cut.vertices) vertices.push_back(patch.position(uv));
  return {std::move(name), std::move(vertices), cut.pieces, Space::three_d};
}

template class SurfaceLoad<2>;
template class SurfaceLoad<3>;

}  // namespace polder::mpm
