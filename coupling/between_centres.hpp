// Value of a cell field at a place: multilinear between the centres of the cells around it that hold water;
// the others do not count. Zero where none does.
#pragma once

#include <algorithm>
#include <cmath>

#include "fdm/water_cells.hpp"

namespace polder::coupling {

template <int D>
class BetweenCentres {
 public:
  BetweenCentres(const fdm::WaterCells<D>& cells, const Point<D>& at) {
    const Grid<D>& grid = cells.grid();
    Index<D> base;
    double share[D];
    for (int d = 0; d < D; ++d) {
      const double x = (at[d] - grid.origin()[d]) / grid.spacing() - 0.5;
      base[d] = static_cast<int>(std::floor(x));
      share[d] = x - base[d];
    }
    for (int k = 0; k < ipow(2, D); ++k) {
      Index<D> cell = base;
      double w = 1;
      for (int d = 0; d < D; ++d) {
        const int one = k >> d & 1;
        cell[d] = std::clamp(base[d] + one, 0, grid.cells()[d] - 1);
        w *= one ? share[d] : 1 - share[d];
      }
      slot_[k] = grid.slot(cell);
      if (slot_[k] < 0 || !cells.active(slot_[k])) slot_[k] = -1, w = 0;
      weight_[k] = w;
      sum_ += w;
    }
  }

  // field: over slots.
  double value(const Reals& field) const {
    double sum = 0;
    for (int k = 0; k < ipow(2, D); ++k)
      if (slot_[k] >= 0) sum += weight_[k] * field[slot_[k]];
    return sum_ > 0 ? sum / sum_ : 0.0;
  }

 private:
  int slot_[ipow(2, D)];
  double weight_[ipow(2, D)];
  double sum_ = 0;
};

}  // namespace polder::coupling
