// Newton's method for UnsaturatedField through a resting skeleton, and the steady states that need it.
//
// The matrix of the iteration in fdm/unsaturated_field.cpp is symmetric because it leaves out how k_r changes
// with p. Where k_r is steep, about a free surface in coarse soil or near saturation in fine soil, what is
// left out is as large as what is there, and that iteration crawls or goes in circles. Here it is put back:
// the system is no longer symmetric, and is solved by flexible GMRES with the symmetric one as
// preconditioner, no more accurately than the next evaluation can use (Eisenstat & Walker 1996, SIAM J. Sci.
// Comput. 17). The step along the direction found is halved until the residual falls (Armijo's rule).
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "fdm/loops.hpp"
#include "fdm/unsaturated_field.hpp"

namespace polder::fdm {
namespace {

constexpr double kInner = 0.1;               // reduction of the residual by the preconditioner
constexpr double kLeastConductivity = 1e-9;  // least k_r in steady flow
constexpr int kMostDirections = 40;          // of GMRES
constexpr double kShortest = 1.0 / 128;      // part of Newton's step

}  // namespace

// What a change of p changes in the flows through k_r, by faces: flow_ += slope_low dp_low + slope_high
// dp_high (boundary: slope_low dp of the cell).
template <int D>
void UnsaturatedField<D>::find_slopes() {
  const auto interior = cells_.interior_faces();
  const auto boundary = cells_.boundary_faces();
  const int n_interior = static_cast<int>(interior.size());
  const double h = cells_.grid().spacing();
  const bool upstream = weighting_ == FaceWeighting::upstream;
  kr_slope_.resize(p_now_.size());
  slope_low_.resize(flow_.size()), slope_high_.resize(flow_.size()), slope_flow_.resize(flow_.size());
  for (std::size_t s = 0; s < curves_.size(); ++s)
    curves_[s].conductivity_slope(cells_of_soil_[s], p_now_, kr_slope_);
  for_each(n_interior, [&](int i) {
    const InteriorFace<D>& f = interior[i];
    const double difference = p_now_[f.high] - p_now_[f.low] - water_.density * water_.gravity[f.axis] * h;
    const double low = upstream ? (difference > 0 ? 0 : 1) : 0.5;
    slope_low_[i] = kappa_[i] * difference * low * kr_slope_[f.low];
    slope_high_[i] = kappa_[i] * difference * (1 - low) * kr_slope_[f.high];
  });
  constexpr double kStep = 1e-6;  // of k_r, for the difference quotient
  for (std::size_t b = 0; b < boundary.size(); ++b) {
    const int c = boundary[b].cell, i = n_interior + static_cast<int>(b);
    const double changed = boundary_flow(laws_[b], kappa_[i], p_now_[c], kr_[c] * (1 - kStep)).inflow;
    slope_low_[i] = kr_[c] > 0 ? (flow_[i] - changed) / (kStep * kr_[c]) * kr_slope_[c] : 0;
    slope_high_[i] = 0;
  }
}

// Newton's matrix times v: the symmetric system's, less what the flows gain through k_r.
template <int D>
void UnsaturatedField<D>::multiply(std::span<const double> v, std::span<double> out) {
  const auto cells = cells_.cells();
  const auto interior = cells_.interior_faces();
  const auto boundary = cells_.boundary_faces();
  const int n_interior = static_cast<int>(interior.size());
  for_each(n_interior, [&](int i) {
    const InteriorFace<D>& f = interior[i];
    slope_flow_[i] =
        conductance_[i] * (v[f.high] - v[f.low]) + slope_low_[i] * v[f.low] + slope_high_[i] * v[f.high];
  });
  for (std::size_t b = 0; b < boundary.size(); ++b)
    slope_flow_[n_interior + b] = slope_low_[n_interior + b] * v[boundary[b].cell];
  if (runs_off()) add_run_off(v, slope_flow_);
  for_each(cells_.count(), [&](int c) {
    double sum = sink_[c] * v[c];
    for (int side = 0; side < 2 * D; ++side) {
      const int face = cells[c].faces[side];
      if (face < 0) continue;
      sum -= face >= n_interior || side % 2 ? slope_flow_[face] : -slope_flow_[face];
    }
    out[c] = sum;
  });
}

// One step from the present state, whose balance is assembled. Leaves the state after it, assembled, in
// `residual`; false, and the state as it was, where no part of the step lets the residual fall.
template <int D>
bool UnsaturatedField<D>::newton_step(Residual& residual, double reduction, StepReport& report) {
  find_slopes();
  const std::span<const double> links =
      std::span<const double>(conductance_).first(cells_.interior_faces().size());
  Accuracy inner;
  inner.tolerance = kInner;
  const FlexibleGmres::Report found =
      gmres_.solve([&](std::span<const double> in, std::span<double> out) { multiply(in, out); },
                   [&](std::span<const double> in, std::span<double> out) {
                     report.linear_iterations += solver_->solve({sink_, links, in}, inner, out).iterations;
                   },
                   rhs_, reduction, kMostDirections, change_);
  if (found.iterations == 0) return false;
  const double driest = -unit_weight_ * RetentionCurve::kDriestSuction;
  image_ = p_now_;
  for (double part = 1; part >= kShortest; part *= 0.5) {
    double largest = 0;
    for (int c = 0; c < cells_.count(); ++c) {
      p_now_[c] = image_[c] + part * change_[c];
      if (!saturated_[c]) p_now_[c] = std::max(p_now_[c], driest);
      largest = std::max(largest, std::abs(p_now_[c] - image_[c]));
    }
    assemble();
    const Residual now = gather();
    if (now.sum < (1 - 1e-4 * part) * residual.sum || now.small(tolerance_)) {
      residual = now;
      report.largest_change = largest;
      return true;
    }
  }
  p_now_ = image_;
  assemble();
  residual = gather();
  return false;
}
// ---- steady state

// Each step starts from the last one; its length grows the faster the more easily the iteration converges,
// and slowly where a longer one has failed. Steady when storage is no longer part of the balance.
template <int D>
StepReport UnsaturatedField<D>::steady(const UnsaturatedStep& given) {
  if (!given.velocity.empty())
    throw std::logic_error("UnsaturatedField: steady flow needs a resting skeleton");
  may_lag_ = false;  // what is steady must not depend on the way there
  const StepReport total = steady_steps(given);
  may_lag_ = true;
  kr_floor_ = 0;
  return total;
}

// Time that water takes through the field under its own weight in the least permeable of its soils [s].
template <int D>
double UnsaturatedField<D>::passage(const UnsaturatedStep& step) const {
  const auto cells = cells_.cells();
  double slowest = 0;
  for (const ActiveCell<D>& c : cells)
    if (step.darcy_mobility[c.slot] > 0)
      slowest = std::max(slowest, step.porosity[c.slot] / (step.darcy_mobility[c.slot] * unit_weight_));
  return slowest * cells_.grid().spacing() * std::pow(cells_.count(), 1.0 / D);
}

// From soil that conducts as if it were full, which makes the flow linear but for its seepage faces, over
// soil that conducts something everywhere, to the true one: each flow is the start of the next, over a time
// after which storage hardly counts.
template <int D>
StepReport UnsaturatedField<D>::steady_homotopy(const UnsaturatedStep& step) {
  const Reals pressure = p_, saturation = saturation_;
  StepReport total;
  for (const double floor : {1.0, 0.3, 1e-1, 1e-2, 1e-3, 1e-5, 1e-7, kLeastConductivity}) {
    kr_floor_ = floor;
    const StepReport r = solve(step);
    total.iterations += r.iterations;
    total.linear_iterations += r.linear_iterations;
    total.converged = r.converged;
    if (r.converged) continue;
    p_ = pressure, saturation_ = saturation;
    break;
  }
  kr_floor_ = kLeastConductivity;
  return total;
}

template <int D>
StepReport UnsaturatedField<D>::steady_steps(UnsaturatedStep step) {
  constexpr int kSteps = 300;
  constexpr double kLongest = 1e16;  // [s]
  const UnsaturatedStep given = step;
  const double longest = 1e4 * passage(given);
  step.dt = std::max(longest, given.dt);
  StepReport total = steady_homotopy(step);
  if (!total.converged) step.dt = given.dt;
  total.converged = false;
  double failed = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kSteps; ++i) {
    const StepReport r = solve(step);
    total.iterations += r.iterations;
    total.linear_iterations += r.linear_iterations;
    total.residual = r.residual, total.largest_change = r.largest_change;
    total.failure = r.failure;
    if (!r.converged) {
      if (step.dt < 1e-8 * given.dt) return total;
      failed = step.dt;
      step.dt *= 0.1;
      continue;
    }
    double storing = 0;
    for (int c = 0; c < cells_.count(); ++c)
      storing += std::abs(cell_[c].pores * (s_now_[c] - s_old_[c])) +
                 std::abs(cell_[c].elastic * s_now_[c] * (p_now_[c] - p_old_[c]));
    if (storing <= 10 * tolerance_ * balance_.magnitude || step.dt >= kLongest) {
      total.converged = true;
      return total;
    }
    const double growth = r.iterations <= 10 ? 10 : r.iterations <= 20 ? 4 : 2;
    step.dt *= step.dt * growth < failed ? growth : 1.5;
  }
  total.failure = "the steady state was not reached in " + std::to_string(kSteps) + " steps";
  return total;
}

template class UnsaturatedField<2>;
template class UnsaturatedField<3>;

}  // namespace polder::fdm
