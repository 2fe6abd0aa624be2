#include "fdm/linear_system.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/error.hpp"
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

namespace {

// Multigrid above the limit, and sparse Cholesky where multigrid does not converge (contrast and anisotropy
// together can be too much for its plain aggregates). Which one answers depends on the system alone.
template <int D>
class AutomaticSolver final : public LinearSolver<D> {
 public:
  const char* name() const override { return small_ ? direct_.name() : multigrid_.name(); }
  void analyse(const Connectivity<D>& connectivity) override {
    small_ = static_cast<int>(connectivity.cells.size()) <= kDirectLimit;
    connectivity_ = connectivity;
    direct_ready_ = false;
    if (small_)
      prepare_direct();
    else
      multigrid_.analyse(connectivity);
  }
  SolveReport solve(const SystemValues& system, const Accuracy& accuracy, std::span<double> x) override {
    if (!small_) {
      try {
        return multigrid_.solve(system, accuracy, x);
      } catch (const NumericalError&) {
        if (!direct_ready_) prepare_direct();  // throws in its turn if the system has no solution
      }
    }
    return direct_.solve(system, accuracy, x);
  }

 private:
  void prepare_direct() {
    direct_.analyse(connectivity_);
    direct_ready_ = true;
  }

  Connectivity<D> connectivity_;
  DirectSolver<D> direct_;
  Multigrid<D> multigrid_;
  bool small_ = true;
  bool direct_ready_ = false;
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
