// Seepage faces on cut surfaces in UnsaturatedField.
//
// A slope made of cells is a flight of steps. At its seepage face the pressure is zero and water leaves, but
// what flows along the slope leaves through the upright faces of the steps and enters through the level ones
// again; only together is it the flow through the slope, and that is what may not be negative. Closing each
// level face on its own would drain the slope as if it lay a fraction of a cell further in. So what seeps out
// of the upright faces of a step runs down and may enter the level ones at its foot, as far as they take it
// under zero pressure.
//
// Only where the field resolves free surfaces within cells (set_averages).
#include <algorithm>

#include "fdm/unsaturated_field.hpp"

namespace polder::fdm {
namespace {

// In cells; what is flatter or steeper counts as level or upright.
constexpr int kLongestStep = 5;

}  // namespace

template <int D>
void UnsaturatedField<D>::find_steps() {
  steps_.clear();
  const auto cells = cells_.cells();
  const auto boundary = cells_.boundary_faces();
  const int n_interior = static_cast<int>(cells_.interior_faces().size());
  const auto surface_of = [&](const Index<D>& at, int side) {  // the cell's surface face on a side, or -1
    for (int d = 0; d < D; ++d)
      if (at[d] < 0 || at[d] >= cells_.grid().cells()[d]) return -1;
    const int slot = cells_.grid().slot(at);
    if (slot < 0 || !cells_.active(slot)) return -1;
    const int face = cells[cells_.number(slot)].faces[side] - n_interior;
    return face >= 0 && boundary[face].free_surface ? face : -1;
  };
  for (const ActiveCell<D>& c : cells)
    for (int side = 0; side < 2 * (D - 1); ++side) {
      if (surface_of(c.index, side) < 0) continue;
      Step step;
      Index<D> at = c.index;
      --at[D - 1];
      for (int k = 0; k < kLongestStep; ++k) {
        at[side / 2] += side % 2 ? 1 : -1;
        const int face = surface_of(at, 2 * D - 1);
        if (face < 0) break;
        step.below.push_back(face);
      }
      if (step.below.empty()) continue;
      at = c.index;
      for (int k = 0; k < kLongestStep; ++k, ++at[D - 1]) {
        const int face = surface_of(at, side);
        if (face < 0) break;
        step.above.push_back(face);
      }
      step.potential.resize(step.below.size());
      steps_.push_back(std::move(step));
    }
}

// What the level faces could take, and what of it they get.
template <int D>
void UnsaturatedField<D>::run_off() {
  const auto boundary = cells_.boundary_faces();
  const int n_interior = static_cast<int>(cells_.interior_faces().size());
  for (Step& step : steps_) {
    double out = 0;
    step.demand = 0;
    for (int face : step.above) out += std::max(0.0, -flow_[n_interior + face]);
    for (std::size_t i = 0; i < step.below.size(); ++i) {
      const int face = step.below[i];
      const BoundaryLaw& law = laws_[face];
      const bool takes = law.kind == BoundaryLaw::Kind::complementary && law.inflow == 0;
      const double driven = law.upper - p_now_[boundary[face].cell] + law.gravity;
      step.potential[i] =
          takes ? std::max(0.0, kappa_[n_interior + face] * law.upper_conductivity * driven) : 0;
      step.demand += step.potential[i];
    }
    step.part = step.demand > 0 ? std::min(1.0, out / step.demand) : 0;
    if (step.part == 0) continue;
    for (std::size_t i = 0; i < step.below.size(); ++i) {
      if (step.potential[i] == 0) continue;
      const int face = n_interior + step.below[i];
      flow_[face] = step.part * step.potential[i];
      conductance_[face] = step.part * kappa_[face] * laws_[step.below[i]].upper_conductivity;
    }
  }
}

// Adds to the flows of boundary faces what changes v of p change in the parts above: with the supply
// Q = sum of -flow above and the demand P = sum of potentials below, flow_i = P_i Q / P where Q < P.
template <int D>
void UnsaturatedField<D>::add_run_off(std::span<const double> v, std::span<double> flow) const {
  const auto boundary = cells_.boundary_faces();
  const int n_interior = static_cast<int>(cells_.interior_faces().size());
  for (const Step& step : steps_) {
    if (step.part == 0 || step.part == 1) continue;
    double supply = 0, demand = 0;  // their changes
    for (int face : step.above)
      if (flow_[n_interior + face] < 0) supply += conductance_[n_interior + face] * v[boundary[face].cell];
    for (std::size_t i = 0; i < step.below.size(); ++i)
      if (step.potential[i] > 0)
        demand -= conductance_[n_interior + step.below[i]] / step.part * v[boundary[step.below[i]].cell];
    for (std::size_t i = 0; i < step.below.size(); ++i)
      flow[n_interior + step.below[i]] += step.potential[i] / step.demand * (supply - step.part * demand);
  }
}

template void UnsaturatedField<2>::find_steps();
template void UnsaturatedField<3>::find_steps();
template void UnsaturatedField<2>::run_off();
template void UnsaturatedField<3>::run_off();
template void UnsaturatedField<2>::add_run_off(std::span<const double>, std::span<double>) const;
template void UnsaturatedField<3>::add_run_off(std::span<const double>, std::span<double>) const;

}  // namespace polder::fdm
