// A fluid on material points of its own, on the grid of a skeleton: the second layer of two-layer
// formulations.
//
// The points keep their mass and volume; they carry no stress. A step in the order in which a formulation
// calls it:
//
//   Skeleton::sort()   sorts the points of the layer too (Skeleton::attach)
//   follow_grid()      after a sort
//   scatter()          mass, momentum and drag of the points at the nodes; velocity_old
//   ...                the formulation writes velocity(); constrain() under the boundaries
//   gather()           velocities (affine, or a blend of FLIP and PIC) and motion of the points
//
// Boundaries are those of the fluid: it slips along walls, and passes where a side is open.
#pragma once

#include "mpm/boundary_set.hpp"
#include "mpm/transfer.hpp"

namespace polder::mpm {

template <int D>
class FluidLayer {
 public:
  static constexpr int kSum = Transfer<D>::kSum;        // numbers a node in sums()
  static constexpr int kVector = Transfer<D>::kVector;  // and in velocities
  static constexpr int kDrag = Transfer<D>::kVolume;    // where the drag of the points sits [N s/m]

  // `grid` must outlive the layer. flip: share of FLIP in the blend where velocities are not affine.
  FluidLayer(const Grid<D>& grid, Space space, ShapeKind shape, AffineKind affine, double flip,
             BoundarySet<D> boundaries);
  FluidLayer(const FluidLayer&) = delete;
  FluidLayer& operator=(const FluidLayer&) = delete;

  // Name, density_solid (of the fluid) and points are the caller's; `wet` must be 1.
  ParticleSet<D>& points() { return points_; }
  const ParticleSet<D>& points() const { return points_; }

  // Room for the nodal fields after the grid has changed; harmless otherwise.
  void follow_grid();
  void scatter();
  // Volume of the fluid in cells by the overlap of the points' domains [slots].
  void scatter_volume(Reals& cells) { mpm::scatter_volume(transfer_, cells); }
  // Drag of a unit of volume of the fluid in each cell, for scatter() [slots, Pa s/m2]; must outlive it.
  void set_cell_drag(const Reals& drag) { transfer_.weight.of_cell = &drag; }
  void set_flip(double flip) { flip_ = flip; }
  void constrain(double time, double dt, Reals& velocity);
  // Throws NumericalError where a point runs away.
  MoveResult gather(double time, double dt);
  // Moves the points, not their velocities; see mpm::shift_points.
  double shift(const Reals& displacement, double most) { return shift_points(transfer_, displacement, most); }
  AffineKind affine() const { return affine_; }

  const Reals& sums() const { return sums_; }
  const Reals& velocity_old() const { return v_old_; }
  Reals& velocity() { return v_new_; }
  const Reals& velocity() const { return v_new_; }
  // Bit d of a slot: component d is held by a wall.
  const std::vector<std::uint8_t>& held_components() const { return boundaries_.held_components(); }

 private:
  const Grid<D>& grid_;
  AffineKind affine_;
  double flip_;
  ParticleSet<D> points_;
  BoundarySet<D> boundaries_;
  Transfer<D> transfer_;
  Reals sums_, v_old_, v_new_;
  std::uint64_t revision_ = 0;
};

extern template class FluidLayer<2>;
extern template class FluidLayer<3>;

}  // namespace polder::mpm
