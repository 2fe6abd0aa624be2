// State and iteration of UnsaturatedField.
//
// One iteration evaluates the balance at the present p and solves the symmetric system of its derivative
// without that of k_r (modified Picard: Celia, Bouloutas & Zarba 1990). Five things make it robust and fast:
// * Cells whose storage is far from linear over the change take the root of their own balance instead, so
// that
//   dry soil does not shoot over whatever its curve (in place of the switching of primary variables by
//   Forsyth, Wu & Pruess 1995, Adv. Water Resour. 18).
// * The iterates are combined after Anderson (fdm/anderson.hpp), which makes up for the missing derivative.
// * The combination starts afresh when the residual has grown.
// * When it has not fallen for a while the moves are halved: a lagged k_r can go around in circles.
// * Where all that takes long Newton's method takes over (fdm/unsaturated_newton.cpp).
#include "fdm/unsaturated_field.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "core/error.hpp"
#include "fdm/loops.hpp"

namespace polder::fdm {
namespace {

constexpr double kAlmostFull = 1e-4;  // share of the pores that may be empty in a full cell

}  // namespace

template <int D>
UnsaturatedField<D>::UnsaturatedField(const WaterCells<D>& cells, const WaterProperties<D>& water,
                                      std::vector<Soil<D>> soils, SolverKind solver)
    : cells_(cells), water_(water), soils_(std::move(soils)), solver_(make_solver<D>(solver)) {
  if (!(water.density > 0) || !(water.bulk_modulus > 0))
    throw InputError("water: density and bulk modulus must be positive");
  if (soils_.empty()) throw InputError("unsaturated flow: no soil is given");
  double g2 = 0;
  for (double g : water.gravity) g2 += g * g;
  // Suction head is measured in the weight of water; without gravity in that of the earth's surface.
  unit_weight_ = water.density * (g2 > 0 ? std::sqrt(g2) : 9.81);
  for (const Soil<D>& s : soils_) {
    curves_.emplace_back(s.retention, unit_weight_);
    const RetentionCurve& curve = curves_.back();
    full_suction_.push_back(curve.always_saturated() ? std::numeric_limits<double>::infinity()
                                                     : -curve.pressure(s.retention.maximum -
                                                                       kAlmostFull * (s.retention.maximum -
                                                                                      s.retention.residual)));
    for (double a : s.anisotropy)
      if (!(a > 0)) throw InputError("unsaturated flow: the factors of anisotropy must be positive");
  }
}

template <int D>
UnsaturatedField<D>::~UnsaturatedField() = default;

template <int D>
const char* UnsaturatedField<D>::solver_name() const {
  return solver_->name();
}

template <int D>
void UnsaturatedField<D>::set_averages(bool over_cells) {
  averages_ = over_cells;
  for (RetentionCurve& curve : curves_) curve.average_over(over_cells ? cells_.grid().spacing() : 0);
}

template <int D>
void UnsaturatedField<D>::carry() {
  const Grid<D>& grid = cells_.grid();
  grid.carry(p_);
  grid.carry(saturation_, 1, kFromPressure);
  Reals known;
  if (!pressure_cells_.empty()) {
    known.assign(known_slots_, 0);
    for (int s : pressure_cells_) known[s] = 1;
    grid.carry(known);
    pressure_cells_.clear();
    for (int s = 0; s < grid.slots(); ++s)
      if (known[s] > 0) pressure_cells_.push_back(s);
  }
  known_slots_ = grid.slots();
  positive_.assign(grid.slots(), 0);
  increment_.assign(grid.slots(), 0);
  grid_revision_ = grid.revision();
}

template <int D>
void UnsaturatedField<D>::restore(const Reals& pressure, const Reals& saturation,
                                  const std::vector<int>& pressure_cells) {
  if (pressure_cells != pressure_cells_) cells_revision_ = 0;
  p_ = pressure, saturation_ = saturation, pressure_cells_ = pressure_cells;
  known_slots_ = static_cast<int>(pressure.size());
}

template <int D>
void UnsaturatedField<D>::refresh() {
  const Grid<D>& grid = cells_.grid();
  if (grid_revision_ == 0) carry();
  if (grid_revision_ != grid.revision())
    throw std::logic_error("UnsaturatedField: the grid changed and carry() was not called");
  if (cells_revision_ == cells_.revision()) return;
  cells_revision_ = cells_.revision();
  const auto cells = cells_.cells();
  const std::size_t n = cells.size(), interior = cells_.interior_faces().size();
  const std::size_t faces = interior + cells_.boundary_faces().size();

  // Cells without a past: the mean head of their neighbours, layer by layer where several are new.
  std::vector<unsigned char> known(grid.slots(), 0);
  for (int s : pressure_cells_) known[s] = 1;
  const bool first = pressure_cells_.empty();
  pressure_cells_.clear();
  for (const ActiveCell<D>& c : cells) pressure_cells_.push_back(c.slot);
  for (int s = 0; s < grid.slots(); ++s)
    if (!cells_.active(s)) p_[s] = 0, saturation_[s] = kFromPressure;
  std::vector<int> found;
  for (bool more = !first; more;) {
    found.clear();
    for (const ActiveCell<D>& c : cells) {
      if (known[c.slot]) continue;
      double sum = 0;
      int count = 0;
      for (int side = 0; side < 2 * D; ++side) {
        if (c.faces[side] < 0 || c.faces[side] >= static_cast<int>(interior)) continue;
        const InteriorFace<D>& f = cells_.interior_faces()[c.faces[side]];
        const int other = cells[side % 2 ? f.high : f.low].slot;
        if (!known[other]) continue;
        const double rise =
            water_.density * water_.gravity[side / 2] * grid.spacing();  // of p along the axis
        sum += p_[other] + (side % 2 ? -rise : rise), ++count;
      }
      if (count == 0) continue;
      p_[c.slot] = sum / count;
      saturation_[c.slot] = kFromPressure;
      found.push_back(c.slot);
    }
    for (int s : found) known[s] = 1;
    more = !found.empty();
  }

  gradient_.build(cells_);
  node_grad_.assign(static_cast<std::size_t>(grid.slots()) * kStride, 0);
  std::fill(increment_.begin(), increment_.end(), 0.0);
  std::fill(positive_.begin(), positive_.end(), 0.0);
  soil_.assign(n, -1);
  saturated_.assign(n, 0);
  was_wet_.assign(n, 0);
  cell_.assign(n, {});
  for (Reals* a : {&fringe_, &motion_, &p_now_, &p_old_, &s_now_, &s_old_, &capacity_, &kr_, &positive_old_,
                   &plus_change_, &projection_, &sink_, &rhs_, &diagonal_, &change_, &rounding_, &image_})
    a->assign(n, 0);
  for (Reals* a : {&kappa_, &lambda_, &flow_, &conductance_}) a->assign(faces, 0);
  correction_.assign(interior, 0);
  acceleration_.resize(n);
  laws_.assign(faces - interior, {});
  discharge_ = {};
  discharge_.boundary.assign(cells_.conditions().boundaries.size(), 0);
  discharge_.well.assign(cells_.conditions().wells.size(), 0);
  discharge_.drain.assign(cells_.conditions().drains.size(), 0);
  balance_ = {};
  find_lines();
  find_steps();
  basins_ = find_basins(cells_, blocked_);

  Connectivity<D> connectivity;
  connectivity.cells.reserve(n);
  connectivity.links.reserve(interior);
  for (const ActiveCell<D>& c : cells) connectivity.cells.push_back(c.index);
  for (const InteriorFace<D>& f : cells_.interior_faces())
    connectivity.links.push_back({f.low, f.high, f.axis});
  solver_->analyse(connectivity);
}

template <int D>
void UnsaturatedField<D>::require_current(std::size_t slots) const {
  if (cells_revision_ != cells_.revision() || cells_revision_ == 0)
    throw std::logic_error("UnsaturatedField: the active cells changed and refresh() was not called");
  if (slots < static_cast<std::size_t>(cells_.grid().slots()) ||
      p_.size() != static_cast<std::size_t>(cells_.grid().slots()))
    throw std::logic_error("UnsaturatedField: an array does not cover the grid");
}

// ---- iteration

// Pressure of cell c after the linear system asked for the change d. Where the linearised storage is no good
// over that distance, the root of the cell's own balance
//   pores [S(p) - S_m] + L (p - p_m) = (pores dS/dp + L) d,
// with the true curve and L the conductance to all else; it is taken if it is the smaller change.
template <int D>
double UnsaturatedField<D>::changed_pressure(int c, double d) const {
  constexpr double kLinear = 0.01;  // of |p|: storage is linear over this distance
  constexpr int kSections = 60;
  if (inertia_) return changed_pressure_moving(c, d);
  const double before = p_now_[c], after = before + d;
  const RetentionCurve& curve = curves_[soil_[c]];
  const double full = curve.full_pressure();
  if (saturated_[c] || (before >= full && after >= full) || std::abs(d) < kLinear * std::abs(before - full))
    return after;
  const double pores = cell_[c].pores, links = diagonal_[c] - pores * capacity_[c];
  const double target = diagonal_[c] * d;
  const auto excess = [&](double p) {
    return pores * (curve.saturation(p) - s_now_[c]) + links * (p - before) - target;
  };
  double low = before, high = after, f_low = -target, f_high = excess(after);
  if (f_low * f_high >= 0) return after;
  // Illinois variant of false position; a few digits are enough.
  for (int i = 0; i < kSections && std::abs(high - low) > 1e-3 * std::abs(high); ++i) {
    const double p = (low * f_high - high * f_low) / (f_high - f_low), f = excess(p);
    if (f == 0) return p;
    if (f * f_high < 0)
      low = high, f_low = f_high;
    else
      f_low *= 0.5;
    high = p, f_high = f;
  }
  return high;
}

// The same in moving soil, where links of motion L+ act while a cell is wet: the root of
//   pores [S(p) - S_m] + L (p - p_m) + L+ (p+ - p+_m) = F,   F = D d, D the diagonal without what is not
//   there yet.
// A cell that fills goes at once to where its neighbours stop it, and one that empties to where its pores do.
template <int D>
double UnsaturatedField<D>::changed_pressure_moving(int c, double d) const {
  constexpr int kSections = 60;
  constexpr double kLinear = 0.01;  // of |p|: storage is linear over this distance
  const double before = p_now_[c], after = before + d, full = -fringe_[c];
  if (saturated_[c] || (before >= 0 && after >= 0)) return after;
  if (before < full && after < full && std::abs(d) < kLinear * std::abs(before)) return after;
  const RetentionCurve& curve = curves_[soil_[c]];
  const double pores = cell_[c].pores, motion = motion_[c];
  const double links = diagonal_[c] - pores * capacity_[c] - (wet(c) ? motion : 0.0);
  const double force = diagonal_[c] * d;
  const auto excess = [&](double p) {
    return pores * (curve.saturation(p) - s_now_[c]) + links * (p - before) +
           motion * (std::max(p, full) - std::max(before, full)) - force;
  };
  const double at_zero = excess(0);
  if (at_zero <= 0) return -at_zero / (links + motion);
  double high = 0, f_high = at_zero, low = std::min(before, -1.0), f_low = excess(low);
  for (int i = 0; i < kSections && f_low > 0; ++i) high = low, f_high = f_low, low *= 2, f_low = excess(low);
  if (f_low > 0) return low;
  for (int i = 0; i < kSections && high - low > 1e-9 * std::abs(low); ++i) {  // Illinois
    const double p = (low * f_high - high * f_low) / (f_high - f_low), f = excess(p);
    if (f > 0) {
      high = p, f_high = f, f_low *= 0.5;
    } else {
      low = p, f_low = f, f_high *= 0.5;
    }
  }
  return 0.5 * (low + high);
}

// Moves p by the change that the linear system asks for; the largest move.
template <int D>
double UnsaturatedField<D>::advance() {
  double largest = 0;
  for_each(cells_.count(), [&](int c) {
    image_[c] = p_now_[c] + relaxation_ * (changed_pressure(c, change_[c]) - p_now_[c]);
  });
  for (int c = 0; c < cells_.count(); ++c) largest = std::max(largest, std::abs(image_[c] - p_now_[c]));
  // The steps of moving soil are short: Newton's method alone is faster there.
  if (inertia_)
    std::copy(image_.begin(), image_.end(), p_now_.begin());
  else
    acceleration_.next(p_now_, image_, diagonal_);
  const double driest = -unit_weight_ * RetentionCurve::kDriestSuction;
  for (int c = 0; c < cells_.count(); ++c)
    if (!saturated_[c]) p_now_[c] = std::max(p_now_[c], driest);
  return largest;
}

template <int D>
StepReport UnsaturatedField<D>::solve(const UnsaturatedStep& step) {
  if (!(step.dt > 0)) throw std::logic_error("UnsaturatedField: the time step must be positive");
  prepare(step);
  acceleration_.restart();
  StepReport report;
  const std::span<const double> links =
      std::span<const double>(conductance_).first(cells_.interior_faces().size());
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  constexpr int kPatience = 8;
  // Where the symmetric iteration takes long Newton's method takes over, in steady flow at once; where that
  // finds no way down it pauses for some iterations.
  constexpr int kNewtonAfter = 8, kNewtonAfterSteady = 0, kPause = 4;
  // Near saturation the k_r of fine soils falls without bound in its slope (van Genuchten's with n < 2), and
  // both may fail. From here on the iteration keeps the k_r that it has: water is balanced all the same.
  constexpr int kLagAfter = 20;
  double last = kInfinity, best = last;
  int waited = 0, next_newton = may_lag_ ? kNewtonAfter : kNewtonAfterSteady;
  bool assembled = false;
  Residual residual;
  relaxation_ = 1;
  lags_ = false;
  for (int i = 0;; ++i) {
    try {
      if (!assembled) {
        assemble();
        residual = gather();
      }
      assembled = false;
      report.residual = residual.relative();
      if (!std::isfinite(residual.sum)) {
        report.failure = "the pressure is not a number";
        return report;
      }
      if (residual.small(tolerance_)) break;
      if (i == kLagAfter && may_lag_ && !inertia_) {
        lags_ = report.lagged = true;
        lagged_kr_ = kr_;
        acceleration_.restart();
        relaxation_ = 1;
        last = best = kInfinity, waited = 0;
      }
      if (i == max_iterations_) {
        report.failure = "no convergence in " + std::to_string(i) + " iterations";
        return report;
      }
      pin_closed_basins();
      const double enough = 0.1 * (tolerance_ * residual.scale + residual.rounding) / residual.sum;
      if (!inertia_ && !lags_ && i >= next_newton) {
        const double gain = last < kInfinity ? residual.sum / last : 1;
        last = residual.sum;
        acceleration_.restart();
        report.iterations = i + 1;
        assembled =
            newton_step(residual, std::clamp(0.1 * gain * gain, std::max(1e-4, enough), 0.01), report);
        if (!assembled) next_newton = i + 1 + kPause;
        continue;
      }
      // No more digits than the next evaluation can use; all of them where the balance is linear.
      Accuracy accuracy;
      accuracy.tolerance = std::clamp(0.1 * enough, 1e-12, 1e-3);
      accuracy.floor = rounding_norm_;
      report.linear_iterations += solver_->solve({sink_, links, rhs_}, accuracy, change_).iterations;
    } catch (const NumericalError& error) {
      report.failure = error.what();
      return report;
    }
    if (residual.sum > last) acceleration_.restart();
    last = residual.sum;
    if (residual.sum < 0.9 * best) {
      best = residual.sum, waited = 0;
    } else if (++waited == kPatience) {
      waited = 0;
      relaxation_ = std::max(0.5 * relaxation_, 0.05);
      acceleration_.restart();
    }
    report.largest_change = advance();
    report.iterations = i + 1;
  }
  report.converged = true;
  accept();
  return report;
}

// Leaves the step with its state, discharges and balance.
template <int D>
void UnsaturatedField<D>::accept() {
  const auto cells = cells_.cells();
  balance_ = {};
  for (int c = 0; c < cells_.count(); ++c) {
    const int slot = cells[c].slot;
    p_[slot] = p_now_[c];
    saturation_[slot] = s_now_[c];
    positive_[slot] = positive(c);
    increment_[slot] = plus_change_[c];
    const double stored =
        cell_[c].pores * (s_now_[c] - s_old_[c]) + cell_[c].elastic * s_now_[c] * (p_now_[c] - p_old_[c]);
    const double skeleton = s_now_[c] * cell_[c].source;
    balance_.storage += stored;
    balance_.skeleton += skeleton;
    balance_.projection -= projection_[c];
    balance_.withdrawal += cell_[c].withdrawal;
    balance_.magnitude +=
        std::abs(stored) + std::abs(skeleton) + std::abs(projection_[c]) + std::abs(cell_[c].withdrawal);
  }
  const auto boundary = cells_.boundary_faces();
  const std::size_t interior = cells_.interior_faces().size();
  discharge_.surface = 0;
  std::fill(discharge_.boundary.begin(), discharge_.boundary.end(), 0.0);
  for (std::size_t b = 0; b < boundary.size(); ++b) {
    const double q = -flow_[interior + b];
    balance_.outflow += q;
    balance_.magnitude += std::abs(q);
    (boundary[b].boundary < 0 ? discharge_.surface : discharge_.boundary[boundary[b].boundary]) += q;
  }
  std::fill(discharge_.well.begin(), discharge_.well.end(), 0.0);
  std::fill(discharge_.drain.begin(), discharge_.drain.end(), 0.0);
  for (const LineSink& l : lines_) {
    balance_.outflow += l.flow;
    balance_.magnitude += std::abs(l.flow);
    (l.drain ? discharge_.drain : discharge_.well)[l.owner] += l.flow;
  }
}

// ---- evaluation

template <int D>
void UnsaturatedField<D>::node_gradient(std::span<const double> field, BoundaryValues values,
                                        WallNormal walls, std::span<double> out) {
  require_current(std::min(field.size(), out.size() / kStride));
  update_gradient_faces();
  gradient_.evaluate(cells_, gradient_faces_, field, values, walls, out);
}

template class UnsaturatedField<2>;
template class UnsaturatedField<3>;

}  // namespace polder::fdm
