// One level of a multigrid hierarchy: a five- or seven-point system on the active cells of a box, and the
// sweeps over it.
//
// Cells are stored in rows along x, each from its first to its last active cell with one cell of padding at
// either end; the neighbour across another axis is at a distance that is constant along a row. Where a
// neighbour is missing the link is zero and the position read instead is harmless. Values at inactive
// positions stay finite and never count: diagonal, links and right-hand side are zero there. All sums have a
// fixed shape, so the bits do not depend on the number of threads.
#pragma once

#include <array>
#include <vector>

#include "core/aligned.hpp"
#include "core/grid.hpp"
#include "core/threads.hpp"

namespace polder::fdm {

template <int D>
struct StencilLevel {
  static constexpr double kDamping = 0.75;  // of the Jacobi smoother

  // A run of cells along x, from the first to the last active cell of a grid line; between them may be
  // inactive ones.
  struct Row {
    int begin, end;               // positions in the level's arrays
    int x;                        // index along x of the first cell
    Index<D> line;                // indices along the other axes (line[0] unused)
    std::array<int, D> up, down;  // distance in the arrays to the cell above and below along each axis
  };

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

  // From the active cells, any order.
  StencilLevel(const Index<D>& box, const std::vector<Index<D>>& active_cells);
  // The level whose cells are the aggregates of 2^shift cells of `fine` along each axis.
  static StencilLevel coarser(const StencilLevel& fine);

  int line_number(const Index<D>& line) const;
  int position(const Index<D>& index) const;  // -1 if outside the rows
  // Links downwards, diagonal and smoother from links upwards and sinks.
  void finish_values();

  void apply(const Reals& in, Reals& out) const;                     // out = A in
  void residual(const Reals& b, const Reals& in, Reals& out) const;  // out = b - A in
  void smooth(const Reals& b, const Reals& in, Reals& out) const;    // out = in + weight (b - A in)
  static void sum_children(const StencilLevel& fine, const Reals& in, StencilLevel& coarse, Reals& out);
  static void add_parents(const StencilLevel& coarse, const Reals& in, const StencilLevel& fine, Reals& out);
};

// Rows of a level: on several threads once the level is large; a sweep over fewer cells is over before the
// other threads have started.
template <class F>
void for_rows(int cells, int rows, const F& f) {
  constexpr int kParallelCells = 32768;
  if (cells < kParallelCells)
    for (int r = 0; r < rows; ++r) f(r);
  else
    parallel_for(rows, f);
}

void add_scaled(Reals& y, double a, const Reals& x);                         // y += a x
void combine(Reals& y, double a, const Reals& x, double b, const Reals& z);  // y = a x + b z
void multiply(const Reals& a, const Reals& x, Reals& y);                     // y = a * x by element

extern template struct StencilLevel<2>;
extern template struct StencilLevel<3>;

}  // namespace polder::fdm
