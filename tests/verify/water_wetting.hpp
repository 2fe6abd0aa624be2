// Two layers: water that enters soil whose pores hold some already, and leaves it again. SI units.
#pragma once

#include "tests/verify/one_layer_scenes.hpp"

namespace polder::verify {

// Water rises from the base, where a head of 1.5 m stands, through soil that retains a share S of its pores
// full; below 0.25 m it is saturated at the start. Without suction (Green & Ampt 1911) the front is at z with
//   k t / (n (1 - S)) = H ln((H - z0) / (H - z)) - (z - z0).
struct Wetting {
  double front_error = 0;   // largest [cells]
  double inflow_error = 0;  // of the water that has entered, at the end [-]
  double water_error = 0;   // of the mass of all water [-]
  // Error of the vertical effective stress at 0.55 m, before and after the front has passed, over the weight
  // above: of grains, water that they retain and, after, water that has come [-].
  double stress_before = 0, stress_after = 0;
  double front = 0;  // at the end [m]
};
Wetting rising_front(const Choice& choice, double retained);
Scene rising_front_scene(const Choice& choice, double retained, double duration);

// The same up to 0.85 m; then the base is free of pressure and the level falls by k t / (n (1 - S)), while
// what the soil retained at the start stays.
struct Draining {
  double level_error = 0;  // largest [cells]
  double water_error = 0;  // of the mass of all water [-]
};
Draining falling_front(const Choice& choice, double retained);

}  // namespace polder::verify
