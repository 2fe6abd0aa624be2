// Soil that has come to rest is put to sleep, block by block of the grid: its points are neither mapped nor
// moved nor strained until something wakes them.
//
// A block falls asleep when for a while no node that its points reach has moved faster than a threshold, and
// the forces there have balanced but for a share of the weight. Both in the mean over time: soil at rest on a
// grid trembles without getting anywhere. Its points then stop, and keep place, stress and volume. What they
// give to nodes and cells is kept from the first step of their sleep, and the nodes that they reach are held:
// for what is still awake around, sleeping soil is rigid.
//
// A block wakes as soon as at its nodes
//   - the force that holds them exceeds the threshold. It is all that does not balance: stress of points that
//     are awake, surface loads, the gradient of the pore pressure, gravity; or
//   - points that are awake arrive with more than twice the threshold of velocity (contact).
// and when a point crosses into it. Both forces are norms over the nodes of a block, sqrt(sum (m a)^2) over
// sqrt(sum (m g)^2), as the out-of-balance force ratio is; falling asleep takes half of the threshold.
// Nothing is lost while asleep: woken points go on from where they stopped.
//
// Error: soil that creeps more slowly than the velocity threshold stands still instead, so a point misses at
// most velocity times duration; and stress keeps the small part of it that was still swinging.
#pragma once

#include <cstdint>
#include <vector>

#include "mpm/transfer.hpp"

namespace polder::mpm {

struct SleepOptions {
  double velocity = 0;  // of nodes, below which they rest [m/s]
  double delay = 0;     // how long they must rest [s]; the mean's time constant is a fifteenth
  double force = 0;     // out of balance, over the weight [-]
};

template <int D>
class Sleep {
 public:
  // transfer: of the skeleton; its list of sleeping blocks is kept here.
  Sleep(const SleepOptions& options, Transfer<D>& transfer) : options_(options), transfer_(transfer) {}

  const SleepOptions& options() const { return options_; }
  // Blocks fall asleep only while this is set (stages of free motion).
  void set_active(bool active) { active_ = active; }

  // Around a sort of the points: who sleeps is carried to the new order, and who is to fall asleep does so,
  // when every point is in the block where it lies. Points that have strayed into sleeping blocks stop as
  // well.
  void before_sort();
  void after_sort(bool renumbered);

  // After the scatter of a step: the nodes that sleeping points reach, where they have changed.
  void find_held();
  // Now and then: who wakes, at once, and who is to fall asleep. v_new: of the nodes under the boundaries,
  // not yet held; g: gravity [m/s2].
  void judge(double dt, double g, const Reals& sums, const Reals& v_old, const Reals& v_new);
  // Sets the velocities of held nodes [slots * 4] to zero.
  void hold(Reals& velocity) const;
  // At the end of a step. True: a block is to fall asleep, sort before the next one.
  bool end_step();
  // What the momentum of the nodes tells and that of the points does not: the change of momentum of sleeping
  // soil at held nodes, where they change by v_new - v_old, of which points keep the share `flip`; and the
  // momentum of points that have been stopped. Since the last call [kg m/s].
  void count_held(const Reals& v_old, double flip);
  Point<D> take_stopped();

  void wake_all();
  void wake(const std::vector<std::uint8_t>& blocks);  // those marked

  long points() const { return points_; }                      // asleep now
  std::int64_t skipped() const { return skipped_; }            // particle-steps not made
  std::int64_t times_asleep() const { return times_asleep_; }  // blocks put to sleep, and woken
  std::int64_t times_woken() const { return times_woken_; }

  // What a checkpoint keeps: sleeping blocks by their place among the occupied ones, for how long the others
  // have rested [s], and the rest.
  struct State {
    std::vector<int> asleep, falling;
    Reals quiet, means;
    double since_look = 0;
    std::int64_t steps = 0, skipped = 0, times_asleep = 0, times_woken = 0;
  };
  State state() const;
  void restore(const State& state);

 private:
  // Steps between two looks: a wave takes longer through a block. Not a multiple of the periods, of two and
  // four steps, in which nodes tremble.
  static constexpr int kLook = 7;
  static constexpr int kMean = 2 * D;                // numbers a node: mean velocity [m/s], mean force [N]
  static constexpr int kReach = Grid<D>::kSide + 2;  // nodes [-1, kReach) of a block that its points reach
  struct Motion {
    double force = 0, weight = 0;  // squared [N2]
    double speed = 0;              // largest, squared [m2/s2]
  };
  void average(double dt, const Reals& sums, const Reals& v_old, const Reals& v_new);
  Motion motion_of(int block, double g, const Reals& sums) const;
  std::vector<int> count_points() const;
  void stop_points(int block);
  void changed();

  SleepOptions options_;
  Transfer<D>& transfer_;
  bool active_ = false;
  bool stale_ = false;               // held nodes do not belong to the present sleepers
  Reals quiet_;                      // occupied blocks: for how long they have rested [s]
  std::vector<std::uint8_t> falls_;  // who falls asleep at the next sort
  std::vector<std::uint8_t> wakes_;  // work space
  Reals means_;                      // nodes [slots * kMean]
  std::vector<int> held_;            // slots
  Reals held_mass_;                  // of the sleeping soil there [kg]
  std::vector<int> counts_;          // points of the occupied blocks, before a sort
  std::vector<int> numbers_;         // of these blocks
  double since_look_ = 0;            // [s]
  std::int64_t steps_ = 0, skipped_ = 0, times_asleep_ = 0, times_woken_ = 0;
  long points_ = 0;
  Point<D> stopped_{};
};

extern template class Sleep<2>;
extern template class Sleep<3>;

}  // namespace polder::mpm
