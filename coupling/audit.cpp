#include "coupling/audit.hpp"

#include <algorithm>
#include <cmath>

#include "core/threads.hpp"

namespace polder::coupling {
namespace {

template <int D>
void add_layer(const WaterLayer<D>& layer, Totals& t) {
  const ParticleSet<D>& set = layer.fluid.points();
  for (int p = 0; p < set.slots(); ++p) {
    if (set.id[p] < 0) continue;
    double square = 0;
    for (int d = 0; d < D; ++d) {
      const double v = set.velocity[d][p];
      square += v * v;
      t.momentum[d] += set.mass[p] * v;
    }
    t.water_volume += set.volume[p];
    t.kinetic_energy += 0.5 * set.mass[p] * square;
    t.largest_speed = std::max(t.largest_speed, square);
    t.water_runout = std::max(t.water_runout, set.position[0][p] + set.half_size[0][p]);
    t.water_height = std::max(t.water_height, set.position[D - 1][p] + set.half_size[D - 1][p]);
  }
}

}  // namespace

template <int D>
Audit<D>::Audit(const World<D>& world) {
  const Totals t = totals(world);
  initial_kinetic_ = t.kinetic_energy;
  initial_momentum_ = t.momentum;
}

template <int D>
void Audit<D>::add_step(const World<D>& world, double dt, double damping, double gravity) {
  struct Part {
    Work work;
    std::array<double, 3> impulse{};
    double magnitude = 0;
  };
  const mpm::Skeleton<D>& k = world.skeleton;
  const PoreWater<D>* water = world.pore_water.get();
  const bool corrected = water != nullptr && !water->correction.empty();
  thread_local std::vector<Part> store;  // work space of the calling thread, for all
  std::vector<Part>& parts = store;
  parts.assign(k.grid().blocks(), Part{});
  parallel_for(k.grid().blocks(), [&](int block) {
    Part part;  // in registers: sums in memory wait for each other
    for (int i = block * Grid<D>::kCells; i < (block + 1) * Grid<D>::kCells; ++i) {
      const double* s = &k.sums()[static_cast<std::size_t>(i) * 8];
      const double mass = s[0];
      if (!(mass > 0)) continue;
      const bool force = mass > k.mass_floor();
      for (int d = 0; d < D; ++d) {
        const std::size_t j = static_cast<std::size_t>(i) * 4 + d;
        const double v0 = k.v_old()[j], v1 = k.v_new()[j], mean = 0.5 * (v0 + v1), dv = v1 - v0;
        double known = 0;
        if (force) {
          const double stress = dt * s[1 + D + d], weight = dt * mass * gravity * world.gravity[d];
          const double first = water != nullptr ? dt * mass * water->acceleration[j] : 0.0;
          const double second = corrected ? mass * water->correction[j] : 0.0;
          const double a = stress + weight + first,
                       damped = damping > 0 && a * v0 != 0 ? (a * v0 > 0 ? -damping * a : damping * a) : 0.0;
          part.work.stress += stress * mean;
          part.work.gravity += weight * mean;
          part.work.water += (first + second) * mean;
          part.work.damping += damped * mean;
          known = a + damped + second;
        }
        part.work.boundary += (mass * dv - known) * mean;
        part.impulse[d] += mass * dv;
        part.magnitude += std::abs(mass * dv);
      }
    }
    parts[block] = part;
  });
  const auto add_water = [&](const Reals& sums, const Reals& before, const Reals& after) {
    parallel_for(k.grid().blocks(), [&](int block) {
      Part part = parts[block];
      for (int i = block * Grid<D>::kCells; i < (block + 1) * Grid<D>::kCells; ++i) {
        const double mass = sums[static_cast<std::size_t>(i) * 8];
        if (!(mass > 0)) continue;
        for (int d = 0; d < D; ++d) {
          const std::size_t j = static_cast<std::size_t>(i) * 4 + d;
          const double v0 = before[j], v1 = after[j], mean = 0.5 * (v0 + v1);
          const double weight = dt * mass * gravity * world.gravity[d];
          part.work.gravity += weight * mean;
          part.work.water += (mass * (v1 - v0) - weight) * mean;
          part.impulse[d] += mass * (v1 - v0);
          part.magnitude += std::abs(mass * (v1 - v0));
        }
      }
      parts[block] = part;
    });
  };
  if (water != nullptr && water->layer) {
    const mpm::FluidLayer<D>& fluid = water->layer->fluid;
    add_water(fluid.sums(), fluid.velocity_old(), fluid.velocity());
  } else if (water != nullptr && water->points && water->points->relative_inertia) {
    add_water(water->points->sums, water->points->velocity_old, water->points->velocity);
  }
  for (const Part& p : parts) {
    work_.stress += p.work.stress, work_.gravity += p.work.gravity, work_.water += p.work.water;
    work_.damping += p.work.damping, work_.boundary += p.work.boundary;
    impulse_magnitude_ += p.magnitude;
    for (int d = 0; d < 3; ++d) impulse_[d] += p.impulse[d];
  }
}

template <int D>
void Audit<D>::add_impulse(const Point<D>& impulse) {
  double square = 0;
  for (int d = 0; d < D; ++d) impulse_[d] += impulse[d], square += impulse[d] * impulse[d];
  impulse_magnitude_ += std::sqrt(square);
}

template <int D>
void Audit<D>::rebase(const World<D>& world) {
  const Totals t = totals(world);
  initial_kinetic_ =
      t.kinetic_energy - (work_.stress + work_.gravity + work_.water + work_.damping + work_.boundary);
  for (int d = 0; d < 3; ++d) initial_momentum_[d] = t.momentum[d] - impulse_[d];
}

template <int D>
Totals Audit<D>::totals(const World<D>& world) const {
  Totals t;
  t.runout = t.height = t.water_runout = t.water_height = -1e300;
  const bool unsaturated = world.pore_water && world.pore_water->unsaturated;
  const bool layered = world.pore_water && world.pore_water->layer;
  const double per_density = 1 / world.scene.water.density;
  for (const auto& body : world.skeleton.bodies()) {
    const ParticleSet<D>& set = *body;
    const mpm::MaterialParameters& m = world.materials[set.material];
    const double young = m.young, nu = m.poisson;
    for (int p = 0; p < set.slots(); ++p) {
      if (set.id[p] < 0) continue;
      const double pores = set.volume[p] - set.mass[p] / set.density_solid;
      const double mass = set.mass[p] + (set.pore_water.empty() ? 0.0 : set.pore_water[p] * pores) +
                          (set.retained_water.empty() ? 0.0 : set.retained_water[p]);
      t.solid_mass += set.mass[p];
      if (unsaturated && !set.pore_water.empty())
        t.water_volume += set.pore_water[p] * per_density * pores;
      else if (!set.wet.empty() && !layered)
        t.water_volume += set.wet[p] * pores;
      double square = 0;
      for (int d = 0; d < D; ++d) {
        const double v = set.velocity[d][p];
        square += v * v;
        t.momentum[d] += mass * v;
      }
      t.kinetic_energy += 0.5 * mass * square;
      t.largest_speed = std::max(t.largest_speed, square);
      if (!set.water_velocity[0].empty() && set.wet[p] > 0) {
        const double water_mass = world.scene.water.density * pores;
        double flow = 0;
        for (int d = 0; d < D; ++d) {
          const double w = set.water_velocity[d][p];
          flow += w * w;
          t.momentum[d] += water_mass * w;
        }
        t.kinetic_energy += 0.5 * water_mass * flow;
        t.largest_speed = std::max(t.largest_speed, flow);
      }
      t.runout = std::max(t.runout, set.position[0][p] + set.half_size[0][p]);
      t.height = std::max(t.height, set.position[D - 1][p] + set.half_size[D - 1][p]);
      double diagonal = 0, trace = 0, shear = 0;
      for (int c = 0; c < ParticleSet<D>::kStress; ++c) {
        const double s = set.stress[c][p];
        if (c < 3)
          diagonal += s * s, trace += s;
        else
          shear += s * s;
      }
      if (young > 0)
        t.elastic_energy +=
            set.volume[p] * (0.5 * ((1 + nu) * diagonal - nu * trace * trace) + (1 + nu) * shear) / young;
    }
  }
  if (world.pore_water && world.pore_water->layer) add_layer(*world.pore_water->layer, t);
  t.largest_speed = std::sqrt(t.largest_speed);
  return t;
}

template <int D>
double Audit<D>::impulse_error(const Totals& totals) const {
  double error = 0;
  for (int d = 0; d < D; ++d) {
    const double e = totals.momentum[d] - initial_momentum_[d] - impulse_[d];
    error += e * e;
  }
  return impulse_magnitude_ > 0 ? std::sqrt(error) / impulse_magnitude_ : 0.0;
}

template <int D>
double Audit<D>::energy_loss(const Totals& totals) const {
  return work_.stress + work_.gravity + work_.water + work_.damping + work_.boundary -
         (totals.kinetic_energy - initial_kinetic_);
}

template <int D>
std::vector<double*> Audit<D>::state() {
  std::vector<double*> s{&work_.stress,   &work_.gravity,    &work_.water,       &work_.damping,
                         &work_.boundary, &initial_kinetic_, &impulse_magnitude_};
  for (int d = 0; d < 3; ++d) s.push_back(&initial_momentum_[d]), s.push_back(&impulse_[d]);
  return s;
}

template <int D>
double pressure_roughness(const PoreWater<D>& water) {
  const Grid<D>& grid = water.cells.grid();
  double sum = 0;
  long count = 0;
  for (const fdm::ActiveCell<D>& cell : water.cells.cells()) {
    double r = 0;
    bool inner = true;
    for (int j = -1; j <= 1 && inner; ++j)
      for (int i = -1; i <= 1 && inner; ++i) {
        Index<D> n = cell.index;
        n[0] += i, n[D - 1] += j;
        const int slot = grid.is_cell(n) ? grid.slot(n) : -1;
        inner = slot >= 0 && water.cells.active(slot);
        if (inner) r += (i == 0 ? 2 : -1) * (j == 0 ? 2 : -1) * water.pore_pressure()[slot] / 16;
      }
    if (inner) sum += r * r, ++count;
  }
  return count > 0 ? std::sqrt(sum / count) : 0.0;
}

template class Audit<2>;
template class Audit<3>;
template double pressure_roughness<2>(const PoreWater<2>&);
template double pressure_roughness<3>(const PoreWater<3>&);

}  // namespace polder::coupling
