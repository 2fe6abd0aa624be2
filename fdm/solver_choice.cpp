// The solver of a pressure system, chosen from its size, mask and contrast. The limits are measured
// (bench/solver_table.cpp, docs/validation/solvers.md).
//   full box, values that vary along one axis only     cosine transform
//   up to kDirectCells cells                           sparse Cholesky
//   plane and rough, up to kRoughCells                 sparse Cholesky
//   else                                               multigrid
// and sparse Cholesky where multigrid does not converge. Which one answers depends on the system alone.
#include <algorithm>

#include "core/error.hpp"
#include "fdm/aggregation_multigrid.hpp"
#include "fdm/cosine_solver.hpp"
#include "fdm/direct_solver.hpp"

namespace polder::fdm {
namespace {

constexpr int kDirectCells = 500;
constexpr int kRoughCells = 30000;
// A system is rough when more than this part of the cells is torn: bound more than kTear times more strongly
// to the cells around their aggregate than within it, so that a constant on the aggregate says nothing about
// them. Layers, cores and mild scatter stay below 1 %, a contrast of 1e5 or more from cell to cell is above.
constexpr double kRoughPart = 0.05;
constexpr double kTear = 30;

template <int D>
class AutomaticSolver final : public LinearSolver<D> {
 public:
  const char* name() const override { return last_->name(); }

  void analyse(const Connectivity<D>& connectivity) override {
    ++this->counts_.structures;
    connectivity_ = connectivity;
    direct_ready_ = multigrid_ready_ = false;
    cosine_.analyse(connectivity);
    lower_.fill(0);
    for (int d = 0; d < D && !connectivity.cells.empty(); ++d)
      lower_[d] = std::min_element(connectivity.cells.begin(), connectivity.cells.end(),
                                   [d](const auto& a, const auto& b) { return a[d] < b[d]; })
                      ->at(d);
    within_.resize(connectivity.cells.size());
    beyond_.resize(connectivity.cells.size());
    last_ = small() ? static_cast<LinearSolver<D>*>(&direct_) : &multigrid_;
  }

  // Of the cells as a whole, whoever solved; factors of the direct solver.
  SolverCounts counts() const override {
    return {this->counts_.systems, this->counts_.structures, direct_.counts().factors};
  }

  SolveReport solve(const SystemValues& system, const Accuracy& accuracy, std::span<double> x) override {
    ++this->counts_.systems;
    if (cosine_.full_box() && cosine_.applies(system)) {
      try {
        last_ = &cosine_;
        return cosine_.solve(system, accuracy, x);
      } catch (const NumericalError&) {  // the others throw in their turn if the system has no solution
      }
    }
    if (small() || (D == 2 && x.size() <= kRoughCells && rough(system)))
      return solve_directly(system, accuracy, x);
    try {
      if (!multigrid_ready_) multigrid_.analyse(connectivity_);
      multigrid_ready_ = true;
      last_ = &multigrid_;
      return multigrid_.solve(system, accuracy, x);
    } catch (const NumericalError&) {
      return solve_directly(system, accuracy, x);
    }
  }

 private:
  bool small() const { return connectivity_.cells.size() <= kDirectCells; }

  SolveReport solve_directly(const SystemValues& system, const Accuracy& accuracy, std::span<double> x) {
    if (!direct_ready_) direct_.analyse(connectivity_);
    direct_ready_ = true;
    last_ = &direct_;
    return direct_.solve(system, accuracy, x);
  }

  // Strongest link of every cell within its aggregate of 2^D cells, and out of it.
  bool rough(const SystemValues& system) {
    std::fill(within_.begin(), within_.end(), 0.0);
    std::fill(beyond_.begin(), beyond_.end(), 0.0);
    for (std::size_t k = 0; k < connectivity_.links.size(); ++k) {
      const auto& l = connectivity_.links[k];
      auto& strongest = (connectivity_.cells[l.low][l.axis] - lower_[l.axis]) % 2 == 0 ? within_ : beyond_;
      for (int cell : {l.low, l.high}) strongest[cell] = std::max(strongest[cell], system.link[k]);
    }
    std::size_t torn = 0;
    for (std::size_t i = 0; i < within_.size(); ++i)
      torn += within_[i] > 0 && beyond_[i] > kTear * within_[i];
    return static_cast<double>(torn) > kRoughPart * static_cast<double>(within_.size());
  }

  Connectivity<D> connectivity_;
  DirectSolver<D> direct_;
  AggregationMultigrid<D> multigrid_;
  CosineSolver<D> cosine_;
  LinearSolver<D>* last_ = &direct_;
  Index<D> lower_{};
  std::vector<double> within_, beyond_;
  bool direct_ready_ = false, multigrid_ready_ = false;
};

}  // namespace

template <int D>
std::unique_ptr<LinearSolver<D>> make_solver(SolverKind kind) {
  if (kind == SolverKind::direct) return std::make_unique<DirectSolver<D>>();
  if (kind == SolverKind::multigrid) return std::make_unique<AggregationMultigrid<D>>();
  if (kind == SolverKind::cosine) return std::make_unique<CosineSolver<D>>();
  return std::make_unique<AutomaticSolver<D>>();
}

template std::unique_ptr<LinearSolver<2>> make_solver<2>(SolverKind);
template std::unique_ptr<LinearSolver<3>> make_solver<3>(SolverKind);

}  // namespace polder::fdm
