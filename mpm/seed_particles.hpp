// Material points of a new body.
#pragma once

#include <functional>

#include "core/particles.hpp"

namespace polder::mpm {

template <int D>
struct SeedRegion {
  // Lattice of points: origin of the first point's domain, number and spacing along each axis.
  Point<D> lower{};
  Index<D> count{};
  Point<D> spacing{};
};

// Lattice of `per_axis` points in each cell that covers [lower, upper]. Along an anchored axis the spacing is
// adjusted so that a whole number of points fills exactly [lower, upper] (boxes, prisms along their length);
// otherwise the lattice is that of the grid's cells.
template <int D>
SeedRegion<D> seed_region(const Grid<D>& grid, int per_axis, const Point<D>& lower, const Point<D>& upper,
                          const std::array<bool, D>& anchored);

// Number of points that seed_particles would create.
template <int D>
long count_particles(const SeedRegion<D>& region, const std::function<bool(const Point<D>&)>& inside);

// Fill `set` (empty; its optional fields are added later) with the points of the region that are inside. Mass
// is dry_density times volume. jitter: uniform random displacement, as a share of the spacing, with a
// reproducible sequence.
template <int D>
void seed_particles(ParticleSet<D>& set, const SeedRegion<D>& region, Space space, double dry_density,
                    double jitter, int seed, const std::function<bool(const Point<D>&)>& inside);

}  // namespace polder::mpm
