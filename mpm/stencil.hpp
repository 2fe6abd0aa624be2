// Shape functions of a pack of particles: three nodes along each axis, for every kind of shape.
//
// Positions are in cells from the grid's origin. The stencil of a particle starts at node base = floor(x -
// 1/2), so it covers the support of the linear hat, of GIMP (Bardenhagen & Kober 2004) with half sizes up to
// half a cell, and of the quadratic B-spline (Steffen et al. 2008).
//
// At the sides of the grid the value of the missing outer node is extrapolated linearly, v_-1 = 2 v_0 - v_1,
// which folds its weight into the first two nodes. That keeps partition of unity and linear completeness and
// makes the shape interpolate at the wall; for the B-spline it is the usual boundary-modified spline.
#pragma once

#include "core/simd.hpp"
#include "mpm/shape_kind.hpp"

namespace polder::POLDER_SIMD_NAMESPACE {

struct AxisStencil {
  Mask base;       // first node
  Pack weight[3];  // N
  Pack slope[3];   // dN/dx in 1/cell
};

// x, half_size: in cells. nodes: index of the last node along the axis (number of cells).
POLDER_INLINE void axis_stencil(mpm::ShapeKind shape, Pack x, Pack half_size, int nodes, AxisStencil& s) {
  s.base = floor_to_int(x - 0.5);
  const Pack r = x - to_real(s.base);  // in [1/2, 3/2): distance from the first node
  if (shape == mpm::ShapeKind::quadratic_bspline) {
    const Pack t = r - 1.0;
    s.weight[0] = 0.5 * (0.5 - t) * (0.5 - t);
    s.weight[2] = 0.5 * (0.5 + t) * (0.5 + t);
    s.slope[0] = t - 0.5;
    s.slope[2] = t + 0.5;
  } else if (shape == mpm::ShapeKind::gimp) {
    const Pack l = half_size, scale = 0.25 / l;
    const Pack q = 2.0 - r;  // distance to the last node
    const Pack a = max(1.0 + l - r, 0.0), b = max(1.0 + l - q, 0.0);
    const Mask inner_a = r < 1.0 - l, inner_b = q < 1.0 - l;
    s.weight[0] = select(inner_a, 1.0 - r, a * a * scale);
    s.weight[2] = select(inner_b, 1.0 - q, b * b * scale);
    s.slope[0] = select(inner_a, broadcast(-1.0), -2.0 * a * scale);
    s.slope[2] = select(inner_b, broadcast(1.0), 2.0 * b * scale);
  } else {
    const Mask left = r < 1.0;
    s.weight[0] = max(1.0 - r, 0.0);
    s.weight[2] = max(r - 1.0, 0.0);
    s.slope[0] = select(left, broadcast(-1.0), Pack{});
    s.slope[2] = select(left, Pack{}, broadcast(1.0));
  }
  s.weight[1] = 1.0 - s.weight[0] - s.weight[2];
  s.slope[1] = -(s.slope[0] + s.slope[2]);

  const Mask low = s.base<0, high = s.base> nodes - 2;
  if (any(low | high)) {
    const auto fold = [&](Pack* w) {
      const Pack w0 = w[0], w1 = w[1], w2 = w[2];
      w[0] = select(low, w1 + 2.0 * w0, select(high, Pack{}, w0));
      w[1] = select(low, w2 - w0, select(high, w0 - w2, w1));
      w[2] = select(low, Pack{}, select(high, w1 + 2.0 * w2, w2));
    };
    fold(s.weight);
    fold(s.slope);
    s.base = low ? Mask{} : (high ? Mask{} + (nodes - 2) : s.base);
  }
}

}  // namespace polder::POLDER_SIMD_NAMESPACE
