// Conjugate gradients preconditioned with multigrid: what the two multigrid solvers have in common, the
// hierarchy of levels (fdm/stencil_level.hpp) and the iteration.
//
// The shape of the aggregates follows from the values alone: squares or cubes, but an axis along which most
// cells are weakly linked is not coarsened. The coarsest level is solved directly. The iteration is flexible
// (Polak-Ribiere), because a preconditioner that is itself an iteration is not a fixed linear map.
#pragma once

#include <array>
#include <utility>
#include <vector>

#include "fdm/cholesky.hpp"
#include "fdm/linear_system.hpp"
#include "fdm/stencil_level.hpp"

namespace polder::fdm {

template <int D>
class Multigrid : public LinearSolver<D> {
 public:
  void analyse(const Connectivity<D>& connectivity) override;
  SolveReport solve(const SystemValues& system, const Accuracy& accuracy, std::span<double> x) override;
  int levels() const { return static_cast<int>(levels_.size()); }

 protected:
  using Level = StencilLevel<D>;
  using Row = typename Level::Row;

  // Links upwards and sinks of the coarser level of `l`; called from the finest level on.
  virtual void coarse_values(int l) = 0;
  // x = (approximate inverse of level l) b.
  virtual void cycle(int l, const Reals& b, Reals& x) = 0;
  void solve_coarsest(const Reals& b, Reals& x);

  std::vector<Level> levels_;

 private:
  static std::array<int, D> aggregate_shape(const Level& level);
  void refresh(const SystemValues& system);
  void set_coarsest();

  Connectivity<D> connectivity_;
  std::vector<int> position_;       // of each cell in the finest level
  std::vector<int> link_position_;  // of the low cell of each link
  Cholesky coarsest_;
  bool coarsest_stale_ = true;
  std::vector<int> coarsest_cells_;                  // positions
  std::vector<std::pair<int, int>> coarsest_links_;  // axis, position of the low cell
  std::vector<double> coarsest_diagonal_, coarsest_off_diagonal_, coarsest_rhs_, coarsest_x_;
  Reals x_, r_, z_, p_, q_;
};

extern template class Multigrid<2>;
extern template class Multigrid<3>;

}  // namespace polder::fdm
