// Drag of water on grains, as a function of porosity and relative velocity.
//
// In a mixture of porosity n whose water moves by u relative to its grains, grains feel the force beta u per
// volume, water its opposite, besides the pressure gradient that each phase takes its volume's share of
// ("model A" of Gidaspow 1994, chapter 2). A bed at rest then has the gradient |grad p| = beta u / n beyond
// hydrostatic pressure, and with q = n u the specific discharge, mu, rho and gamma the water's viscosity,
// density and unit weight, d the diameter of the grains:
//
//   darcy        beta = n^2 gamma / k
//   forchheimer  beta = n^2 gamma (1 / k + b q), from i = q / k + b q^2 (Forchheimer 1901)
//   ergun        beta = 150 mu (1-n)^2 / (n d^2) + 1.75 rho (1-n) u / d (Ergun 1952)
//   gidaspow     ergun's for n < 0.8, beyond that Wen & Yu's (1966; Gidaspow 1994, eq. 2.11 f.):
//                beta = 3/4 C n (1-n) rho u / d n^-2.65, C = 24 (1 + 0.15 Re^0.687) / Re below Re = 1000,
//                then 0.44, Re = rho n u d / mu
//   di_felice    beta = 3/4 C (1-n) n^(2-x) rho u / d, C = (0.63 + 4.8 / sqrt Re)^2,
//                x = 3.7 - 0.65 exp(-(1.5 - log10 Re)^2 / 2) (Di Felice 1994)
//
// The last three know grains in a fluid, not soil: they go over into the drag of single grains as n goes to 1
// and vanish with them. SI units.
#pragma once

#include "coupling/scene.hpp"

namespace polder::coupling {

struct DragFluid {
  double density, viscosity, unit_weight;  // [kg/m3], [Pa s], [N/m3]
};

// beta [Pa s/m2] at a porosity and a relative velocity [m/s]. Darcy's conductivity is the material's,
// whatever the porosity.
double drag_coefficient(const Material& material, const DragFluid& fluid, double porosity, double speed);

// Conductivity q / i of soil with that drag [m/s]: Darcy's k is it at any velocity.
double apparent_conductivity(const Material& material, const DragFluid& fluid, double porosity, double speed);

}  // namespace polder::coupling
