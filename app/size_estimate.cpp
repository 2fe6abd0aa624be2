#include "app/size_estimate.hpp"

#include <algorithm>
#include <cmath>

#include "app/geometry.hpp"
#include "core/threads.hpp"

namespace polder::app {
namespace {

// Arrays of a particle: position, velocity, gradient, stress, strain, internal variables, domain, order; and
// the grid around it. From the sizes of the stores, in doubles, rounded up.
constexpr double kDoublesPerParticle2d = 48;
constexpr double kDoublesPerParticle3d = 80;
constexpr double kDoublesPerCell = 24;
// The table of the grid's blocks is kept for the whole box.
constexpr double kBytesPerEmptyCell = 0.1;

}  // namespace

int choose_threads(int asked, const coupling::Scene& scene) {
  if (asked > 0) return asked;
  constexpr double kParticlesPerThread = 8000;      // 7,200 take 15.8 s with one thread and 15.1 s with two
  static const int cores = std::max(1, threads());  // all, or OMP_NUM_THREADS; asked before anything is set
  return static_cast<int>(
      std::clamp(estimate_size(scene).particles / kParticlesPerThread, 1.0, static_cast<double>(cores)));
}

SizeEstimate estimate_size(const coupling::Scene& scene) {
  SizeEstimate s;
  const int d = scene.dimension();
  const double cell = std::pow(scene.grid.cell, d);
  double filled = 0;
  for (const coupling::Body& body : scene.bodies) {
    const double cells = measure(body, d) / cell;
    filled += cells;
    // In two layers the pores have points of their own.
    s.particles += (scene.layered() ? 2 : 1) * cells * std::pow(body.particles_per_axis, d);
  }
  for (const coupling::Body& body : scene.water_bodies) {
    const double cells = measure(body, d) / cell;
    filled += cells;
    s.particles += cells * std::pow(body.particles_per_axis, d);
  }
  s.cells = 1;
  for (std::size_t i = 0; i < static_cast<std::size_t>(d); ++i)
    s.cells *= std::round(scene.grid.size[i] / scene.grid.cell);
  s.memory = sizeof(double) * (s.particles * (d == 3 ? kDoublesPerParticle3d : kDoublesPerParticle2d) +
                               filled * kDoublesPerCell) +
             s.cells * kBytesPerEmptyCell;
  return s;
}

}  // namespace polder::app
