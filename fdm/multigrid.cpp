#include "fdm/multigrid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "core/error.hpp"

namespace polder::fdm {
namespace {

constexpr int kMaxIterations = 500;
constexpr int kCoarsestCells = 160;  // solved directly from here on

}  // namespace

template <int D>
void Multigrid<D>::analyse(const Connectivity<D>& connectivity) {
  ++this->counts_.structures;
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
  std::vector<Index<D>> cells = connectivity.cells;
  for (Index<D>& c : cells)
    for (int d = 0; d < D; ++d) c[d] -= lower[d];
  levels_.emplace_back(size, cells);
  position_.clear();
  link_position_.clear();
  for (const Index<D>& c : cells) position_.push_back(levels_[0].position(c));
  for (const auto& link : connectivity.links) link_position_.push_back(position_[link.low]);
  for (Reals* a : {&x_, &r_, &z_, &p_, &q_}) a->assign(levels_[0].active.size(), 0);
}

// Aggregates are squares or cubes; an axis along which most cells are weakly linked is left alone. (Four in a
// row along a single stiff axis coarsen faster but need up to four times the iterations, more than they
// save.)
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
  for (int d = 0; d < D; ++d) {
    shift[d] = 3 * weak[d] <= 2 * level.cells && level.size[d] > 1;
    strong += shift[d];
  }
  if (strong == 0) shift.fill(1);
  return shift;
}

// New values on all levels. The shape of the aggregates follows from the values alone, never from earlier
// ones.
template <int D>
void Multigrid<D>::refresh(const SystemValues& system) {
  Level& finest = levels_[0];
  for (std::size_t i = 0; i < position_.size(); ++i) finest.sink[position_[i]] = system.sink[i];
  for (std::size_t k = 0; k < link_position_.size(); ++k)
    finest.link[connectivity_.links[k].axis][link_position_[k]] = system.link[k];
  finest.finish_values();
  for (std::size_t l = 0; levels_[l].cells > kCoarsestCells; ++l) {
    const std::array<int, D> shift = aggregate_shape(levels_[l]);
    if (l + 1 >= levels_.size() || shift != levels_[l].shift) {
      levels_.erase(levels_.begin() + l + 1, levels_.end());
      levels_[l].shift = shift;
      Level coarse = Level::coarser(levels_[l]);
      levels_.push_back(std::move(coarse));
      coarsest_stale_ = true;
    }
    coarse_values(static_cast<int>(l));
    levels_[l + 1].finish_values();
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
  for (const Row& row : c.rows)
    for (int p = row.begin; p < row.end; ++p)
      for (int d = 0; d < D; ++d) {
        Index<D> above = row.line;
        above[0] = row.x + p - row.begin;
        ++above[d];
        const int other = c.position(above);
        if (number[p] < 0 || other < 0 || number[other] < 0) continue;
        coarsest_links_.push_back({d, p});
        pairs.push_back({number[p], number[other]});
      }
  coarsest_.analyse(static_cast<int>(coarsest_cells_.size()), pairs);
  coarsest_diagonal_.resize(coarsest_cells_.size());
  coarsest_rhs_.resize(coarsest_cells_.size());
  coarsest_x_.resize(coarsest_cells_.size());
  coarsest_off_diagonal_.resize(pairs.size());
  coarsest_stale_ = false;
}

template <int D>
void Multigrid<D>::solve_coarsest(const Reals& b, Reals& x) {
  for (std::size_t i = 0; i < coarsest_cells_.size(); ++i) coarsest_rhs_[i] = b[coarsest_cells_[i]];
  coarsest_.solve(coarsest_rhs_, coarsest_x_);
  for (std::size_t i = 0; i < coarsest_cells_.size(); ++i) x[coarsest_cells_[i]] = coarsest_x_[i];
}

template <int D>
SolveReport Multigrid<D>::solve(const SystemValues& system, const Accuracy& accuracy, std::span<double> x) {
  ++this->counts_.systems;
  std::fill(x.begin(), x.end(), 0.0);
  if (levels_.empty()) return {};
  refresh(system);
  const Level& a = levels_[0];
  Reals& work = levels_[0].v;
  std::fill(r_.begin(), r_.end(), 0.0);
  for (std::size_t i = 0; i < position_.size(); ++i) r_[position_[i]] = system.rhs[i];
  const auto scaled_norm = [&] {  // || D^-1/2 r ||
    multiply(a.weight, r_, work);
    return std::sqrt(dot(r_, work) / Level::kDamping);
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
    a.apply(p_, q_);
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
