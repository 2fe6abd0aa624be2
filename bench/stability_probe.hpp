// One point of the maps of `polder bench stability`: a small block of saturated soil under one scheme, and
// what becomes of it with a given step.
//
// Two runs of the same block, 8 cells wide and 6 1/2 high between walls, its surface within a cell:
//  * without weight, random velocities of 1e-10 of the wave speed: positions stay what they are, the response
//  is
//    linear, and growth of the energy shows the instability of the scheme and nothing else;
//  * with weight, in equilibrium at the start, half of its surface suddenly loaded: what breaks down, how
//  rough
//    the pressure is from cell to cell, and whether water or energy comes from nowhere.
// SI units.
#pragma once

#include <string>

#include "coupling/scene.hpp"

namespace polder::bench {

struct Specimen {
  std::string formulation = "one-layer";
  coupling::PressureMethod pressure = coupling::PressureMethod::projected;  // of water with its own points
  coupling::DragStep drag = coupling::DragStep::implicit;
  mpm::ShapeKind shape = mpm::ShapeKind::gimp;
  bool musl = true;
  double flip = 0.99;  // of soil and water
  double conductivity = 1e-4;
  double bulk_modulus = 2.2e9;
  double porosity = 0.4;
  double density_ratio = 2.65;  // grains over water
  double saturation = 1;        // below 1: with a retention curve, at the suction that belongs to it
  int per_axis = 2;
  bool random = false;  // points moved by up to 0.4 of their spacing
  double friction = 0;  // above 0: Mohr-Coulomb without cohesion under a load that it cannot carry [rad]
  double dilation = 0;  // [rad]

  bool has_points_of_water() const { return formulation == "two-layer" || formulation == "two-layer-darcy"; }
  bool is_explicit() const;  // the pressure
  double dry_density() const { return (1 - porosity) * density_ratio * kWater; }
  double density() const { return dry_density() + porosity * saturation * kWater; }

  static constexpr double kWater = 1000, kYoung = 1e7, kPoisson = 0.2, kCell = 0.1, kLoad = 5e3,
                          kFailingLoad = 2e4;
};

// What the program takes by itself, with its default `courant` [s].
double chosen_step(const Specimen& specimen);
// What `polder explain` prints: found by experiment on a patch [s].
double printed_limit(const Specimen& specimen);
// Of a plane wave on a uniform grid, by the formulas of docs/theory [s]; with points and their shape
// functions in it where the pressure is explicit.
double theoretical_limit(const Specimen& specimen);

enum class Mark { stable, drift, noise, grows, broke_down };
const char* to_string(Mark mark);

struct Verdict {
  double growth = 0;        // of the energy of random velocities from the first third to the end
  bool broke_down = false;  // of the loaded block
  double noise = 0;         // roughness of the pressure over the load, largest of the second half
  double water = 0;         // error of the mass of water, relative
  double gain = 0;          // energy from nowhere over what the load stores in the skeleton
  std::string reason;       // why it broke down

  static constexpr double kGrowth = 1e3, kNoise = 0.05, kWaterDrift = 1e-3, kGain = 0.1;
  Mark mark() const;
};

Verdict probe(const Specimen& specimen, double step);

}  // namespace polder::bench
