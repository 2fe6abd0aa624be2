#include "bench/geometric_multigrid.hpp"

#include <algorithm>

namespace polder::fdm {
namespace {

// Conductance of a link and half a link to a sibling (none: the value sits in the cell itself) in series.
double half_way(double link, double sibling) {
  return sibling > 0 ? 2 * link * sibling / (link + 2 * sibling) : link;
}

}  // namespace

template <int D>
typename GeometricMultigrid<D>::Ways GeometricMultigrid<D>::ways(const Level& fine, const Row& row,
                                                                 int c) const {
  Ways w;
  for (int d = 0; d < D; ++d) {
    if (fine.shift[d] == 0) continue;
    const int index = d == 0 ? row.x + c - row.begin : row.line[d];
    const double up = fine.link[d][c], down = d == 0 ? fine.link[0][c - 1] : fine.link_down[d][c];
    const bool odd = index & 1;
    w.in[d] = odd ? down : up;
    w.out[d] = odd ? up : down;
    w.out_at[d] = d == 0 ? (odd ? c + 1 : c - 1) : (odd ? c + row.up[d] : c - row.down[d]);
  }
  return w;
}

template <int D>
void GeometricMultigrid<D>::set_weights(const Level& fine, Transfer& t) const {
  const std::size_t n = fine.active.size();
  for (Reals* a : {&t.own, &t.interpolated}) a->resize(n);
  for (int d = 0; d < D; ++d)
    for (Reals* a : {&t.weight[d], &t.weight_of_out[d]}) a->assign(n, 0);
  const int rows = static_cast<int>(fine.rows.size());
  for_rows(fine.cells, rows, [&](int r) {
    const Row& row = fine.rows[r];
    for (int c = row.begin; c < row.end; ++c) {
      const Ways w = ways(fine, row, c);
      double strongest = 0, sum = 0;
      for (double in : w.in) strongest = std::max(strongest, in);
      for (int d = 0; d < D; ++d) {
        if (!(w.out[d] > 0 && w.in[d] > 0)) continue;
        // The sibling of the cell out there lies further out: its link has the same direction.
        const int beyond = w.out_at[d];
        const bool up = ((d == 0 ? row.x + c - row.begin : row.line[d]) & 1) != 0;
        const double sibling =
            up ? fine.link[d][beyond] : (d == 0 ? fine.link[0][beyond - 1] : fine.link_down[d][beyond]);
        const double g = half_way(w.out[d], sibling);
        t.weight[d][c] = g / (g + 2 * strongest);
        sum += t.weight[d][c];
      }
      const double towards_zero = strongest > 0 ? fine.sink[c] / (fine.sink[c] + 2 * strongest) : 0;
      if (sum > 1) {
        for (int d = 0; d < D; ++d) t.weight[d][c] /= sum;
        sum = 1;
      }
      t.own[c] = std::max(0.0, 1 - sum - towards_zero);
    }
  });
  for_rows(fine.cells, rows, [&](int r) {
    const Row& row = fine.rows[r];
    for (int c = row.begin; c < row.end; ++c) {
      const Ways w = ways(fine, row, c);
      for (int d = 0; d < D; ++d)
        if (w.out[d] > 0) t.weight_of_out[d][c] = t.weight[d][w.out_at[d]];
    }
  });
}

template <int D>
void GeometricMultigrid<D>::coarse_links(const Level& fine, Level& coarse) const {
  std::fill(coarse.sink.begin(), coarse.sink.end(), 0.0);
  for (Reals& t : coarse.link) std::fill(t.begin(), t.end(), 0.0);
  for_rows(fine.cells, static_cast<int>(coarse.rows.size()), [&](int r) {
    const int origin = coarse.rows[r].begin - coarse.rows[r].x;
    for (int k = coarse.first_child[r]; k < coarse.first_child[r + 1]; ++k) {
      const Row& row = fine.rows[coarse.children[k]];
      for (int c = row.begin; c < row.end; ++c) {
        if (!fine.active[c]) continue;
        const int x = row.x + c - row.begin;
        const int parent = origin + (x >> fine.shift[0]);
        const Ways w = ways(fine, row, c);
        double strongest = 0;
        bool side = false;
        for (int d = 0; d < D; ++d) {
          strongest = std::max(strongest, w.in[d]);
          const double up = fine.link[d][c];
          side = side || up == 0 || (d == 0 ? fine.link[0][c - 1] : fine.link_down[d][c]) == 0;
          if (fine.shift[d] == 0) {
            coarse.link[d][parent] += up;
          } else if (((d == 0 ? x : row.line[d]) & 1) && up > 0) {
            coarse.link[d][parent] += 0.5 * up;
          }
        }
        coarse.sink[parent] += side ? half_way(fine.sink[c], strongest) : fine.sink[c];
      }
    }
  });
}

template <int D>
void GeometricMultigrid<D>::coarse_values(int l) {
  if (static_cast<int>(transfers_.size()) <= l) transfers_.resize(l + 1);
  set_weights(this->levels_[l], transfers_[l]);
  coarse_links(this->levels_[l], this->levels_[l + 1]);
}

// out += interpolation of the coarse values, given as `in` in all cells of each coarse cell.
template <int D>
void GeometricMultigrid<D>::spread(const Level& fine, const Transfer& t, const Reals& in, Reals& out) {
  for_rows(fine.cells, static_cast<int>(fine.rows.size()), [&](int r) {
    const Row& row = fine.rows[r];
    const double* __restrict e = in.data();
    const double* __restrict own = t.own.data();
    const double* __restrict w0 = t.weight[0].data();
    double* __restrict to = out.data();
    const int step = (row.x - row.begin) & 1;  // a cell is odd if its position plus this is
    for (int c = row.begin; c < row.end; ++c)
      to[c] += own[c] * e[c] + w0[c] * (((c + step) & 1) ? e[c + 1] : e[c - 1]);
    for (int d = 1; d < D; ++d) {
      if (fine.shift[d] == 0) continue;
      const double* __restrict w = t.weight[d].data();
      const double* __restrict beyond = e + ((row.line[d] & 1) ? row.up[d] : -row.down[d]);
      for (int c = row.begin; c < row.end; ++c) to[c] += w[c] * beyond[c];
    }
  });
}

// The transpose: what the cells give to the coarse cells, as values that are then summed over each.
template <int D>
void GeometricMultigrid<D>::collect(const Level& fine, const Transfer& t, const Reals& in, Reals& out) {
  for_rows(fine.cells, static_cast<int>(fine.rows.size()), [&](int r) {
    const Row& row = fine.rows[r];
    const double* __restrict e = in.data();
    const double* __restrict own = t.own.data();
    const double* __restrict w0 = t.weight_of_out[0].data();
    double* __restrict to = out.data();
    const int step = (row.x - row.begin) & 1;
    for (int c = row.begin; c < row.end; ++c)
      to[c] = own[c] * e[c] + w0[c] * (((c + step) & 1) ? e[c + 1] : e[c - 1]);
    for (int d = 1; d < D; ++d) {
      if (fine.shift[d] == 0) continue;
      const double* __restrict w = t.weight_of_out[d].data();
      const double* __restrict beyond = e + ((row.line[d] & 1) ? row.up[d] : -row.down[d]);
      for (int c = row.begin; c < row.end; ++c) to[c] += w[c] * beyond[c];
    }
  });
}

template <int D>
void GeometricMultigrid<D>::cycle(int l, const Reals& b, Reals& x) {
  if (l + 1 == this->levels()) return this->solve_coarsest(b, x);
  Level& f = this->levels_[l];
  Level& c = this->levels_[l + 1];
  Transfer& t = transfers_[l];
  multiply(f.weight, b, f.smoothed);
  f.residual(b, f.smoothed, f.q);
  collect(f, t, f.q, f.v);
  Level::sum_children(f, f.v, c, c.rhs);
  cycle(l + 1, c.rhs, c.x);
  std::fill(t.interpolated.begin(), t.interpolated.end(), 0.0);
  Level::add_parents(c, c.x, f, t.interpolated);
  spread(f, t, t.interpolated, f.smoothed);
  f.smooth(b, f.smoothed, x);
}

template class GeometricMultigrid<2>;
template class GeometricMultigrid<3>;

}  // namespace polder::fdm
