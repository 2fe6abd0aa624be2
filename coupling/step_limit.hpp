// The largest stable time step of a scene, found by letting the scene's own scheme decide.
//
// Closed formulas exist for the one-dimensional scheme on a uniform grid (docs/theory/time-step.md). The
// limit of the material point method depends on more: the mapping of stress (MUSL, USL), the shape functions,
// where the particles sit in their cells and where the soil's surface cuts them. So each soil of the scene is
// built once as a small patch with two walls and two free surfaces, with the scene's cell, shape, order,
// transfer, particles, conductivity and water; its points get tiny random velocities, so that positions stay
// what they are and the response is linear, and the growth of the energy over some hundred steps shows
// whether a step is stable. The limit is bracketed by bisection; a step longer than stable by 2 % multiplies
// the energy by many orders of magnitude, so the bracket is sharp.
#pragma once

#include "coupling/scene.hpp"

namespace polder::coupling {

struct StabilityLimit {
  double dt = 0;              // largest stable step [s]
  std::string material;       // that sets it
  bool with_water = false;    // in saturated soil, or in dry soil or soil above the phreatic line
  std::string mechanism;      // which wave, or Darcy flow
  double courant_number = 0;  // dt times the speed of the drained compression wave over the cell [-]
};

// Of the soils at rest at the start. Takes some tenths of a second at most.
StabilityLimit find_stability_limit(const Scene& scene);

}  // namespace polder::coupling
