// The defect of an approximate solution in the units of Accuracy (fdm/linear_system.hpp), and the refinement
// of a direct solution until it is small enough.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "fdm/linear_system.hpp"

namespace polder::fdm {

class Defect {
 public:
  template <int D>
  void analyse(const Connectivity<D>& connectivity) {
    links_.clear();
    for (const auto& link : connectivity.links) links_.push_back({link.low, link.high});
    diagonal_.resize(connectivity.cells.size());
    residual_.resize(connectivity.cells.size());
    correction_.resize(connectivity.cells.size());
  }
  std::span<const std::pair<int, int>> links() const { return links_; }

  // Takes the diagonal from the system and returns || D^-1/2 b ||.
  double start(const SystemValues& system);
  std::span<const double> diagonal() const { return diagonal_; }

  // x from solve(rhs, x), and at most twice solve(defect, correction) until the accuracy is reached. rhs_norm
  // is what start() returned; `method` names the solver in the NumericalError otherwise thrown.
  template <class Solve>
  SolveReport refine(const SystemValues& system, const Accuracy& accuracy, double rhs_norm,
                     const char* method, std::span<double> x, const Solve& solve) {
    solve(system.rhs, x);
    for (int refinement = 0; !reached(system, accuracy, rhs_norm, x); ++refinement) {
      if (refinement == 2) fail(rhs_norm, method);
      solve(residual_, correction_);
      for (std::size_t i = 0; i < x.size(); ++i) x[i] += correction_[i];
    }
    return {.iterations = 0, .residual = norm_ / rhs_norm};
  }

 private:
  bool reached(const SystemValues& system, const Accuracy& accuracy, double rhs_norm,
               std::span<const double> x);
  [[noreturn]] void fail(double rhs_norm, const char* method) const;

  std::vector<std::pair<int, int>> links_;
  std::vector<double> diagonal_, residual_, correction_;
  double norm_ = 0;  // || D^-1/2 r ||
};

}  // namespace polder::fdm
