// Everything a running simulation owns: arrays, no behaviour of its own. Built from a scene once; what the
// scene does not need is not there (pore_water is null in a dry scene).
#pragma once

#include <memory>
#include <vector>

#include "coupling/scene.hpp"
#include "fdm/pressure_field.hpp"
#include "mpm/material/material.hpp"
#include "mpm/skeleton.hpp"

namespace polder::coupling {

// Pore water in the grid's cells (one-layer formulation).
template <int D>
struct PoreWater {
  PoreWater(const Grid<D>& grid, Space space, const fdm::WaterProperties<D>& properties)
      : cells(grid, space), pressure(cells, properties) {}

  fdm::WaterCells<D> cells;
  fdm::PressureField<D> pressure;
  fdm::WaterConditions<D> conditions;
  // Cells (slots): saturated soil's share, its porosity, its conductivity over unit weight. Nodes (slots * 4
  // or slots).
  Reals cell_sums, fill, porosity, darcy_mobility;
  Reals node_gradient, acceleration, correction, mobility;
  std::uint64_t sealed_revision = 0;  // of the cells whose nodes the boundaries know as sealed
  double wall_seconds = 0;            // spent on the water's part of the steps
  double outflow = 0;                 // water that has left by Darcy flow [m3]
  double storage = 0;                 // taken up by compression of the water [m3]
  double initial_volume = 0;          // in the pores of saturated soil at the start [m3]
};

// Hydraulic conductivities are defined with it where a scene has no gravity [m/s2].
inline constexpr double kStandardGravity = 9.81;

template <int D>
struct World {
  Scene scene;
  std::vector<mpm::StateLayout> layouts;  // of the materials
  mpm::Skeleton<D> skeleton;
  std::unique_ptr<PoreWater<D>> pore_water;
  Point<D> gravity{};

  World(Scene scene, Grid<D> grid, const mpm::SkeletonOptions& options, mpm::BoundarySet<D> boundaries);

  double unit_weight() const;  // of water [N/m3]
};

// Grid, bodies with their initial stress and pore pressure, boundaries. Throws InputError for what a scene
// cannot be.
template <int D>
std::unique_ptr<World<D>> build_world(const Scene& scene);

}  // namespace polder::coupling
