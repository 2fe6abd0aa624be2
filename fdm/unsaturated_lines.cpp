// Wells, drains and sheets in UnsaturatedField: conditions in fdm/water_conditions.hpp, cells and faces in
// fdm/water_lines.hpp.
#include <algorithm>
#include <cmath>
#include <limits>

#include "fdm/unsaturated_field.hpp"

namespace polder::fdm {
namespace {

// Conductance of a drain whose own is infinite, over that of its cell's faces in saturated soil.
constexpr double kOpenLine = 1e4;

}  // namespace

template <int D>
void UnsaturatedField<D>::find_lines() {
  const WaterConditions<D>& conditions = cells_.conditions();
  blocked_ = blocked_faces<D>(cells_, conditions.sheets);
  lines_.clear();
  const auto add = [&](const std::vector<Point<D>>& points, int owner, bool drain) {
    for (const CrossedCell& c : crossed_cells<D>(cells_, points))
      lines_.push_back({.cell = c.cell, .share = c.share, .owner = owner, .drain = drain});
  };
  for (int i = 0; i < static_cast<int>(conditions.wells.size()); ++i)
    add(conditions.wells[i].points, i, false);
  for (int i = 0; i < static_cast<int>(conditions.drains.size()); ++i)
    add(conditions.drains[i].points, i, true);
  line_flow_.assign(lines_.empty() ? 0 : cells_.count(), 0);
  line_conductance_.assign(line_flow_.size(), 0);
}

template <int D>
void UnsaturatedField<D>::prepare_lines() {
  constexpr double kUnlimited = std::numeric_limits<double>::infinity();
  for (LineSink& l : lines_) {
    double links = 0;
    for (int face : cells_.cells()[l.cell].faces)
      if (face >= 0) links += kappa_[face];
    if (l.drain) {
      const WaterDrain<D>& d = cells_.conditions().drains[l.owner];
      l.pressure = d.pressure;
      l.conductance = std::isfinite(d.conductance) ? d.conductance * l.share : kOpenLine * links;
      l.least = 0, l.most = kUnlimited;
    } else {
      const WaterWell<D>& w = cells_.conditions().wells[l.owner];
      const double rate = w.rate * l.share;
      const bool limited = std::isfinite(w.limiting_pressure);
      l.pressure = w.limiting_pressure;
      l.conductance = limited ? links : 0;
      l.least = limited ? std::min(rate, 0.0) : rate;
      l.most = limited ? std::max(rate, 0.0) : rate;
    }
  }
}

template <int D>
void UnsaturatedField<D>::assemble_lines() {
  std::fill(line_flow_.begin(), line_flow_.end(), 0.0);
  std::fill(line_conductance_.begin(), line_conductance_.end(), 0.0);
  for (LineSink& l : lines_) {
    const double driven = l.conductance > 0 ? l.conductance * (p_now_[l.cell] - l.pressure) : l.most;
    l.flow = std::clamp(driven, l.least, l.most);
    line_flow_[l.cell] += l.flow;
    if (driven > l.least && driven < l.most) line_conductance_[l.cell] += l.conductance;
  }
}

template void UnsaturatedField<2>::find_lines();
template void UnsaturatedField<3>::find_lines();
template void UnsaturatedField<2>::prepare_lines();
template void UnsaturatedField<3>::prepare_lines();
template void UnsaturatedField<2>::assemble_lines();
template void UnsaturatedField<3>::assemble_lines();

}  // namespace polder::fdm
