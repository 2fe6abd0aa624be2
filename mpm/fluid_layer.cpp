#include "mpm/fluid_layer.hpp"

#include "core/threads.hpp"
#include "mpm/runaway.hpp"

namespace polder::mpm {

template <int D>
FluidLayer<D>::FluidLayer(const Grid<D>& grid, Space space, ShapeKind shape, AffineKind affine, double flip,
                          BoundarySet<D> boundaries)
    : grid_(grid), affine_(affine), flip_(flip), boundaries_(std::move(boundaries)) {
  transfer_.grid = &grid_;
  transfer_.space = space;
  transfer_.shape = shape;
  transfer_.bodies = {{&points_, nullptr, 0.0}};
}

template <int D>
void FluidLayer<D>::follow_grid() {
  if (revision_ == grid_.revision()) return;
  revision_ = grid_.revision();
  transfer_.resize();
  for (Reals* r : {&v_old_, &v_new_}) r->assign(static_cast<std::size_t>(grid_.slots()) * kVector, 0.0);
  boundaries_.update(grid_);
}

template <int D>
void FluidLayer<D>::scatter() {
  scatter_fluid(transfer_, affine_, sums_, v_old_);
}

template <int D>
void FluidLayer<D>::constrain(double time, double dt, Reals& velocity) {
  boundaries_.apply(time, dt, sums_, velocity, false, false);
}

template <int D>
MoveResult FluidLayer<D>::gather(double time, double dt) {
  MoveOptions o;
  o.dt = dt;
  o.affine = affine_;
  o.update_velocity = affine_ == AffineKind::none;
  o.flip = flip_;
  const MoveResult r = update_stress_and_move(transfer_, o, &v_old_, v_new_);
  require_calm(r, points_, time, dt);
  return r;
}

template class FluidLayer<2>;
template class FluidLayer<3>;

}  // namespace polder::mpm
