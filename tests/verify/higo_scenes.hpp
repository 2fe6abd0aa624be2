// Cases of the explicit pore pressure (formulation higo), used by its tests and by the program that prints
// the tables of docs/validation/higo.md. SI units.
#pragma once

#include <vector>

#include "tests/verify/one_layer_scenes.hpp"

namespace polder::verify {

// First step at which a saturated block on a uniform grid becomes unstable, by the analysis of
// docs/theory/higo.md: the worst of all plane waves with GIMP and two points in a cell along each axis.
double analysed_limit(const Choice& choice, double porosity, double density);

// Infiltration into a column of unsaturated soil of 1 m, van Genuchten's with alpha = 2/m, n = 2, residual
// saturation 0.1, suction head 1 m, rain of 5e-4 m/s on k = 1e-3 m/s for a time [s]; the skeleton moves
// (E = 1 MPa).
struct Rain {
  double saturation[3] = {};  // at 0.1, 0.3 and 0.5 m below the initial surface [-]
  double settlement = 0;      // since the rain began, heave negative [m]
  double water_error = 0;     // of the water's mass
  double largest_speed = 0;   // of a point at the end [m/s]
  long steps = 0;
  double seconds = 0;
};
Scene rain_scene(const Choice& choice, double duration);
Rain rain(const Choice& choice, double duration = 100);

// Highest point and run-out of the undrained slump at the times [s].
struct Slumped {
  std::vector<double> height, runout;
  long steps = 0;
  double seconds = 0;
};
Slumped slump_in_time(const Choice& choice, const std::vector<double>& times);

}  // namespace polder::verify
