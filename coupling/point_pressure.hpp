// Pore pressure at the points of the soil (formulations v-w and u-p): where it starts, how it follows the
// change of volume and the flow of a step, and what cells show of it. Pressure [Pa], positive in compression.
#pragma once

#include "coupling/world.hpp"

namespace polder::coupling {

// Before the points move: their volumes, and what PointWater::flow takes of their water. grains: the nodal
// velocity that strains the soil [slots * 4].
template <int D>
void begin_rates(World<D>& world, double dt, const Reals& grains);

// After they have moved: dp = -(K_w / n) (de + div q dt), e their volumetric strain; the water's balance and
// its discharge. gravity: in force [m/s2].
template <int D>
void update_point_pressure(World<D>& world, double dt, const Point<D>& gravity);

}  // namespace polder::coupling
