// Scenes of the two-layer formulation that are about drag: beds of soil with water pushed through them. Used
// by the tests and by the program that prints the tables of docs/validation/two_layer.md. SI units.
#pragma once

#include "tests/verify/one_layer_scenes.hpp"

namespace polder::verify {

// Water pushed upwards through a bed 1 m high that fills its box, no gravity, until the flow is steady.
struct Permeameter {
  double discharge = 0;   // specific, through the outlet [m/s]
  double exact = 0;       // at which the material's drag law loses the pressure applied [m/s]
  double difference = 0;  // of inlet and outlet, over the discharge [-]
  double reynolds = 0;    // rho q d / mu; with Darcy's and Forchheimer's laws 0
  long steps = 0;
};
// material: porosity, drag law and what it needs. gradient: hydraulic, applied.
Permeameter permeameter(const Choice& choice, const coupling::Material& material, double gradient);

// A block of soil and its water that float without weight or pressure, 0.5 m/s between them at the start.
struct Slowing {
  double momentum_error = 0;  // largest change of the sum of both over that of the water at the start [-]
  double decay_error = 0;     // largest, of the relative velocity, against the implicit step with the drag of
                              // the velocity before it, over the velocity at the start [-]
  double relative = 0;        // left at the end, over that at the start [-]
};
Slowing slowing(const Choice& choice, const coupling::Material& material, int steps);

}  // namespace polder::verify
