// Sides of the grid for water on the soil's points: prescribed pressures, closed parts, walls with friction.
#pragma once

#include "coupling/world.hpp"

namespace polder::coupling {

// Area of the soil at a node of a side [m2]: the support of such a node is half a cell deep.
template <int D>
double area_of_side(const World<D>& world, int slot) {
  const double volume = world.skeleton.sums()[static_cast<std::size_t>(slot) * 8 + mpm::Transfer<D>::kVolume];
  return 2 * volume / world.skeleton.grid().spacing();
}

// Nodes at which water may pass and those on walls with friction, after the grid has changed.
template <int D>
void find_sides(World<D>& world);

// Adds what acts on the water at the sides to the force in PointWater::sums.
template <int D>
void push_at_sides(World<D>& world);

// Takes from PointWater::flow what would pass a side that is closed at present, as above the level of a head.
template <int D>
void close_sides(World<D>& world);

}  // namespace polder::coupling
