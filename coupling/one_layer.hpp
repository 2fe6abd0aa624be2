// The one-layer step: soil carries its pore water, pressure lives in the grid's cells.
//
// Order of a step (after Higo et al. 2010 with a projected pressure; equations in docs/theory):
//   sort, cells (fill, porosity, surface), scatter,
//   predict with grad p^n, constrain, map to the velocities that strain the soil, solve for dp, correct with
//   grad dp, gather, wet.
// Where the pressure is not projected but follows from the bulk modulus of the water (formulation higo), it
// is advanced with the velocities that strain the soil in place of solution and correction.
#pragma once

#include "coupling/world.hpp"

namespace polder::coupling {

struct StepInput {
  double time = 0;     // at the start of the step [s]
  double dt = 0;       // [s]
  double damping = 0;  // local damping
  double gravity = 1;  // share of the scene's gravity
  bool water_flows = true;
};

// Moves the cells' fields after Skeleton::sort() returned true.
template <int D>
void carry_water(World<D>& world);

// Cells, mask and boundary conditions for the time `end`; call after a sort or before reading cell fields.
template <int D>
void update_water_cells(World<D>& world, double end);

// Acceleration of the nodes by the pore pressure as it is, into world.pore_water->acceleration [slots * 4];
// after Skeleton::scatter().
template <int D>
void push_by_pressure(World<D>& world);

template <int D>
mpm::MoveResult step_one_layer(World<D>& world, const StepInput& in, long step);

template <int D>
mpm::MoveResult step_dry(World<D>& world, const StepInput& in);

}  // namespace polder::coupling
