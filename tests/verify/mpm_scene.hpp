// Small scenes for the tests and benchmarks of the soil skeleton: bodies, sides, the step loop.
//
// The step is the one a dry formulation makes: sort, scatter, predict, constrain,
// gather.
#pragma once

#include <cmath>
#include <functional>
#include <memory>
#include <vector>

#include "mpm/material/material.hpp"
#include "mpm/seed_particles.hpp"
#include "mpm/skeleton.hpp"

namespace polder::verify {

using namespace polder::mpm;

inline MaterialParameters elastic(double density, double young, double poisson) {
  MaterialParameters m;
  m.name = "elastic";
  m.density_solid = density;
  m.young = young;
  m.poisson = poisson;
  return m;
}

inline MaterialParameters mohr_coulomb(double density, double young, double poisson, double friction,
                                       double cohesion, double dilation) {
  MaterialParameters m = elastic(density, young, poisson);
  m.name = "mohr-coulomb";
  m.model = MaterialModel::mohr_coulomb;
  m.friction.value = {friction};
  m.cohesion.value = {cohesion};
  m.dilation.value = {dilation};
  return m;
}

// Every side of the grid under the same kind.
template <int D>
std::vector<BoundarySpec<D>> all_sides(BoundaryKind kind) {
  std::vector<BoundarySpec<D>> specs(2 * D);
  for (int s = 0; s < 2 * D; ++s) specs[s].side = s, specs[s].kind = kind;
  return specs;
}

template <int D>
class Scene {
 public:
  Scene(const Grid<D>& grid, const SkeletonOptions& options, std::vector<BoundarySpec<D>> sides)
      : skeleton(grid, options, BoundarySet<D>(std::move(sides))) {}

  // A body of the points inside [lower, upper] for which `inside` holds; `per_axis` points a cell and axis.
  ParticleSet<D>& add(const MaterialParameters& material, const Point<D>& lower, const Point<D>& upper,
                      int per_axis = 2, double jitter = 0,
                      const std::function<bool(const Point<D>&)>& inside = {}) {
    ParticleSet<D>& set = skeleton.add_body();
    set.name = material.name;
    set.material = static_cast<int>(materials.size());
    set.density_solid = material.density_solid;
    std::array<bool, D> whole;
    whole.fill(true);
    const SeedRegion<D> region = seed_region<D>(skeleton.grid(), per_axis, lower, upper, whole);
    seed_particles<D>(
        set, region, skeleton.options().space, material.dry_density(), jitter, 1,
        inside ? inside : [](const Point<D>&) { return true; });
    if (skeleton.options().affine != AffineKind::none)
      for (Reals& a : set.affine) a.assign(set.slots(), 0.0);
    const StateLayout layout = state_layout(material, D);
    set.state.assign(layout.count(), Reals(set.slots(), 0.0));
    for (const StateVariable& v : layout.variables) set.state_padding.push_back(v.initial);
    std::vector<double> state(layout.count());
    for (int p = 0; p < set.slots(); ++p) {
      set_initial_state(material, D, set.position[D - 1][p], state);
      for (int k = 0; k < layout.count(); ++k) set.state[k][p] = state[k];
    }
    materials.push_back(material);
    skeleton.set_laws(materials, true);
    return set;
  }

  double wave_step(double courant) const {
    return courant * skeleton.grid().spacing() / skeleton.wave_speed(materials);
  }

  void step(double dt) {
    skeleton.sort();
    skeleton.scatter(time);
    skeleton.predict(dt, gravity, damping, nullptr);
    skeleton.constrain(time, dt);
    last = skeleton.gather(time, dt);
    time += dt;
    ++steps;
  }

  // Relax under damping until the out-of-balance force is below `ratio` of the load. Returns false after
  // `most` steps.
  bool relax(double dt, double ratio, long most) {
    for (long i = 0; i < most; ++i) {
      step(dt);
      if (i > 10 && skeleton.unbalanced_force() < ratio * skeleton.load_norm()) return true;
    }
    return false;
  }

  // f(set, slot) for every point with mass.
  template <class F>
  void each(const F& f) const {
    for (const auto& body : skeleton.bodies())
      for (int p = 0; p < body->slots(); ++p)
        if (body->id[p] >= 0) f(*body, p);
  }

  double kinetic_energy() const {
    double e = 0;
    each([&](const ParticleSet<D>& s, int p) {
      for (int d = 0; d < D; ++d) e += 0.5 * s.mass[p] * s.velocity[d][p] * s.velocity[d][p];
    });
    return e;
  }

  Skeleton<D> skeleton;
  std::vector<MaterialParameters> materials;
  Point<D> gravity{};
  double damping = 0;
  double time = 0;
  long steps = 0;
  MoveResult last;
};

// Stored elastic energy of an isotropic solid at this stress, per unit volume [J/m3].
template <int D>
double elastic_energy_density(const MaterialParameters& m, const ParticleSet<D>& s, int p) {
  double trace = 0, square = 0;
  for (int k = 0; k < ParticleSet<D>::kStress; ++k) {
    const double v = s.stress[k][p];
    if (k < 3) trace += v;
    square += (k < 3 ? 1 : 2) * v * v;
  }
  return ((1 + m.poisson) * square - m.poisson * trace * trace) / (2 * m.young);
}

}  // namespace polder::verify
