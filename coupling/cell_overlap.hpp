// The cells that a point's domain overlaps, at most two along each axis, and its share in each. The same
// shares as those of mpm::scatter_cells.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/grid.hpp"
#include "core/particles.hpp"

namespace polder::coupling {

template <int D>
struct Overlap {
  int slot[ipow(2, D)];  // -1: none
  double share[ipow(2, D)];
};

template <int D>
Overlap<D> overlap_of(const Grid<D>& grid, const ParticleSet<D>& set, int p) {
  int cell[D];
  double lower[D];
  for (int d = 0; d < D; ++d) {
    const double x = (set.position[d][p] - grid.origin()[d]) / grid.spacing();
    const double l = std::min(set.half_size[d][p] / grid.spacing(), 0.5);
    cell[d] = static_cast<int>(std::floor(x - l));
    lower[d] = l > 0 ? std::clamp((cell[d] + 1 - (x - l)) / (2 * l), 0.0, 1.0) : 1.0;
    if (cell[d] < 0) cell[d] = 0, lower[d] = 1.0;
    if (cell[d] > grid.cells()[d] - 2) {
      if (cell[d] > grid.cells()[d] - 1) cell[d] = grid.cells()[d] - 1;
      lower[d] = 1.0;
    }
  }
  Overlap<D> o;
  for (int k = 0; k < ipow(2, D); ++k) {
    Index<D> index;
    o.share[k] = 1;
    for (int d = 0; d < D; ++d) {
      const int upper = k >> d & 1;
      index[d] = std::min(cell[d] + upper, grid.cells()[d] - 1);
      o.share[k] *= upper ? 1 - lower[d] : lower[d];
    }
    o.slot[k] = o.share[k] > 0 ? grid.slot(index) : -1;
  }
  return o;
}

}  // namespace polder::coupling
