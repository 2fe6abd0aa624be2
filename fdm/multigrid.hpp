// Conjugate gradients preconditioned with an aggregation multigrid K-cycle, on the box around the active
// cells.
//
// A coarse cell is an aggregate of 2^D fine cells (4 along one axis only where that axis is much stiffer) and
// the transfer is piecewise constant. The Galerkin coarse matrix is then again a five- or seven-point system
// whose links and sinks are plain sums, for any mask and any coefficients. The poor scaling of constant
// transfer is cured by the K-cycle: on every coarse level two steps of flexible conjugate gradients, the
// second left out when the first has gained a factor four (Notay 2010, "An aggregation-based algebraic
// multigrid method", ETNA 37, section 3). Smoother: one sweep of damped Jacobi before and after. The coarsest
// level is solved directly. The outer iteration is flexible (Polak-Ribiere) because a K-cycle is not a fixed
// linear map.
//
// Cells are stored in rows along x, each from its first to its last active cell with one cell of padding at
// either end; the neighbour across another axis is at a distance that is constant along a row. Where a
// neighbour is missing the link is zero and the position read instead is harmless. Values at inactive
// positions stay finite and never count: diagonal, links and right-hand side are zero there. All sums have a
// fixed shape, so the bits do not depend on the number of threads.
#pragma once

#include <array>
#include <utility>
#include <vector>

#include "fdm/cholesky.hpp"
#include "fdm/linear_system.hpp"

namespace polder::fdm {

template <int D>
class Multigrid final : public LinearSolver<D> {
 public:
  const char* name() const override { return "conjugate gradients with aggregation multigrid"; }
  void analyse(const Connectivity<D>& connectivity) override;
  SolveReport solve(const SystemValues& system, const Accuracy& accuracy, std::span<double> x) override;
  int levels() const { return static_cast<int>(levels_.size()); }

 private:
  static constexpr double kDamping = 0.75;  // of the Jacobi smoother

  // A run of cells along x, from the first to the last active cell of a grid line; between them may be
  // inactive ones.
  struct Row {
    int begin, end;               // positions in the level's arrays
    int x;                        // index along x of the first cell
    Index<D> line;                // indices along the other axes (line[0] unused)
    std::array<int, D> up, down;  // distance in the arrays to the cell above and below along each axis
  };
  struct Level {
    Index<D> size{};  // cells of the box
    int cells = 0;    // active
    std::vector<Row> rows;
    std::vector<unsigned char> active;
    std::vector<int> row_at;         // row of each grid line of the box, -1 if it is empty
    std::vector<int> children;       // rows of the finer level, grouped by the rows of this one
    std::vector<int> first_child;    // of each row in `children`, and the end
    std::array<int, D> shift{};      // 2^shift cells of this level make one of the next, along each axis
    std::array<Reals, D> link;       // to the neighbour above
    std::array<Reals, D> link_down;  // to the neighbour below (along x: link of the position before)
    Reals sink, diagonal;
    Reals weight;                        // damping / diagonal, 0 where inactive
    Reals rhs, x, p, z, q, v, smoothed;  // work
    int line_number(const Index<D>& line) const;
    int position(const Index<D>& index) const;  // -1 if outside the rows
  };

  // From the active cells, any order.
  static Level make_level(const Index<D>& size, const std::vector<Index<D>>& cells);
  static void finish_values(Level& level);
  static std::array<int, D> aggregate_shape(const Level& level);
  static Level make_coarse(const Level& fine);
  static void coarse_values(const Level& fine, Level& coarse);
  void refresh(const SystemValues& system);
  void set_coarsest();

  static void apply(const Level& a, const Reals& x, Reals& y);
  static void residual(const Level& a, const Reals& b, const Reals& x, Reals& r);
  static void smooth(const Level& a, const Reals& b, const Reals& x, Reals& y);  // y = x + weight (b - A x)
  static void restrict_to(const Level& fine, const Reals& r, Level& coarse);
  static void prolong_add(const Level& coarse, const Level& fine, Reals& x);
  void cycle(int l, const Reals& b, Reals& x);
  void coarse_correction(int l);
  void solve_coarsest(const Reals& b, Reals& x);

  Connectivity<D> connectivity_;
  std::vector<Level> levels_;
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
