#include "fdm/stencil_level.hpp"

#include <algorithm>

namespace polder::fdm {

void add_scaled(Reals& y, double a, const Reals& x) {
  double* __restrict py = y.data();
  const double* __restrict px = x.data();
  const int n = static_cast<int>(y.size());
  for (int i = 0; i < n; ++i) py[i] += a * px[i];
}

void combine(Reals& y, double a, const Reals& x, double b, const Reals& z) {
  double* __restrict py = y.data();
  const double* px = x.data();
  const double* pz = z.data();
  const int n = static_cast<int>(y.size());
#pragma GCC ivdep
  for (int i = 0; i < n; ++i) py[i] = a * px[i] + b * pz[i];
}

void multiply(const Reals& a, const Reals& x, Reals& y) {
  const double* __restrict pa = a.data();
  const double* __restrict px = x.data();
  double* __restrict py = y.data();
  const int n = static_cast<int>(y.size());
  for (int i = 0; i < n; ++i) py[i] = pa[i] * px[i];
}

namespace {

// f(c, sum of link * x over the neighbours) for the cells of a row.
template <int D, class Level, class Row, class F>
inline void stencil(const Level& a, const Row& row, const double* __restrict x, const F& f) {
  const double* __restrict t0 = a.link[0].data();
  const double* __restrict t1 = a.link[1].data();
  const double* __restrict d1 = a.link_down[1].data();
  const double* __restrict x1 = x + row.up[1];
  const double* __restrict y1 = x - row.down[1];
  const int begin = row.begin, end = row.end;
  if constexpr (D == 2) {
#pragma GCC ivdep
    for (int c = begin; c < end; ++c)
      f(c, t0[c] * x[c + 1] + t0[c - 1] * x[c - 1] + (t1[c] * x1[c] + d1[c] * y1[c]));
  } else {
    const double* __restrict t2 = a.link[2].data();
    const double* __restrict d2 = a.link_down[2].data();
    const double* __restrict x2 = x + row.up[2];
    const double* __restrict y2 = x - row.down[2];
#pragma GCC ivdep
    for (int c = begin; c < end; ++c)
      f(c, t0[c] * x[c + 1] + t0[c - 1] * x[c - 1] + (t1[c] * x1[c] + d1[c] * y1[c]) +
               (t2[c] * x2[c] + d2[c] * y2[c]));
  }
}

}  // namespace

// ---- building

template <int D>
StencilLevel<D>::StencilLevel(const Index<D>& box, const std::vector<Index<D>>& active_cells) : size(box) {
  int lines = 1;
  for (int d = 1; d < D; ++d) lines *= box[d];
  std::vector<int> first(lines, box[0]), last(lines, -1);
  for (const Index<D>& c : active_cells) {
    const int line = line_number(c);
    first[line] = std::min(first[line], c[0]);
    last[line] = std::max(last[line], c[0]);
  }
  // A row longer than its neighbour reads past the neighbour's ends, at most so far beyond the arrays' ends.
  const int margin = box[0] + 2;
  int at = margin;
  row_at.assign(lines, -1);
  for (int line = 0; line < lines; ++line) {
    if (last[line] < 0) continue;
    row_at[line] = static_cast<int>(rows.size());
    Row row{};
    row.begin = at + 1;
    row.end = row.begin + last[line] - first[line] + 1;
    row.x = first[line];
    for (int d = 1, rest = line; d < D; ++d) {
      row.line[d] = rest % box[d];
      rest /= box[d];
    }
    at = row.end + 1;
    rows.push_back(row);
  }
  for (Row& row : rows)
    for (int d = 1; d < D; ++d)
      for (int step : {-1, 1}) {
        Index<D> line = row.line;
        line[d] += step;
        const int number = line_number(line);
        const int other = number < 0 ? -1 : row_at[number];
        if (other < 0) continue;  // there are no links either: the distance 0 serves
        const Row& to = rows[other];
        const int distance = (to.begin - to.x) - (row.begin - row.x);
        (step > 0 ? row.up : row.down)[d] = step * distance;
      }
  const int length = at + margin;
  active.assign(length, 0);
  for (const Index<D>& c : active_cells) active[position(c)] = 1;
  cells = static_cast<int>(std::count(active.begin(), active.end(), 1));
  for (int d = 0; d < D; ++d) link[d].assign(length, 0);
  for (int d = 1; d < D; ++d) link_down[d].assign(length, 0);
  for (Reals* a : {&sink, &diagonal, &weight, &rhs, &x, &p, &z, &q, &v, &smoothed}) a->assign(length, 0);
}

template <int D>
int StencilLevel<D>::line_number(const Index<D>& line) const {
  int n = 0;
  for (int d = D - 1; d > 0; --d) {
    if (line[d] < 0 || line[d] >= size[d]) return -1;
    n = n * size[d] + line[d];
  }
  return n;
}

template <int D>
int StencilLevel<D>::position(const Index<D>& index) const {
  const int line = line_number(index);
  const int row = line < 0 ? -1 : row_at[line];
  if (row < 0) return -1;
  const int p = rows[row].begin + index[0] - rows[row].x;
  return p >= rows[row].begin && p < rows[row].end ? p : -1;
}

template <int D>
StencilLevel<D> StencilLevel<D>::coarser(const StencilLevel& fine) {
  Index<D> size;
  for (int d = 0; d < D; ++d) size[d] = (fine.size[d] + (1 << fine.shift[d]) - 1) >> fine.shift[d];
  std::vector<Index<D>> cells, parent_line;
  for (const Row& row : fine.rows) {
    Index<D> parent{};
    for (int d = 1; d < D; ++d) parent[d] = row.line[d] >> fine.shift[d];
    parent_line.push_back(parent);
    for (int c = row.begin; c < row.end; ++c) {
      if (!fine.active[c]) continue;
      parent[0] = (row.x + c - row.begin) >> fine.shift[0];
      cells.push_back(parent);
    }
  }
  StencilLevel coarse(size, cells);
  // Children by parent: a stable counting sort, so that sums run over them in the order of the rows.
  std::vector<int> parent_row;
  for (const Index<D>& line : parent_line) parent_row.push_back(coarse.row_at[coarse.line_number(line)]);
  coarse.first_child.assign(coarse.rows.size() + 1, 0);
  for (int r : parent_row) ++coarse.first_child[r + 1];
  for (std::size_t r = 0; r < coarse.rows.size(); ++r) coarse.first_child[r + 1] += coarse.first_child[r];
  std::vector<int> next(coarse.first_child.begin(), coarse.first_child.end() - 1);
  coarse.children.resize(fine.rows.size());
  for (int r = 0; r < static_cast<int>(fine.rows.size()); ++r) coarse.children[next[parent_row[r]]++] = r;
  return coarse;
}

template <int D>
void StencilLevel<D>::finish_values() {
  for (const Row& row : rows)
    for (int d = 1; d < D; ++d) {
      Index<D> line = row.line;
      --line[d];
      const int number = line_number(line);
      if (number < 0 || row_at[number] < 0) continue;
      const Row& below = rows[row_at[number]];
      const int from = std::max(row.begin, below.begin + row.down[d]);
      const int to = std::min(row.end, below.end + row.down[d]);
      for (int c = from; c < to; ++c) link_down[d][c] = link[d][c - row.down[d]];
    }
  for (const Row& row : rows)
    for (int c = row.begin; c < row.end; ++c) {
      double sum = sink[c] + link[0][c] + link[0][c - 1];
      for (int d = 1; d < D; ++d) sum += link[d][c] + link_down[d][c];
      diagonal[c] = sum;
      weight[c] = active[c] && sum > 0 ? kDamping / sum : 0;
    }
}

// ---- sweeps

template <int D>
void StencilLevel<D>::apply(const Reals& in, Reals& out) const {
  for_rows(cells, static_cast<int>(rows.size()), [&](int row) {
    const double* __restrict px = in.data();
    const double* __restrict diagonal = this->diagonal.data();
    double* __restrict py = out.data();
    stencil<D>(*this, rows[row], px,
               [=](int c, double neighbours) { py[c] = diagonal[c] * px[c] - neighbours; });
  });
}

template <int D>
void StencilLevel<D>::residual(const Reals& b, const Reals& in, Reals& out) const {
  for_rows(cells, static_cast<int>(rows.size()), [&](int row) {
    const double* __restrict px = in.data();
    const double* __restrict pb = b.data();
    const double* __restrict diagonal = this->diagonal.data();
    double* __restrict pr = out.data();
    stencil<D>(*this, rows[row], px,
               [=](int c, double neighbours) { pr[c] = pb[c] - diagonal[c] * px[c] + neighbours; });
  });
}

template <int D>
void StencilLevel<D>::smooth(const Reals& b, const Reals& in, Reals& out) const {
  for_rows(cells, static_cast<int>(rows.size()), [&](int row) {
    const double* __restrict px = in.data();
    const double* __restrict pb = b.data();
    const double* __restrict weight = this->weight.data();
    double* __restrict py = out.data();
    // x + weight (b - A x), for weight * diagonal = damping wherever a cell is active
    stencil<D>(*this, rows[row], px, [=](int c, double neighbours) {
      py[c] = (1 - kDamping) * px[c] + weight[c] * (pb[c] + neighbours);
    });
  });
}

template <int D>
void StencilLevel<D>::sum_children(const StencilLevel& fine, const Reals& in, StencilLevel& coarse,
                                   Reals& out) {
  for_rows(fine.cells, static_cast<int>(coarse.rows.size()), [&](int row) {
    const Row& to = coarse.rows[row];
    double* __restrict sum = out.data() + to.begin - to.x;
    std::fill(out.begin() + to.begin, out.begin() + to.end, 0.0);
    for (int k = coarse.first_child[row]; k < coarse.first_child[row + 1]; ++k) {
      const Row& from = fine.rows[coarse.children[k]];
      const double* __restrict value = in.data() + from.begin - from.x;
      const int begin = from.x, end = from.x + from.end - from.begin;
      if (fine.shift[0] == 1)  // beyond the ends of the row there is one position of padding that holds zero
        for (int x = begin >> 1; x <= (end - 1) >> 1; ++x) sum[x] += value[2 * x] + value[2 * x + 1];
      else
        for (int x = begin; x < end; ++x) sum[x] += value[x];
    }
  });
}

template <int D>
void StencilLevel<D>::add_parents(const StencilLevel& coarse, const Reals& in, const StencilLevel& fine,
                                  Reals& out) {
  for_rows(fine.cells, static_cast<int>(coarse.rows.size()), [&](int row) {
    const double* __restrict value = in.data() + coarse.rows[row].begin - coarse.rows[row].x;
    for (int k = coarse.first_child[row]; k < coarse.first_child[row + 1]; ++k) {
      const Row& to = fine.rows[coarse.children[k]];
      double* __restrict sum = out.data() + to.begin - to.x;
      const int begin = to.x, end = to.x + to.end - to.begin;
      if (fine.shift[0] == 1)  // may write to the padding, which never counts
        for (int i = begin >> 1; i <= (end - 1) >> 1; ++i) {
          sum[2 * i] += value[i];
          sum[2 * i + 1] += value[i];
        }
      else
        for (int i = begin; i < end; ++i) sum[i] += value[i];
    }
  });
}

template struct StencilLevel<2>;
template struct StencilLevel<3>;

}  // namespace polder::fdm
