// Remedies for the quadrature of water on the soil's points (formulations v-w and u-p; Jassim, Stolle &
// Vermeer 2013).
//
// Mixed quadrature: cells that points fill are integrated at their centre, as a finite element with one Gauss
// point: force V_c p_c grad N(x_c) of the mean pressure p_c, and the rate of volume div(v + q) there, which
// is the adjoint of that force. Cells that are not full are integrated point by point. Smoothing of rates:
// the change of volume that pressure follows is carried to the nodes, weighted by volume, and back.
#pragma once

#include "coupling/world.hpp"

namespace polder::coupling {

// Which cells are full, and the force of their pressure: before the points' own pressures are mapped (full
// cells' points bring none), and after.
template <int D>
void set_full_cells_aside(World<D>& world);
template <int D>
void add_force_of_full_cells(World<D>& world);

// dt div(v + q) in the centres of full cells, v the nodal velocity that strains the soil [slots * 4]; after
// the flow of the step is known.
template <int D>
void find_rates_of_full_cells(World<D>& world, double dt, const Reals& grains);

// Into PointWater::rate of the points of full cells.
template <int D>
void take_rates_of_full_cells(World<D>& world);

// Smooths PointWater::rate over the nodes, at the points' places before they moved.
template <int D>
void smooth_rates(World<D>& world);

}  // namespace polder::coupling
