#include "coupling/relaxation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/threads.hpp"
#include "coupling/one_layer.hpp"
#include "coupling/simulation.hpp"
#include "mpm/point_stencil.hpp"

namespace polder::coupling {
namespace {

constexpr int kLook = 10;          // steps between two looks at the balance
constexpr double kRefresh = 0.02;  // cells that points may move before masses and water cells are found anew
// Least slope of a shape function times h that counts for a mass: nodes that points only begin to reach must
// stay slow until masses are found anew.
constexpr double kLeastSlope = 0.05;
constexpr double kLargeForce = 0.1;   // out-of-balance force ratio that takes the whole ramp
constexpr double kFarthest = 0.05;    // cells that a node may move in one step
constexpr double kMostDamping = 1.9;  // below 2, where motion would stop at once
constexpr double kRunawaySteps = 35;  // for each cell of height: five periods of the slowest elastic mode
// A motion that goes on at one speed makes twice the way in twice the steps, one that a constant force drives
// four times.
constexpr double kFastGrowth = 2.5;
// Share that is left of an out-of-balance force that hardly falls. While stress turns in soil that yields
// everywhere, as in a column without cohesion, it falls by a sixth and more from one look back to the next.
constexpr double kStubborn = 0.85;
constexpr double kCreep = 0.5,
                 kStuck = 0.9;     // the same for a motion that goes on slowly, after twice the steps
constexpr int kFewestSteps = 300;  // before a motion counts as running away

}  // namespace

template <int D>
Relaxation<D>::Relaxation(World<D>& world, const RelaxationOptions& options)
    : world_(world), held_(world), options_(options), audit_(world) {
  for (auto& body : world_.skeleton.bodies()) {
    ParticleSet<D>& set = *body;
    const int plastic = world_.layouts[set.material].plastic_strain;
    for (Reals& v : set.velocity) std::fill(v.begin(), v.end(), 0.0);
    for (Reals& c : set.affine) std::fill(c.begin(), c.end(), 0.0);
    Reals start(static_cast<std::size_t>(set.count()) * (D + 1), 0.0);
    for (int p = 0; p < set.slots(); ++p) {
      if (set.id[p] < 0) continue;
      double* s = &start[static_cast<std::size_t>(set.id[p]) * (D + 1)];
      for (int d = 0; d < D; ++d) s[d] = set.position[d][p];
      if (plastic >= 0) s[D] = set.state[plastic][p];
    }
    start_.push_back(std::move(start));
  }
  displacement_.assign(static_cast<std::size_t>(world_.skeleton.grid().slots()) * 4, 0.0);
  moved_ = std::numeric_limits<double>::infinity();
}

// Gershgorin's circles about the rows of the elastic stiffness, |K_ij| <= sum_p V (lambda + 2 G) |grad N_i|
// |grad N_j|: with a quarter of a row's sum as mass no mode of the grid is faster than a step can follow,
// wherever the points lie.
template <int D>
void Relaxation<D>::find_masses() {
  const mpm::Skeleton<D>& skeleton = world_.skeleton;
  const Grid<D>& grid = skeleton.grid();
  const double least = kLeastSlope / grid.spacing();
  mass_.assign(grid.slots(), 0.0);
  for (const auto& body : skeleton.bodies()) {
    const ParticleSet<D>& set = *body;
    const double quarter = 0.25 * world_.materials[set.material].wave_modulus();
    for (int p = 0; p < set.slots(); ++p) {
      if (set.id[p] < 0) continue;
      Point<D> x, l;
      for (int d = 0; d < D; ++d) x[d] = set.position[d][p], l[d] = set.half_size[d][p];
      const mpm::PointStencil<D> s = mpm::point_stencil<D>(grid, skeleton.options().shape, x, l);
      double slope[mpm::PointStencil<D>::kNodes], sum = 0;
      for (int n = 0; n < s.count; ++n) {
        double square = 0;
        for (int d = 0; d < D; ++d) square += s.slope[n][d] * s.slope[n][d];
        sum += slope[n] = std::max(std::sqrt(square), least);
      }
      for (int n = 0; n < s.count; ++n) mass_[s.slot[n]] += quarter * set.volume[p] * sum * slope[n];
    }
  }
  show_masses();
}

template <int D>
void Relaxation<D>::show_masses() {
  sums_.assign(mass_.size() * 8, 0.0);
  for (std::size_t i = 0; i < mass_.size(); ++i) sums_[i * 8] = mass_[i];
}

// f(block, slot) for every node that carries soil.
template <int D>
template <class F>
void Relaxation<D>::each_node(const F& f) const {
  const mpm::Skeleton<D>& skeleton = world_.skeleton;
  constexpr int kBlock = Grid<D>::kCells;
  parallel_for(skeleton.grid().blocks(), [&](int block) {
    for (int i = block * kBlock; i < (block + 1) * kBlock; ++i)
      if (skeleton.sums()[static_cast<std::size_t>(i) * 8] > skeleton.mass_floor() && mass_[i] > 0)
        f(block, static_cast<std::size_t>(i));
  });
}

// F, and what it and the last motion tell about the mode that moves.
template <int D>
void Relaxation<D>::find_forces(double gravity) {
  mpm::Skeleton<D>& skeleton = world_.skeleton;
  const Reals* acceleration = nullptr;
  if (world_.pore_water) {
    push_by_pressure(world_);
    acceleration = &world_.pore_water->acceleration;
  }
  std::swap(force_, last_);
  force_.assign(displacement_.size(), 0.0);
  const bool second = report_.steps > 0;
  struct Part {
    double load = 0, motion = 0, stiffness = 0;
  };
  std::vector<Part> parts(skeleton.grid().blocks());
  each_node([&](int block, std::size_t i) {
    Part& part = parts[block];
    const double* s = &skeleton.sums()[i * 8];
    for (int d = 0; d < D; ++d) {
      const double weight = s[0] * gravity * world_.gravity[d], u = displacement_[i * 4 + d];
      double f = s[mpm::Skeleton<D>::kForce + d] + weight;
      if (acceleration != nullptr) f += s[0] * (*acceleration)[i * 4 + d];
      force_[i * 4 + d] = f;
      part.load += weight * weight;
      part.motion += mass_[i] * u * u;
      if (second) part.stiffness -= u * (f - last_[i * 4 + d]);
    }
  });
  double load = 0;
  motion_ = stiffness_ = 0;
  for (const Part& p : parts) load += p.load, motion_ += p.motion, stiffness_ += p.stiffness;
  for (int d = 0; d < D; ++d) load += skeleton.applied_load()[d] * skeleton.applied_load()[d];
  load_ = std::sqrt(load);
  if (!second) first_ = force_;
}

template <int D>
double Relaxation<D>::damping() const {
  if (!(motion_ > 0)) return 0;
  return std::min(2 * std::sqrt(std::max(0.0, stiffness_ / motion_)), kMostDamping);
}

// Motion of the next step.
template <int D>
void Relaxation<D>::push(double c) {
  const double held = ramp_ > 0 ? std::max(0.0, 1 - (static_cast<double>(report_.steps) + 1) / ramp_) : 0.0;
  trial_.assign(displacement_.size(), 0.0);
  each_node([&](int, std::size_t i) {
    for (std::size_t j = i * 4; j < i * 4 + D; ++j)
      trial_[j] = ((2 - c) * displacement_[j] + 2 * (force_[j] - held * first_[j]) / mass_[i]) / (2 + c);
  });
}

template <int D>
bool Relaxation<D>::step(double time, double gravity) {
  if (report_.converged || report_.runs_away || report_.steps >= options_.most_steps) return false;
  mpm::Skeleton<D>& skeleton = world_.skeleton;
  if (skeleton.sort()) {
    for (Reals* r : {&displacement_, &force_, &first_})
      if (!r->empty()) skeleton.grid().carry(*r, 4);
    if (world_.pore_water) carry_water(world_);
    moved_ = std::numeric_limits<double>::infinity();
  }
  const bool refresh = moved_ > kRefresh;
  if (world_.pore_water && refresh) update_water_cells(world_, time);
  skeleton.scatter(time);
  if (refresh) find_masses(), moved_ = 0;
  find_forces(gravity);
  skeleton.boundaries().set_still(true);
  if (report_.steps % kLook == 0) look(time, gravity >= 1);
  const bool over = report_.converged || report_.runs_away;
  if (!over) {
    push(damping());
    skeleton.boundaries().apply(time, 1.0, sums_, trial_, true, false);
    std::swap(displacement_, trial_);
    double largest = 0;
    for (const double u : displacement_) largest = std::max(largest, std::abs(u));
    const double most = kFarthest * skeleton.grid().spacing();
    if (largest > most)
      for (double& u : displacement_) u *= most / largest;
    moved_ += skeleton.deform(time, 1.0, displacement_).largest_displacement;
    ++report_.steps;
  }
  skeleton.boundaries().set_still(false);
  return !over;
}

// Balance of the nodes at rest: what the boundaries leave of the forces, walls' friction used where it helps.
template <int D>
void Relaxation<D>::look(double time, bool may_end) {
  mpm::Skeleton<D>& skeleton = world_.skeleton;
  trial_.assign(mass_.size() * 4, 0.0);
  each_node([&](int, std::size_t i) {
    for (int d = 0; d < D; ++d) trial_[i * 4 + d] = force_[i * 4 + d] / mass_[i];
  });
  skeleton.boundaries().apply(time, 1.0, sums_, trial_, true, true);
  double square = 0;
  for (std::size_t i = 0; i < mass_.size(); ++i)
    for (int d = 0; d < D; ++d) {
      const double f = mass_[i] * trial_[i * 4 + d];
      square += f * f;
    }
  skeleton.set_balance(std::sqrt(square), load_);
  report_.force_ratio = load_ > 0 ? std::sqrt(square) / load_ : 0;
  const double elastic = audit_.totals(world_).elastic_energy;
  report_.energy_ratio = elastic > 0 ? 0.5 * motion_ / elastic : 0;
  measure_displacement();
  past_.push_back(report_.displacement), past_ratio_.push_back(report_.force_ratio);
  if (report_.steps == 0) ramp_ = options_.ramp * std::min(1.0, report_.force_ratio / kLargeForce);
  report_.converged = may_end && report_.force_ratio < options_.force_tolerance &&
                      report_.energy_ratio < options_.energy_tolerance;
  report_.runs_away = options_.stop_runaway && !report_.converged && runs_away();
}

template <int D>
void Relaxation<D>::measure_displacement() {
  double mass = 0, sum = 0, largest = 0;
  report_.plastic_strain = 0;
  for (std::size_t b = 0; b < start_.size(); ++b) {
    const ParticleSet<D>& set = *world_.skeleton.bodies()[b];
    const int plastic = world_.layouts[set.material].plastic_strain;
    for (int p = 0; p < set.slots(); ++p) {
      if (set.id[p] < 0) continue;
      const double* s = &start_[b][static_cast<std::size_t>(set.id[p]) * (D + 1)];
      double square = 0;
      for (int d = 0; d < D; ++d) square += (set.position[d][p] - s[d]) * (set.position[d][p] - s[d]);
      mass += set.mass[p], sum += set.mass[p] * square;
      largest = std::max(largest, square);
      if (plastic >= 0)
        report_.plastic_strain = std::max(report_.plastic_strain, set.state[plastic][p] - s[D]);
    }
  }
  report_.displacement = std::sqrt(sum / mass);
  report_.largest_displacement = std::sqrt(largest);
}

template <int D>
bool Relaxation<D>::runs_away() const {
  // Height of the blocks that hold soil.
  const Grid<D>& grid = world_.skeleton.grid();
  int low = std::numeric_limits<int>::max(), high = 0;
  for (int b = 0; b < grid.occupied_blocks(); ++b) {
    low = std::min(low, grid.block_origin(b)[D - 1]);
    high = std::max(high, grid.block_origin(b)[D - 1] + Grid<D>::kSide);
  }
  const std::size_t n = past_.size() - 1, half = n / 2, quarter = n / 4;
  const double fewest = std::max<double>(kFewestSteps, kRunawaySteps * (high - low));
  const auto steps = static_cast<double>(n * kLook);
  if (steps < fewest) return false;
  const auto least = [&](std::size_t from, std::size_t to) {
    return *std::min_element(past_ratio_.begin() + static_cast<std::ptrdiff_t>(from),
                             past_ratio_.begin() + static_cast<std::ptrdiff_t>(to));
  };
  const double growth = (past_[n] - past_[half]) / (past_[half] - past_[quarter]);
  const double left = least(half, n + 1) / least(quarter, half);
  return (growth > kFastGrowth && left > kStubborn) ||
         (steps >= 2 * fewest && growth > kCreep && left > kStuck);
}

template <int D>
void Relaxation<D>::visit(StateVisitor& v) {
  v.reals("relaxation_displacement", displacement_), v.reals("relaxation_mass", mass_);
  v.reals("relaxation_force", force_), v.reals("relaxation_first_force", first_);
  v.reals("relaxation_past_displacement", past_), v.reals("relaxation_past_ratio", past_ratio_);
  for (std::size_t b = 0; b < start_.size(); ++b) v.reals("relaxation_start_" + std::to_string(b), start_[b]);
  std::int64_t steps = report_.steps;
  v.count("relaxation_step", steps), v.number("relaxation_moved", moved_), v.number("relaxation_ramp", ramp_);
  report_.steps = steps;
  if (v.reading()) show_masses();
}

template <int D>
RelaxationReport relax(World<D>& world, const RelaxationOptions& options, double time) {
  Relaxation<D> relaxation(world, options);
  while (relaxation.step(time)) {
  }
  return relaxation.report();
}

template class Relaxation<2>;
template class Relaxation<3>;
template RelaxationReport relax<2>(World<2>&, const RelaxationOptions&, double);
template RelaxationReport relax<3>(World<3>&, const RelaxationOptions&, double);

}  // namespace polder::coupling
