#include "coupling/point_quadrature.hpp"

#include <cmath>

#include "core/threads.hpp"
#include "mpm/point_stencil.hpp"

namespace polder::coupling {
namespace {

constexpr int kStride = 4;
constexpr double kFull = 0.9;  // share of a cell's volume that points must fill

// Slope along axis d of the shape function of a cell's corner at the cell's centre, times h 2^(D-1).
template <int D>
int slope_sign(int corner, int d) {
  return corner >> d & 1 ? 1 : -1;
}

}  // namespace

template <int D>
void set_full_cells_aside(World<D>& world) {
  PointWater<D>& w = *world.pore_water->points;
  const Grid<D>& grid = world.skeleton.grid();
  const double cell_volume = std::pow(grid.spacing(), D);
  w.full.assign(grid.slots(), 0);
  w.cell_pressure.assign(grid.slots(), 0.0);
  Reals volume(grid.slots(), 0.0), wet(grid.slots(), 0.0);
  w.pushing.resize(world.skeleton.bodies().size());
  constexpr int kCells = Grid<D>::kCells;
  for (std::size_t b = 0; b < w.pushing.size(); ++b) {
    const ParticleSet<D>& set = *world.skeleton.bodies()[b];
    w.pushing[b] = set.pore_pressure;
    if (set.pore_pressure.empty()) continue;
    parallel_for(static_cast<int>(set.ranges.size()), [&](int block) {
      const auto range = set.ranges[block];
      for (int p = range.first; p < range.first + range.count; ++p) {
        if (set.id[p] < 0) continue;
        const int slot = block * kCells + static_cast<int>(set.home_cell[p]);
        volume[slot] += set.volume[p], wet[slot] += set.wet[p] * set.volume[p];
        w.cell_pressure[slot] += set.wet[p] * set.volume[p] * set.pore_pressure[p];
      }
    });
  }
  parallel_for(grid.slots(), [&](int i) {
    if (!(volume[i] >= kFull * cell_volume && wet[i] == volume[i])) return;
    w.full[i] = 1, w.cell_pressure[i] /= volume[i];
  });
  for (std::size_t b = 0; b < w.pushing.size(); ++b) {
    ParticleSet<D>& set = *world.skeleton.bodies()[b];
    if (set.pore_pressure.empty()) continue;
    parallel_for(static_cast<int>(set.ranges.size()), [&](int block) {
      const auto range = set.ranges[block];
      for (int p = range.first; p < range.first + range.count; ++p)
        if (set.id[p] >= 0 && w.full[block * kCells + static_cast<int>(set.home_cell[p])])
          set.pore_pressure[p] = 0;
    });
  }
}

template <int D>
void add_force_of_full_cells(World<D>& world) {
  PointWater<D>& w = *world.pore_water->points;
  const Grid<D>& grid = world.skeleton.grid();
  for (std::size_t b = 0; b < w.pushing.size(); ++b)
    world.skeleton.bodies()[b]->pore_pressure.swap(w.pushing[b]);
  const double area = std::pow(0.5 * grid.spacing(), D - 1);
  parallel_for(grid.slots(), [&](int i) {
    const Index<D> node = grid.index(i);
    for (int corner = 0; corner < ipow(2, D); ++corner) {
      Index<D> cell = node;
      for (int d = 0; d < D; ++d) cell[d] -= corner >> d & 1;
      const int slot = grid.is_cell(cell) ? grid.slot(cell) : -1;
      if (slot < 0 || !w.full[slot]) continue;
      for (int d = 0; d < D; ++d)
        w.sums[static_cast<std::size_t>(i) * 8 + 1 + D + d] +=
            slope_sign<D>(corner, d) * area * w.cell_pressure[slot];
    }
  });
}

template <int D>
void find_rates_of_full_cells(World<D>& world, double dt, const Reals& grains) {
  PointWater<D>& w = *world.pore_water->points;
  const Grid<D>& grid = world.skeleton.grid();
  const double slope = 1 / (grid.spacing() * ipow(2, D - 1));
  w.cell_rate.assign(grid.slots(), 0.0);
  parallel_for(grid.slots(), [&](int i) {
    if (!w.full[i]) return;
    double divergence = 0;
    for (int corner = 0; corner < ipow(2, D); ++corner) {
      Index<D> node = grid.index(i);
      for (int d = 0; d < D; ++d) node[d] += corner >> d & 1;
      const std::size_t j = static_cast<std::size_t>(grid.slot(node)) * kStride;
      for (int d = 0; d < D; ++d) divergence += slope_sign<D>(corner, d) * (grains[j + d] + w.flow[j + d]);
    }
    w.cell_rate[i] = dt * slope * divergence;
  });
}

template <int D>
void take_rates_of_full_cells(World<D>& world) {
  PointWater<D>& w = *world.pore_water->points;
  for (std::size_t b = 0; b < w.rate.size(); ++b) {
    const ParticleSet<D>& set = *world.skeleton.bodies()[b];
    if (set.pore_pressure.empty()) continue;
    parallel_for(static_cast<int>(set.ranges.size()), [&](int block) {
      const auto range = set.ranges[block];
      for (int p = range.first; p < range.first + range.count; ++p) {
        if (set.id[p] < 0) continue;
        const int slot = block * Grid<D>::kCells + static_cast<int>(set.home_cell[p]);
        if (w.full[slot]) w.rate[b][p] = w.cell_rate[slot];
      }
    });
  }
}

template <int D>
void smooth_rates(World<D>& world) {
  PointWater<D>& w = *world.pore_water->points;
  const mpm::Skeleton<D>& skeleton = world.skeleton;
  const Grid<D>& grid = skeleton.grid();
  const auto stencil_of = [&](const ParticleSet<D>& set, int p) {
    Point<D> x, l;
    for (int d = 0; d < D; ++d) x[d] = set.position[d][p], l[d] = set.half_size[d][p];
    return mpm::point_stencil<D>(grid, skeleton.options().shape, x, l);
  };
  Reals volume(grid.slots(), 0.0), sum(grid.slots(), 0.0);
  // One point after the other: in an order that no number of threads changes.
  for (std::size_t b = 0; b < w.rate.size(); ++b) {
    const ParticleSet<D>& set = *skeleton.bodies()[b];
    if (set.pore_pressure.empty()) continue;
    for (int p = 0; p < set.slots(); ++p) {
      if (set.id[p] < 0 || set.wet[p] == 0) continue;
      const mpm::PointStencil<D> s = stencil_of(set, p);
      for (int n = 0; n < s.count; ++n) {
        volume[s.slot[n]] += s.weight[n] * set.volume[p];
        sum[s.slot[n]] += s.weight[n] * set.volume[p] * w.rate[b][p];
      }
    }
  }
  for (std::size_t b = 0; b < w.rate.size(); ++b) {
    const ParticleSet<D>& set = *skeleton.bodies()[b];
    if (set.pore_pressure.empty()) continue;
    parallel_for(set.slots(), [&](int p) {
      if (set.id[p] < 0 || set.wet[p] == 0) return;
      const mpm::PointStencil<D> s = stencil_of(set, p);
      double rate = 0;
      for (int n = 0; n < s.count; ++n)
        if (volume[s.slot[n]] > 0) rate += s.weight[n] * sum[s.slot[n]] / volume[s.slot[n]];
      w.rate[b][p] = rate;
    });
  }
}

#define POLDER_INSTANTIATE(D)                                                 \
  template void set_full_cells_aside<D>(World<D>&);                           \
  template void add_force_of_full_cells<D>(World<D>&);                        \
  template void find_rates_of_full_cells<D>(World<D>&, double, const Reals&); \
  template void take_rates_of_full_cells<D>(World<D>&);                       \
  template void smooth_rates<D>(World<D>&);
POLDER_INSTANTIATE(2)
POLDER_INSTANTIATE(3)

}  // namespace polder::coupling
