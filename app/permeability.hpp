// Hydraulic conductivity k [m/s] and intrinsic permeability kappa [m2]: k = kappa rho_w g / mu.
// g is the standard 9.81 m/s2 whatever the scene's gravity, as in a laboratory's conductivity.
#pragma once

#include "coupling/scene.hpp"

namespace polder::app {

inline constexpr double kStandardGravity = 9.81;  // [m/s2]

inline double conductivity_of(double permeability, const coupling::WaterSpec& water) {
  return permeability * water.density * kStandardGravity / water.viscosity;
}

inline double permeability_of(double conductivity, const coupling::WaterSpec& water) {
  return conductivity * water.viscosity / (water.density * kStandardGravity);
}

}  // namespace polder::app
