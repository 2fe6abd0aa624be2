#include "fdm/direct_solver.hpp"

#include <algorithm>

namespace polder::fdm {
namespace {

// Up to here column by column; beyond, the dense blocks of the supernodal code pay
// (docs/validation/solvers.md).
template <int D>
constexpr int kSimplicialCells = D == 2 ? 50000 : 10000;

}  // namespace

template <int D>
void DirectSolver<D>::analyse(const Connectivity<D>& connectivity) {
  const int n = static_cast<int>(connectivity.cells.size());
  defect_.analyse(connectivity);
  std::vector<Cholesky::Pair> pairs;
  for (const auto& [low, high] : defect_.links()) pairs.push_back({low, high});
  off_diagonal_.resize(pairs.size());
  cholesky_ = Cholesky(method_.value_or(CholeskyMethod{.supernodal = n > kSimplicialCells<D>}));
  if (n > 0) cholesky_.analyse(n, pairs);
  ++this->counts_.structures;
}

template <int D>
SolveReport DirectSolver<D>::solve(const SystemValues& system, const Accuracy& accuracy,
                                   std::span<double> x) {
  ++this->counts_.systems;
  std::fill(x.begin(), x.end(), 0.0);
  const double b = defect_.start(system);
  if (x.empty() || b <= accuracy.floor) return {};
  for (std::size_t k = 0; k < off_diagonal_.size(); ++k) off_diagonal_[k] = -system.link[k];
  this->counts_.factors += cholesky_.factorise(defect_.diagonal(), off_diagonal_);
  return defect_.refine(
      system, accuracy, b, "sparse Cholesky", x,
      [&](std::span<const double> rhs, std::span<double> solution) { cholesky_.solve(rhs, solution); });
}

template class DirectSolver<2>;
template class DirectSolver<3>;

}  // namespace polder::fdm
