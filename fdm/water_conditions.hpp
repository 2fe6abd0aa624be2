// Boundary conditions of the pore water at one instant, as the pressure equations need them.
//
// Pressures are pore pressures [Pa], compression positive, relative to the atmosphere. Heights are measured
// along the last axis (y in 2D, z in 3D), upwards [m]. Water standing at level H exerts p = unit_weight (H -
// height) below the level. Everything that is not named is impermeable on the sides of the grid; the soil's
// own free surface is at atmospheric pressure where soil is saturated throughout, and a seepage face (water
// may leave, not enter) where it need not be.
//
// Seepage faces, flux, atmosphere, conditions named on the free surface, wells, drains and sheets need the
// unsaturated equation (fdm/unsaturated_field.hpp); the saturated one (fdm/pressure_field.hpp) refuses them.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "core/grid.hpp"

namespace polder::fdm {

inline constexpr int kFreeSurface = -1;  // instead of a side of the grid: where the soil ends inside it

// A part of one side of the grid, or of the soil's free surface, through which water may pass.
template <int D>
struct WaterBoundary {
  enum class Kind {
    impermeable,  // no flow; the same as not naming it, kept so that a schedule can close a boundary
    head,         // hydrostatic below the water level `value` [m]; above it impermeable or a seepage face
    pressure,     // uniform pressure `value` [Pa]
    surface,      // the soil ends here as at its free surface: pressure of the open water, else zero
    flux,         // inflow `value` [m/s] through every face, whatever pressure that takes
    atmosphere,   // rain or evaporation as far as the soil takes or gives it, and outflow: see below
  };
  std::string name;
  Kind kind = Kind::head;
  int side = 0;   // 2 * axis + (0 lower, 1 upper), or kFreeSurface
  Point<D> from;  // the part whose face centres lie in [from, to]; on a side of the grid the component along
  Point<D> to;    // its own axis is ignored; everything by default
  double value = 0;  // water level [m], pressure [Pa], inflow [m/s] or potential inflow [m/s]

  bool seepage_above = false;  // head: water may leave above the level

  // Atmosphere: `value` is the potential inflow per horizontal area, rain positive, evaporation negative; it
  // acts on faces that look upwards. The face takes it as long as the surface pressure stays between
  // `limiting_pressure` (evaporation dries no further) and the weight of `ponding_depth` of water (what
  // exceeds it runs off). At the upper limit water may also leave: with value 0 a plain seepage face. Below
  // the open water's level (WaterConditions::outside_level) the face is hydrostatic.
  double ponding_depth = 0;                                             // [m]
  double limiting_pressure = -std::numeric_limits<double>::infinity();  // [Pa]

  WaterBoundary() {
    from.fill(-std::numeric_limits<double>::infinity());
    to.fill(std::numeric_limits<double>::infinity());
  }
};

// A line through the soil that takes water out at a given rate (or puts it in, where the rate is negative).
template <int D>
struct WaterWell {
  std::string name;
  std::vector<Point<D>> points;  // the line's corners; a single one: the cell it lies in
  double rate = 0;               // of the whole well, outwards [m3/s]
  // Pressure in the well below which it takes no water, or above which it gives none; unlimited where not
  // finite [Pa]. Between cell and well water meets the resistance of the cell's faces in saturated soil.
  double limiting_pressure = -std::numeric_limits<double>::infinity();
};

// A line through the soil that takes water where the pressure exceeds its own, and never gives any.
template <int D>
struct WaterDrain {
  std::string name;
  std::vector<Point<D>> points;
  double pressure = 0;  // [Pa]
  // Flow per pressure excess of the whole drain [m3/(Pa s)]; infinite: its cells do not exceed the pressure.
  double conductance = std::numeric_limits<double>::infinity();
};

// A thin wall through which no water passes. In space it stands upright over its line between two heights.
template <int D>
struct WaterSheet {
  std::string name;
  std::vector<Point<D>> points;
  double bottom = -std::numeric_limits<double>::infinity();  // [m], in space only
  double top = std::numeric_limits<double>::infinity();
};

template <int D>
struct WaterConditions {
  double unit_weight = 9810;  // of water [N/m3]
  // Level of open water over the soil's own surface [m]; none: the surface is at atmospheric pressure.
  double outside_level = -std::numeric_limits<double>::infinity();
  // Those on one side of the grid must not overlap; on the free surface the first one that fits counts.
  std::vector<WaterBoundary<D>> boundaries;
  std::vector<WaterWell<D>> wells;
  std::vector<WaterDrain<D>> drains;
  std::vector<WaterSheet<D>> sheets;
};

}  // namespace polder::fdm
