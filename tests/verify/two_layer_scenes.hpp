// Scenes of the two-layer formulation with known answers: rest, seepage into free water, exchange of
// momentum, free water. Used by the tests and by the program that prints the tables of
// docs/validation/two_layer.md; the scenes that both formulations share are in one_layer_consolidation.hpp
// and one_layer_rest.hpp. SI units.
#pragma once

#include <utility>
#include <vector>

#include "tests/verify/one_layer_scenes.hpp"

namespace polder::verify {

// Errors of a state of rest against hydrostatic pressure below the level at the start.
struct WaterRest {
  double pressure_error = 0;    // RMS over gamma_w H [-]
  double pressure_largest = 0;  // largest [-]
  double speed = 0;             // largest of all points [m/s]
  double drift = 0;             // largest excess of volume of a cell that no surface is near [-]
};
// Saturated soil 1 m high, points displaced at random by up to `jitter` times half their spacing.
WaterRest jittered_column(const Choice& choice, double jitter, double duration);
// 0.4 m of free water over 1 m of soil.
WaterRest pond_over_soil(const Choice& choice, double jitter, double duration);

// A pond that drains through 1 m of soil to a base without pressure: head falls as H0 exp(-k t / L).
struct FallingHead {
  double outflow_error = 0;  // of the water that has left in the last 70 % of the time, over the exact [-]
  double pressure_error = 0, pressure_largest = 0;  // over gamma_w H0, at the end [-]
  double water_error = 0;                           // of the water's mass [-]
  // Excess of volume of grains and water over that of a cell, away from the surface and the base: RMS and
  // largest beside the soil's surface, largest elsewhere [-].
  double drift_rms = 0, drift_interface = 0, drift_elsewhere = 0;
  long steps = 0;
};
FallingHead falling_head(const Choice& choice, double jitter, double duration);

// Water driven through a confined layer that friction holds on its base: the head falls evenly along it.
struct LevelSeepage {
  double outflow_error = 0;   // over what Darcy's law lets through [-]
  double pressure_error = 0;  // largest, over the head that drives it [-]
};
LevelSeepage level_seepage(const Choice& choice, double duration);

// Block of soil and water that float without weight, the water so soft that it knows no pressure: drag alone
// passes momentum between them.
struct Exchange {
  double momentum_error = 0;  // largest change of the sum of both over that of the water at the start [-]
  double decay_error =
      0;  // of the relative velocity after `steps` implicit steps, against 1/(1 + r dt)^n [-]
  double explicit_ratio = 0;  // step over 2 / r, the limit of explicit drag [-]
  double relative = 0;        // relative velocity left over the one at the start [-]
};
// Gives all points of the water the velocity `speed` along x [m/s]; mean velocity of the water relative to
// the grains along x, each the mean over its points.
void give_water_speed(Simulation& simulation, double speed);
double relative_speed(const Simulation& simulation);
// The water starts with `speed`, the soil at rest.
Exchange exchange_of_momentum(const Choice& choice, double speed, int steps);
// Rate r at which drag takes relative velocity away in soil of porosity 0.4 [1/s].
double drag_rate(double conductivity);

// ---- free water

struct DamBreak {
  std::vector<double> time;           // [s]
  std::vector<double> front, height;  // of the water: farthest point of its body; depth at the wall [m]
  std::vector<std::pair<double, double>> profile;  // x from the dam, depth at the end [m]
  double water_error = 0;
  double largest_speed = 0;  // over the time [m/s]
  double seconds = 0;
  long steps = 0;
};
// Column of water, `width` x `height`, let go at the left wall of a basin of length `length`; looked at every
// `every` seconds.
DamBreak dam_break(const Choice& choice, double width, double height, double length, double duration,
                   double every);

struct Sloshing {
  double period = 0, exact = 0;  // [s]
  double amplitude = 0;          // of the last half swing over that of the first [-]
  int half_swings = 0;
  long steps = 0;
};
// First mode of a basin 1 m x 0.5 m, 6 s. `exact` is that of small waves, 2 pi / sqrt(g k tanh(k H)).
Sloshing sloshing(const Choice& choice, double amplitude, double duration);

// ---- a scene with everything

// Soft wet soil with jitter between a higher level outside on the left and a lower one on the right, through
// open sides; slumps on the way.
Scene open_sides_scene(const Choice& choice, double duration);

// Two-layer over one-layer, wall time of a step on the slump; `pairs` runs of each by turns, the smallest
// counts.
struct Cost {
  double one_layer = 0, two_layer = 0;              // of a step [s]
  double one_layer_water = 0, two_layer_water = 0;  // of that, pressure [s]
  long particles_one = 0, particles_two = 0;
};
Cost cost_of_a_step(const Choice& choice, int pairs, double duration);

}  // namespace polder::verify
