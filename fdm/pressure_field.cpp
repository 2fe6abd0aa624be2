#include "fdm/pressure_field.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/error.hpp"
#include "fdm/cell_operators.hpp"
#include "fdm/loops.hpp"

namespace polder::fdm {
namespace {

// A basin counts as closed when storage and open faces together conduct less than this part of its links:
// below it the level of the pressure would be decided by rounding.
constexpr double kClosedBasin = 1e-11;

// Conditions that switch with the solution, or that ask for suction, belong to UnsaturatedField.
template <int D>
void refuse_unsaturated(const WaterConditions<D>& conditions) {
  using Kind = typename WaterBoundary<D>::Kind;
  for (const WaterBoundary<D>& b : conditions.boundaries)
    if (b.kind == Kind::flux || b.kind == Kind::atmosphere || b.seepage_above || b.side == kFreeSurface)
      throw std::logic_error("PressureField: water boundary '" + b.name + "' needs the unsaturated equation");
  if (!conditions.wells.empty() || !conditions.drains.empty() || !conditions.sheets.empty())
    throw std::logic_error("PressureField: wells, drains and sheets need the unsaturated equation");
}

}  // namespace

double Discharge::total() const {
  double sum = surface;
  for (const std::vector<double>* list : {&boundary, &well, &drain})
    for (double q : *list) sum += q;
  return sum;
}

template <int D>
PressureField<D>::PressureField(const WaterCells<D>& cells, const WaterProperties<D>& water,
                                SolverKind solver)
    : cells_(cells), water_(water), solver_(make_solver<D>(solver)) {
  if (!(water.density > 0) || !(water.bulk_modulus > 0))
    throw InputError("water: density and bulk modulus must be positive");
}

template <int D>
PressureField<D>::~PressureField() = default;

template <int D>
const char* PressureField<D>::solver_name() const {
  return solved_by_ != nullptr ? solved_by_ : solver_->name();
}

template <int D>
void PressureField<D>::carry() {
  const Grid<D>& grid = cells_.grid();
  grid.carry(p_);
  dp_.assign(grid.slots(), 0);
  grid_revision_ = grid.revision();
}

template <int D>
void PressureField<D>::restore(const Reals& pressure, const std::vector<int>& pressure_cells) {
  if (pressure_cells != pressure_cells_) cells_revision_ = 0;
  p_ = pressure, pressure_cells_ = pressure_cells;
}

template <int D>
void PressureField<D>::refresh() {
  const Grid<D>& grid = cells_.grid();
  if (p_.empty()) carry();
  if (grid_revision_ != grid.revision())
    throw std::logic_error("PressureField: the grid changed and carry() was not called");
  if (cells_revision_ == cells_.revision()) return;
  refuse_unsaturated(cells_.conditions());
  cells_revision_ = cells_.revision();
  pressure_cells_.clear();
  for (const ActiveCell<D>& c : cells_.cells()) pressure_cells_.push_back(c.slot);
  gradient_.build(cells_);
  for (int s = 0; s < grid.slots(); ++s)
    if (!cells_.active(s)) p_[s] = 0;
  fill_new_cells();
  std::fill(dp_.begin(), dp_.end(), 0.0);
  node_grad_.assign(static_cast<std::size_t>(grid.slots()) * kStride, 0);

  const std::size_t n = cells_.count(), interior = cells_.interior_faces().size();
  const std::size_t boundary = cells_.boundary_faces().size();
  for (Reals* a : {&flow_, &conductance_}) a->assign(interior + boundary, 0);
  for (Reals* a : {&boundary_inertia_, &boundary_darcy_}) a->assign(boundary, 0);
  for (Reals* a : {&storage_, &sink_, &rhs_, &x_}) a->assign(n, 0);
  divergence_.assign(n, 0);
  discharge_.boundary.assign(cells_.conditions().boundaries.size(), 0);
  balance_ = {};
  basins_ = find_basins(cells_);
  basin_sink_.assign(basins_.first_cell.size(), 0);
  basin_scale_.assign(basins_.first_cell.size(), 0);

  Connectivity<D> connectivity;
  connectivity.cells.reserve(n);
  connectivity.links.reserve(interior);
  for (const ActiveCell<D>& c : cells_.cells()) connectivity.cells.push_back(c.index);
  for (const InteriorFace<D>& f : cells_.interior_faces())
    connectivity.links.push_back({f.low, f.high, f.axis});
  solver_->analyse(connectivity);
  solved_by_ = nullptr;
}

// A cell without a pressure of its own takes the mean of what surrounds it, weighted with the inverse of the
// distances: exact where pressure is linear between the last cell and the surface, so that a hydrostatic
// state does not notice when the mask follows the surface. Cells without pressure do not count as neighbours.
template <int D>
void PressureField<D>::fill_new_cells() {
  const int n_interior = static_cast<int>(cells_.interior_faces().size());
  std::vector<std::pair<int, double>> found;
  for (int c = 0; c < cells_.count(); ++c) {
    const ActiveCell<D>& cell = cells_.cells()[c];
    if (p_[cell.slot] != 0) continue;
    double sum = 0, weight = 0;
    for (int face : cell.faces) {
      double p = 0, distance = cells_.grid().spacing();
      if (face < 0) continue;
      if (face < n_interior) {
        const InteriorFace<D>& f = cells_.interior_faces()[face];
        p = p_[cells_.cells()[f.low == c ? f.high : f.low].slot];
        if (p == 0) continue;
      } else {
        const BoundaryFace<D>& f = cells_.boundary_faces()[face - n_interior];
        if (!f.open) continue;
        p = f.pressure, distance = f.distance;
      }
      sum += p / distance, weight += 1 / distance;
    }
    if (weight > 0) found.emplace_back(cell.slot, sum / weight);
  }
  for (const auto& [slot, p] : found) p_[slot] = p;
}

template <int D>
void PressureField<D>::require_current(std::size_t slots) const {
  if (cells_revision_ != cells_.revision() || cells_revision_ == 0)
    throw std::logic_error("PressureField: the active cells changed and refresh() was not called");
  if (slots < static_cast<std::size_t>(cells_.grid().slots()))
    throw std::logic_error("PressureField: an array does not cover the grid");
}

template <int D>
void PressureField<D>::require_mixture(const PressureStep& step) const {
  const std::size_t faces = cells_.interior_faces().size() + cells_.boundary_faces().size();
  if (step.divergence.size() < static_cast<std::size_t>(cells_.count()) || step.face_mobility.size() < faces)
    throw std::logic_error("PressureField: the mixture's flow does not cover the cells");
}

template <int D>
bool PressureField<D>::require_step(const PressureStep& step) const {
  require_current(std::min({p_.size(), step.porosity.size(), step.darcy_mobility.size()}));
  const bool mixture = !step.divergence.empty();
  if (mixture)
    require_mixture(step);
  else
    require_current(std::min(step.velocity.size() / kStride, step.mobility.size()));
  return mixture;
}

// ---- assembly
// -------------------------------------------------------------------------------------------------------

// Volume flow out of the soil at the present pressure, - kappa (dp/dn - rho_w g.n) A.
template <int D>
double PressureField<D>::darcy_outflow(const BoundaryFace<D>& f, double darcy_mobility) const {
  if (!f.open) return 0;
  const double gradient = (f.pressure - p_[cells_.cells()[f.cell].slot]) / f.distance;
  return -darcy_mobility * f.area * (gradient - water_.density * water_.gravity[f.axis] * f.outward);
}

template <int D>
void PressureField<D>::face_terms(const PressureStep& step, bool inertia) {
  const auto cells = cells_.cells();
  const auto interior = cells_.interior_faces();
  const auto boundary = cells_.boundary_faces();
  const int n_interior = static_cast<int>(interior.size());
  const double per_spacing = 1 / cells_.grid().spacing(), chi = step.rhie_chow;
  const std::span<const double> darcy_mobility = step.darcy_mobility;
  std::span<const double> node_gradient = step.pressure_gradient;
  if (inertia && chi > 0 && node_gradient.empty()) {
    gradient_.evaluate(cells_, p_, BoundaryValues::present, WallNormal::none, node_grad_);
    node_gradient = node_grad_;
  }
  const auto mobility_of = [&](int face, const FaceNodes<D>& nodes) {
    return step.face_mobility.empty() ? face_mobility<D>(nodes, step.mobility) : step.face_mobility[face];
  };

  for_each(n_interior, [&](int i) {
    const InteriorFace<D>& f = interior[i];
    const int low = cells[f.low].slot, high = cells[f.high].slot;
    const double gradient = (p_[high] - p_[low]) * per_spacing;
    const double kappa = harmonic_mean(darcy_mobility[low], darcy_mobility[high]);
    double flow = kappa * (gradient - water_.density * water_.gravity[f.axis]);
    double conductance = kappa;
    if (inertia) {
      const double lam = mobility_of(i, f.nodes);
      conductance += lam * (1 + chi);
      if (chi > 0) {
        double mean = 0;
        for (int node : f.nodes) mean += node_gradient[static_cast<std::size_t>(node) * kStride + f.axis];
        flow += chi * lam * (gradient - mean / static_cast<double>(f.nodes.size()));
      }
    }
    flow_[i] = f.area * flow;  // enters the low cell, leaves the high one
    conductance_[i] = f.area * per_spacing * conductance;
  });

  for_each(static_cast<int>(boundary.size()), [&](int b) {
    const BoundaryFace<D>& f = boundary[b];
    const double kappa = darcy_mobility[cells[f.cell].slot];
    const double lam = inertia && f.open ? mobility_of(n_interior + b, f.nodes) : 0;
    boundary_darcy_[b] = kappa;
    boundary_inertia_[b] = lam * f.area / f.distance;
    flow_[n_interior + b] = -darcy_outflow(f, kappa);
    conductance_[n_interior + b] = f.open ? (kappa + lam) * f.area / f.distance : 0;
  });
}

// Right-hand side, sinks and the rounding floor of the right-hand side, cell by cell from the faces.
template <int D>
void PressureField<D>::gather_sinks() {
  const auto cells = cells_.cells();
  const int n_interior = static_cast<int>(cells_.interior_faces().size());
  for_each(cells_.count(), [&](int c) {
    double rhs = -divergence_[c], sink = storage_[c], diagonal = storage_[c];
    for (int side = 0; side < 2 * D; ++side) {
      const int face = cells[c].faces[side];
      if (face < 0) continue;
      diagonal += conductance_[face];
      if (face >= n_interior) {
        rhs += flow_[face];
        sink += conductance_[face];
      } else {
        rhs += side % 2 ? flow_[face] : -flow_[face];
      }
    }
    rhs_[c] = rhs;
    sink_[c] = sink;
    x_[c] = diagonal;
  });
  double p2 = 0;
  for (int c = 0; c < cells_.count(); ++c) {
    const double p = p_[cells[c].slot];
    p2 += x_[c] * p * p;
    if (x_[c] > 0) continue;
    const bool walled =
        std::all_of(cells[c].faces.begin(), cells[c].faces.end(), [](int f) { return f < 0; });
    if (walled && storage_[c] == 0) continue;  // a basin of one cell; pinned
    std::string place;
    for (double x : cells_.centre(cells[c].index)) place += (place.empty() ? "" : ", ") + std::to_string(x);
    throw NumericalError("pressure equation: the cell at (" + place +
                         ") m is coupled to nothing: no nodal mass, no conductivity and no storage");
  }
  accuracy_.floor = 8 * std::numeric_limits<double>::epsilon() * std::sqrt(p2);
}

// Holds the increment of the first cell of every closed basin at zero: a sink there as large as the cell's
// links. With a compatible right-hand side (no net inflow) the sink takes nothing and the solution is exact;
// otherwise what it takes shows as the defect of the balance.
template <int D>
void PressureField<D>::pin_closed_basins() {
  const auto interior = cells_.interior_faces();
  std::fill(basin_sink_.begin(), basin_sink_.end(), 0.0);
  std::fill(basin_scale_.begin(), basin_scale_.end(), 0.0);
  for (int c = 0; c < cells_.count(); ++c) basin_sink_[basins_.of_cell[c]] += sink_[c];
  for (std::size_t f = 0; f < interior.size(); ++f)
    basin_scale_[basins_.of_cell[interior[f].low]] += conductance_[f];
  pinned_ = 0;
  for (std::size_t b = 0; b < basins_.first_cell.size(); ++b) {
    if (basin_sink_[b] > kClosedBasin * basin_scale_[b]) continue;
    const int c = basins_.first_cell[b];
    double links = 0;
    for (int face : cells_.cells()[c].faces)
      if (face >= 0 && face < static_cast<int>(interior.size())) links += conductance_[face];
    sink_[c] += links > 0 ? links : 1;
    if (links == 0) rhs_[c] = 0;
    ++pinned_;
  }
}

// ---- solution
// -------------------------------------------------------------------------------------------------------

template <int D>
SolveReport PressureField<D>::solve_increment() {
  const auto cells = cells_.cells();
  gather_sinks();
  pin_closed_basins();
  const SystemValues system{
      sink_, std::span<const double>(conductance_).first(cells_.interior_faces().size()), rhs_};
  const SolveReport report = solver_->solve(system, accuracy_, x_);
  solved_by_ = solver_->name();
  for_each(cells_.count(), [&](int c) {
    dp_[cells[c].slot] = x_[c];
    p_[cells[c].slot] += x_[c];
  });
  return report;
}

template <int D>
SolveReport PressureField<D>::solve(const PressureStep& step) {
  const std::size_t slots = cells_.grid().slots();
  const bool mixture = require_step(step);
  if (!step.pressure_gradient.empty() && step.pressure_gradient.size() < slots * kStride)
    throw std::logic_error("PressureField: the pressure gradient does not cover the grid");
  if (!step.skeleton_compressibility.empty() && step.skeleton_compressibility.size() < slots)
    throw std::logic_error("PressureField: the compressibility does not cover the grid");
  if (!(step.dt > 0)) throw std::logic_error("PressureField: the time step must be positive");
  const auto cells = cells_.cells();
  const auto boundary = cells_.boundary_faces();
  if (p_.size() != slots)
    throw std::logic_error("PressureField: the grid changed and carry() was not called");

  face_terms(step, true);
  for_each(cells_.count(), [&](int c) {
    divergence_[c] = mixture ? step.divergence[c] : cell_outflow<D>(cells[c], step.velocity);
    const int slot = cells[c].slot;
    const double skeleton = step.skeleton_compressibility.empty() ? 0 : step.skeleton_compressibility[slot];
    storage_[c] = (step.porosity[slot] / water_.bulk_modulus + skeleton) * cells[c].volume / step.dt;
  });
  const SolveReport report = solve_increment();

  balance_ = {};
  for (int c = 0; c < cells_.count(); ++c) {
    const double stored = storage_[c] * x_[c];
    balance_.storage += stored;
    balance_.skeleton += divergence_[c];
    balance_.magnitude += std::abs(stored) + std::abs(divergence_[c]);
  }
  for (std::size_t b = 0; b < boundary.size(); ++b) {
    const double corrected = boundary_inertia_[b] * x_[boundary[b].cell];
    const double outflow = darcy_outflow(boundary[b], boundary_darcy_[b]);
    balance_.projection += corrected;
    balance_.outflow += outflow;
    balance_.magnitude += std::abs(corrected) + std::abs(outflow);
  }
  return report;
}

template <int D>
SolveReport PressureField<D>::steady(std::span<const double> darcy_mobility) {
  require_current(std::min(p_.size(), darcy_mobility.size()));
  const auto cells = cells_.cells();
  for (const ActiveCell<D>& c : cells)
    if (!(darcy_mobility[c.slot] > 0))
      throw NumericalError("steady seepage needs a positive hydraulic conductivity in every cell with water");
  std::fill(p_.begin(), p_.end(), 0.0);
  std::fill(storage_.begin(), storage_.end(), 0.0);
  std::fill(divergence_.begin(), divergence_.end(), 0.0);
  SolveReport report;
  PressureStep step;
  step.darcy_mobility = darcy_mobility;
  for (int pass = 0; pass < 2; ++pass) {  // the second solves for what rounding and tolerance left
    face_terms(step, false);
    const SolveReport r = solve_increment();
    report.iterations += r.iterations;
    report.residual = r.residual;
  }
  std::fill(dp_.begin(), dp_.end(), 0.0);
  return report;
}

// ---- evaluation
// -----------------------------------------------------------------------------------------------------

template <int D>
void PressureField<D>::node_gradient(std::span<const double> field, BoundaryValues values, WallNormal walls,
                                     std::span<double> out) {
  require_current(std::min(field.size(), out.size() / kStride));
  gradient_.evaluate(cells_, field, values, walls, out);
}

template <int D>
void PressureField<D>::cell_divergence(std::span<const double> velocity, std::span<double> out) const {
  const auto cells = cells_.cells();
  std::fill(out.begin(), out.end(), 0.0);
  for_each(cells_.count(),
           [&](int c) { out[cells[c].slot] = cell_outflow<D>(cells[c], velocity) / cells[c].volume; });
}

template <int D>
const Discharge& PressureField<D>::discharge() {
  const auto boundary = cells_.boundary_faces();
  discharge_.surface = 0;
  std::fill(discharge_.boundary.begin(), discharge_.boundary.end(), 0.0);
  for (std::size_t b = 0; b < boundary.size(); ++b) {
    const double q = darcy_outflow(boundary[b], boundary_darcy_[b]);
    (boundary[b].boundary < 0 ? discharge_.surface : discharge_.boundary[boundary[b].boundary]) += q;
  }
  return discharge_;
}

template <int D>
Reals PressureField<D>::darcy_flow(std::span<const double> darcy_mobility) const {
  require_current(std::min(p_.size(), darcy_mobility.size()));
  const auto cells = cells_.cells();
  const auto interior = cells_.interior_faces();
  const auto boundary = cells_.boundary_faces();
  Reals flow(interior.size() + boundary.size());
  for (std::size_t i = 0; i < interior.size(); ++i) {
    const InteriorFace<D>& f = interior[i];
    const int low = cells[f.low].slot, high = cells[f.high].slot;
    const double gradient = (p_[high] - p_[low]) / cells_.grid().spacing();
    flow[i] = f.area * harmonic_mean(darcy_mobility[low], darcy_mobility[high]) *
              (gradient - water_.density * water_.gravity[f.axis]);
  }
  for (std::size_t b = 0; b < boundary.size(); ++b)
    flow[interior.size() + b] = -darcy_outflow(boundary[b], darcy_mobility[cells[boundary[b].cell].slot]);
  return flow;
}

template <int D>
WaterBalance PressureField<D>::balance(std::span<const double> velocity) const {
  WaterBalance result = balance_;
  result.projection = 0;
  result.skeleton = 0;
  for (const ActiveCell<D>& c : cells_.cells()) {
    result.skeleton += cell_outflow<D>(c, velocity);
  }
  return result;
}

template class PressureField<2>;
template class PressureField<3>;

}  // namespace polder::fdm
