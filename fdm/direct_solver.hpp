// Solves the pressure system by sparse Cholesky factorisation: best for small systems, and the oracle for the
// other. The residual is checked; one step of iterative refinement follows where it is not small enough.
#pragma once

#include <vector>

#include "fdm/cholesky.hpp"
#include "fdm/linear_system.hpp"

namespace polder::fdm {

template <int D>
class DirectSolver final : public LinearSolver<D> {
 public:
  const char* name() const override { return "sparse Cholesky"; }
  void analyse(const Connectivity<D>& connectivity) override;
  SolveReport solve(const SystemValues& system, const Accuracy& accuracy, std::span<double> x) override;

 private:
  void residual(const SystemValues& system, std::span<const double> x);

  Cholesky cholesky_;
  std::vector<Cholesky::Pair> pairs_;
  std::vector<double> diagonal_, off_diagonal_, residual_, correction_;
};

extern template class DirectSolver<2>;
extern template class DirectSolver<3>;

}  // namespace polder::fdm
