// Boundary conditions of the pore water at one instant, as the pressure equation needs them.
//
// Pressures are pore pressures [Pa], compression positive, relative to the atmosphere. Heights are measured
// along the last axis (y in 2D, z in 3D), upwards [m]. Water standing at level H exerts p = unit_weight (H -
// height) below the level; a part of a side above the level of its head is impermeable (seepage faces are not
// modelled here). Everything that is not named is impermeable: the sides of the grid are walls.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "core/grid.hpp"

namespace polder::fdm {

// A part of one side of the grid through which water may pass.
template <int D>
struct WaterBoundary {
  enum class Kind {
    impermeable,  // no flow; the same as not naming it, kept so that a schedule can close a boundary
    head,         // hydrostatic below the water level `value` [m]
    pressure,     // uniform pressure `value` [Pa]
    surface,      // the soil ends here as at its free surface: pressure of the open water, else zero
  };
  std::string name;
  Kind kind = Kind::head;
  int side = 0;   // 2 * axis + (0 lower, 1 upper)
  Point<D> from;  // the part of the side whose face centres lie in [from, to]; the component along the side's
  Point<D> to;    // own axis is ignored; the whole side by default
  double value = 0;  // water level [m] or pressure [Pa]

  WaterBoundary() {
    from.fill(-std::numeric_limits<double>::infinity());
    to.fill(std::numeric_limits<double>::infinity());
  }
};

template <int D>
struct WaterConditions {
  double unit_weight = 9810;  // of water [N/m3]
  // Level of open water over the soil's own surface [m]; none: the surface is at atmospheric pressure.
  double outside_level = -std::numeric_limits<double>::infinity();
  std::vector<WaterBoundary<D>> boundaries;  // must not overlap
};

}  // namespace polder::fdm
