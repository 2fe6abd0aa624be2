#include "fdm/aggregation_multigrid.hpp"

#include <algorithm>

namespace polder::fdm {
namespace {

constexpr double kEnough =
    1.0 / 16;  // squared gain of the first coarse step that makes the second one superfluous

}  // namespace

// Galerkin values for piecewise constant transfer: sums over the aggregates.
template <int D>
void AggregationMultigrid<D>::coarse_values(int l) {
  const Level& fine = this->levels_[l];
  Level& coarse = this->levels_[l + 1];
  std::fill(coarse.sink.begin(), coarse.sink.end(), 0.0);
  for (Reals& t : coarse.link) std::fill(t.begin(), t.end(), 0.0);
  const int mask = (1 << fine.shift[0]) - 1;
  for (int r = 0; r < static_cast<int>(coarse.rows.size()); ++r) {
    const int origin = coarse.rows[r].begin - coarse.rows[r].x;
    for (int k = coarse.first_child[r]; k < coarse.first_child[r + 1]; ++k) {
      const Row& row = fine.rows[coarse.children[k]];
      std::array<bool, D> last{};  // whether the row is the last of its aggregate along the axis
      for (int d = 1; d < D; ++d) last[d] = ((row.line[d] + 1) & ((1 << fine.shift[d]) - 1)) == 0;
      for (int c = row.begin; c < row.end; ++c) {
        const int x = row.x + c - row.begin;
        const int parent = origin + (x >> fine.shift[0]);
        coarse.sink[parent] += fine.sink[c];
        if ((x & mask) == mask) coarse.link[0][parent] += fine.link[0][c];
        for (int d = 1; d < D; ++d)
          if (last[d]) coarse.link[d][parent] += fine.link[d][c];
      }
    }
  }
}

// x = (approximate inverse) b: smooth, correct on the coarser level, smooth.
template <int D>
void AggregationMultigrid<D>::cycle(int l, const Reals& b, Reals& x) {
  if (l + 1 == this->levels()) return this->solve_coarsest(b, x);
  Level& f = this->levels_[l];
  multiply(f.weight, b, f.smoothed);
  f.residual(b, f.smoothed, f.q);
  Level& c = this->levels_[l + 1];
  Level::sum_children(f, f.q, c, c.rhs);
  coarse_correction(l + 1);
  Level::add_parents(c, c.x, f, f.smoothed);
  f.smooth(b, f.smoothed, x);
}

// Two steps of flexible conjugate gradients for the level's system, from `rhs` to `x`.
template <int D>
void AggregationMultigrid<D>::coarse_correction(int l) {
  Level& c = this->levels_[l];
  if (l + 1 == this->levels()) return this->solve_coarsest(c.rhs, c.x);
  cycle(l, c.rhs, c.p);
  c.apply(c.p, c.v);
  const double energy = dot(c.p, c.v);
  const double step = energy > 0 ? dot(c.p, c.rhs) / energy : 0;
  const double before = dot(c.rhs, c.rhs);
  add_scaled(c.rhs, -step, c.v);
  if (energy <= 0 || dot(c.rhs, c.rhs) <= kEnough * before) {
    combine(c.x, step, c.p, 0, c.p);
    return;
  }
  cycle(l, c.rhs, c.z);
  c.apply(c.z, c.q);
  const double coupling = dot(c.z, c.v);
  const double second = dot(c.z, c.q) - coupling * coupling / energy;
  const double step2 = second > 0 ? dot(c.z, c.rhs) / second : 0;
  combine(c.x, step - coupling * step2 / energy, c.p, step2, c.z);
}

template class AggregationMultigrid<2>;
template class AggregationMultigrid<3>;

}  // namespace polder::fdm
