// Direct solver for the pressure system: sparse Cholesky, refined until the accuracy is reached.
#pragma once

#include <optional>
#include <vector>

#include "fdm/cholesky.hpp"
#include "fdm/defect.hpp"
#include "fdm/linear_system.hpp"

namespace polder::fdm {

template <int D>
class DirectSolver final : public LinearSolver<D> {
 public:
  // Without a method: the fastest one for the size.
  explicit DirectSolver(std::optional<CholeskyMethod> method = {}) : method_(method) {}
  const char* name() const override { return "sparse Cholesky"; }
  void analyse(const Connectivity<D>& connectivity) override;
  SolveReport solve(const SystemValues& system, const Accuracy& accuracy, std::span<double> x) override;

 private:
  std::optional<CholeskyMethod> method_;
  Cholesky cholesky_;
  Defect defect_;
  std::vector<double> off_diagonal_;
};

extern template class DirectSolver<2>;
extern template class DirectSolver<3>;

}  // namespace polder::fdm
