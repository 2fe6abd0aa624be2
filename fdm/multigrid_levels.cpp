// The hierarchy of the multigrid solver: levels, aggregates and their values.
#include <algorithm>

#include "fdm/multigrid.hpp"

namespace polder::fdm {
namespace {

constexpr int kCoarsestCells = 160;  // solved directly from here on

}  // namespace

template <int D>
int Multigrid<D>::Level::line_number(const Index<D>& line) const {
  int n = 0;
  for (int d = D - 1; d > 0; --d) {
    if (line[d] < 0 || line[d] >= size[d]) return -1;
    n = n * size[d] + line[d];
  }
  return n;
}

template <int D>
int Multigrid<D>::Level::position(const Index<D>& index) const {
  const int line = line_number(index);
  const int row = line < 0 ? -1 : row_at[line];
  if (row < 0) return -1;
  const int p = rows[row].begin + index[0] - rows[row].x;
  return p >= rows[row].begin && p < rows[row].end ? p : -1;
}

template <int D>
typename Multigrid<D>::Level Multigrid<D>::make_level(const Index<D>& size,
                                                      const std::vector<Index<D>>& cells) {
  Level level;
  level.size = size;
  int lines = 1;
  for (int d = 1; d < D; ++d) lines *= size[d];
  std::vector<int> first(lines, size[0]), last(lines, -1);
  for (const Index<D>& c : cells) {
    const int line = level.line_number(c);
    first[line] = std::min(first[line], c[0]);
    last[line] = std::max(last[line], c[0]);
  }
  // A row longer than its neighbour reads past the neighbour's ends, at most so far beyond the arrays' ends.
  const int margin = size[0] + 2;
  int position = margin;
  level.row_at.assign(lines, -1);
  for (int line = 0; line < lines; ++line) {
    if (last[line] < 0) continue;
    level.row_at[line] = static_cast<int>(level.rows.size());
    Row row{};
    row.begin = position + 1;
    row.end = row.begin + last[line] - first[line] + 1;
    row.x = first[line];
    for (int d = 1, rest = line; d < D; ++d) {
      row.line[d] = rest % size[d];
      rest /= size[d];
    }
    position = row.end + 1;
    level.rows.push_back(row);
  }
  for (Row& row : level.rows)
    for (int d = 1; d < D; ++d)
      for (int step : {-1, 1}) {
        Index<D> line = row.line;
        line[d] += step;
        const int number = level.line_number(line);
        const int other = number < 0 ? -1 : level.row_at[number];
        if (other < 0) continue;  // there are no links either: the distance 0 serves
        const Row& to = level.rows[other];
        const int distance = (to.begin - to.x) - (row.begin - row.x);
        (step > 0 ? row.up : row.down)[d] = step * distance;
      }
  const int length = position + margin;
  level.active.assign(length, 0);
  for (const Index<D>& c : cells) level.active[level.position(c)] = 1;
  level.cells = static_cast<int>(std::count(level.active.begin(), level.active.end(), 1));
  for (int d = 0; d < D; ++d) level.link[d].assign(length, 0);
  for (int d = 1; d < D; ++d) level.link_down[d].assign(length, 0);
  for (Reals* a : {&level.sink, &level.diagonal, &level.weight, &level.rhs, &level.x, &level.p, &level.z,
                   &level.q, &level.v, &level.smoothed})
    a->assign(length, 0);
  return level;
}

// Aggregates are squares or cubes; an axis along which most cells are weakly linked is left alone. (Four in a
// row along a single stiff axis coarsen faster but need up to four times the iterations, more than they
// save.)
template <int D>
std::array<int, D> Multigrid<D>::aggregate_shape(const Level& level) {
  std::array<int, D> weak{};
  for (const Row& row : level.rows)
    for (int c = row.begin; c < row.end; ++c) {
      double strongest = 0;
      for (int d = 0; d < D; ++d) strongest = std::max(strongest, level.link[d][c]);
      for (int d = 0; d < D; ++d) weak[d] += 3 * level.link[d][c] < strongest;
    }
  std::array<int, D> shift{};
  int strong = 0;
  for (int d = 0; d < D; ++d) {
    shift[d] = 3 * weak[d] <= 2 * level.cells && level.size[d] > 1;
    strong += shift[d];
  }
  if (strong == 0) shift.fill(1);
  return shift;
}

template <int D>
typename Multigrid<D>::Level Multigrid<D>::make_coarse(const Level& fine) {
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
  Level coarse = make_level(size, cells);
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

// Galerkin values for piecewise constant transfer: sums over the aggregates.
template <int D>
void Multigrid<D>::coarse_values(const Level& fine, Level& coarse) {
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
  finish_values(coarse);
}

// Links downwards, diagonal and smoother from links upwards and sinks.
template <int D>
void Multigrid<D>::finish_values(Level& level) {
  for (const Row& row : level.rows)
    for (int d = 1; d < D; ++d) {
      Index<D> line = row.line;
      --line[d];
      const int number = level.line_number(line);
      if (number < 0 || level.row_at[number] < 0) continue;
      const Row& below = level.rows[level.row_at[number]];
      const int from = std::max(row.begin, below.begin + row.down[d]);
      const int to = std::min(row.end, below.end + row.down[d]);
      for (int c = from; c < to; ++c) level.link_down[d][c] = level.link[d][c - row.down[d]];
    }
  for (const Row& row : level.rows)
    for (int c = row.begin; c < row.end; ++c) {
      double sum = level.sink[c] + level.link[0][c] + level.link[0][c - 1];
      for (int d = 1; d < D; ++d) sum += level.link[d][c] + level.link_down[d][c];
      level.diagonal[c] = sum;
      level.weight[c] = level.active[c] && sum > 0 ? kDamping / sum : 0;
    }
}

template <int D>
void Multigrid<D>::analyse(const Connectivity<D>& connectivity) {
  connectivity_ = connectivity;
  levels_.clear();
  coarsest_stale_ = true;
  if (connectivity.cells.empty()) return;
  Index<D> lower = connectivity.cells[0], upper = lower;
  for (const Index<D>& c : connectivity.cells)
    for (int d = 0; d < D; ++d) {
      lower[d] = std::min(lower[d], c[d]);
      upper[d] = std::max(upper[d], c[d]);
    }
  Index<D> size;
  for (int d = 0; d < D; ++d) size[d] = upper[d] - lower[d] + 1;
  std::vector<Index<D>> cells = connectivity.cells;
  for (Index<D>& c : cells)
    for (int d = 0; d < D; ++d) c[d] -= lower[d];
  levels_.push_back(make_level(size, cells));
  position_.clear();
  link_position_.clear();
  for (const Index<D>& c : cells) position_.push_back(levels_[0].position(c));
  for (const auto& link : connectivity.links) link_position_.push_back(position_[link.low]);
  for (Reals* a : {&x_, &r_, &z_, &p_, &q_}) a->assign(levels_[0].active.size(), 0);
}

// New values on all levels. The shape of the aggregates follows from the values alone, never from earlier
// ones.
template <int D>
void Multigrid<D>::refresh(const SystemValues& system) {
  Level& finest = levels_[0];
  for (std::size_t i = 0; i < position_.size(); ++i) finest.sink[position_[i]] = system.sink[i];
  for (std::size_t k = 0; k < link_position_.size(); ++k)
    finest.link[connectivity_.links[k].axis][link_position_[k]] = system.link[k];
  finish_values(finest);
  for (std::size_t l = 0; levels_[l].cells > kCoarsestCells; ++l) {
    const std::array<int, D> shift = aggregate_shape(levels_[l]);
    if (l + 1 >= levels_.size() || shift != levels_[l].shift) {
      levels_.resize(l + 1);
      levels_[l].shift = shift;
      Level coarse = make_coarse(levels_[l]);
      levels_.push_back(std::move(coarse));
      coarsest_stale_ = true;
    }
    coarse_values(levels_[l], levels_[l + 1]);
  }
  if (coarsest_stale_) set_coarsest();
  const Level& c = levels_.back();
  for (std::size_t i = 0; i < coarsest_cells_.size(); ++i)
    coarsest_diagonal_[i] = c.diagonal[coarsest_cells_[i]];
  for (std::size_t k = 0; k < coarsest_links_.size(); ++k)
    coarsest_off_diagonal_[k] = -c.link[coarsest_links_[k].first][coarsest_links_[k].second];
  coarsest_.factorise(coarsest_diagonal_, coarsest_off_diagonal_);
}

template <int D>
void Multigrid<D>::set_coarsest() {
  const Level& c = levels_.back();
  std::vector<int> number(c.active.size(), -1);
  coarsest_cells_.clear();
  coarsest_links_.clear();
  for (int p = 0; p < static_cast<int>(c.active.size()); ++p)
    if (c.active[p]) {
      number[p] = static_cast<int>(coarsest_cells_.size());
      coarsest_cells_.push_back(p);
    }
  std::vector<Cholesky::Pair> pairs;
  for (const Row& row : c.rows)
    for (int p = row.begin; p < row.end; ++p)
      for (int d = 0; d < D; ++d) {
        Index<D> above = row.line;
        above[0] = row.x + p - row.begin;
        ++above[d];
        const int other = c.position(above);
        if (number[p] < 0 || other < 0 || number[other] < 0) continue;
        coarsest_links_.push_back({d, p});
        pairs.push_back({number[p], number[other]});
      }
  coarsest_.analyse(static_cast<int>(coarsest_cells_.size()), pairs);
  coarsest_diagonal_.resize(coarsest_cells_.size());
  coarsest_rhs_.resize(coarsest_cells_.size());
  coarsest_x_.resize(coarsest_cells_.size());
  coarsest_off_diagonal_.resize(pairs.size());
  coarsest_stale_ = false;
}

template class Multigrid<2>;
template class Multigrid<3>;

}  // namespace polder::fdm
