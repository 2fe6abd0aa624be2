// Displacement of water that takes the drift out of its volume.
//
// Points carry water where the velocity field takes them, and in the long run a little too much of it comes
// together in some cells and too little in others: the sum of the volumes of grains and water leaves the
// cell's volume. The drift is taken back by moving the points alone, without touching velocities or pressure:
// along u = -grad psi / n with
//   sum_f A_f / d_f (psi_c - psi_e) = share * excess_c V_c,
// psi = 0 at free surfaces, no flow through walls and open sides. (A source in the pressure equation instead
// answers a drift of a per cent with huge pressures where soil conducts badly.)
#pragma once

#include <span>

#include "core/aligned.hpp"
#include "fdm/cell_operators.hpp"
#include "fdm/linear_system.hpp"
#include "fdm/pressure_field.hpp"
#include "fdm/water_cells.hpp"

namespace polder::fdm {

template <int D>
class VolumeCorrection {
 public:
  static constexpr int kStride = NodeGradient<D>::kStride;

  // `cells`, and the field of pressure in them, must outlive the correction; PressureField::refresh() comes
  // before solve().
  VolumeCorrection(const WaterCells<D>& cells, PressureField<D>& pressure);

  // excess: volume of grains and water over that of the cell, minus one [-]; porosity: volume not taken by
  // grains [-]; both over slots. Beside free surfaces, where cells need not be full, only positive excess
  // counts. displacement [slots * kStride, m] of the nodes.
  void solve(std::span<const double> excess, std::span<const double> porosity, double share,
             Reals& displacement);

 private:
  void refresh();

  const WaterCells<D>& cells_;
  PressureField<D>& pressure_;  // lends its lists of faces and basins and its solver
  std::uint64_t revision_ = 0;
  std::vector<BoundaryFace<D>> faces_;  // of the cells, open sides closed
  std::vector<unsigned char> edge_;     // cells beside a surface
  Reals sink_, link_, rhs_, x_, psi_, weight_;
};

extern template class VolumeCorrection<2>;
extern template class VolumeCorrection<3>;

}  // namespace polder::fdm
