// Shear stress of water on points of its own: Newtonian, tau = mu (grad w + grad w^T), implicit in a step.
//
// On the nodes of the grid, with bilinear (trilinear) cells integrated exactly:
//   (M + dt K) w = M w~,   K_ij^ab = sum_c s_c mu int (delta_ab grad N_i . grad N_j + d_b N_i d_a N_j) dV,
// w~ the trial velocity, M the water's nodal mass, s_c the water's share of the cell's volume: in soil the
// pores' part of the stress (Brinkman 1949 with the fluid's own viscosity), at a free surface the wet part of
// the cell. K is symmetric, positive and indifferent to rigid motion, so that linear and angular momentum
// change at walls only; backward Euler in time sets no limit to the step. Conjugate gradients with the
// diagonal as preconditioner find w to kTolerance, in an order of sums that no number of threads changes.
//
// Components that a wall holds keep their trial value: no-slip walls hold all of them. A free surface has no
// shear stress by itself. Through an open side of the grid water passes at a right angle: components along it
// do not feel viscosity there, which lets developed profiles through.
#pragma once

#include <cstdint>
#include <vector>

#include "core/aligned.hpp"
#include "core/grid.hpp"
#include "mpm/fluid_layer.hpp"

namespace polder::coupling {

template <int D>
class WaterViscosity {
 public:
  WaterViscosity(const Grid<D>& grid, double viscosity) : grid_(grid), viscosity_(viscosity) {}

  // Velocities [slots * 4] after dt of viscous stress. volume: of the water in each cell
  // [slots]. Throws NumericalError where the iteration does not end.
  void diffuse(const mpm::FluidLayer<D>& fluid, const Reals& volume, double dt, Reals& velocity);

  int iterations() const { return iterations_; }  // of the last call

 private:
  static constexpr int kCorners = ipow(2, D);
  void follow_grid(const mpm::FluidLayer<D>& fluid);
  void apply(const Reals& x, Reals& y) const;
  template <class F>
  double sum(const F& of_component);

  const Grid<D>& grid_;
  double viscosity_;
  std::uint64_t revision_ = 0;
  int iterations_ = 0;
  // Nodes: slots of the 3^D around each, of the 2^D cells around it (-1: none), components that are kept.
  std::vector<std::array<int, ipow(3, D)>> nodes_;
  std::vector<std::array<int, kCorners>> cells_;
  std::vector<std::uint8_t> kept_;
  Reals share_;  // of a cell's volume that water takes, times dt mu h^(D-2)
  Reals mass_;   // of the nodes
  Reals diagonal_, residual_, direction_, product_;
  std::vector<double> parts_;  // of a sum, one for each block
};

extern template class WaterViscosity<2>;
extern template class WaterViscosity<3>;

}  // namespace polder::coupling
