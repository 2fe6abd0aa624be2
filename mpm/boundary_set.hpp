// Mechanical boundaries of the background grid: constraints on nodal velocities.
//
// A boundary acts along a side of the grid, or behind a segment (2D) or a plane patch (3D) inside it. The
// list of constrained nodes is built when the grid's numbering changes and applied in the order of the case
// file, so that at a corner the later boundary has the last word where two prescribe the same component.
//
// Coulomb friction: a node that presses against the boundary loses its normal velocity; the tangential
// velocity falls by at most `coefficient` times that loss. The normal force is what the node's acceleration
// says, so where pore pressure is part of the acceleration it is the effective one. A node of several
// boundaries meets the others first: friction acts on the velocity that they leave.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "core/grid.hpp"

namespace polder::mpm {

// tied: the nodes of the side and those across the grid move alike, as in one of endless equal columns side
// by side; points must not leave through it.
enum class BoundaryKind { free, fixed, roller, friction, velocity, tied };

template <int D>
struct BoundarySpec {
  std::string name;
  BoundaryKind kind = BoundaryKind::roller;
  int side = -1;  // 2 * axis + (0 lower, 1 upper), or -1
  // Restricts the side to its part between the ends; in 2D it may stand alone inside the grid, with the soil
  // to the left, seen from `from` to `to`.
  bool has_segment = false;
  Point<D> from{}, to{};
  // 3D: a plane polygon inside the grid, its corners counter-clockwise seen from the soil; side is -1.
  std::vector<Point<3>> patch{};
  double coefficient = 0;                                   // friction
  std::array<bool, D> prescribed{};                         // velocity: which components
  std::array<std::function<double(double)>, D> velocity{};  // [m/s] at time t
};

template <int D>
class BoundarySet {
 public:
  // Later boundaries overrule earlier ones on the sides they share. Sides without any boundary are free.
  explicit BoundarySet(std::vector<BoundarySpec<D>> specs = {})
      : specs_(std::move(specs)), reaction_(specs_.size()) {}

  const std::vector<BoundarySpec<D>>& specs() const { return specs_; }

  // Friction boundaries hold without slip while this is set (a stage that builds up initial stress).
  void set_sticking(bool sticking) { sticking_ = sticking; }

  // Coefficients of friction count this many times themselves (strength reduction).
  void set_friction_share(double share) { friction_share_ = share; }
  // Walls with a prescribed velocity stand still while this is set (relaxation, where no time passes).
  void set_still(bool still) { still_ = still; }

  // Find the constrained nodes; cheap when the grid has not changed.
  void update(const Grid<D>& grid);

  // Constrain v [slots * 4] at time t. mass [sums, stride 8] turns velocity changes into reactions; with
  // `record` the force of each boundary on the material over dt is kept. `friction` false is for velocities
  // that have friction in them already (corrected ones, the second mapping of MUSL): nodes that it has
  // stopped when it last acted stay so, others keep their tangential velocity. Nodes that friction holds and
  // the mapping lets slip would be pulled back and forth by stresses that do work on that slip, and wet soil
  // on its base started to tremble.
  void apply(double time, double dt, const Reals& sums, Reals& v, bool friction, bool record);

  // Nodes (slots; empty: none) at which saturated soil cannot leave a friction boundary along a side of the
  // grid: the gap would have to fill with water, which does not come through the wall. Their normal velocity
  // is held both ways, and suction of the pore water carries what pulls.
  void set_sealed(std::vector<std::uint8_t> sealed) { sealed_ = std::move(sealed); }

  // Force of boundary i on the material in the last recorded step [N per m thickness, per radian, or N].
  const Point<D>& reaction(int i) const { return reaction_[i]; }

  // Bit d of a slot: its velocity component d is held by a boundary (of friction, the normal one).
  const std::vector<std::uint8_t>& held_components() const { return held_; }

 private:
  struct Node {
    int slot;
    int spec;
    Point<D> normal;       // into the material
    double pressed;        // friction: velocity into the boundary that it has taken away
    bool stopped = false;  // and it has stopped the node when it last acted
  };
  void tie(const Grid<D>& grid, int side);

  std::vector<BoundarySpec<D>> specs_;
  std::vector<Node> nodes_;
  std::vector<std::array<int, 2>> ties_;  // slots
  std::vector<std::uint8_t> held_;
  std::vector<Point<D>> reaction_;
  std::uint64_t revision_ = 0;
  std::vector<std::uint8_t> sealed_;
  bool sticking_ = false;
  bool still_ = false;
  double friction_share_ = 1;
};

extern template class BoundarySet<2>;
extern template class BoundarySet<3>;

}  // namespace polder::mpm
