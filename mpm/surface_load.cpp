#include "mpm/surface_load.hpp"

#include <algorithm>
#include <cmath>

#include "mpm/point_stencil.hpp"

namespace polder::mpm {
namespace {
// A load has no extent of its own: the linear hat where particles use linear or GIMP shapes.
ShapeKind load_shape(ShapeKind shape) {
  return shape == ShapeKind::quadratic_bspline ? shape : ShapeKind::linear;
}
}  // namespace

SurfaceLoad::SurfaceLoad(std::string name_, Point<2> from, Point<2> to, double piece, Space space)
    : name(std::move(name_)), space_(space) {
  const double length = std::hypot(to[0] - from[0], to[1] - from[1]);
  const int pieces = std::max(1, static_cast<int>(std::ceil(length / piece - 1e-9)));
  piece_length_ = length / pieces;
  for (int i = 0; i <= pieces; ++i) {
    const double s = double(i) / pieces;
    vertices_.push_back({from[0] + s * (to[0] - from[0]), from[1] + s * (to[1] - from[1])});
  }
}

Point<2> SurfaceLoad::apply(const Grid<2>& grid, ShapeKind shape, double time, Reals& sums) const {
  Point<2> total{};
  const double p = pressure ? pressure(time) : 0;
  const double tx = traction[0] ? traction[0](time) : 0, ty = traction[1] ? traction[1](time) : 0;
  for (std::size_t i = 0; i + 1 < vertices_.size(); ++i) {
    const Point<2>&a = vertices_[i], &b = vertices_[i + 1];
    const Point<2> middle{0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])};
    const double width = space_ == Space::axisymmetric ? middle[0] : 1;  // one radian, or one metre
    // Material to the left of a -> b: the inward normal times the present length is (-(b-a)_y, (b-a)_x).
    const Point<2> force{width * (tx * piece_length_ - p * (b[1] - a[1])),
                         width * (ty * piece_length_ + p * (b[0] - a[0]))};
    const PointStencil<2> s = point_stencil<2>(grid, load_shape(shape), middle, {});
    for (int n = 0; n < s.count; ++n)
      for (int d = 0; d < 2; ++d)
        sums[static_cast<std::size_t>(s.slot[n]) * 8 + 3 + d] += s.weight[n] * force[d];
    for (int d = 0; d < 2; ++d) total[d] += force[d];
  }
  return total;
}

void SurfaceLoad::move(const Grid<2>& grid, ShapeKind shape, double dt, const Reals& v) {
  for (Point<2>& x : vertices_) {
    const Point<2> u = interpolate<2>(grid, load_shape(shape), x, v, 4);
    for (int d = 0; d < 2; ++d) x[d] = std::clamp(x[d] + dt * u[d], grid.origin()[d], grid.upper()[d]);
  }
}

}  // namespace polder::mpm
