#include "fdm/multigrid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "core/error.hpp"
#include "core/threads.hpp"

namespace polder::fdm {
namespace {

constexpr int kParallelCells =
    32768;  // a sweep over fewer cells is over before the other threads have started
constexpr int kMaxIterations = 200;
constexpr double kEnough =
    1.0 / 16;  // squared gain of the first coarse step that makes the second one superfluous

// Rows of a level: on several threads once the level is large.
template <class F>
void for_rows(int cells, int rows, const F& f) {
  if (cells < kParallelCells)
    for (int r = 0; r < rows; ++r) f(r);
  else
    parallel_for(rows, f);
}

// y += a x
void add_scaled(Reals& y, double a, const Reals& x) {
  double* __restrict py = y.data();
  const double* __restrict px = x.data();
  const int n = static_cast<int>(y.size());
  for (int i = 0; i < n; ++i) py[i] += a * px[i];
}

// y = a x + b z
void combine(Reals& y, double a, const Reals& x, double b, const Reals& z) {
  double* __restrict py = y.data();
  const double* px = x.data();
  const double* pz = z.data();
  const int n = static_cast<int>(y.size());
#pragma GCC ivdep
  for (int i = 0; i < n; ++i) py[i] = a * px[i] + b * pz[i];
}

// y = a * x, element by element
void multiply(const Reals& a, const Reals& x, Reals& y) {
  const double* __restrict pa = a.data();
  const double* __restrict px = x.data();
  double* __restrict py = y.data();
  const int n = static_cast<int>(y.size());
  for (int i = 0; i < n; ++i) py[i] = pa[i] * px[i];
}

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

// ---- kernels
// --------------------------------------------------------------------------------------------------------

template <int D>
void Multigrid<D>::apply(const Level& a, const Reals& x, Reals& y) {
  for_rows(a.cells, static_cast<int>(a.rows.size()), [&](int row) {
    const double* __restrict px = x.data();
    const double* __restrict diagonal = a.diagonal.data();
    double* __restrict py = y.data();
    stencil<D>(a, a.rows[row], px,
               [=](int c, double neighbours) { py[c] = diagonal[c] * px[c] - neighbours; });
  });
}

template <int D>
void Multigrid<D>::residual(const Level& a, const Reals& b, const Reals& x, Reals& r) {
  for_rows(a.cells, static_cast<int>(a.rows.size()), [&](int row) {
    const double* __restrict px = x.data();
    const double* __restrict pb = b.data();
    const double* __restrict diagonal = a.diagonal.data();
    double* __restrict pr = r.data();
    stencil<D>(a, a.rows[row], px,
               [=](int c, double neighbours) { pr[c] = pb[c] - diagonal[c] * px[c] + neighbours; });
  });
}

template <int D>
void Multigrid<D>::smooth(const Level& a, const Reals& b, const Reals& x, Reals& y) {
  for_rows(a.cells, static_cast<int>(a.rows.size()), [&](int row) {
    const double* __restrict px = x.data();
    const double* __restrict pb = b.data();
    const double* __restrict weight = a.weight.data();
    double* __restrict py = y.data();
    // x + weight (b - A x), for weight * diagonal = damping wherever a cell is active
    stencil<D>(a, a.rows[row], px, [=](int c, double neighbours) {
      py[c] = (1 - kDamping) * px[c] + weight[c] * (pb[c] + neighbours);
    });
  });
}

template <int D>
void Multigrid<D>::restrict_to(const Level& fine, const Reals& r, Level& coarse) {
  for_rows(fine.cells, static_cast<int>(coarse.rows.size()), [&](int row) {
    const Row& to = coarse.rows[row];
    double* __restrict sum = coarse.rhs.data() + to.begin - to.x;
    std::fill(coarse.rhs.begin() + to.begin, coarse.rhs.begin() + to.end, 0.0);
    for (int k = coarse.first_child[row]; k < coarse.first_child[row + 1]; ++k) {
      const Row& from = fine.rows[coarse.children[k]];
      const double* __restrict value = r.data() + from.begin - from.x;
      const int begin = from.x, end = from.x + from.end - from.begin;
      if (fine.shift[0] == 1)  // beyond the ends of the row there is one position of padding that holds zero
        for (int x = begin >> 1; x <= (end - 1) >> 1; ++x) sum[x] += value[2 * x] + value[2 * x + 1];
      else
        for (int x = begin; x < end; ++x) sum[x] += value[x];
    }
  });
}

template <int D>
void Multigrid<D>::prolong_add(const Level& coarse, const Level& fine, Reals& x) {
  for_rows(fine.cells, static_cast<int>(coarse.rows.size()), [&](int row) {
    const double* __restrict value = coarse.x.data() + coarse.rows[row].begin - coarse.rows[row].x;
    for (int k = coarse.first_child[row]; k < coarse.first_child[row + 1]; ++k) {
      const Row& to = fine.rows[coarse.children[k]];
      double* __restrict sum = x.data() + to.begin - to.x;
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
  multiply(f.weight, b, f.smoothed);
  residual(f, b, f.smoothed, f.q);
  restrict_to(f, f.q, levels_[l + 1]);
  coarse_correction(l + 1);
  prolong_add(levels_[l + 1], f, f.smoothed);
  smooth(f, b, f.smoothed, x);
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
  if (energy <= 0 || dot(c.rhs, c.rhs) <= kEnough * before) {
    combine(c.x, step, c.p, 0, c.p);
    return;
  }
  cycle(l, c.rhs, c.z);
  apply(c, c.z, c.q);
  const double coupling = dot(c.z, c.v);
  const double second = dot(c.z, c.q) - coupling * coupling / energy;
  const double step2 = second > 0 ? dot(c.z, c.rhs) / second : 0;
  combine(c.x, step - coupling * step2 / energy, c.p, step2, c.z);
}

template <int D>
SolveReport Multigrid<D>::solve(const SystemValues& system, const Accuracy& accuracy, std::span<double> x) {
  std::fill(x.begin(), x.end(), 0.0);
  if (levels_.empty()) return {};
  refresh(system);
  const Level& a = levels_[0];
  Reals& work = levels_[0].v;
  std::fill(r_.begin(), r_.end(), 0.0);
  for (std::size_t i = 0; i < position_.size(); ++i) r_[position_[i]] = system.rhs[i];
  const auto scaled_norm = [&] {  // || D^-1/2 r ||
    multiply(a.weight, r_, work);
    return std::sqrt(dot(r_, work) / kDamping);
  };
  const auto solution_norm = [&] {  // || D^1/2 x ||
    multiply(a.diagonal, x_, work);
    return std::sqrt(dot(x_, work));
  };
  const double b = scaled_norm();
  if (!std::isfinite(b)) throw NumericalError("pressure equation: the right-hand side is not finite");
  if (b <= accuracy.floor) return {};
  std::fill(x_.begin(), x_.end(), 0.0);
  std::fill(p_.begin(), p_.end(), 0.0);
  const double goal = accuracy.tolerance * b + accuracy.floor;
  const double eps = std::numeric_limits<double>::epsilon();

  double r = b, rz = 1, step = 0;
  for (int iteration = 1; iteration <= kMaxIterations; ++iteration) {
    cycle(0, r_, z_);
    const double rz_new = dot(r_, z_);
    // Polak-Ribiere: beta = z.(r - r_old) / (z_old.r_old) with r - r_old = -step A p.
    const double beta = iteration > 1 ? -step * dot(z_, q_) / rz : 0;
    rz = rz_new;
    combine(p_, 1, z_, beta, p_);
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
  throw NumericalError("pressure equation: residual " + number(r / b) + " of the right-hand side after " +
                       std::to_string(kMaxIterations) + " iterations, wanted " + number(accuracy.tolerance) +
                       " (" + std::to_string(position_.size()) + " cells)");
}

template class Multigrid<2>;
template class Multigrid<3>;

}  // namespace polder::fdm
