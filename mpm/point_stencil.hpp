// Shape functions at a single point: loads, probes and tests. The same numbers as mpm/stencil.hpp gives for a
// pack.
#pragma once

#include "core/grid.hpp"
#include "mpm/shape_kind.hpp"

namespace polder::mpm {

template <int D>
struct PointStencil {
  static constexpr int kNodes = ipow(3, D);
  int count = 0;     // nodes with storage
  int slot[kNodes];  // of the grid
  double weight[kNodes];
  double slope[kNodes][D];  // [1/m]
};

// half_size [m] matters for GIMP only; 0 gives the linear hat there.
template <int D>
PointStencil<D> point_stencil(const Grid<D>& grid, ShapeKind shape, const Point<D>& position,
                              const Point<D>& half_size);

// sum N_i field_i of a node field with `stride` numbers a node.
template <int D>
Point<D> interpolate(const Grid<D>& grid, ShapeKind shape, const Point<D>& position, const Reals& field,
                     int stride);

}  // namespace polder::mpm
