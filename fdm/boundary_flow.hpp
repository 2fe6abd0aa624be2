// Flow of water through one boundary face of soil that need not be saturated.
//
// The flow that a surface pressure p_b drives into the cell with pressure p_c at the distance d is
//   Q(p_b) = A (k k_r / gamma_w) [ (p_b - p_c) / d + rho_w g.m ],   m the inward normal;
// k_r that of p_b where water enters (a dry coarse cell behind a wet surface would otherwise keep rain out
// that the soil takes), the logarithmic mean of surface and cell where it leaves: the mean over p if k_r is
// exponential between the two, so that evaporation to a dry surface does not depend on the size of the cell.
// A face then is closed, has a pressure, has a flow, or is complementary: it takes the potential inflow R as
// long as the surface pressure stays between two limits,
//   Q = max( min( R, Q(upper) ), Q(lower) ),
// which is at once rain with ponding and run-off, evaporation down to a limiting suction, and, with R = 0 and
// upper = 0, a seepage face. The derivative of that expression makes the iteration a semismooth Newton
// method for the complementarity conditions (Qi & Sun 1993, Math. Program. 58); no list of switched faces is
// kept.
//
// Where curves are means over the height of a cell (fdm/suction_integrals.hpp), so is the flow through an
// upright face: with the pressure p - y of the cell at the height y above its centre (both in Pa, from -s to
// s) and a water level at y = l, saturated soil gives
//   -Q = A k / (gamma_w d) [ mean of (p - l) below the level + mean of max(0, p - y) above it ],
// so that a face opens and drowns bit by bit as the free surface or the level passes it.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "fdm/water_cells.hpp"

namespace polder::fdm {

struct BoundaryLaw {
  enum class Kind { closed, pressure, flow, complementary, split } kind = Kind::closed;
  double upper = 0;  // surface pressure: the prescribed one, or the most [Pa]
  double lower = -std::numeric_limits<double>::infinity();  // the least [Pa]
  double inflow = 0;                                        // prescribed or potential [m3/s]
  double upper_conductivity = 1, lower_conductivity = 1;    // k_r at the limits
  double gravity = 0;     // rho_w g.m d: what the water's weight adds to the pressure difference [Pa]
  bool upstream = false;  // k_r of the cell alone where water leaves
  // split: half the pressure between the face's lower and upper end; that of the outside water at its centre,
  // within +- spread [Pa]; whether water may leave above the level
  double spread = 0, level = 0;
  bool seeps = true;
};

struct BoundaryFlow {
  double inflow = 0;       // [m3/s]
  double conductance = 0;  // -d inflow / d p_c at constant k_r [m3/(Pa s)]
  double pressure = 0;     // at the surface, where the law prescribes it
  bool prescribed = false;
};

// (a - b) / (ln a - ln b), for a, b >= 0.
inline double logarithmic_mean(double a, double b) {
  const double low = std::max(std::min(a, b), std::numeric_limits<double>::min()), high = std::max(a, b);
  const double excess = high / low - 1;
  return excess < 1e-4 ? 0.5 * (low + high) : (high - low) / std::log1p(excess);
}

// kind split: outflow over kappa, and its derivative.
inline BoundaryFlow split_flow(const BoundaryLaw& law, double kappa, double p) {
  const double per_height = 0.5 / law.spread, drowned = (law.level + law.spread) * per_height;
  double outflow = drowned * (p - law.level), slope = drowned;
  if (law.seeps) {
    const double low = std::max(0.0, p - law.level), high = std::max(0.0, p - law.spread);
    outflow += 0.5 * (low - high) * (low + high) * per_height;
    slope += (low - high) * per_height;
  }
  return {-kappa * outflow, kappa * slope, 0, false};
}

// kappa: saturated A k / (gamma_w d) [m3/(Pa s)]; p, relative: pressure and k_r of the cell.
inline BoundaryFlow boundary_flow(const BoundaryLaw& law, double kappa, double p, double relative) {
  const auto driven = [&](double surface, double surface_relative) {
    const double difference = surface - p + law.gravity;
    double k = surface_relative;
    if (difference < 0) k = law.upstream ? relative : logarithmic_mean(surface_relative, relative);
    return BoundaryFlow{kappa * k * difference, kappa * k, surface, true};
  };
  switch (law.kind) {
    case BoundaryLaw::Kind::closed:
      return {};
    case BoundaryLaw::Kind::flow:
      return {law.inflow, 0, 0, false};
    case BoundaryLaw::Kind::pressure:
      return driven(law.upper, law.upper_conductivity);
    case BoundaryLaw::Kind::split:
      return split_flow(law, kappa, p);
    case BoundaryLaw::Kind::complementary:
      break;
  }
  const BoundaryFlow most = driven(law.upper, law.upper_conductivity);
  if (law.inflow >= most.inflow) return most;
  if (law.lower > -std::numeric_limits<double>::infinity()) {
    const BoundaryFlow least = driven(law.lower, law.lower_conductivity);
    if (law.inflow <= least.inflow) return least;
  }
  return {law.inflow, 0, 0, false};
}

// The law of a face under the conditions of the cells; k_r at its limits is left to the caller, who knows the
// soil.
template <int D>
BoundaryLaw boundary_law(const BoundaryFace<D>& face, const WaterConditions<D>& conditions) {
  using Kind = typename WaterBoundary<D>::Kind;
  BoundaryLaw law;
  const WaterBoundary<D>* named = face.boundary < 0 ? nullptr : &conditions.boundaries[face.boundary];
  const Kind kind = named ? named->kind : Kind::surface;
  switch (kind) {
    case Kind::impermeable:
      break;
    case Kind::pressure:
      law.kind = BoundaryLaw::Kind::pressure;
      law.upper = face.pressure;
      break;
    case Kind::flux:
      law.kind = BoundaryLaw::Kind::flow;
      law.inflow = named->value * face.area;
      break;
    case Kind::head:
      if (face.open) {
        law.kind = BoundaryLaw::Kind::pressure;
        law.upper = face.pressure;
      } else if (named->seepage_above) {
        law.kind = BoundaryLaw::Kind::complementary;
      }
      break;
    case Kind::surface:
    case Kind::atmosphere:
      law.kind = face.pressure > 0 ? BoundaryLaw::Kind::pressure : BoundaryLaw::Kind::complementary;
      law.upper = face.pressure;
      if (kind == Kind::surface || face.pressure > 0) break;
      law.upper = conditions.unit_weight * named->ponding_depth;
      law.lower = named->limiting_pressure;
      if (face.axis == D - 1 && face.outward > 0) law.inflow = named->value * face.area;
  }
  return law;
}

// The law of an upright face on which a water level or a seepage face may end, resolved over the face's
// height; others stay as they are. height: of the centre of its cell.
template <int D>
void split_law(const BoundaryFace<D>& face, const WaterConditions<D>& conditions, double height,
               double spacing, BoundaryLaw& law) {
  using Kind = typename WaterBoundary<D>::Kind;
  if (face.axis == D - 1) return;
  const WaterBoundary<D>* named = face.boundary < 0 ? nullptr : &conditions.boundaries[face.boundary];
  const Kind kind = named ? named->kind : Kind::surface;
  if (kind != Kind::head && kind != Kind::surface) return;
  const double level = kind == Kind::head ? named->value : conditions.outside_level;
  const double spread = 0.5 * conditions.unit_weight * spacing;
  const double pressure = std::max(conditions.unit_weight * (level - height), -spread);
  const bool seeps = kind == Kind::surface || named->seepage_above;
  if (pressure >= spread || (pressure == -spread && !seeps)) return;
  law.kind = BoundaryLaw::Kind::split;
  law.spread = spread, law.level = pressure, law.seeps = seeps;
}

}  // namespace polder::fdm
