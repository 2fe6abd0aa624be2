// Explicit steps of both pressure fields (fdm/explicit_pressure.hpp): flows through the faces at the pressure
// before the step, one equation for the new pressure of each cell, no linear system.
//
// Unsaturated cells keep the balance of fdm/unsaturated_field.hpp, differences of stored volumes and not
// capacities times dp: the new p is the root of
//   n vf V [S(p) - S^n] / dt + S(p) [vf V n / K_w (p - p^n) / dt + (D v)_c] = inflow at p^n,
// so that no water is lost where a cell fills or the curve bends. Wells and drains are taken at the new
// pressure: an open drain conducts too well for an explicit step.
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/error.hpp"
#include "fdm/explicit_pressure.hpp"
#include "fdm/loops.hpp"
#include "fdm/pressure_field.hpp"
#include "fdm/unsaturated_field.hpp"

namespace polder::fdm {
namespace {

// A cell with less air than this share of its pores may be full after the step: the limit counts it as full.
constexpr double kNearlyFull = 0.05;

// Water that the root of a cell's balance may miss, as a share of its pores.
constexpr double kRootTolerance = 1e-14;

// A / (rho d) of all faces from 1 / rho of the cells.
template <int D>
void find_inertia(const WaterCells<D>& cells, std::span<const double> specific_volume, Reals& inertia) {
  const auto list = cells.cells();
  const auto interior = cells.interior_faces();
  const auto boundary = cells.boundary_faces();
  const int n_interior = static_cast<int>(interior.size());
  const double per_spacing = 1 / cells.grid().spacing();
  inertia.resize(interior.size() + boundary.size());
  for_each(n_interior, [&](int i) {
    const InteriorFace<D>& f = interior[i];
    inertia[i] =
        0.5 * (specific_volume[list[f.low].slot] + specific_volume[list[f.high].slot]) * f.area * per_spacing;
  });
  for (std::size_t b = 0; b < boundary.size(); ++b)
    inertia[n_interior + b] =
        specific_volume[list[boundary[b].cell].slot] * boundary[b].area / boundary[b].distance;
}

// The same from that of the faces.
template <int D>
void find_face_inertia(const WaterCells<D>& cells, std::span<const double> specific_volume, Reals& inertia) {
  const auto interior = cells.interior_faces();
  const auto boundary = cells.boundary_faces();
  if (specific_volume.size() < interior.size() + boundary.size())
    throw std::logic_error("explicit pressure: the specific volumes do not cover the faces");
  inertia.resize(interior.size() + boundary.size());
  for (std::size_t i = 0; i < interior.size(); ++i)
    inertia[i] = specific_volume[i] * interior[i].area / cells.grid().spacing();
  for (std::size_t b = 0; b < boundary.size(); ++b)
    inertia[interior.size() + b] =
        specific_volume[interior.size() + b] * boundary[b].area / boundary[b].distance;
}

void require_compressible(double bulk_modulus) {
  if (!std::isfinite(bulk_modulus))
    throw InputError("water: an explicit step of the pore pressure needs a finite bulk modulus");
}

}  // namespace

// ---- saturated

template <int D>
ExplicitLimit PressureField<D>::explicit_limit(const PressureStep& step,
                                               std::span<const double> specific_volume) {
  require_compressible(water_.bulk_modulus);
  require_current(std::min({step.porosity.size(), step.darcy_mobility.size(), specific_volume.size()}));
  find_inertia(cells_, specific_volume, limit_inertia_);
  return limit_of_inertia(step);
}

template <int D>
ExplicitLimit PressureField<D>::explicit_limit_of_faces(const PressureStep& step,
                                                        std::span<const double> specific_volume) {
  require_compressible(water_.bulk_modulus);
  require_current(std::min(step.porosity.size(), step.darcy_mobility.size()));
  find_face_inertia(cells_, specific_volume, limit_inertia_);
  return limit_of_inertia(step);
}

template <int D>
ExplicitLimit PressureField<D>::limit_of_inertia(const PressureStep& step) {
  const auto cells = cells_.cells();
  const auto interior = cells_.interior_faces();
  const auto boundary = cells_.boundary_faces();
  const int n_interior = static_cast<int>(interior.size());
  const double per_spacing = 1 / cells_.grid().spacing();
  limit_darcy_.resize(interior.size() + boundary.size());
  limit_storage_.resize(cells.size());
  for_each(n_interior, [&](int i) {
    const InteriorFace<D>& f = interior[i];
    limit_darcy_[i] =
        harmonic_mean(step.darcy_mobility[cells[f.low].slot], step.darcy_mobility[cells[f.high].slot]) *
        f.area * per_spacing;
  });
  for (std::size_t b = 0; b < boundary.size(); ++b) {
    const BoundaryFace<D>& f = boundary[b];
    limit_darcy_[n_interior + b] = f.open ? step.darcy_mobility[cells[f.cell].slot] * f.area / f.distance : 0;
    if (!f.open) limit_inertia_[n_interior + b] = 0;
  }
  for_each(cells_.count(), [&](int c) {
    limit_storage_[c] = step.porosity[cells[c].slot] / water_.bulk_modulus * cells[c].volume;
  });
  return fdm::explicit_limit(cells_, {limit_storage_, limit_darcy_, limit_inertia_, step.rhie_chow});
}

template <int D>
void PressureField<D>::advance(const PressureStep& step) {
  require_compressible(water_.bulk_modulus);
  const bool mixture = require_step(step);
  if (!(step.dt > 0)) throw std::logic_error("PressureField: the time step must be positive");
  const auto cells = cells_.cells();
  const auto boundary = cells_.boundary_faces();
  face_terms(step, true);
  for_each(cells_.count(), [&](int c) {
    divergence_[c] = mixture ? step.divergence[c] : cell_outflow<D>(cells[c], step.velocity);
    storage_[c] = step.porosity[cells[c].slot] / water_.bulk_modulus * cells[c].volume / step.dt;
  });
  net_inflow<D>(cells_, divergence_, flow_, rhs_);
  for_each(cells_.count(), [&](int c) {
    x_[c] = rhs_[c] / storage_[c];
    dp_[cells[c].slot] = x_[c];
    p_[cells[c].slot] += x_[c];
  });

  balance_ = {};
  for (int c = 0; c < cells_.count(); ++c) {
    balance_.storage += rhs_[c];
    balance_.skeleton += divergence_[c];
    balance_.magnitude += std::abs(rhs_[c]) + std::abs(divergence_[c]);
  }
  const std::size_t interior = cells_.interior_faces().size();
  for (std::size_t b = 0; b < boundary.size(); ++b) {
    balance_.outflow -= flow_[interior + b];
    balance_.magnitude += std::abs(flow_[interior + b]);
  }
}

// ---- unsaturated

template <int D>
ExplicitLimit UnsaturatedField<D>::limit_of_assembled(const UnsaturatedStep& step,
                                                      std::span<const double> specific_volume) {
  const auto cells = cells_.cells();
  const auto interior = cells_.interior_faces();
  const auto boundary = cells_.boundary_faces();
  const int n_interior = static_cast<int>(interior.size());
  find_inertia(cells_, specific_volume, limit_inertia_);
  limit_darcy_.resize(interior.size() + boundary.size());
  limit_storage_.resize(cells.size());
  for_each(n_interior, [&](int i) {
    limit_darcy_[i] = kappa_[i] * std::max(kr_[interior[i].low], kr_[interior[i].high]);
  });
  for (std::size_t b = 0; b < boundary.size(); ++b) {
    const double relative = std::max(kr_[boundary[b].cell], laws_[b].upper_conductivity);
    const bool closed = laws_[b].kind == BoundaryLaw::Kind::closed;
    limit_darcy_[n_interior + b] = closed ? 0 : kappa_[n_interior + b] * relative;
    if (!gradient_faces_[b].open) limit_inertia_[n_interior + b] = 0;
  }
  for_each(cells_.count(), [&](int c) {
    const Retention& r = curves_[soil_[c]].parameters();
    const bool full = r.maximum - s_now_[c] <= kNearlyFull * (r.maximum - r.residual);
    const double capacity = full ? 0 : cell_[c].pores * capacity_[c];
    limit_storage_[c] = step.dt * (capacity + s_now_[c] * cell_[c].elastic);
  });
  return fdm::explicit_limit(cells_, {limit_storage_, limit_darcy_, limit_inertia_, step.rhie_chow});
}

template <int D>
ExplicitLimit UnsaturatedField<D>::explicit_limit(const UnsaturatedStep& step,
                                                  std::span<const double> specific_volume) {
  require_compressible(water_.bulk_modulus);
  UnsaturatedStep rest = step;
  rest.dt = 1;  // of no account
  rest.velocity = rest.mobility = {};
  prepare(rest);
  assemble();
  return limit_of_assembled(rest, specific_volume);
}

// Pressure at which cell c stores what it had and `inflow` [m3/s] besides, of which `drawn` per Pa of
// pressure goes to wells and drains. Newton's method between two bounds of the root.
template <int D>
double UnsaturatedField<D>::stored_pressure(int c, double inflow, double drawn) const {
  constexpr int kMost = 200;
  const Cell& k = cell_[c];
  const RetentionCurve& curve = curves_[soil_[c]];
  const double before = p_old_[c], driest = -unit_weight_ * RetentionCurve::kDriestSuction;
  double low = driest, high = std::numeric_limits<double>::infinity(), p = before;
  for (int i = 0; i < kMost; ++i) {
    const double s = curve.saturation(p), swell = k.elastic * (p - before) + k.source;
    const double excess = k.pores * (s - s_old_[c]) + s * swell + drawn * (p - before) - inflow;
    if (std::abs(excess) <= kRootTolerance * k.pores) return p;
    (excess > 0 ? high : low) = p;
    const double slope = curve.capacity(p) * (k.pores + swell) + s * k.elastic + drawn;
    const double next = p - excess / slope;
    if (next > low && next < high) {
      if (next == p) return p;
      p = next;
    } else if (std::isinf(high)) {
      p = std::max(2 * std::abs(p), 1.0);  // beyond full pores the balance is linear: the next one finds it
    } else {
      p = 0.5 * (low + high);
      if (p <= low || p >= high) return p;
    }
  }
  return p;
}

template <int D>
ExplicitLimit UnsaturatedField<D>::advance_explicitly(const UnsaturatedStep& step,
                                                      std::span<const double> specific_volume) {
  require_compressible(water_.bulk_modulus);
  if (!(step.dt > 0) || step.velocity.empty())
    throw std::logic_error("UnsaturatedField: an explicit step needs a time step and a moving skeleton");
  lags_ = false;
  prepare(step);
  assemble();
  const ExplicitLimit limit = limit_of_assembled(step, specific_volume);

  // Flows with the pressure before the step.
  const auto cells = cells_.cells();
  const int n_interior = static_cast<int>(cells_.interior_faces().size());
  change_.assign(cells.size(), 0.0);
  net_inflow<D>(cells_, change_, flow_, rhs_);  // the outflow of the skeleton depends on the new saturation
  for_each(cells_.count(), [&](int c) {
    double interpolation = 0;
    for (int side = 0; side < 2 * D; ++side) {
      const int face = cells[c].faces[side];
      if (face < 0 || face >= n_interior) continue;
      const InteriorFace<D>& f = cells_.interior_faces()[face];
      if (!was_wet_[f.low] || !was_wet_[f.high]) continue;
      interpolation += side % 2 ? correction_[face] : -correction_[face];
    }
    projection_[c] = interpolation;
    const double lines = line_flow_.empty() ? 0 : line_flow_[c];
    const double drawn = line_flow_.empty() ? 0 : line_conductance_[c];
    p_now_[c] = stored_pressure(c, rhs_[c] + interpolation - lines, drawn);
  });
  for (LineSink& l : lines_)
    if (l.conductance > 0 && l.flow > l.least && l.flow < l.most)
      l.flow += l.conductance * (p_now_[l.cell] - p_old_[l.cell]);
  for (std::size_t s = 0; s < curves_.size(); ++s)
    curves_[s].evaluate(cells_of_soil_[s], p_now_, s_now_, capacity_, kr_);
  for_each(cells_.count(), [&](int c) { plus_change_[c] = positive(c) - positive_old_[c]; });
  accept();
  return limit;
}

#define POLDER_INSTANTIATE(D)                                                                            \
  template ExplicitLimit PressureField<D>::explicit_limit(const PressureStep&, std::span<const double>); \
  template ExplicitLimit PressureField<D>::explicit_limit_of_faces(const PressureStep&,                  \
                                                                   std::span<const double>);             \
  template ExplicitLimit PressureField<D>::limit_of_inertia(const PressureStep&);                        \
  template void PressureField<D>::advance(const PressureStep&);                                          \
  template ExplicitLimit UnsaturatedField<D>::explicit_limit(const UnsaturatedStep&,                     \
                                                             std::span<const double>);                   \
  template ExplicitLimit UnsaturatedField<D>::advance_explicitly(const UnsaturatedStep&,                 \
                                                                 std::span<const double>);               \
  template double UnsaturatedField<D>::stored_pressure(int, double, double) const;                       \
  template ExplicitLimit UnsaturatedField<D>::limit_of_assembled(const UnsaturatedStep&,                 \
                                                                 std::span<const double>);
POLDER_INSTANTIATE(2)
POLDER_INSTANTIATE(3)

}  // namespace polder::fdm
