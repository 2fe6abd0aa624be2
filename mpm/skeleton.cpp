#include "mpm/skeleton.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.hpp"
#include "core/threads.hpp"
#include "mpm/node_update.hpp"
#include "mpm/runaway.hpp"

namespace polder::mpm {
namespace {

// Least mass of a node that feels forces, as a share of a full cell of the lightest soil. Only guards the
// division: where a support ends, mass vanishes as the square of the force, so leaving such forces out any
// earlier would lose momentum.
constexpr double kMassFloor = 1e-26;

constexpr double kFarTravelled = 1e9;  // cells: sort before the next step

}  // namespace

template <int D>
Skeleton<D>::Skeleton(Grid<D> grid, SkeletonOptions options, BoundarySet<D> boundaries)
    : grid_(std::move(grid)), options_(options), boundaries_(std::move(boundaries)) {
  transfer_.grid = &grid_;
  transfer_.space = options.space;
  transfer_.shape = options.shape;
}

template <int D>
ParticleSet<D>& Skeleton<D>::add_body() {
  bodies_.push_back(std::make_unique<ParticleSet<D>>());
  bodies_.back()->group_by_cell = options_.cell_average;
  return *bodies_.back();
}

template <int D>
void Skeleton<D>::set_laws(const std::vector<MaterialParameters>& materials, bool plastic) {
  laws_.clear();
  transfer_.bodies.clear();
  for (const auto& body : bodies_) {
    const MaterialParameters& m = materials[body->material];
    laws_.push_back(make_law_handle(D, m, plastic));
    const bool opens = plastic && m.model == MaterialModel::mohr_coulomb;
    transfer_.bodies.push_back({body.get(), laws_.back().get(), opens ? m.bulk_modulus() : 0.0});
  }
}

template <int D>
void Skeleton<D>::allocate() {
  transfer_.resize();
  const std::size_t n = grid_.slots();
  for (Reals* r : {&v_old_, &v_trial_, &v_new_, &v_map_}) r->assign(n * kVector, 0.0);
  boundaries_.update(grid_);
}

template <int D>
bool Skeleton<D>::sort(bool force) {
  if (!force && travelled_ <= kSkin) return false;
  std::vector<ParticleSet<D>*> sets = attached_;
  for (const auto& body : bodies_) sets.push_back(body.get());
  std::vector<int> occupied;
  for (const ParticleSet<D>* set : sets) {
    const std::vector<int> numbers = set->occupied_block_numbers(grid_);
    occupied.insert(occupied.end(), numbers.begin(), numbers.end());
  }
  if (sleep_) sleep_->before_sort();
  const bool changed = grid_.activate(std::move(occupied));
  for (ParticleSet<D>* set : sets) set->sort(grid_);
  if (sleep_) sleep_->after_sort(changed);
  if (changed) allocate();
  travelled_ = 0;
  return changed;
}

template <int D>
void Skeleton<D>::restore(double travelled, double mass_floor, const std::vector<int>& occupied_blocks) {
  mass_floor_ = mass_floor;
  grid_.activate(occupied_blocks);
  allocate();
  travelled_ = travelled;
}

template <int D>
void Skeleton<D>::scatter(double time) {
  scatter_state(transfer_, options_.affine, sums_, v_old_);
  if (sleep_) sleep_->find_held();
  applied_load_ = Point<D>{};
  for (const SurfaceLoad<D>& load : loads_) {
    const Point<D> f = load.apply(grid_, options_.shape, time, sums_);
    for (int d = 0; d < D; ++d) applied_load_[d] += f[d];
  }
  if (mass_floor_ == 0) {
    double density = std::numeric_limits<double>::infinity();
    for (const auto& body : bodies_)
      for (int p = 0; p < body->slots(); ++p)
        if (body->mass[p] > 0) density = std::min(density, body->mass[p] / body->volume[p]);
    mass_floor_ = kMassFloor * density * std::pow(grid_.spacing(), D);
  }
}

template <int D>
void Skeleton<D>::predict(double dt, const Point<D>& gravity, double damping, const Reals* acceleration) {
  const NodePrediction<D> p{dt, gravity, damping, mass_floor_, acceleration, &boundaries_.held_components()};
  const double squared_mass = predict_velocities(grid_, p, sums_, v_old_, v_trial_);
  double load = 0, square = 0;
  for (double g : gravity) square += g * g;
  gravity_ = std::sqrt(square);
  for (int d = 0; d < D; ++d)
    load += squared_mass * gravity[d] * gravity[d] + applied_load_[d] * applied_load_[d];
  load_norm_ = std::sqrt(load);
}

template <int D>
void Skeleton<D>::constrain(double time, double dt) {
  std::swap(v_new_, v_trial_);  // the next prediction writes every component anew
  boundaries_.apply(time, dt, sums_, v_new_, true, true);
  unbalanced_ = std::sqrt(squared_impulse(grid_, sums_, v_old_, v_new_)) / dt;
  if (!sleep_) return;
  sleep_->judge(dt, gravity_, sums_, v_old_, v_new_);
  sleep_->hold(v_new_);
  sleep_->count_held(v_old_, options_.affine == AffineKind::none ? options_.flip : 0);
}

template <int D>
void Skeleton<D>::remap(double flip, const Reals& from, const Reals& to, double time, double dt) {
  update_velocities(transfer_, flip, from, to, sums_, v_map_);
  boundaries_.apply(time, dt, sums_, v_map_, false, false);
  if (sleep_) sleep_->hold(v_map_);
  mapped_ = true;
}

template <int D>
const Reals& Skeleton<D>::strain_velocity(double time, double dt) {
  if (!options_.musl) return v_new_;
  if (!mapped_) remap(options_.flip, v_old_, v_new_, time, dt);
  return v_map_;
}

template <int D>
void Skeleton<D>::correct(double time, double dt, const Reals& correction) {
  const std::size_t stride = static_cast<std::size_t>(Grid<D>::kCells) * kVector;
  if (options_.musl) v_before_.resize(v_new_.size());
  parallel_for(grid_.blocks(), [&](int block) {
    if (options_.musl) std::copy_n(&v_new_[block * stride], stride, &v_before_[block * stride]);
    for (std::size_t i = block * stride; i < (block + 1) * stride; ++i) v_new_[i] += correction[i];
  });
  boundaries_.apply(time, dt, sums_, v_new_, false, false);
  if (sleep_) sleep_->hold(v_new_);
  if (options_.musl) remap(1.0, v_before_, v_new_, time, dt);
}

template <int D>
MoveResult Skeleton<D>::gather(double time, double dt) {
  MoveOptions o;
  o.dt = dt;
  o.affine = options_.affine;
  o.flip = options_.flip;
  o.cell_average = options_.cell_average;
  // Points, and the surfaces that carry loads, move with the velocity that strains the soil. Under MUSL v_new
  // differs from it where a node carries little mass; positions and strains would part company there, and
  // stressed soil at a surface start to oscillate.
  const Reals& v = strain_velocity(time + dt, dt);
  o.update_velocity = !options_.musl && options_.affine == AffineKind::none;
  return move(time, o, options_.musl ? nullptr : &v_old_, v);
}

template <int D>
MoveResult Skeleton<D>::deform(double time, double dt, const Reals& velocity) {
  MoveOptions o;
  o.dt = dt;
  o.cell_average = options_.cell_average;
  return move(time, o, nullptr, velocity);
}

template <int D>
MoveResult Skeleton<D>::move(double time, const MoveOptions& o, const Reals* before, const Reals& v) {
  const double dt = o.dt;
  MoveResult r = update_stress_and_move(transfer_, o, before, v);
  for (SurfaceLoad<D>& load : loads_) load.move(grid_, options_.shape, dt, v, sums_);
  mapped_ = false;
  travelled_ += r.largest_displacement;
  if (sleep_ && sleep_->end_step()) travelled_ = kFarTravelled;
  if (r.fastest_body >= 0) require_calm(r, *bodies_[r.fastest_body], time, dt);
  return r;
}

template <int D>
double Skeleton<D>::wave_speed(const std::vector<MaterialParameters>& materials) const {
  double fastest = 0;
  for (const auto& body : bodies_) {
    const MaterialParameters& m = materials[body->material];
    double density = std::numeric_limits<double>::infinity();
    for (int p = 0; p < body->slots(); ++p) {
      if (body->mass[p] <= 0) continue;
      double mass = body->mass[p];
      if (!body->pore_water.empty())
        mass += body->pore_water[p] * (body->volume[p] - mass / body->density_solid);
      if (!body->retained_water.empty()) mass += body->retained_water[p];
      density = std::min(density, mass / body->volume[p]);
    }
    fastest = std::max(fastest, std::sqrt(m.wave_modulus() / density));
  }
  return fastest;
}

template class Skeleton<2>;
template class Skeleton<3>;

}  // namespace polder::mpm
