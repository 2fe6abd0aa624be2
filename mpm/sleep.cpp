#include "mpm/sleep.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/threads.hpp"

namespace polder::mpm {
namespace {

constexpr double kFallShare = 0.5;       // of the force threshold, for falling asleep
constexpr double kWakeSpeed = 2;         // times the velocity threshold, for waking
constexpr double kMeanShare = 1.0 / 15;  // of the delay: the mean's time constant

// Calls f(tile node, slot) for the stored nodes [-1, reach) of a block.
template <int D, class F>
void for_nodes(const Grid<D>& grid, int block, int reach, const F& f) {
  constexpr int kSide = Grid<D>::kSide, kTile = Transfer<D>::kTileSide;
  const auto& neighbours = grid.neighbours(block);
  const auto part = [](int x) { return x < 0 ? 0 : x < kSide ? 1 : 2; };
  for (int z = D == 3 ? -1 : 0; z < (D == 3 ? reach : 1); ++z)
    for (int y = -1; y < reach; ++y)
      for (int x = -1; x < reach; ++x) {
        const int around = (D == 3 ? part(z) * 9 : 0) + part(y) * 3 + part(x);
        const int of = neighbours[around];
        if (of < 0) continue;
        const int local =
            ((D == 3 ? (z + kSide) % kSide * kSide : 0) + (y + kSide) % kSide) * kSide + (x + kSide) % kSide;
        const int node = ((D == 3 ? (z + 1) * kTile : 0) + y + 1) * kTile + x + 1;
        f(node, of * Grid<D>::kCells + local);
      }
}

}  // namespace

template <int D>
std::vector<int> Sleep<D>::count_points() const {
  std::vector<int> counts(transfer_.grid->occupied_blocks(), 0);
  for (const Body<D>& body : transfer_.bodies)
    for (std::size_t b = 0; b < body.particles->ranges.size() && b < counts.size(); ++b) {
      const auto range = body.particles->ranges[b];
      for (int p = range.first; p < range.first + range.count; ++p)
        if (body.particles->id[p] >= 0) ++counts[b];
    }
  return counts;
}

// Sizes and counts after the set of sleepers was changed.
template <int D>
void Sleep<D>::changed() {
  stale_ = true;
  points_ = 0;
  const std::vector<int> counts = count_points();
  for (int b = 0; b < static_cast<int>(counts.size()); ++b)
    if (transfer_.asleep(b)) points_ += counts[b];
}

template <int D>
void Sleep<D>::before_sort() {
  const Grid<D>& grid = *transfer_.grid;
  numbers_.clear();
  for (int b = 0; b < static_cast<int>(quiet_.size()); ++b)
    numbers_.push_back(grid.block_number(grid.block_origin(b)));
  counts_ = numbers_.empty() ? std::vector<int>{} : count_points();
}

template <int D>
void Sleep<D>::after_sort(bool renumbered) {
  const Grid<D>& grid = *transfer_.grid;
  const int blocks = grid.occupied_blocks();
  std::vector<int> before(grid.block_numbers(), -1);
  for (std::size_t b = 0; b < numbers_.size(); ++b) before[numbers_[b]] = static_cast<int>(b);
  std::vector<Sleeper> sleepers(blocks);
  Reals quiet(blocks, 0.0);
  const std::vector<int> counts = count_points();
  bool changes = false;
  for (int b = 0; b < blocks; ++b) {
    const int old = before[grid.block_number(grid.block_origin(b))];
    if (old < 0) continue;
    quiet[b] = quiet_[old];
    if (falls_[old]) ++times_asleep_;
    if (transfer_.asleep(old)) sleepers[b] = std::move(transfer_.sleepers[old]);
    if (!falls_[old] && !(sleepers[b].asleep && counts[b] != counts_[old])) continue;
    // Also a point that strays into sleeping soil stops; one that came with more than that has woken it.
    sleepers[b] = Sleeper{};
    sleepers[b].asleep = changes = true;
    stop_points(b);
  }
  transfer_.sleepers = std::move(sleepers);
  quiet_ = std::move(quiet);
  if (means_.empty())
    means_.assign(static_cast<std::size_t>(grid.slots()) * kMean, 0.0);
  else if (renumbered)
    grid.carry(means_, kMean);
  falls_.assign(blocks, 0);
  wakes_.assign(blocks, 0);
  if (changes || renumbered) changed();
}

template <int D>
void Sleep<D>::stop_points(int block) {
  for (const Body<D>& body : transfer_.bodies) {
    ParticleSet<D>& set = *body.particles;
    const auto range = set.ranges[block];
    for (int p = range.first; p < range.first + range.count; ++p) {
      if (set.id[p] < 0) continue;
      double mass = set.mass[p];
      if (!set.pore_water.empty()) mass += set.pore_water[p] * (set.volume[p] - mass / set.density_solid);
      if (!set.retained_water.empty()) mass += set.retained_water[p];
      for (int d = 0; d < D; ++d) stopped_[d] += mass * set.velocity[d][p], set.velocity[d][p] = 0;
    }
    for (Reals& c : set.affine)
      if (!c.empty()) std::fill_n(c.begin() + range.first, range.count, 0.0);
  }
}

template <int D>
Point<D> Sleep<D>::take_stopped() {
  return std::exchange(stopped_, Point<D>{});
}

template <int D>
void Sleep<D>::find_held() {
  if (!stale_) return;
  stale_ = false;
  const Grid<D>& grid = *transfer_.grid;
  Reals mass(grid.slots(), 0.0);
  for (int b = 0; b < grid.occupied_blocks(); ++b) {
    if (!transfer_.asleep(b)) continue;
    const Reals& kept = transfer_.sleepers[b].state;
    for_nodes(grid, b, Transfer<D>::kTileSide - 1, [&](int node, int slot) {
      mass[slot] += kept[static_cast<std::size_t>(node) * Transfer<D>::kSum];
    });
  }
  held_.clear(), held_mass_.clear();
  for (int i = 0; i < grid.slots(); ++i)
    if (mass[i] > 0) held_.push_back(i), held_mass_.push_back(mass[i]);
}

template <int D>
void Sleep<D>::count_held(const Reals& v_old, double flip) {
  for (std::size_t i = 0; i < held_.size(); ++i)
    for (int d = 0; d < D; ++d)
      stopped_[d] -=
          flip * held_mass_[i] * v_old[static_cast<std::size_t>(held_[i]) * Transfer<D>::kVector + d];
}

template <int D>
void Sleep<D>::average(double dt, const Reals& sums, const Reals& v_old, const Reals& v_new) {
  const Grid<D>& grid = *transfer_.grid;
  const double fresh = -std::expm1(-since_look_ / (kMeanShare * options_.delay));
  parallel_for(grid.blocks(), [&](int block) {
    for (int i = block * Grid<D>::kCells; i < (block + 1) * Grid<D>::kCells; ++i) {
      const double mass = sums[static_cast<std::size_t>(i) * Transfer<D>::kSum];
      double* mean = &means_[static_cast<std::size_t>(i) * kMean];
      for (int d = 0; d < D; ++d) {
        const std::size_t j = static_cast<std::size_t>(i) * Transfer<D>::kVector + d;
        mean[d] += fresh * (v_old[j] - mean[d]);
        mean[D + d] += fresh * (mass * (v_new[j] - v_old[j]) / dt - mean[D + d]);
      }
    }
  });
}

template <int D>
typename Sleep<D>::Motion Sleep<D>::motion_of(int block, double g, const Reals& sums) const {
  Motion m;
  for_nodes(*transfer_.grid, block, kReach, [&](int, int slot) {
    const double weight = sums[static_cast<std::size_t>(slot) * Transfer<D>::kSum] * g;
    if (!(weight > 0)) return;
    const double* mean = &means_[static_cast<std::size_t>(slot) * kMean];
    double speed = 0;
    for (int d = 0; d < D; ++d) speed += mean[d] * mean[d], m.force += mean[D + d] * mean[D + d];
    m.speed = std::max(m.speed, speed);
    m.weight += weight * weight;
  });
  return m;
}

template <int D>
void Sleep<D>::judge(double dt, double g, const Reals& sums, const Reals& v_old, const Reals& v_new) {
  since_look_ += dt;
  if (++steps_ % kLook != 0) return;
  average(dt, sums, v_old, v_new);
  const auto square = [](double x) { return x * x; };
  parallel_for(transfer_.grid->occupied_blocks(), [&](int b) {
    const Motion m = motion_of(b, g, sums);
    wakes_[b] = falls_[b] = 0;
    if (transfer_.asleep(b)) {
      wakes_[b] =
          m.force > square(options_.force) * m.weight || m.speed > square(kWakeSpeed * options_.velocity);
      return;
    }
    const bool rests =
        m.speed < square(options_.velocity) && m.force < square(kFallShare * options_.force) * m.weight;
    quiet_[b] = rests ? quiet_[b] + since_look_ : 0;
    falls_[b] = active_ && quiet_[b] >= options_.delay;
  });
  since_look_ = 0;
  wake(wakes_);
  find_held();
}

template <int D>
void Sleep<D>::hold(Reals& velocity) const {
  for (int slot : held_)
    for (int d = 0; d < D; ++d) velocity[static_cast<std::size_t>(slot) * Transfer<D>::kVector + d] = 0;
}

template <int D>
bool Sleep<D>::end_step() {
  skipped_ += points_;
  return std::any_of(falls_.begin(), falls_.end(), [](std::uint8_t falls) { return falls != 0; });
}

template <int D>
void Sleep<D>::wake(const std::vector<std::uint8_t>& blocks) {
  bool any = false;
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    if (!blocks[b] || !transfer_.asleep(static_cast<int>(b))) continue;
    transfer_.sleepers[b] = Sleeper{};
    quiet_[b] = 0, any = true;
    ++times_woken_;
  }
  if (any) changed();
}

template <int D>
void Sleep<D>::wake_all() {
  std::fill(quiet_.begin(), quiet_.end(), 0.0);
  std::fill(falls_.begin(), falls_.end(), 0);
  wake(std::vector<std::uint8_t>(quiet_.size(), 1));
}

template <int D>
typename Sleep<D>::State Sleep<D>::state() const {
  State s;
  for (int b = 0; b < static_cast<int>(quiet_.size()); ++b)
    if (falls_[b])
      s.falling.push_back(b);
    else if (transfer_.asleep(b))
      s.asleep.push_back(b);
  s.quiet = quiet_, s.means = means_;
  s.since_look = since_look_;
  s.steps = steps_, s.skipped = skipped_, s.times_asleep = times_asleep_, s.times_woken = times_woken_;
  return s;
}

template <int D>
void Sleep<D>::restore(const State& s) {
  const int blocks = transfer_.grid->occupied_blocks();
  transfer_.sleepers.assign(blocks, Sleeper{});
  for (int b : s.asleep) transfer_.sleepers.at(b).asleep = true;
  quiet_ = s.quiet, means_ = s.means;
  falls_.assign(blocks, 0);
  for (int b : s.falling) falls_.at(b) = 1;
  wakes_.assign(blocks, 0);
  since_look_ = s.since_look;
  steps_ = s.steps, skipped_ = s.skipped, times_asleep_ = s.times_asleep, times_woken_ = s.times_woken;
  changed();
}

template class Sleep<2>;
template class Sleep<3>;

}  // namespace polder::mpm
