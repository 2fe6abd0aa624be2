#include "mpm/point_stencil.hpp"

#include <algorithm>
#include <cmath>

namespace polder::mpm {
namespace {

void axis(ShapeKind shape, double x, double l, int last, int& base, double* w, double* g) {
  base = static_cast<int>(std::floor(x - 0.5));
  const double r = x - base;
  if (shape == ShapeKind::quadratic_bspline) {
    const double t = r - 1;
    w[0] = 0.5 * (0.5 - t) * (0.5 - t), w[2] = 0.5 * (0.5 + t) * (0.5 + t);
    g[0] = t - 0.5, g[2] = t + 0.5;
  } else if (shape == ShapeKind::gimp && l > 0) {
    const double q = 2 - r, a = std::max(1 + l - r, 0.0), b = std::max(1 + l - q, 0.0), scale = 0.25 / l;
    w[0] = r < 1 - l ? 1 - r : a * a * scale, g[0] = r < 1 - l ? -1 : -2 * a * scale;
    w[2] = q < 1 - l ? 1 - q : b * b * scale, g[2] = q < 1 - l ? 1 : 2 * b * scale;
  } else {
    w[0] = std::max(1 - r, 0.0), w[2] = std::max(r - 1, 0.0);
    g[0] = r < 1 ? -1 : 0, g[2] = r < 1 ? 0 : 1;
  }
  w[1] = 1 - w[0] - w[2];
  g[1] = -(g[0] + g[2]);
  for (double* v : {w, g}) {  // fold what lies beyond the grid's sides (mpm/stencil.hpp)
    const double v0 = v[0], v1 = v[1], v2 = v[2];
    if (base < 0)
      v[0] = v1 + 2 * v0, v[1] = v2 - v0, v[2] = 0;
    else if (base > last - 2)
      v[0] = 0, v[1] = v0 - v2, v[2] = v1 + 2 * v2;
  }
  base = std::clamp(base, 0, last - 2);
}

}  // namespace

template <int D>
PointStencil<D> point_stencil(const Grid<D>& grid, ShapeKind shape, const Point<D>& position,
                              const Point<D>& half_size) {
  int base[D];
  double w[D][3], g[D][3];
  for (int d = 0; d < D; ++d) {
    axis(shape, (position[d] - grid.origin()[d]) / grid.spacing(), half_size[d] / grid.spacing(),
         grid.cells()[d], base[d], w[d], g[d]);
    for (double& x : g[d]) x /= grid.spacing();
  }
  PointStencil<D> s;
  for (int n = 0; n < PointStencil<D>::kNodes; ++n) {
    const int a[3] = {n % 3, n / 3 % 3, n / 9};
    Index<D> index;
    for (int d = 0; d < D; ++d) index[d] = base[d] + a[d];
    const int slot = grid.slot(index);
    if (slot < 0) continue;
    double weight = 1;
    for (int d = 0; d < D; ++d) weight *= w[d][a[d]];
    s.slot[s.count] = slot;
    s.weight[s.count] = weight;
    for (int e = 0; e < D; ++e) {
      double slope = 1;
      for (int d = 0; d < D; ++d) slope *= d == e ? g[d][a[d]] : w[d][a[d]];
      s.slope[s.count][e] = slope;
    }
    ++s.count;
  }
  return s;
}

template <int D>
Point<D> interpolate(const Grid<D>& grid, ShapeKind shape, const Point<D>& position, const Reals& field,
                     int stride) {
  const PointStencil<D> s = point_stencil<D>(grid, shape, position, Point<D>{});
  Point<D> v{};
  for (int n = 0; n < s.count; ++n)
    for (int d = 0; d < D; ++d) v[d] += s.weight[n] * field[static_cast<std::size_t>(s.slot[n]) * stride + d];
  return v;
}

template PointStencil<2> point_stencil<2>(const Grid<2>&, ShapeKind, const Point<2>&, const Point<2>&);
template PointStencil<3> point_stencil<3>(const Grid<3>&, ShapeKind, const Point<3>&, const Point<3>&);
template Point<2> interpolate<2>(const Grid<2>&, ShapeKind, const Point<2>&, const Reals&, int);
template Point<3> interpolate<3>(const Grid<3>&, ShapeKind, const Point<3>&, const Reals&, int);

}  // namespace polder::mpm
