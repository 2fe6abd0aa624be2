// Pore pressure advanced explicitly from the compressibility of the water: what a cell gains and loses in a
// step, and how long a step may be.
//
// The volume balance of a cell (Higo et al. 2010, Soils Found. 50; unsaturated: Higo et al. 2015) is taken as
// it stands,
//   storage_c (p^{n+1} - p^n) / dt = - outflow_c + sum_f (+-) flow_f(p^n),
// outflow: the divergence of what carries the pressure, integrated over the cell, with the velocities that
// the pressure of the last step has already changed (symplectic: stable undamped waves up to a limit); flow:
// what passes the faces besides, by Darcy's law. Both come from the caller, so that the same update serves a
// mixture in one layer (outflow of the skeleton, Darcy flow) and one in two (outflow of both, no Darcy flow).
//
// The limit. A mode of pressure with the eigenvalues w of storage^-1 (divergence, mobility, gradient) and d
// of storage^-1 (Darcy flow) flips its sign from step to step where w dt^2 / 4 + d dt / 2 = 1: on a uniform
// grid
//   (dt / dt_w)^2 + dt / dt_k = 1,   dt_w = h sqrt(rho / Q),   dt_k = h^2 / (2 kappa Q),   Q = K_w / n,
// in one dimension. In several the gradient at the nodes averages across its axis: a wave that alternates
// along two axes feels no gradient at all, while Darcy flow feels all of them. Of the modes that alternate
// along a set of axes the worst are those along one, w and d of that axis, and along all, d of all axes and
// no w but 4 chi (sum of w) of the momentum interpolation. Eigenvalues are bounded by the rows of each cell
// (Gershgorin): 2 for a link between cells, 1 for one to a prescribed pressure. With the true distances
// theta h, that is the factor of cut cells. The stiffness of the skeleton is left to the caller: it adds
// (c_d / h)^2 to w / 4.
//
// Points between the nodes of one step and the next change w (docs/theory/higo.md): the caller may put a
// factor on `inertia`.
#pragma once

#include <limits>
#include <span>

#include "fdm/water_cells.hpp"

namespace polder::fdm {

// Net volume flow into each active cell [m3/s]. outflow: of the cells; face_flow: interior faces into the low
// cell, then boundary faces into the soil.
template <int D>
void net_inflow(const WaterCells<D>& cells, std::span<const double> outflow,
                std::span<const double> face_flow, std::span<double> inflow);

// What the limit depends on.
struct ExplicitRates {
  std::span<const double> storage;  // of the active cells, dV/dp [m3/Pa]; infinite: sets no limit
  std::span<const double> darcy;    // of the faces, interior then boundary: k k_r A / (gamma_w d) [m3/(Pa s)]
  std::span<const double> inertia;  // the same, A / (rho d) [m3/(Pa s2)]
  double chi = 0;                   // of the momentum interpolation [-]
};

struct ExplicitLimit {
  double dt = std::numeric_limits<double>::infinity();  // longest stable step [s]
  bool darcy = false;  // set by Darcy flow rather than by the wave in the water
};

template <int D>
ExplicitLimit explicit_limit(const WaterCells<D>& cells, const ExplicitRates& rates);

}  // namespace polder::fdm
