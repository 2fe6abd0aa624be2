// The two-layer step: soil and pore water on material points of their own, each with its own velocity
// (Bandara & Soga 2015, Comput. Geotech. 63), with the pressure of the one-layer formulation in the cells.
//
// Per volume of mixture, with porosity n, grain and water velocities v and w:
//   (1 - n) rho_s dv/dt = div sigma' - (1 - n) grad p + (1 - n) rho_s g + beta (w - v)
//   n rho_w dw/dt       = - n grad p + n rho_w g - beta (w - v),      beta = n^2 gamma_w / k
//   (n / Kw) dp/dt + div [ (1 - n) v + n w ] = 0
// Drag is exchanged implicitly at each node, so it limits no step and conserves momentum exactly; pressure is
// projected out of the mixture's flow. Order of a step:
//   sort, cells (fill of water, porosity, drag: coupling/layer_cells.hpp), scatter both layers, find the
//   nodes that hold something, the only ones looked at from here on,
//   predict with grad p^n, constrain, let viscosity act, exchange drag, solve for dp, correct both with grad
//   dp, gather both, take the drift out of the water's volume, let points in and out at open sides.
#pragma once

#include "coupling/one_layer.hpp"

namespace polder::coupling {

// Points of water in the pores below the phreatic line and in the scene's bodies of water. Throws InputError
// for what cannot hold water.
template <int D>
void seed_water(World<D>& world);

// Boundaries of the water along those of the soil: it slips along walls or sticks to them, and passes where a
// side is open.
template <int D>
mpm::BoundarySet<D> water_walls(const Scene& scene, const mpm::BoundarySet<D>& soil);

// Fill of the cells with water, porosity and drag from both layers; part of update_water_cells().
template <int D>
void update_layer_cells(World<D>& world);

// While it lives soil holds the water in its pores, as in one layer, and the points of water rest: for
// relaxation, which finds a balance of forces and moves no water. Does nothing in other formulations.
template <int D>
class HeldWater {
 public:
  explicit HeldWater(World<D>& world);
  ~HeldWater();
  HeldWater(const HeldWater&) = delete;
  HeldWater& operator=(const HeldWater&) = delete;

 private:
  void give_pore_water(bool full);
  World<D>& world_;
};

template <int D>
mpm::MoveResult step_two_layer(World<D>& world, const StepInput& in, long step);

// Speed of the wave in the skeleton over the one that the inertia of the grains alone gives it. Where the
// acceleration of water relative to them is neglected, the water's follows theirs and its pressure with it,
// which pushes on them: (1 - n)(rho_s - rho_w) is left of their inertia in soil of high conductivity.
double wave_factor(const Scene& scene);

// Speed of long waves on the water's surface, sqrt(g H) with H the height from its lowest to its highest
// point [m/s].
template <int D>
double surface_wave_speed(const World<D>& world);

// Makes two points of one that is too large for the pores around it.
template <int D>
void split_points(World<D>& world);

// Keeps the points inside the grid, and lets water in and out at open sides.
template <int D>
void pass_open_sides(World<D>& world, double dt);

}  // namespace polder::coupling
