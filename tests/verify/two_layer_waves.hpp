// Waves in saturated columns on a rigid, closed base, drained at their top: harmonic loading (Zienkiewicz,
// Chang & Bettess 1980) and the first and second compression wave under a load that rises within 0.2 ms. SI
// units.
#pragma once

#include <complex>
#include <string>
#include <vector>

#include "tests/verify/one_layer_scenes.hpp"

namespace polder::verify {

// Largest stable step of a plane wave in water of finite stiffness and the skeleton, pressure explicit, drag
// implicit, in the order of the choice (docs/theory/two-layer.md), GIMP with two points a cell along each
// axis [s].
double analysed_mixture_limit(const Choice& choice, double porosity, double density_solid);

// What a formulation keeps: all inertia (u-w), not that of water relative to the skeleton (u-p), none
// (consolidation). darcy: u-p that also leaves the skeleton's acceleration out of Darcy's law.
enum class ColumnEquations { uw, up, darcy, consolidation };

// Dimensionless groups of the column: Pi1 = k V_c^2 / (g beta omega L^2), Pi2 = (omega L / V_c)^2 with
// V_c^2 = (D + K_w / n) / rho, kappa = (K_w / n) / (D + K_w / n), beta = rho_w / rho.
struct HarmonicGroups {
  double pi1 = 0, pi2 = 0, kappa = 0.973, beta = 0.333, porosity = 0.333;
};

// Complex amplitude of the pressure over that of the load at a depth over L.
std::complex<double> harmonic_pressure(ColumnEquations equations, const HarmonicGroups& groups, double depth);

// Largest difference over the depth of two columns of equations, over the largest amplitude of the second.
double harmonic_difference(ColumnEquations a, ColumnEquations b, const HarmonicGroups& groups);

struct Harmonic {
  std::vector<double> depth;                    // of the cells over L
  std::vector<std::complex<double>> amplitude;  // of their pressure over the load's, in the last period
  double change = 0;  // of the amplitudes from the last period but one, over the largest [-]
  long steps = 0;
  // Largest distance to the exact amplitudes over the largest of these [-].
  double error(ColumnEquations equations, const HarmonicGroups& groups) const;
};
// `steps` of a period, `periods` of them; the load grows to its amplitude in the first two.
Harmonic harmonic_column(const Choice& choice, const HarmonicGroups& groups, int steps, int periods);

// Effective stress, grain and water velocity and pressure at heights of 0.25, 0.5 and 0.75 m in 1 m of stiff,
// permeable soil: tests/reference/biot_column_permeable[_up]_smooth_*.csv.
struct TwoWaves {
  // L2 over time of the difference to the reference over the L2 of that: pressure, effective stress, velocity
  // of grains, of water [-].
  double pressure = 0, stress = 0, grains = 0, water = 0;
  double speed = 0, amplitude = 0;  // of the second wave over the reference's [-]
  long steps = 0;
  double seconds = 0;  // processor time of the steps [s]
};
// Compared with the equations of the given form: uw or up.
TwoWaves two_waves(const Choice& choice, ColumnEquations equations);

}  // namespace polder::verify
