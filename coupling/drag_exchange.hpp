// Drag between the two layers of points: what each node of the grid passes from water to grains in a step.
//
// With b = dt B / M_w, B the drag of the node's water [N s/m], M_s and M_w its masses of grains and water,
//   M_s (v - v~) = - M_w (w - w~) = dt B (w - v)
// in the velocities at the end of the step, solved in closed form: no limit of the step, and what one layer
// gains the other loses to rounding (Bandara & Soga 2015 exchange the same force explicitly). B comes from
// the drag of the cells at the water's points, WaterLayer::drag [Pa s/m2 per volume of water].
#pragma once

#include <cmath>

#include "coupling/drag_law.hpp"
#include "coupling/world.hpp"

namespace polder::coupling {

// Mass of a node's water that feels forces: guards a division only [kg].
template <int D>
double water_floor(const World<D>& world) {
  constexpr double kNoWater = 1e-26;  // as a share of a cell of water
  return kNoWater * world.scene.water.density * std::pow(world.scene.grid.cell, D);
}

// Exchanges drag between the trial velocities of grains and water, and finds what a unit pressure gradient
// over the step does to both (WaterLayer: water, grains_response, water_response). Where a boundary holds the
// grains they do not give way to the water; the reaction goes into their trial velocity all the same, from
// where the boundary takes it, and friction feels it. end: time at the end of the step [s].
template <int D>
void exchange_drag(World<D>& world, double end, double dt);

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
