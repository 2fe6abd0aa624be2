// Viscous flow between two plates 1 m apart, with exact solutions. Used by the tests and by the program that
// prints the tables of docs/validation/water_physics.md. SI units.
#pragma once

#include "tests/verify/one_layer_scenes.hpp"

namespace polder::verify {

// A model fluid of 1000 kg/m3 in a channel 4 cells long, open to a pressure at either end, which
// starts at rest. As it is here it moves through a hundredth of a cell until nu t / L^2 = 1.
struct PlateFlow {
  enum class Drive { pressure, upper_plate } drive = Drive::pressure;
  double duration = 1;
  bool slips = false;  // plates do not hold the fluid
  bool affine = false;
  double flip = 1;
  double time_step = 2e-3;
  double viscosity = 1000;  // [Pa s]
  double speed = 1e-3;      // in the middle in the end, or of the plate [m/s]
};
struct PlateProfile {
  // L2 of the error of the points' velocities along the plates over that of the exact ones, and largest error
  // over the largest exact one [-].
  double error = 0, largest = 0;
  double across = 0;     // largest velocity across the plates over the largest exact one [-]
  double discharge = 0;  // over the exact [-]
  double speed = 0;      // mean of the points along the plates [m/s]
  double water_error = 0;
  long steps = 0;
};
PlateProfile plate_flow(const Choice& choice, const PlateFlow& flow);

}  // namespace polder::verify
