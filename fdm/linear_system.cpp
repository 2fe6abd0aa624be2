#include "fdm/linear_system.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/threads.hpp"
#include "fdm/direct_solver.hpp"
#include "fdm/multigrid.hpp"

namespace polder::fdm {
namespace {

constexpr std::size_t kChunk = 4096;

double dot_chunk(const double* a, const double* b, std::size_t n) {
  double lane[8] = {};
  const std::size_t whole = n / 8 * 8;
  for (std::size_t i = 0; i < whole; i += 8)
    for (std::size_t k = 0; k < 8; ++k) lane[k] += a[i + k] * b[i + k];
  for (std::size_t i = whole; i < n; ++i) lane[i - whole] += a[i] * b[i];
  return ((lane[0] + lane[4]) + (lane[2] + lane[6])) + ((lane[1] + lane[5]) + (lane[3] + lane[7]));
}

}  // namespace

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2e", value);
  return text;
}

double dot(std::span<const double> a, std::span<const double> b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); i += kChunk)
    sum += dot_chunk(a.data() + i, b.data() + i, std::min(kChunk, a.size() - i));
  return sum;
}

// Measured with a levee-shaped mask, new values in every solution (bench/pressure_solvers).
template <>
int direct_limit<2>() {
  return 1500;
}
template <>
int direct_limit<3>() {
  return 1000;
}

namespace {

// Chooses between the two at every analysis.
template <int D>
class AutomaticSolver final : public LinearSolver<D> {
 public:
  const char* name() const override { return chosen_ ? chosen_->name() : "automatic"; }
  void analyse(const Connectivity<D>& connectivity) override {
    const bool small = static_cast<int>(connectivity.cells.size()) <= direct_limit<D>();
    if (small)
      chosen_ = &direct_;
    else
      chosen_ = &multigrid_;
    chosen_->analyse(connectivity);
  }
  SolveReport solve(const SystemValues& system, const Accuracy& accuracy, std::span<double> x) override {
    return chosen_->solve(system, accuracy, x);
  }

 private:
  DirectSolver<D> direct_;
  Multigrid<D> multigrid_;
  LinearSolver<D>* chosen_ = nullptr;
};

}  // namespace

template <int D>
std::unique_ptr<LinearSolver<D>> make_solver(SolverKind kind) {
  if (kind == SolverKind::direct) return std::make_unique<DirectSolver<D>>();
  if (kind == SolverKind::multigrid) return std::make_unique<Multigrid<D>>();
  return std::make_unique<AutomaticSolver<D>>();
}

template std::unique_ptr<LinearSolver<2>> make_solver<2>(SolverKind);
template std::unique_ptr<LinearSolver<3>> make_solver<3>(SolverKind);

}  // namespace polder::fdm
