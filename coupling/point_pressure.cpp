#include "coupling/point_pressure.hpp"

#include <cmath>

#include "core/threads.hpp"
#include "coupling/between_centres.hpp"
#include "coupling/initial_state.hpp"
#include "coupling/point_quadrature.hpp"
#include "coupling/point_sides.hpp"
#include "coupling/point_water.hpp"

namespace polder::coupling {
namespace {

constexpr int kStride = 4;

// f(body, point) for all points with water.
template <int D, class F>
void each_wet_point(World<D>& world, const F& f) {
  for (std::size_t b = 0; b < world.skeleton.bodies().size(); ++b) {
    const ParticleSet<D>& set = *world.skeleton.bodies()[b];
    if (set.pore_pressure.empty()) continue;
    parallel_for(static_cast<int>(set.ranges.size()), [&](int block) {
      const auto range = set.ranges[block];
      for (int p = range.first; p < range.first + range.count; ++p)
        if (set.id[p] >= 0 && set.wet[p] != 0) f(b, p);
    });
  }
}

// Points of a body in one cell share their mean head: their pressures differ by those of water at rest
// between their places. What single points keep beyond that acts on no node and piles up as they wander.
// gradient: of pressure at rest [Pa/m].
template <int D>
void average_in_cells(const PointWater<D>& w, ParticleSet<D>& set, int block, const Point<D>& gradient) {
  double volume[Grid<D>::kCells] = {}, sum[Grid<D>::kCells] = {};
  const auto range = set.ranges[block];
  const auto rest = [&](int p) {
    double x = 0;
    for (int d = 0; d < D; ++d) x += gradient[d] * set.position[d][p];
    return x;
  };
  for (int p = range.first; p < range.first + range.count; ++p) {
    if (set.id[p] < 0 || set.wet[p] == 0) continue;
    const int cell = static_cast<int>(set.home_cell[p]);
    volume[cell] += set.volume[p], sum[cell] += set.volume[p] * (set.pore_pressure[p] - rest(p));
  }
  for (int p = range.first; p < range.first + range.count; ++p) {
    if (set.id[p] < 0 || set.wet[p] == 0) continue;
    const int cell = static_cast<int>(set.home_cell[p]);
    if (!w.full.empty() && !w.full[block * Grid<D>::kCells + cell]) continue;  // mixed: full cells only
    set.pore_pressure[p] = sum[cell] / volume[cell] + rest(p);
  }
}

template <int D>
void measure_discharge(World<D>& world, double outflow) {
  PointWater<D>& w = *world.pore_water->points;
  double sides = 0;
  w.discharge.boundary.assign(world.scene.water_boundaries.size(), 0.0);
  for (const SideNode& n : w.sides) {
    const double q =
        n.outward * area_of_side(world, n.slot) * w.flow[static_cast<std::size_t>(n.slot) * kStride + n.axis];
    w.discharge.boundary[n.boundary] += q, sides += q;
  }
  w.discharge.surface = outflow - sides;
}

}  // namespace

template <int D>
void set_point_water(World<D>& world) {
  const bool steady = world.scene.water.initial == WaterSpec::Initial::steady;
  const PoreWater<D>& water = *world.pore_water;
  const auto pressure = initial_pressure(world.scene, world.unit_weight());
  for (auto& body : world.skeleton.bodies()) {
    ParticleSet<D>& set = *body;
    if (set.pore_pressure.empty()) continue;
    for (int p = 0; p < set.slots(); ++p) {
      if (set.id[p] < 0 || set.wet[p] == 0) continue;
      Point<D> x;
      Vector3 at{};
      for (int d = 0; d < D; ++d) x[d] = at[d] = set.position[d][p];
      set.pore_pressure[p] =
          steady ? BetweenCentres<D>(water.cells, x).value(water.pressure.pressure()) : pressure(at);
    }
  }
  find_cells_of_points(world, 0.0);
}

template <int D>
void begin_rates(World<D>& world, double dt, const Reals& grains) {
  PointWater<D>& w = *world.pore_water->points;
  const auto& bodies = world.skeleton.bodies();
  mpm::gather_expelled(w.transfer, dt, w.flow, world.skeleton.options().cell_average);
  w.volume.resize(bodies.size()), w.rate.resize(bodies.size());
  for (std::size_t b = 0; b < bodies.size(); ++b)
    w.volume[b] = bodies[b]->volume, w.rate[b] = bodies[b]->expelled;
  if (world.scene.numerics.point_pressure == PointPressure::mixed)
    find_rates_of_full_cells(world, dt, grains);
}

template <int D>
void update_point_pressure(World<D>& world, double dt, const Point<D>& gravity) {
  PoreWater<D>& water = *world.pore_water;
  PointWater<D>& w = *water.points;
  const NumericsSpec& numerics = world.scene.numerics;
  const auto& bodies = world.skeleton.bodies();
  each_wet_point(world, [&](std::size_t b, int p) {
    const double before = w.volume[b][p];
    w.rate[b][p] += std::log1p((bodies[b]->volume[p] - before) / before);
  });
  if (numerics.point_pressure == PointPressure::mixed) take_rates_of_full_cells(world);
  if (numerics.smooth_rates) smooth_rates(world);

  const double stiffness = world.scene.water.bulk_modulus;
  Point<D> gradient = gravity;
  for (double& g : gradient) g *= world.scene.water.density;
  double outflow = 0, storage = 0;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    ParticleSet<D>& set = *bodies[b];
    if (set.pore_pressure.empty()) continue;
    w.parts.resize(set.ranges.size());
    parallel_for(static_cast<int>(set.ranges.size()), [&](int block) {
      const auto range = set.ranges[block];
      double out = 0, stored = 0;
      for (int p = range.first; p < range.first + range.count; ++p) {
        if (set.id[p] < 0 || set.wet[p] == 0) continue;
        const double n = 1 - set.mass[p] / (set.density_solid * set.volume[p]);
        set.pore_pressure[p] -= stiffness / n * w.rate[b][p];
        out += w.volume[b][p] * set.expelled[p], stored -= w.volume[b][p] * w.rate[b][p];
      }
      w.parts[block] = {out, stored};
      if (numerics.point_pressure != PointPressure::points) average_in_cells<D>(w, set, block, gradient);
    });
    for (const std::array<double, 2>& p : w.parts) outflow += p[0], storage += p[1];
  }
  water.outflow += outflow, water.storage += storage;
  measure_discharge(world, outflow / dt);
}

template <int D>
void find_cells_of_points(World<D>& world, double time) {
  PoreWater<D>& water = *world.pore_water;
  PointWater<D>& w = *water.points;
  if (w.cells_found) return;
  w.cells_found = true;
  update_water_cells(world, time);
  const Grid<D>& grid = world.skeleton.grid();
  Reals sum(grid.slots(), 0.0), volume(grid.slots(), 0.0);
  for (const auto& body : world.skeleton.bodies()) {
    const ParticleSet<D>& set = *body;
    if (set.pore_pressure.empty()) continue;
    for (int id = 0; id < set.count(); ++id) {  // by number: the same sum whatever the order
      const int p = set.find(id);
      if (set.wet[p] == 0) continue;
      const Index<D> cell = set.cell_of(grid, p);
      const Point<D> centre = water.cells.centre(cell);
      double head = set.pore_pressure[p];  // of the point, as a pressure at the centre of its cell
      for (int d = 0; d < D; ++d)
        head += world.scene.water.density * world.gravity[d] * (centre[d] - set.position[d][p]);
      const int slot = grid.slot(cell);
      sum[slot] += set.volume[p] * head, volume[slot] += set.volume[p];
    }
  }
  Reals& pressure = water.pressure.pressure();
  for (const fdm::ActiveCell<D>& cell : water.cells.cells())
    pressure[cell.slot] = volume[cell.slot] > 0 ? sum[cell.slot] / volume[cell.slot] : 0.0;
}

#define POLDER_INSTANTIATE(D)                                                 \
  template void set_point_water<D>(World<D>&);                                \
  template void begin_rates<D>(World<D>&, double, const Reals&);              \
  template void update_point_pressure<D>(World<D>&, double, const Point<D>&); \
  template void find_cells_of_points<D>(World<D>&, double);
POLDER_INSTANTIATE(2)
POLDER_INSTANTIATE(3)

}  // namespace polder::coupling
