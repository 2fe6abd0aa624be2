#include "fdm/multigrid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "core/error.hpp"
#include "core/threads.hpp"
#include "fdm/loops.hpp"

namespace polder::fdm {
namespace {

constexpr double kDamping = 0.75;    // of the Jacobi smoother
constexpr int kCoarsestCells = 160;  // solved directly from here on
constexpr int kMaxIterations = 200;
constexpr double kEnough =
    1.0 / 16;  // squared gain of the first coarse step that makes the second one superfluous

// Rows of a level: on several threads once the level is large.
template <class F>
void for_rows(int cells, int rows, const F& f) {
  if (cells < kParallelFrom)
    for (int r = 0; r < rows; ++r) f(r);
  else
    parallel_for(rows, f);
}

void add_scaled(Reals& y, double a, const Reals& x) {
  double* __restrict py = y.data();
  const double* __restrict px = x.data();
  const int n = static_cast<int>(y.size());
  for (int i = 0; i < n; ++i) py[i] += a * px[i];
}

}  // namespace

// ---- hierarchy
// ------------------------------------------------------------------------------------------------------

template <int D>
int Multigrid<D>::Level::position(const Index<D>& index) const {
  int p = 0;
  for (int d = 0; d < D; ++d) p += (index[d] + 1) * stride[d];
  return p;
}

template <int D>
typename Multigrid<D>::Level Multigrid<D>::make_level(const Index<D>& size) {
  Level level;
  level.size = size;
  int padded = 1;
  for (int d = 0; d < D; ++d) {
    level.stride[d] = padded;
    padded *= size[d] + 2;
  }
  level.active.assign(padded, 0);
  for (Reals& t : level.link) t.assign(padded, 0);
  for (Reals* a : {&level.sink, &level.diagonal, &level.weight, &level.rhs, &level.x, &level.p, &level.z,
                   &level.q, &level.v})
    a->assign(padded, 0);
  return level;
}

template <int D>
void Multigrid<D>::finish_shape(Level& level) {
  level.cells = static_cast<int>(std::count(level.active.begin(), level.active.end(), 1));
  level.rows.clear();
  const int rows = static_cast<int>(level.active.size()) / level.stride[1];
  for (int r = 0; r < rows; ++r) {
    const auto begin = level.active.begin() + r * level.stride[1];
    const auto end = begin + level.stride[1];
    const auto first = std::find(begin, end, 1);
    if (first == end) continue;
    auto last = end;
    while (!*(last - 1)) --last;
    level.rows.push_back({static_cast<int>(first - level.active.begin()),
                          static_cast<int>(last - level.active.begin()), r * level.stride[1] + 1});
  }
}

// Aggregates are squares or cubes; an axis along which nearly all cells are weakly linked is left alone, and
// a single strong axis gets aggregates of four in a row.
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
  for (int d = 0; d < D; ++d) strong += shift[d] = 3 * weak[d] <= 2 * level.cells;
  if (strong == 1)
    for (int& s : shift) s *= 2;
  if (strong == 0) shift.fill(1);
  return shift;
}

template <int D>
typename Multigrid<D>::Level Multigrid<D>::make_coarse(const Level& fine) {
  Index<D> size;
  for (int d = 0; d < D; ++d) size[d] = (fine.size[d] + (1 << fine.shift[d]) - 1) >> fine.shift[d];
  Level coarse = make_level(size);
  std::vector<int> parent_origin;  // of each fine row
  for (const Row& row : fine.rows) {
    int parent = 1, rest = row.origin;
    for (int d = D - 1; d > 0; --d) {
      parent += (((rest / fine.stride[d] - 1) >> fine.shift[d]) + 1) * coarse.stride[d];
      rest %= fine.stride[d];
    }
    parent_origin.push_back(parent);
    for (int c = row.begin; c < row.end; ++c)
      if (fine.active[c]) coarse.active[parent + ((c - row.origin) >> fine.shift[0])] = 1;
  }
  finish_shape(coarse);
  // Children by parent: a stable counting sort, so that sums run over them in the order of the rows.
  std::vector<int> row_at(coarse.active.size() / coarse.stride[1], -1);
  for (int r = 0; r < static_cast<int>(coarse.rows.size()); ++r)
    row_at[coarse.rows[r].origin / coarse.stride[1]] = r;
  coarse.first_child.assign(coarse.rows.size() + 1, 0);
  for (int parent : parent_origin) ++coarse.first_child[row_at[parent / coarse.stride[1]] + 1];
  for (std::size_t r = 0; r < coarse.rows.size(); ++r) coarse.first_child[r + 1] += coarse.first_child[r];
  std::vector<int> next(coarse.first_child.begin(), coarse.first_child.end() - 1);
  coarse.children.resize(fine.rows.size());
  for (int r = 0; r < static_cast<int>(fine.rows.size()); ++r)
    coarse.children[next[row_at[parent_origin[r] / coarse.stride[1]]]++] = r;
  return coarse;
}

template <int D>
void Multigrid<D>::coarse_values(const Level& fine, Level& coarse) {
  std::fill(coarse.sink.begin(), coarse.sink.end(), 0.0);
  for (Reals& t : coarse.link) std::fill(t.begin(), t.end(), 0.0);
  for (int r = 0; r < static_cast<int>(coarse.rows.size()); ++r)
    for (int k = coarse.first_child[r]; k < coarse.first_child[r + 1]; ++k) {
      const Row& row = fine.rows[coarse.children[k]];
      std::array<bool, D> last{};  // whether the row is the last of its aggregate along the axis
      for (int d = 1, rest = row.origin; d < D; ++d) {
        const int index = (d + 1 < D ? rest % fine.stride[d + 1 < D ? d + 1 : d] : rest) / fine.stride[d] - 1;
        const int mask = (1 << fine.shift[d]) - 1;
        last[d] = (index & mask) == mask;
      }
      const int mask = (1 << fine.shift[0]) - 1;
      for (int c = row.begin; c < row.end; ++c) {
        const int x = c - row.origin;
        const int parent = coarse.rows[r].origin + (x >> fine.shift[0]);
        coarse.sink[parent] += fine.sink[c];
        if ((x & mask) == mask) coarse.link[0][parent] += fine.link[0][c];
        for (int d = 1; d < D; ++d)
          if (last[d]) coarse.link[d][parent] += fine.link[d][c];
      }
    }
  finish_values(coarse);
}

template <int D>
void Multigrid<D>::finish_values(Level& level) {
  for (const Row& row : level.rows)
    for (int c = row.begin; c < row.end; ++c) {
      double sum = level.sink[c];
      for (int d = 0; d < D; ++d) sum += level.link[d][c] + level.link[d][c - level.stride[d]];
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
  levels_.push_back(make_level(size));
  Level& finest = levels_[0];
  position_.clear();
  link_position_.clear();
  for (Index<D> c : connectivity.cells) {
    for (int d = 0; d < D; ++d) c[d] -= lower[d];
    position_.push_back(finest.position(c));
    finest.active[position_.back()] = 1;
  }
  for (const auto& link : connectivity.links) link_position_.push_back(position_[link.low]);
  finish_shape(finest);
  for (Reals* a : {&x_, &r_, &z_, &p_, &q_}) a->assign(finest.active.size(), 0);
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
  std::size_t l = 0;
  for (; levels_[l].cells > kCoarsestCells; ++l) {
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
  for (int p : coarsest_cells_)
    for (int d = 0; d < D; ++d)
      if (number[p + c.stride[d]] >= 0) {
        coarsest_links_.push_back({d, p});
        pairs.push_back({number[p], number[p + c.stride[d]]});
      }
  coarsest_.analyse(static_cast<int>(coarsest_cells_.size()), pairs);
  coarsest_diagonal_.resize(coarsest_cells_.size());
  coarsest_rhs_.resize(coarsest_cells_.size());
  coarsest_x_.resize(coarsest_cells_.size());
  coarsest_off_diagonal_.resize(pairs.size());
  coarsest_stale_ = false;
}

// ---- kernels
// --------------------------------------------------------------------------------------------------------

template <int D>
void Multigrid<D>::apply(const Level& a, const Reals& x, Reals& y) {
  for_rows(a.cells, static_cast<int>(a.rows.size()), [&](int r) {
    const double* __restrict px = x.data();
    const double* __restrict diagonal = a.diagonal.data();
    double* __restrict py = y.data();
    std::array<const double*, D> t;
    for (int d = 0; d < D; ++d) t[d] = a.link[d].data();
    const auto stride = a.stride;
    const int end = a.rows[r].end;
    for (int c = a.rows[r].begin; c < end; ++c) {
      double sum = diagonal[c] * px[c];
      for (int d = 0; d < D; ++d) {
        const int s = d == 0 ? 1 : stride[d];
        sum -= t[d][c] * px[c + s] + t[d][c - s] * px[c - s];
      }
      py[c] = sum;
    }
  });
}

template <int D>
void Multigrid<D>::residual(const Level& a, const Reals& b, const Reals& x, Reals& r) {
  for_rows(a.cells, static_cast<int>(a.rows.size()), [&](int row) {
    const double* __restrict px = x.data();
    const double* __restrict pb = b.data();
    const double* __restrict diagonal = a.diagonal.data();
    double* __restrict pr = r.data();
    std::array<const double*, D> t;
    for (int d = 0; d < D; ++d) t[d] = a.link[d].data();
    const auto stride = a.stride;
    const int end = a.rows[row].end;
    for (int c = a.rows[row].begin; c < end; ++c) {
      double sum = pb[c] - diagonal[c] * px[c];
      for (int d = 0; d < D; ++d) {
        const int s = d == 0 ? 1 : stride[d];
        sum += t[d][c] * px[c + s] + t[d][c - s] * px[c - s];
      }
      pr[c] = sum;
    }
  });
}

template <int D>
void Multigrid<D>::smooth(const Level& a, const Reals& r, Reals& x) {
  for_rows(a.cells, static_cast<int>(a.rows.size()), [&](int row) {
    for (int c = a.rows[row].begin; c < a.rows[row].end; ++c) x[c] += a.weight[c] * r[c];
  });
}

template <int D>
void Multigrid<D>::restrict_to(const Level& fine, const Reals& r, Level& coarse) {
  for_rows(fine.cells, static_cast<int>(coarse.rows.size()), [&](int row) {
    const Row& to = coarse.rows[row];
    double* const sum = coarse.rhs.data() + to.origin;
    std::fill(coarse.rhs.begin() + to.begin, coarse.rhs.begin() + to.end, 0.0);
    for (int k = coarse.first_child[row]; k < coarse.first_child[row + 1]; ++k) {
      const Row& from = fine.rows[coarse.children[k]];
      const double* const value = r.data() + from.origin;
      const int begin = from.begin - from.origin, end = from.end - from.origin, shift = fine.shift[0];
      if (shift == 1)  // cells beyond the row's ends hold zeros, and the padding has room for one
        for (int x = begin >> 1; x <= (end - 1) >> 1; ++x) sum[x] += value[2 * x] + value[2 * x + 1];
      else
        for (int x = begin; x < end; ++x) sum[x >> shift] += value[x];
    }
  });
}

template <int D>
void Multigrid<D>::prolong_add(const Level& coarse, const Level& fine, Reals& x) {
  for_rows(fine.cells, static_cast<int>(coarse.rows.size()), [&](int row) {
    const double* const value = coarse.x.data() + coarse.rows[row].origin;
    for (int k = coarse.first_child[row]; k < coarse.first_child[row + 1]; ++k) {
      const Row& to = fine.rows[coarse.children[k]];
      const int shift = fine.shift[0];
      for (int c = to.begin; c < to.end; ++c)
        if (fine.active[c]) x[c] += value[(c - to.origin) >> shift];
    }
  });
}

// ---- cycle
// ----------------------------------------------------------------------------------------------------------

template <int D>
void Multigrid<D>::solve_coarsest(const Reals& b, Reals& x) {
  for (std::size_t i = 0; i < coarsest_cells_.size(); ++i) coarsest_rhs_[i] = b[coarsest_cells_[i]];
  coarsest_.solve(coarsest_rhs_, coarsest_x_);
  for (std::size_t i = 0; i < coarsest_cells_.size(); ++i) x[coarsest_cells_[i]] = coarsest_x_[i];
}

// x = (approximate inverse) b: smooth, correct on the coarser level, smooth.
template <int D>
void Multigrid<D>::cycle(int l, const Reals& b, Reals& x) {
  if (l + 1 == levels()) return solve_coarsest(b, x);
  Level& f = levels_[l];
  for_rows(f.cells, static_cast<int>(f.rows.size()), [&](int row) {
    for (int c = f.rows[row].begin; c < f.rows[row].end; ++c) x[c] = f.weight[c] * b[c];
  });
  residual(f, b, x, f.q);
  restrict_to(f, f.q, levels_[l + 1]);
  coarse_correction(l + 1);
  prolong_add(levels_[l + 1], f, x);
  residual(f, b, x, f.q);
  smooth(f, f.q, x);
}

// Two steps of flexible conjugate gradients for the level's system, from `rhs` to `x`.
template <int D>
void Multigrid<D>::coarse_correction(int l) {
  Level& c = levels_[l];
  if (l + 1 == levels()) return solve_coarsest(c.rhs, c.x);
  cycle(l, c.rhs, c.p);
  apply(c, c.p, c.v);
  const double energy = dot(c.p, c.v);
  const double step = energy > 0 ? dot(c.p, c.rhs) / energy : 0;
  const double before = dot(c.rhs, c.rhs);
  add_scaled(c.rhs, -step, c.v);
  const int n = static_cast<int>(c.x.size());
  if (energy <= 0 || dot(c.rhs, c.rhs) <= kEnough * before) {
    for (int i = 0; i < n; ++i) c.x[i] = step * c.p[i];
    return;
  }
  cycle(l, c.rhs, c.z);
  apply(c, c.z, c.q);
  const double coupling = dot(c.z, c.v);
  const double second = dot(c.z, c.q) - coupling * coupling / energy;
  const double step2 = second > 0 ? dot(c.z, c.rhs) / second : 0;
  const double step1 = step - coupling * step2 / energy;
  for (int i = 0; i < n; ++i) c.x[i] = step1 * c.p[i] + step2 * c.z[i];
}

template <int D>
SolveReport Multigrid<D>::solve(const SystemValues& system, const Accuracy& accuracy, std::span<double> x) {
  std::fill(x.begin(), x.end(), 0.0);
  if (levels_.empty()) return {};
  refresh(system);
  const Level& a = levels_[0];
  Reals& work = levels_[0].v;
  const int n = static_cast<int>(r_.size());
  for (std::size_t i = 0; i < position_.size(); ++i) r_[position_[i]] = system.rhs[i];
  const auto scaled_norm = [&] {  // || D^-1/2 r ||
    for (int i = 0; i < n; ++i) work[i] = a.weight[i] * r_[i];
    return std::sqrt(dot(r_, work) / kDamping);
  };
  const auto solution_norm = [&] {  // || D^1/2 x ||
    for (int i = 0; i < n; ++i) work[i] = a.diagonal[i] * x_[i];
    return std::sqrt(dot(x_, work));
  };
  const double b = scaled_norm();
  if (b <= accuracy.floor) return {};
  if (!std::isfinite(b)) throw NumericalError("pressure equation: the right-hand side is not finite");
  std::fill(x_.begin(), x_.end(), 0.0);
  const double goal = accuracy.tolerance * b + accuracy.floor;
  const double eps = std::numeric_limits<double>::epsilon();

  double r = b, rz = 1, step = 0;
  for (int iteration = 1; iteration <= kMaxIterations; ++iteration) {
    cycle(0, r_, z_);
    const double rz_new = dot(r_, z_);
    // Polak-Ribiere: beta = z.(r - r_old) / (z_old.r_old) with r - r_old = -step A p.
    const double beta = iteration > 1 ? -step * dot(z_, q_) / rz : 0;
    rz = rz_new;
    for (int i = 0; i < n; ++i) p_[i] = z_[i] + beta * p_[i];
    apply(a, p_, q_);
    const double energy = dot(p_, q_);
    if (!(energy > 0))
      throw NumericalError("pressure equation: conjugate gradients met a direction of energy " +
                           number(energy) + " after " + std::to_string(iteration) +
                           " iterations; the matrix is not positive definite");
    step = dot(p_, r_) / energy;
    add_scaled(x_, step, p_);
    add_scaled(r_, -step, q_);
    r = scaled_norm();
    if (r <= goal || (r <= 1e-4 * b && r <= goal + 16 * eps * solution_norm())) {
      for (std::size_t i = 0; i < position_.size(); ++i) x[i] = x_[position_[i]];
      return {.iterations = iteration, .residual = r / b};
    }
  }
  throw NumericalError("pressure equation: residual " + number(r / b) +
                       " of the right-hand side after " + std::to_string(kMaxIterations) +
                       " iterations, wanted " + number(accuracy.tolerance) + " (" +
                       std::to_string(position_.size()) + " cells)");
}

template class Multigrid<2>;
template class Multigrid<3>;

}  // namespace polder::fdm
