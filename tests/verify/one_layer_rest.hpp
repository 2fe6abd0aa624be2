// States of rest, steady flow, undrained loading and slump: small scenes of the one-layer formulation. SI
// units.
#pragma once

#include "tests/verify/one_layer_scenes.hpp"

namespace polder::verify {

struct Rest {
  double pressure_error = 0;  // RMS over gamma_w H [-]
  // RMS of the vertical effective stress: of the points, over the buoyant weight gamma' H; and of the means
  // of the points in each cell, over its largest value now (which upward flow makes smaller) [-]
  double point_stress_error = 0, cell_stress_error = 0;
  double speed = 0;  // largest of the points at the end [m/s]
  double motion =
      0;  // of the point that moved furthest in the last tenth of a second: distance over time [m/s]
};
// Column 10 cells high plus the offset, switched on in equilibrium, then left alone.
Rest hydrostatic(const Choice& choice, double duration);
// Upward flow at `share` of the critical gradient, brought to steady state.
Rest upward_seepage(const Choice& choice, double share);

struct Strip {
  double roughness = 0;       // RMS of the (pi, pi) part of the pressure over the load [-]
  double middle = 0;          // pressure at mid-depth below the load over the load [-]
  double largest_speed = 0;   // at the end [m/s]
  double pressure_cells = 0;  // active at the end
};
// Strip load on a block 2 m x 1 m; returns after `duration` s.
Scene strip_scene(const Choice& choice, double duration, double jitter = 0);
Strip strip_load(const Choice& choice, double duration, double jitter = 0);

// Amplitude of a checkerboard of pressure, 1 Pa at the start, after `steps` steps.
double checkerboard_left(const Choice& choice, int steps);

struct Slump {
  double height = 0;                // of the highest point [m]
  double runout = 0;                // [m]
  double volume = 0;                // over the initial volume [-]
  double energy = 0, released = 0;  // kinetic and elastic at the end; work of gravity [J]
  double roughness = 0;             // of the pressure, over gamma_w times 1 m [-]
  double largest_speed = 0;         // over the whole run [m/s]
  double water_error = 0;           // of the water's mass [-]
  long steps = 0;
};
Scene slump_scene(const Choice& choice, double duration, double poisson = 0.3);
Slump slump(const Choice& choice, double duration, double poisson = 0.3);

}  // namespace polder::verify
