// Relaxation to equilibrium: the soil moves in pseudo time, with masses that only make it converge fast,
// until the forces balance. The pore pressure stays as it is, walls stand still, no time passes.
//
// A step, on the displacements u of one step in place of velocities:
//   F_i  = f_i(stress) + loads + m_i g + pore pressure                          out-of-balance force [N]
//   u_i <- ((2 - c) u_i + 2 F_i / M_i) / (2 + c)                                under the boundaries
//   strain, stress and position of the points from u
// The masses M_i [N/m] bound the elastic stiffness (Gershgorin), so that every material and every cut cell
// follows at its own best speed (fictitious masses: Otter, Cassell & Hobbs 1966; Underwood 1983). Motion
// lives on the nodes alone: no transfer between points and nodes damps or disturbs it. The damping c is
// critical for the mode that moves at present, whose frequency the motion itself tells: w^2 = -u.dF / u.Mu
// (Rayleigh's quotient; Underwood 1983).
//
// The out-of-balance force of the first moment is let loose over some steps, the more the larger it is, which
// keeps the stress from overshooting into yield.
//
// Whether an equilibrium exists shows in the displacement r, the root mean square over the mass, and in the
// force ratio. Below the limit both die out; beyond it a force is left over that nothing balances, and the
// soil goes on or gets faster. The motion counts as running away when in the second half of all steps r has
// grown more than 2.5 times as much as in the quarter before while the least force ratio of that half is
// above 0.85 of the quarter's; or more than half as much while the force ratio has fallen by less
// than a tenth. Both only after steps enough for the slowest elastic mode, the latter after twice as many.
#pragma once

#include <vector>

#include "coupling/audit.hpp"
#include "coupling/two_layer.hpp"

namespace polder::coupling {

class StateVisitor;

struct RelaxationOptions {
  double force_tolerance = 1e-3;   // out-of-balance force over load, norms over the nodes
  double energy_tolerance = 1e-3;  // kinetic energy of pseudo time over elastic energy
  long most_steps = 20000;
  double ramp = 60;          // steps over which a large out-of-balance force is let loose at the start
  bool stop_runaway = true;  // end where no equilibrium exists
};

struct RelaxationReport {
  bool converged = false;
  bool runs_away = false;  // no equilibrium: the displacement goes on growing
  long steps = 0;
  double force_ratio = 0;
  double energy_ratio = 0;
  double displacement = 0;          // root mean square over the mass, since the relaxation began [m]
  double largest_displacement = 0;  // of a point [m]
  double plastic_strain = 0;        // largest new plastic deviatoric strain of a point [-]
};

template <int D>
class Relaxation {
 public:
  // Brings the points to rest.
  Relaxation(World<D>& world, const RelaxationOptions& options);

  // One step under the loads of this time [s] and this share of gravity; while that is below 1 it grows, and
  // there is no end. Returns false, without a step, when nothing is left to do.
  bool step(double time, double gravity = 1);
  const RelaxationReport& report() const { return report_; }

  // All that decides the next step, besides the world.
  void visit(StateVisitor& visitor);

 private:
  void find_masses();
  void show_masses();  // to the boundaries
  void find_forces(double gravity);
  double damping() const;  // c
  void push(double damping);
  void look(double time, bool may_end);
  void measure_displacement();
  bool runs_away() const;
  template <class F>
  void each_node(const F& f) const;

  World<D>& world_;
  HeldWater<D> held_;
  RelaxationOptions options_;
  Audit<D> audit_;
  Reals mass_;                // M [slots]
  Reals displacement_;        // of the last step [slots * 4]
  Reals force_, last_;        // F now and one step before [slots * 4]
  Reals first_;               // F at the first step [slots * 4]
  Reals trial_;               // work space [slots * 4]
  Reals sums_;                // work space, M as the boundaries expect masses [slots * 8]
  std::vector<Reals> start_;  // of each body, by id: position and plastic strain at the start
  Reals past_, past_ratio_;   // displacement and force ratio at every look
  double moved_ = 0;          // since masses and water cells were last found [cells]
  double ramp_ = 0;           // steps
  double load_ = 0;           // norm of the loads [N]
  double motion_ = 0;         // u.Mu [J]
  double stiffness_ = 0;      // -u.dF [J]
  RelaxationReport report_;
};

// All steps at one moment.
template <int D>
RelaxationReport relax(World<D>& world, const RelaxationOptions& options, double time);

}  // namespace polder::coupling
