// The soil skeleton (and any other deformable body): material points on the background grid with explicit
// dynamics.
//
// A step in the order in which a formulation calls it; what pore water adds goes in between:
//
//   sort()          blocks and particle order, only when a point may have left its block's skin
//   scatter()       mass, momentum, force and volume of the particles at the nodes; v_old
//   predict()       v_trial = v_old + dt (f / m + g + extra), local damping
//   constrain()     v = v_trial under the mechanical boundaries
//   gather()        particle velocities, second mapping (MUSL), strain, stress, motion
//
// Stress is updated last from re-mapped momenta (MUSL: Sulsky, Zhou & Schreyer 1995) or from the updated grid
// velocities (USL). Velocities are blended FLIP/PIC or carried affinely (APIC: Jiang et al. 2015; TPIC:
// velocity gradient).
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "mpm/boundary_set.hpp"
#include "mpm/sleep.hpp"
#include "mpm/surface_load.hpp"
#include "mpm/transfer.hpp"

namespace polder::mpm {

struct SkeletonOptions {
  Space space = Space::plane_strain;
  ShapeKind shape = ShapeKind::gimp;
  bool musl = true;
  AffineKind affine = AffineKind::none;  // needs musl = false
  double flip = 0.99;
  bool cell_average = true;  // volumetric strain of full cells from the cell's divergence (locking cure)
};

template <int D>
class Skeleton {
 public:
  static constexpr int kSum = Transfer<D>::kSum;
  static constexpr int kVector = Transfer<D>::kVector;
  static constexpr int kForce = 1 + D;  // first force lane of a sum

  Skeleton(Grid<D> grid, SkeletonOptions options, BoundarySet<D> boundaries);
  Skeleton(const Skeleton&) = delete;
  Skeleton& operator=(const Skeleton&) = delete;

  Grid<D>& grid() { return grid_; }
  const Grid<D>& grid() const { return grid_; }
  const SkeletonOptions& options() const { return options_; }
  void set_flip(double share) { options_.flip = share; }  // from the next step on
  BoundarySet<D>& boundaries() { return boundaries_; }
  const BoundarySet<D>& boundaries() const { return boundaries_; }
  std::vector<SurfaceLoad<D>>& loads() { return loads_; }

  // A body; the reference stays valid. After adding bodies or changing materials call set_laws().
  ParticleSet<D>& add_body();
  std::vector<std::unique_ptr<ParticleSet<D>>>& bodies() { return bodies_; }
  const std::vector<std::unique_ptr<ParticleSet<D>>>& bodies() const { return bodies_; }
  // Laws of all bodies (by ParticleSet::material). plastic = false: elastic response.
  void set_laws(const std::vector<MaterialParameters>& materials, bool plastic);

  // Blocks at rest may sleep from now on (mpm/sleep.hpp); before the first sort().
  void allow_sleep(const SleepOptions& options) { sleep_ = std::make_unique<Sleep<D>>(options, transfer_); }
  Sleep<D>* sleep() { return sleep_.get(); }  // null: nobody may
  const Sleep<D>* sleep() const { return sleep_.get(); }

  // Re-sort if needed, or now if `force`. Returns true when slots were renumbered (Grid::carry moves other
  // fields).
  bool sort(bool force = false);
  void scatter(double time);
  // Of the volumes that later scatters bring to the nodes; what it points to must outlive them.
  void set_cell_weight(const CellWeight& weight) { transfer_.weight = weight; }
  // Soil in cells by the overlap of particle domains, see mpm::scatter_cells [slots * 4].
  void scatter_cells(Reals& cells) { mpm::scatter_cells(transfer_, cells); }

  // acceleration [slots * 4]: added to f / m + g, or null. damping: local damping alpha (Cundall 1987),
  // componentwise.
  void predict(double dt, const Point<D>& gravity, double damping, const Reals* acceleration);

  // What another phase does to the grains may be added between predict() and constrain() [slots * 4].
  Reals& v_trial() { return v_trial_; }
  // v_new = v_trial under the boundaries at `time`; keeps their reactions and the out-of-balance force.
  void constrain(double time, double dt);

  // The velocities that the strains of this step come from: under MUSL the nodal velocities of the particles'
  // momenta updated with v_new (this updates the particles), else v_new. gather() does this itself where it
  // was not called. time: end of the step.
  const Reals& strain_velocity(double time, double dt);
  // Adds `correction` [slots * 4] to v_new under the boundaries (without friction, which has acted), and
  // under MUSL to the particles and their momenta. Pressure must be projected out of the velocities that
  // strain the soil: under MUSL a pressure that makes v_new free of divergence acts ahead of its strains by a
  // part of the step, and feeds energy to undrained motion. And it must reach the strains the way all
  // momentum does, through the particles: added to the strain velocity as it stands it shortens the stable
  // step.
  void correct(double time, double dt, const Reals& correction);

  // Particles from v_new. Returns what the step moved; throws NumericalError naming the point when a value is
  // not finite.
  MoveResult gather(double time, double dt);

  // Strain, stress and motion of the points from a nodal velocity of the caller's, after scatter(). The
  // points' own velocities stay as they are: for relaxation, where motion has no inertia.
  MoveResult deform(double time, double dt, const Reals& velocity);

  // Nodal fields.
  const Reals& sums() const { return sums_; }
  Reals& sums() { return sums_; }
  const Reals& v_old() const { return v_old_; }
  Reals& v_new() { return v_new_; }
  const Reals& v_new() const { return v_new_; }
  double mass_floor() const { return mass_floor_; }  // nodes lighter than this feel no force

  // Out-of-balance force of the last recorded constrain(): norm over the nodes of mass times acceleration,
  // reactions, pore pressure and damping included; zero at rest. load_norm: of gravity and surface loads [N].
  double unbalanced_force() const { return unbalanced_; }
  double load_norm() const { return load_norm_; }
  // The same from a relaxation, which has its own steps.
  void set_balance(double unbalanced, double load) { unbalanced_ = unbalanced, load_norm_ = load; }
  // Sum of surface loads in the last scatter [N].
  const Point<D>& applied_load() const { return applied_load_; }

  // Points of another phase on the same grid, sorted together with the bodies. `set` must outlive the
  // skeleton's last sort().
  void attach(ParticleSet<D>& set) { attached_.push_back(&set); }
  // Distance travelled since the last sort [cells]; part of a checkpoint. Attached points add theirs.
  double travelled() const { return travelled_; }
  void add_travel(double cells) { travelled_ += cells; }
  void restore(double travelled, double mass_floor, const std::vector<int>& occupied_blocks);

  // Largest drained P-wave speed over all bodies, with the water in the pores counted as mass [m/s].
  double wave_speed(const std::vector<MaterialParameters>& materials) const;

 private:
  // Particle velocities changed by the step from one nodal velocity to another, and v_map_ from their
  // momenta.
  void remap(double flip, const Reals& from, const Reals& to, double time, double dt);
  MoveResult move(double time, const MoveOptions& options, const Reals* before, const Reals& velocity);
  void allocate();

  Grid<D> grid_;
  SkeletonOptions options_;
  BoundarySet<D> boundaries_;
  std::vector<SurfaceLoad<D>> loads_;
  std::vector<std::unique_ptr<ParticleSet<D>>> bodies_;
  std::vector<ParticleSet<D>*> attached_;
  std::vector<std::shared_ptr<const void>> laws_;  // one for each body
  Transfer<D> transfer_;
  std::unique_ptr<Sleep<D>> sleep_;
  Reals sums_, v_old_, v_trial_, v_new_, v_map_, v_before_;
  bool mapped_ = false;  // v_map_ and the particles' velocities belong to v_new_
  double travelled_ = 1e9;
  double mass_floor_ = 0;
  double unbalanced_ = 0, load_norm_ = 0;
  double gravity_ = 0;  // of the last prediction [m/s2]
  Point<D> applied_load_{};
};

extern template class Skeleton<2>;
extern template class Skeleton<3>;

}  // namespace polder::mpm
