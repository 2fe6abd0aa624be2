// Factor of safety by strength reduction (Zienkiewicz, Humpheson & Lewis 1975; Griffiths & Lane 1999): the
// factor by which all strength must be divided for the soil to lose its equilibrium.
//
//   c / F, tan(phi) / F, capillary cohesion / F, tension cut-off / F, undrained strength / F, wall friction /
//   F, dilation angle as it is, but not above the reduced friction angle.
//
// Each trial starts from the same state, with the pore pressure of that moment, and relaxes
// (coupling/relaxation.hpp). The soil stands if it finds its equilibrium; it fails if the displacement runs
// away, or if the forces do not balance within the steps allowed.
//
// For the trials all moduli are multiplied by kStiffening. Where a mechanism forms depends on ratios of
// stiffness only, but displacements and plastic strains fall by that factor: trials neither change the
// slope's shape, which would let a creeping slope come to rest on a flatter one, nor soften the soil, so that
// the factor is that of the shape and the strength at the chosen moment.
#pragma once

#include <functional>
#include <vector>

#include "coupling/relaxation.hpp"
#include "coupling/simulation.hpp"

namespace polder::coupling {

inline constexpr double kStiffening = 1e4;

// The material with its strength divided by the factor. The peak undrained strength of points, which is part
// of their state, is not in it.
mpm::MaterialParameters with_reduced_strength(const mpm::MaterialParameters& material, double factor);

struct StabilityOptions {
  double tolerance = 0.005;        // width of the bracket over its lower end
  double first = 1;                // factor tried first
  double least = 0.05, most = 20;  // factors looked at
  double force_tolerance = 1e-3;   // of the relaxations
};

struct StabilityTrial {
  double factor = 0;
  bool stands = false;
  bool runs_away = false;
  long steps = 0;
  double force_ratio = 0;
  // With the soil's own stiffness, root mean square over the mass and of the point that moves most [m].
  double displacement = 0, largest_displacement = 0;
};

struct StabilityResult {
  // Largest factor found to stand and smallest found to fail; 0 and infinity where no trial did.
  double stands = 0, fails = 0;
  double factor() const { return 0.5 * (stands + fails); }
  std::vector<StabilityTrial> trials;  // in the order they were made
};

// Relaxation of the present state with its strength divided by the factor; it leaves the world as the trial
// does, but for the materials.
template <int D>
StabilityTrial try_reduced_strength(World<D>& world, double factor, const StabilityOptions& options,
                                    double time);

// Bracket and bisection from the present state, to which the simulation returns. `look` is called after each
// trial, with the simulation in the state that the trial has left; returning false ends the search.
StabilityResult find_factor_of_safety(Simulation& simulation, const StabilityOptions& options,
                                      const std::function<bool(const StabilityTrial&)>& look);

}  // namespace polder::coupling
