// Drag between water and grains: what each node of the grid passes from one to the other in a step, where
// both have velocities.
//
// With B the drag of the node's water [N s/m], M_s and M_w its masses of grains and water, J the impulse of
// the boundaries on the grains,
//   M_s (v - v~) = J - M_w (w - w~) = J + dt B (w - v)
// in the velocities at the end of the step: no limit of the step, and what one layer gains the other loses to
// rounding (Bandara & Soga 2015 exchange the same force explicitly). Eliminating w,
//   (M_s + a M_w) v = M_s P + J,   P = v~ + a (M_w / M_s) w~,   a = b / (1 + b),   b = dt B / M_w:
// the grains move as if they carried the share a of the water with them. The boundaries act on P, and take
// from it the impulse that they really feel, friction included. In two layers B comes from the drag of the
// cells at the water's points, WaterLayer::drag [Pa s/m2 per volume of water].
//
// Where the acceleration of water relative to the grains is neglected (two-layer-darcy; Abe, Soga & Bandara
// 2014), water in pores is accelerated as the grains are, and only what stands beside the soil by itself.
// With t the share of a node's water that is in pores,
//   M_w [(1 - t)(w - w^n) + t (v - v^n)] = dt F_w - dt B (w - v):
// for t = 1 Darcy's law for the velocity of the water relative to the grains, with the mixture's acceleration
// in it, and M_s + M_w moved by F_s + F_w; for t = 0 the above. It has the same form, with
//   w~ + t (v^n - w^n) in place of w~,   a = b / (1 - t + b),   w = [w~ + (b - t) v] / (1 - t + b).
#pragma once

#include <cmath>

#include "coupling/drag_law.hpp"
#include "coupling/node_drag.hpp"
#include "coupling/world.hpp"

namespace polder::coupling {

// Mass of a node's water that feels forces: guards a division only [kg].
template <int D>
double water_floor(const World<D>& world) {
  constexpr double kNoWater = 1e-26;  // as a share of a cell of water
  return kNoWater * world.scene.water.density * std::pow(world.scene.grid.cell, D);
}

// Share of the nodes' water that is in pores, WaterLayer::tied, from that of the cells around.
template <int D>
void find_tied_water(World<D>& world);

// First half, before the boundaries: P in place of the trial velocity of the grains. end: time at the end of
// the step [s].
template <int D>
void push_by_drag(World<D>& world, double end, double dt);

// Second half, after them: the velocities of both layers, and what a unit pressure gradient over the step
// does to them (WaterLayer: water, following, grains_response, water_response). Grains that a boundary holds,
// or that friction stops, do not give way to the water.
template <int D>
void share_drag(World<D>& world, double dt);

template <int D>
DragFluid drag_fluid(const World<D>& world) {
  return {world.scene.water.density, world.scene.water.viscosity, world.unit_weight()};
}

// Conductivity of the soil's points under drag laws other than Darcy's, from their porosity and the velocity
// of the water relative to them at the end of the step that has just been made: the next one takes it as
// given, so that drag stays linear in the velocities that it changes. Part of a checkpoint as it stands.
template <int D>
void follow_flow(World<D>& world);

}  // namespace polder::coupling
