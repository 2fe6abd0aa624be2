// The terms of UnsaturatedField's balance: what a step holds, flows through faces, residuals of cells.
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "core/error.hpp"
#include "fdm/loops.hpp"
#include "fdm/unsaturated_field.hpp"

namespace polder::fdm {
namespace {

constexpr double kRounding = 16 * std::numeric_limits<double>::epsilon();

// A basin counts as closed when sinks conduct less than this part of its links: its level would be decided by
// rounding (as in pressure_field.cpp).
constexpr double kClosedBasin = 1e-11;

// Sink in the matrix over the links of the cell: keeps pivots positive where soil is so dry that cells
// between are coupled to the rest by less than rounding. It slows such cells down and has no part in the
// balance.
constexpr double kRegular = 1e-12;

}  // namespace

// ---- before the iteration

template <int D>
void UnsaturatedField<D>::prepare(const UnsaturatedStep& step) {
  require_current(std::min(
      {step.porosity.size(), step.volume_fraction.size(), step.darcy_mobility.size(), step.soil.size()}));
  const std::size_t slots = cells_.grid().slots();
  inertia_ = !step.velocity.empty();
  if (inertia_ && averages_)
    throw std::logic_error("UnsaturatedField: curves over the height of cells need a resting skeleton");
  if (inertia_ != !step.mobility.empty())
    throw std::logic_error("UnsaturatedField: a moving skeleton needs both velocity and mobility");
  if (inertia_ && (step.velocity.size() < slots * kStride || step.mobility.size() < slots))
    throw std::logic_error("UnsaturatedField: velocity or mobility does not cover the grid");
  if (!step.skeleton_compressibility.empty() && step.skeleton_compressibility.size() < slots)
    throw std::logic_error("UnsaturatedField: the compressibility does not cover the grid");
  if (!step.withdrawal.empty() && step.withdrawal.size() < static_cast<std::size_t>(cells_.count()))
    throw std::logic_error("UnsaturatedField: the withdrawal does not cover the cells");
  prepare_soils(step);

  const auto cells = cells_.cells();
  for_each(cells_.count(), [&](int c) {
    const int slot = cells[c].slot;
    p_now_[c] = p_old_[c] = p_[slot];
    const double volume = step.volume_fraction[slot] * cells[c].volume / step.dt;
    const double skeleton = step.skeleton_compressibility.empty() ? 0 : step.skeleton_compressibility[slot];
    cell_[c].pores = step.porosity[slot] * volume;
    cell_[c].elastic = (step.porosity[slot] / water_.bulk_modulus + skeleton) * volume;
    cell_[c].source = inertia_ ? cell_outflow<D>(cells[c], step.velocity) : 0;
    cell_[c].withdrawal = step.withdrawal.empty() ? 0 : step.withdrawal[c];
    was_wet_[c] = wet(c);
    positive_old_[c] = positive(c);
    projection_[c] = 0;
  });
  for (std::size_t s = 0; s < curves_.size(); ++s)
    curves_[s].evaluate(cells_of_soil_[s], p_now_, s_now_, capacity_, kr_);
  for_each(cells_.count(), [&](int c) {
    const double s = saturation_[cells[c].slot];
    s_old_[c] = s == kFromPressure ? s_now_[c] : s;
  });
  prepare_faces(step);
}

template <int D>
void UnsaturatedField<D>::prepare_soils(const UnsaturatedStep& step) {
  const auto cells = cells_.cells();
  bool same = cells_of_soil_.size() == curves_.size();
  for (int c = 0; c < cells_.count(); ++c) same = same && soil_[c] == step.soil[cells[c].slot];
  if (same) return;
  cells_of_soil_.assign(curves_.size(), {});
  for (int c = 0; c < cells_.count(); ++c) {
    const int soil = step.soil[cells[c].slot];
    if (soil < 0 || soil >= static_cast<int>(curves_.size()))
      throw std::logic_error("UnsaturatedField: a cell names a soil that is not in the list");
    soil_[c] = soil;
    saturated_[c] = curves_[soil].always_saturated();
    fringe_[c] = full_suction_[soil];
    cells_of_soil_[soil].push_back(c);
  }
}

template <int D>
void UnsaturatedField<D>::prepare_faces(const UnsaturatedStep& step) {
  const auto cells = cells_.cells();
  const auto interior = cells_.interior_faces();
  const auto boundary = cells_.boundary_faces();
  const int n_interior = static_cast<int>(interior.size());
  const double per_spacing = 1 / cells_.grid().spacing();
  for (std::size_t b = 0; b < boundary.size(); ++b) {
    const BoundaryFace<D>& f = boundary[b];
    const int slot = cells[f.cell].slot;
    const RetentionCurve& curve = curves_[soil_[f.cell]];
    BoundaryLaw law = boundary_law(f, cells_.conditions());
    law.gravity = -water_.density * water_.gravity[f.axis] * f.outward * f.distance;
    law.upper_conductivity = curve.relative_conductivity(law.upper);
    law.lower_conductivity = std::isfinite(law.lower) ? curve.relative_conductivity(law.lower) : 0;
    law.upstream = weighting_ == FaceWeighting::upstream;
    if (averages_)
      split_law(f, cells_.conditions(), cells_.centre(cells[f.cell].index)[D - 1], cells_.grid().spacing(),
                law);
    laws_[b] = law;
    kappa_[n_interior + b] =
        step.darcy_mobility[slot] * soils_[soil_[f.cell]].anisotropy[f.axis] * f.area / f.distance;
  }
  const auto conductivity = [&](int cell, int axis) {
    return step.darcy_mobility[cells[cell].slot] * soils_[soil_[cell]].anisotropy[axis];
  };
  for_each(n_interior, [&](int i) {
    const InteriorFace<D>& f = interior[i];
    kappa_[i] =
        harmonic_mean(conductivity(f.low, f.axis), conductivity(f.high, f.axis)) * f.area * per_spacing;
  });
  for (std::size_t i = 0; i < blocked_.size(); ++i)
    if (blocked_[i]) kappa_[i] = 0;
  prepare_lines();
  update_gradient_faces();
  if (!inertia_) return;

  chi_ = step.rhie_chow;
  std::span<const double> gradient = step.pressure_gradient;
  if (!gradient.empty() && gradient.size() < static_cast<std::size_t>(cells_.grid().slots()) * kStride)
    throw std::logic_error("UnsaturatedField: the pressure gradient does not cover the grid");
  if (chi_ > 0 && gradient.empty()) {
    for (int c = 0; c < cells_.count(); ++c) positive_[cells[c].slot] = positive_old_[c];
    gradient_.evaluate(cells_, gradient_faces_, positive_, BoundaryValues::present, WallNormal::none,
                       node_grad_);
    gradient = node_grad_;
  }
  for_each(n_interior, [&](int i) {
    const InteriorFace<D>& f = interior[i];
    const double lam = face_mobility<D>(f.nodes, step.mobility) * f.area;
    lambda_[i] = lam * per_spacing;
    correction_[i] = 0;
    if (chi_ == 0) return;
    double mean = 0;
    for (int node : f.nodes) mean += gradient[static_cast<std::size_t>(node) * kStride + f.axis];
    const double slope = (positive_old_[f.high] - positive_old_[f.low]) * per_spacing;
    correction_[i] = chi_ * lam * (slope - mean / static_cast<double>(f.nodes.size()));
  });
  for (std::size_t b = 0; b < boundary.size(); ++b) {
    const BoundaryFace<D>& f = boundary[b];
    lambda_[n_interior + b] =
        gradient_faces_[b].open ? face_mobility<D>(f.nodes, step.mobility) * f.area / f.distance : 0;
  }
}

// Boundary faces as the gradient of p+ sees them: the soil's surface is free of p+ wherever it is not under
// water, whether water passes or not, and so is a side of the grid that stands for it; elsewhere on the sides
// only where a pressure acts.
template <int D>
void UnsaturatedField<D>::update_gradient_faces() {
  const auto boundary = cells_.boundary_faces();
  gradient_faces_.assign(boundary.begin(), boundary.end());
  for (BoundaryFace<D>& f : gradient_faces_) {
    const BoundaryLaw law = boundary_law(f, cells_.conditions());
    const bool side = f.boundary >= 0 && !f.free_surface &&
                      cells_.conditions().boundaries[f.boundary].kind != WaterBoundary<D>::Kind::surface;
    f.open = law.kind == BoundaryLaw::Kind::pressure ||
             (law.kind == BoundaryLaw::Kind::complementary && (!side || p_[cells_.cells()[f.cell].slot] > 0));
    f.pressure = law.kind == BoundaryLaw::Kind::pressure ? std::max(law.upper, 0.0) : 0;
  }
}

// ---- in the iteration

template <int D>
void UnsaturatedField<D>::assemble() {
  const auto interior = cells_.interior_faces();
  const auto boundary = cells_.boundary_faces();
  const int n_interior = static_cast<int>(interior.size());
  const double h = cells_.grid().spacing();
  const bool upstream = weighting_ == FaceWeighting::upstream;
  for (std::size_t s = 0; s < curves_.size(); ++s)
    curves_[s].evaluate(cells_of_soil_[s], p_now_, s_now_, capacity_, kr_);
  if (kr_floor_ > 0) for_each(cells_.count(), [&](int c) { kr_[c] += kr_floor_ * (1 - kr_[c]); });
  if (lags_) std::copy(lagged_kr_.begin(), lagged_kr_.end(), kr_.begin());
  if (!lines_.empty()) assemble_lines();
  if (inertia_) for_each(cells_.count(), [&](int c) { plus_change_[c] = positive(c) - positive_old_[c]; });

  for_each(n_interior, [&](int i) {
    const InteriorFace<D>& f = interior[i];
    const double difference = p_now_[f.high] - p_now_[f.low] - water_.density * water_.gravity[f.axis] * h;
    const double kr = upstream ? kr_[difference > 0 ? f.high : f.low] : 0.5 * (kr_[f.low] + kr_[f.high]);
    const double conductance = kappa_[i] * kr;
    flow_[i] = conductance * difference;
    conductance_[i] = conductance;
    if (inertia_ && wet(f.low) && wet(f.high)) conductance_[i] += lambda_[i] * chi_factor(f.low, f.high);
  });
  for (std::size_t b = 0; b < boundary.size(); ++b) {
    const int c = boundary[b].cell;
    const BoundaryFlow flow = boundary_flow(laws_[b], kappa_[n_interior + b], p_now_[c], kr_[c]);
    flow_[n_interior + b] = flow.inflow;
    conductance_[n_interior + b] = flow.conductance;
    if (inertia_ && wet(c)) conductance_[n_interior + b] += lambda_[n_interior + b];
  }
  if (runs_off()) run_off();
}

// Residual and sink of every cell; the sum of the residuals' magnitudes and what to measure it by.
template <int D>
typename UnsaturatedField<D>::Residual UnsaturatedField<D>::gather() {
  const auto cells = cells_.cells();
  const auto interior = cells_.interior_faces();
  const int n_interior = static_cast<int>(interior.size());
  const double weight = water_.density * cells_.grid().spacing();
  for_each(cells_.count(), [&](int c) {
    const Cell& k = cell_[c];
    const double stored = k.pores * (s_now_[c] - s_old_[c]) + k.elastic * s_now_[c] * (p_now_[c] - p_old_[c]);
    double balance = -stored - s_now_[c] * k.source - k.withdrawal, projection = 0;
    double sink = k.pores * capacity_[c] + k.elastic * s_now_[c], links = 0, gravity = 0, motion = 0;
    for (int side = 0; side < 2 * D; ++side) {
      const int face = cells[c].faces[side];
      if (face < 0) continue;
      gravity += kappa_[face] * kr_[c] * weight * std::abs(water_.gravity[side / 2]);
      if (face >= n_interior) {
        balance += flow_[face];
        sink += conductance_[face];
        if (!inertia_) continue;
        projection -= lambda_[face] * plus_change_[c];
        motion += lambda_[face];
        continue;
      }
      const InteriorFace<D>& f = interior[face];
      const int other = side % 2 ? f.high : f.low;
      balance += side % 2 ? flow_[face] : -flow_[face];
      links += conductance_[face];
      if (!inertia_) continue;
      const double factor = chi_factor(c, other);
      projection += lambda_[face] * factor * (plus_change_[other] - plus_change_[c]);
      if (factor > 1) projection += side % 2 ? correction_[face] : -correction_[face];
      motion += lambda_[face] * factor;
      if (wet(c) && !wet(other)) sink += lambda_[face] * factor;
    }
    if (!line_flow_.empty()) balance -= line_flow_[c], sink += line_conductance_[c];
    projection_[c] = s_now_[c] * projection;
    rhs_[c] = balance + projection_[c];
    sink_[c] = sink + links > 0 ? sink + kRegular * links : 1;  // 1: a cell so dry that nothing moves in it
    diagonal_[c] = sink + links;
    motion_[c] = motion;
    rounding_[c] = kRounding * (diagonal_[c] * std::abs(p_now_[c]) + gravity + k.pores * s_now_[c]);
  });

  Residual total;
  double norm2 = 0;
  for (int c = 0; c < cells_.count(); ++c) {
    const Cell& k = cell_[c];
    const double stored = k.pores * (s_now_[c] - s_old_[c]) + k.elastic * s_now_[c] * (p_now_[c] - p_old_[c]);
    total.sum += std::abs(rhs_[c]);
    total.scale += std::abs(stored) + std::abs(s_now_[c] * k.source) + std::abs(k.withdrawal);
    total.rounding += rounding_[c];
    if (diagonal_[c] > 0) {
      norm2 += diagonal_[c] * p_now_[c] * p_now_[c];
    } else if (rhs_[c] != 0) {
      std::string place;
      for (double x : cells_.centre(cells[c].index)) place += (place.empty() ? "" : ", ") + std::to_string(x);
      throw NumericalError("unsaturated flow: the cell at (" + place +
                           ") m is coupled to nothing: no conductivity, no storage and no nodal mass");
    }
  }
  for (const LineSink& l : lines_) total.scale += std::abs(l.flow);
  for (std::size_t b = 0; b < laws_.size(); ++b) total.scale += std::abs(flow_[n_interior + b]);
  rounding_norm_ = 0.5 * kRounding * std::sqrt(norm2);
  return total;
}

// A saturated closed basin of incompressible water determines p up to a constant: p stays in its first cell.
template <int D>
void UnsaturatedField<D>::pin_closed_basins() {
  const auto interior = cells_.interior_faces();
  basin_sink_.assign(basins_.first_cell.size(), 0);
  basin_scale_.assign(basins_.first_cell.size(), 0);
  for (int c = 0; c < cells_.count(); ++c) basin_sink_[basins_.of_cell[c]] += sink_[c];
  for (std::size_t f = 0; f < interior.size(); ++f)
    basin_scale_[basins_.of_cell[interior[f].low]] += conductance_[f];
  for (std::size_t b = 0; b < basins_.first_cell.size(); ++b) {
    if (basin_sink_[b] > kClosedBasin * basin_scale_[b]) continue;
    const int c = basins_.first_cell[b];
    sink_[c] += diagonal_[c] > 0 ? diagonal_[c] : 1;
  }
}

// ---- volumes

template <int D>
void soil_fraction(const WaterCells<D>& cells, std::span<const double> fill, std::span<double> fraction) {
  const Grid<D>& grid = cells.grid();
  if (static_cast<int>(std::min(fill.size(), fraction.size())) < grid.slots())
    throw std::logic_error("soil_fraction: an array does not cover the grid");
  std::fill(fraction.begin(), fraction.end(), 0.0);
  for (const ActiveCell<D>& c : cells.cells()) fraction[c.slot] = std::min(1.0, fill[c.slot]);
  // Volumes of equal extent differ between cells in axisymmetry only.
  const auto radius = [&](const Index<D>& i) {
    return cells.space() == Space::axisymmetric ? cells.centre(i)[0] : 1.0;
  };
  std::vector<int> takers;
  for (int s = 0; s < grid.slots(); ++s) {
    const Index<D> index = grid.index(s);
    if (!(fill[s] > 0) || cells.active(s) || !grid.is_cell(index)) continue;
    takers.clear();
    for (int reach = 1; reach <= D && takers.empty(); ++reach)  // faces, then edges, then corners
      for (int n = 0; n < ipow(3, D); ++n) {
        Index<D> other = index;
        int steps = 0;
        for (int d = 0, rest = n; d < D; ++d, rest /= 3) other[d] += rest % 3 - 1, steps += rest % 3 != 1;
        if (steps != reach) continue;
        const int slot = grid.slot(other);
        if (slot >= 0 && cells.active(slot)) takers.push_back(slot);
      }
    for (const int taker : takers)
      fraction[taker] +=
          fill[s] * radius(index) / (radius(grid.index(taker)) * static_cast<double>(takers.size()));
  }
}

template class UnsaturatedField<2>;
template class UnsaturatedField<3>;
template void soil_fraction<2>(const WaterCells<2>&, std::span<const double>, std::span<double>);
template void soil_fraction<3>(const WaterCells<3>&, std::span<const double>, std::span<double>);

}  // namespace polder::fdm
