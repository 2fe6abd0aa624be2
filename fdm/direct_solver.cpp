#include "fdm/direct_solver.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "core/error.hpp"

namespace polder::fdm {

template <int D>
void DirectSolver<D>::analyse(const Connectivity<D>& connectivity) {
  const std::size_t n = connectivity.cells.size();
  pairs_.clear();
  for (const auto& link : connectivity.links) pairs_.push_back({link.low, link.high});
  diagonal_.resize(n);
  residual_.resize(n);
  correction_.resize(n);
  off_diagonal_.resize(pairs_.size());
  if (n > 0) cholesky_.analyse(static_cast<int>(n), pairs_);
}

template <int D>
void DirectSolver<D>::residual(const SystemValues& system, std::span<const double> x) {
  for (std::size_t i = 0; i < x.size(); ++i) residual_[i] = system.rhs[i] - system.sink[i] * x[i];
  for (std::size_t k = 0; k < pairs_.size(); ++k) {
    const double flow = system.link[k] * (x[pairs_[k].first] - x[pairs_[k].second]);
    residual_[pairs_[k].first] -= flow;
    residual_[pairs_[k].second] += flow;
  }
}

template <int D>
SolveReport DirectSolver<D>::solve(const SystemValues& system, const Accuracy& accuracy,
                                   std::span<double> x) {
  const std::size_t n = diagonal_.size();
  const double eps = std::numeric_limits<double>::epsilon();
  std::fill(x.begin(), x.end(), 0.0);
  std::copy(system.sink.begin(), system.sink.end(), diagonal_.begin());
  for (std::size_t k = 0; k < pairs_.size(); ++k) {
    diagonal_[pairs_[k].first] += system.link[k];
    diagonal_[pairs_[k].second] += system.link[k];
    off_diagonal_[k] = -system.link[k];
  }
  double b2 = 0;
  for (std::size_t i = 0; i < n; ++i) b2 += system.rhs[i] * system.rhs[i] / diagonal_[i];
  const double b = std::sqrt(b2);
  if (n == 0 || b <= accuracy.floor) return {};

  cholesky_.factorise(diagonal_, off_diagonal_);
  cholesky_.solve(system.rhs, x);
  double r = 0;
  for (int refinement = 0;; ++refinement) {
    residual(system, x);
    double r2 = 0, x2 = 0;
    for (std::size_t i = 0; i < n; ++i) {
      r2 += residual_[i] * residual_[i] / diagonal_[i];
      x2 += x[i] * x[i] * diagonal_[i];
    }
    r = std::sqrt(r2);
    if (r <= accuracy.tolerance * b + accuracy.floor + 16 * eps * std::sqrt(x2)) break;
    if (refinement == 2)
      throw NumericalError("pressure equation: sparse Cholesky leaves a residual of " + number(r / b) +
                           " of the right-hand side after refinement (" + std::to_string(n) + " cells)");
    cholesky_.solve(residual_, correction_);
    for (std::size_t i = 0; i < n; ++i) x[i] += correction_[i];
  }
  return {.iterations = 0, .residual = r / b};
}

template class DirectSolver<2>;
template class DirectSolver<3>;

}  // namespace polder::fdm
