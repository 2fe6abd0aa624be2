// The water's part of a step where the pore pressure follows explicitly from the bulk modulus of the water
// (formulation higo: Higo et al. 2010, 2015) instead of from a projection: the same cells, faces and
// boundaries, no linear system and no correction of the velocities, and a step that the water limits.
#pragma once

#include "coupling/world.hpp"

namespace polder::coupling {

// Pressure at the end of the step from the velocities that strain the soil in it, and the limit of the next
// step. w.mobility and w.node_gradient belong to the step.
template <int D>
void advance_water(World<D>& world, double dt, const Reals& strain_velocity);

// The same where water has points of its own: pressure from the flow of the mixture, WaterLayer::divergence,
// whose velocities are final. With M the masses and B the drag of grains and water the wave in the mixture is
// stable while
//   (dt/h)^2 (K_w / n) m^T [M + (dt/2) C]^-1 m < 1,  m = (1 - n, n),  C = B {{1, -1}, {-1, 1}},
// drag being implicit. The mobility of the faces over the step is dt m^T [M + dt C]^-1 m: taken as it is it
// gives the limit where the step is half of it, and less where the step is shorter.
template <int D>
void advance_mixture(World<D>& world, double dt);

// Longest stable step of the water [s]: that of the last step, or found now, at this time [s], where the last
// step was none of advance_water's.
template <int D>
const fdm::ExplicitLimit& explicit_limit(World<D>& world, double time);

// The blend of FLIP and PIC for a step of this length. PIC damps in every step; the share that the scene
// gives is that of a step of `skeleton_step`, the one that the skeleton would take by itself, and is spread
// over the many that water makes of it. So motion is damped in time as it is with a projected pressure.
template <int D>
void blend_for_step(World<D>& world, double dt, double skeleton_step);

// What limits a step of motion.
struct MotionLimit {
  double dt = 0;       // [s]
  const char* reason;  // of the two waves, or Darcy flow
};
// Of water and skeleton together; wave_speed: of the skeleton [m/s]. In a mode of the grid the stiffnesses of
// skeleton and water add up, and with them the squares of the frequencies.
MotionLimit combined_limit(const fdm::ExplicitLimit& water, double cell, double wave_speed);

}  // namespace polder::coupling
