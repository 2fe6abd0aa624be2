// Balances of a run: mass, momentum and energy, and the norms that say when it is at rest.
//
// Work is summed over the nodes step by step with the mean of old and new nodal velocity, so that a step's
// change of the nodes' kinetic energy is exactly the sum of its parts; what the transfers between particles
// and grid lose is the rest.
#pragma once

#include "coupling/world.hpp"

namespace polder::coupling {

struct Work {         // cumulative [J]
  double stress = 0;  // of the effective stress and the surface loads on the motion
  double gravity = 0;
  double water = 0;  // of the pore pressure gradient; in two layers also of drag and of the water's walls
  double damping = 0;
  double boundary = 0;  // of the boundaries' reactions
};

struct Totals {
  double solid_mass = 0;      // [kg]
  double water_volume = 0;    // in the pores, of saturated soil where air is not modelled; of its points [m3]
  double kinetic_energy = 0;  // [J]
  double elastic_energy = 0;  // of the effective stress [J]
  std::array<double, 3> momentum{};
  double largest_speed = 0;
  double runout = 0;                          // largest x of any point's domain [m]
  double height = 0;                          // largest height of any point's domain [m]
  double water_runout = 0, water_height = 0;  // the same of the water's own points
};

template <int D>
class Audit {
 public:
  explicit Audit(const World<D>& world);

  // After the step's last constrain and before gather would be too early for particles, so call it after the
  // step: uses the nodal velocities of the step just made.
  void add_step(const World<D>& world, double dt, double damping, double gravity);
  void add_impulse(const Point<D>& impulse);  // that points have received elsewhere than at the nodes
  Totals totals(const World<D>& world) const;

  const Work& work() const { return work_; }
  double impulse_error(
      const Totals& totals) const;  // |P - P0 - sum of impulses| over the sum of their magnitudes
  double energy_loss(
      const Totals& totals) const;  // lost in transfers: work done minus kinetic energy gained [J]

  // Velocities were set from outside (end of a stage): momentum and energy are counted from the present state
  // on.
  void rebase(const World<D>& world);

  // Everything that a checkpoint must keep.
  std::vector<double*> state();

 private:
  Work work_;
  double initial_kinetic_ = 0;
  std::array<double, 3> initial_momentum_{}, impulse_{};
  double impulse_magnitude_ = 0;
};

// Root mean square of the (pi, pi) part of the pressure over cells whose 3 x 3 neighbours are active [Pa]:
// what is left of a checkerboard (2D; 3D takes the planes through the vertical axis).
template <int D>
double pressure_roughness(const PoreWater<D>& water);

}  // namespace polder::coupling
