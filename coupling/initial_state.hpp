// Initial saturation, pore pressure and effective stress.
#pragma once

#include <functional>

#include "coupling/world.hpp"

namespace polder::coupling {

// Which points lie below the phreatic line: full pores below it; above it the scene's degree of saturation,
// with suction and capillary cohesion.
template <int D>
void set_saturation(World<D>& world);

// K0: vertical total stress from the weight of everything above the point (grains, pore water by its
// saturation), minus the pore pressure below the phreatic line, times K0 of the point's layer in the
// horizontal; suction adds an isotropic effective compression S s. Or the given field. Where pores may hold
// air the pressure of the cells must have been set.
template <int D>
void set_initial_stress(World<D>& world);

// Pore pressure of saturated soil at a place at the start [Pa]: at rest below the water table (also where the
// scene asks for steady flow, which is found from there), or the given field.
std::function<double(const Vector3&)> initial_pressure(const Scene& scene, double unit_weight);

// Pressure of the cells [Pa, slots] at rest below the water table, or the given field; where there may be
// suction it goes on above the table.
template <int D>
void set_cell_pressure(const World<D>& world, Reals& pressure);

// Pore pressure under the present conditions: zero, hydrostatic below the phreatic line, steady flow, or the
// given field.
// Needs the cells to be up to date.
template <int D>
void set_initial_pressure(World<D>& world);

// Suction and capillary cohesion end where a point's cell has become an active water cell.
template <int D>
void wet_points(World<D>& world);

}  // namespace polder::coupling
