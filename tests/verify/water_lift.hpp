// Grains that water carries: a column lifted by upward flow, a suspension that settles. Two-layer scenes with
// known answers, used by the tests and by the program that prints the tables of
// docs/validation/water_physics.md. SI units.
#pragma once

#include <vector>

#include "tests/verify/one_layer_scenes.hpp"

namespace polder::verify {

// 1 m of cohesionless sand under a pressure on its base that rises to `most` times the critical gradient
// (1 - n)(rho_s / rho_w - 1), stays, and falls to hydrostatic.
struct Lifting {
  double critical = 0;       // gradient in the soil at which the mean vertical effective stress has fallen to
                             // 5 % of that at rest, over 0.95 of the critical one [-]
  double fluidised = 0;      // largest share of the grains without contact [-]
  double height = 0;         // largest, of the soil [m]
  double settled_share = 0;  // of the grains without contact at the end [-]
  double settled_height = 0;       // of the soil at the end [m]
  double settled_stress = 0;       // mean vertical effective stress at the end over that at rest [-]
  double settled_compression = 0;  // the same by itself, compression positive [Pa]
  double solid_error = 0;          // of the mass of grains, relative
  double water_error = 0;          // of the water, relative
  long steps = 0;
};
Lifting lifting(const Choice& choice, const coupling::Material& soil, double most);

// A box full of grains dispersed in water, which sink from t = 0 on.
struct Settling {
  double velocity = 0;         // of the surface of the suspension [m/s]
  double exact = 0;            // n u of the drag law under the weight of the grains [m/s]
  double richardson_zaki = 0;  // terminal velocity of a grain times n^N (1954), for comparison [m/s]
  // At the end: mean sinking speed [m/s] and porosity between 0.5 and 0.8 of the height of the suspension,
  // mean porosity of what lies on the base.
  double grains = 0, porosity = 0, sediment = 0;
  long steps = 0;
};
Settling settling(const Choice& choice, const coupling::Material& soil, double height);

// Sand, cohesionless, that can be fluidised.
coupling::Material loose_sand(double porosity, double grain_diameter, double fluidisation_porosity);

}  // namespace polder::verify
