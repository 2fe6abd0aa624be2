#include "fdm/volume_correction.hpp"

#include <algorithm>

#include "fdm/cell_operators.hpp"
#include "fdm/loops.hpp"

namespace polder::fdm {
namespace {

constexpr double kLargestExcess = 0.05;  // that one correction answers
constexpr double kTolerance = 1e-3;      // the next correction takes what this one leaves

}  // namespace

template <int D>
VolumeCorrection<D>::VolumeCorrection(const WaterCells<D>& cells, PressureField<D>& pressure)
    : cells_(cells), pressure_(pressure) {}

template <int D>
void VolumeCorrection<D>::refresh() {
  const auto boundary = cells_.boundary_faces();
  faces_.assign(boundary.begin(), boundary.end());
  for (BoundaryFace<D>& f : faces_) f.open = f.free_surface || f.outside >= 0;
  if (revision_ == cells_.revision()) return;
  revision_ = cells_.revision();
  edge_.assign(cells_.count(), 0);
  for (const BoundaryFace<D>& f : faces_)
    if (f.open) edge_[f.cell] = 1;
}

template <int D>
void VolumeCorrection<D>::solve(std::span<const double> excess, std::span<const double> porosity,
                                double share, Reals& displacement) {
  refresh();
  const Grid<D>& grid = cells_.grid();
  const auto cells = cells_.cells();
  const auto interior = cells_.interior_faces();
  const Basins& basins = pressure_.basins();
  const int n = cells_.count();
  displacement.assign(static_cast<std::size_t>(grid.slots()) * kStride, 0.0);
  if (n == 0) return;
  for (Reals* r : {&sink_, &rhs_, &x_}) r->assign(n, 0.0);
  link_.resize(interior.size());
  for_each(static_cast<int>(interior.size()), [&](int i) { link_[i] = interior[i].area / grid.spacing(); });
  for (const BoundaryFace<D>& f : faces_)
    if (f.open) sink_[f.cell] += f.area / f.distance;
  // A basin without a surface keeps its volume: what all its cells have too much cannot go anywhere.
  std::vector<double> total(basins.first_cell.size(), 0.0), volume(total), open(total);
  for (int c = 0; c < n; ++c) {
    const ActiveCell<D>& cell = cells[c];
    const double e = edge_[c] ? std::max(0.0, excess[cell.slot]) : excess[cell.slot];
    rhs_[c] = share * std::clamp(e, -kLargestExcess, kLargestExcess) * cell.volume;
    const int b = basins.of_cell[c];
    total[b] += rhs_[c], volume[b] += cell.volume, open[b] += sink_[c];
  }
  for (int c = 0; c < n; ++c) {
    const int b = basins.of_cell[c];
    if (open[b] > 0) continue;
    rhs_[c] -= total[b] / volume[b] * cells[c].volume;
    if (basins.first_cell[b] == c) sink_[c] = 1;
  }
  pressure_.solver().solve({sink_, link_, rhs_}, {.tolerance = kTolerance, .floor = 1e-300}, x_);
  psi_.assign(grid.slots(), 0.0);
  for (int c = 0; c < n; ++c) psi_[cells[c].slot] = x_[c];
  pressure_.gradient().evaluate(cells_, faces_, psi_, BoundaryValues::homogeneous, WallNormal::none,
                                displacement);
  // Porosity at the nodes: mean of the cells that meet there.
  psi_.assign(grid.slots(), 0.0);
  weight_.assign(grid.slots(), 0.0);
  for (const ActiveCell<D>& cell : cells)
    for (int node : cell.nodes) psi_[node] += porosity[cell.slot], weight_[node] += 1;
  for_each(grid.slots(), [&](int i) {
    const double scale = weight_[i] > 0 ? -weight_[i] / psi_[i] : -1.0;
    for (int d = 0; d < D; ++d) displacement[static_cast<std::size_t>(i) * kStride + d] *= scale;
  });
}

template class VolumeCorrection<2>;
template class VolumeCorrection<3>;

}  // namespace polder::fdm
