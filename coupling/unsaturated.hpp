// Points and cells of soil whose pores may hold air: what passes between them.
//
// Cells hold pore pressure and degree of saturation; points carry the saturation they started with plus the
// changes of the cells they overlap, so that no water is lost or smeared by mapping back and forth:
//   points -> cells   where points have moved, a cell's saturation changes by the change of its points' mean,
//   and
//                     draws near to that mean by as much as the soil has travelled in cells: soil that moves
//                     on brings its water, soil at rest keeps its water table where it is
//   cells -> points   each point takes the part of its own room that the cell's change is of the mean room of
//                     the points that overlap it; the water in all points changes by what the cells took up
// Suction acts on the soil as the isotropic stress chi s (Bishop 1959), interpolated between cell centres;
// positive pore pressure acts through its gradient at the nodes. Capillary cohesion grows linearly with the
// suction up to the material's capillary_suction and vanishes where the pores are full.
#pragma once

#include "coupling/world.hpp"

namespace polder::coupling {

// After Grid::activate changed the numbering.
template <int D>
void carry_unsaturated(World<D>& world);

// Soil, volume fraction, conductivity of the cells from the points, after fill, porosity and the mask are up
// to date; moves the cells' saturation with the points.
template <int D>
void update_unsaturated_cells(World<D>& world);

// Pressure and saturation of the cells at the start (WaterSpec), and the points' from them.
template <int D>
void set_unsaturated_state(World<D>& world);

// Solves for the pressure at the end of the step and gives the changes to the points. velocity and mobility
// (nodes) of a moving skeleton, or empty. Returns false, with nothing changed, where the iteration does not
// converge.
struct FlowInput {
  double dt = 0;  // [s]
  std::span<const double> velocity = {}, mobility = {}, pressure_gradient = {};
  // Of a resting skeleton in a quasi-static stage (volume_feedback.hpp); without them it is held in plan.
  std::span<const double> skeleton_compressibility = {}, withdrawal = {};
};
template <int D>
fdm::StepReport flow_unsaturated(World<D>& world, const FlowInput& in);
// The same by an explicit step with a moving skeleton, after PoreWater::specific_volume is up to date; leaves
// its limit in PoreWater::explicit_limit. And that limit alone.
template <int D>
void flow_unsaturated_explicitly(World<D>& world, const FlowInput& in);
template <int D>
fdm::ExplicitLimit unsaturated_explicit_limit(World<D>& world);

// Suction stress and capillary factor of the points from the present state of the cells.
template <int D>
void update_suction(World<D>& world);

// Pressure that pushes at a point, between the centres of the cells [Pa].
template <int D>
double pushing_pressure_at(const World<D>& world, const ParticleSet<D>& set, int p);

}  // namespace polder::coupling
