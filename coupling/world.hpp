// Everything a running simulation owns: arrays, no behaviour of its own. Built from a scene once; what the
// scene does not need is not there (pore_water is null in a dry scene).
#pragma once

#include <memory>
#include <vector>

#include "coupling/pore_water.hpp"
#include "coupling/scene.hpp"
#include "mpm/material/material.hpp"
#include "mpm/skeleton.hpp"

namespace polder::coupling {

// Hydraulic conductivities are defined with it where a scene has no gravity [m/s2].
inline constexpr double kStandardGravity = 9.81;

template <int D>
struct World {
  Scene scene;
  std::vector<mpm::MaterialParameters> materials;  // of the skeleton, as the laws take them
  std::vector<mpm::StateLayout> layouts;           // of the materials
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
