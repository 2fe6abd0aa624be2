#include "mpm/seed_particles.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace polder::mpm {
namespace {

// splitmix64: the same sequence on every machine.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  double symmetric() {  // in [-1/2, 1/2)
    std::uint64_t z = (state_ += 0x9E3779B97F4A7C15ull);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBull;
    return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53 - 0.5;
  }

 private:
  std::uint64_t state_;
};

template <int D, class F>
void each(const SeedRegion<D>& region, const F& f) {
  long total = 1;
  for (int d = 0; d < D; ++d) total *= region.count[d];
  for (long i = 0; i < total; ++i) {
    Point<D> x;
    long rest = i;
    for (int d = 0; d < D; ++d) {
      x[d] = region.lower[d] + (rest % region.count[d] + 0.5) * region.spacing[d];
      rest /= region.count[d];
    }
    f(x);
  }
}

}  // namespace

template <int D>
SeedRegion<D> seed_region(const Grid<D>& grid, int per_axis, const Point<D>& lower, const Point<D>& upper,
                          const std::array<bool, D>& anchored) {
  SeedRegion<D> r;
  const double step = grid.spacing() / per_axis;
  for (int d = 0; d < D; ++d) {
    if (anchored[d]) {
      r.lower[d] = lower[d];
      r.count[d] = std::max(1, static_cast<int>(std::lround((upper[d] - lower[d]) / step)));
      r.spacing[d] = (upper[d] - lower[d]) / r.count[d];
    } else {
      const double first = std::floor((lower[d] - grid.origin()[d]) / step + 1e-9);
      const double last = std::ceil((upper[d] - grid.origin()[d]) / step - 1e-9);
      r.lower[d] = grid.origin()[d] + first * step;
      r.count[d] = std::max(1, static_cast<int>(last - first));
      r.spacing[d] = step;
    }
  }
  return r;
}

template <int D>
long count_particles(const SeedRegion<D>& region, const std::function<bool(const Point<D>&)>& inside) {
  long n = 0;
  each<D>(region, [&](const Point<D>& x) { n += inside(x); });
  return n;
}

template <int D>
void seed_particles(ParticleSet<D>& set, const SeedRegion<D>& region, Space space, double dry_density,
                    double jitter, int seed, const std::function<bool(const Point<D>&)>& inside) {
  set.append(static_cast<int>(count_particles<D>(region, inside)));
  Random random(static_cast<std::uint64_t>(seed));
  double cell = 1, smallest = region.spacing[0];
  for (int d = 0; d < D; ++d) cell *= region.spacing[d], smallest = std::min(smallest, region.spacing[d]);
  set.reference_half_size = 0.5 * smallest;
  int p = 0;
  each<D>(region, [&](const Point<D>& x) {
    if (!inside(x)) return;
    for (int d = 0; d < D; ++d) {
      set.position[d][p] = x[d] + (jitter > 0 ? jitter * region.spacing[d] * random.symmetric() : 0.0);
      set.initial_position[d][p] = set.position[d][p];
      set.half_size[d][p] = 0.5 * region.spacing[d];
    }
    set.volume[p] = cell * (space == Space::axisymmetric ? x[0] : 1.0);
    set.mass[p] = dry_density * set.volume[p];
    ++p;
  });
}

#define POLDER_INSTANTIATE(D)                                                                          \
  template SeedRegion<D> seed_region<D>(const Grid<D>&, int, const Point<D>&, const Point<D>&,         \
                                        const std::array<bool, D>&);                                   \
  template long count_particles<D>(const SeedRegion<D>&, const std::function<bool(const Point<D>&)>&); \
  template void seed_particles<D>(ParticleSet<D>&, const SeedRegion<D>&, Space, double, double, int,   \
                                  const std::function<bool(const Point<D>&)>&);
POLDER_INSTANTIATE(2)
POLDER_INSTANTIATE(3)

}  // namespace polder::mpm
