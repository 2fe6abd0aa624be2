#include "coupling/drag_exchange.hpp"

#include <algorithm>
#include <cmath>

#include "core/threads.hpp"
#include "coupling/layer_cells.hpp"
#include "mpm/point_stencil.hpp"

namespace polder::coupling {
namespace {

constexpr int kStride = 4;

template <int D>
NodeDrag node_drag(const World<D>& world, int i, double dt, double floor) {
  const WaterLayer<D>& layer = *world.pore_water->layer;
  const double* water = &layer.fluid.sums()[static_cast<std::size_t>(i) * 8];
  NodeDrag n{world.skeleton.sums()[static_cast<std::size_t>(i) * 8], water[0]};
  if (!(n.soil > world.skeleton.mass_floor() && n.water > floor)) return n;
  const double b = dt * water[mpm::FluidLayer<D>::kDrag] / n.water;
  n.set(b, !layer.relative_inertia && b > 0 ? layer.tied[i] : 0.0);
  return n;
}

}  // namespace

template <int D>
void find_tied_water(World<D>& world) {
  WaterLayer<D>& layer = *world.pore_water->layer;
  const Grid<D>& grid = world.skeleton.grid();
  const double floor = water_floor(world);
  layer.tied.resize(grid.slots());
  parallel_for(grid.slots(), [&](int i) {
    layer.tied[i] = 0;
    if (!(world.skeleton.sums()[static_cast<std::size_t>(i) * 8] > world.skeleton.mass_floor()) ||
        !(layer.fluid.sums()[static_cast<std::size_t>(i) * 8] > floor))
      return;
    double in_pores = 0, all = 0;
    for (int corner = 0; corner < ipow(2, D); ++corner) {
      Index<D> cell = grid.index(i);
      for (int d = 0; d < D; ++d) cell[d] -= corner >> d & 1;
      const int slot = grid.slot(cell);
      if (slot < 0) continue;
      const double water = layer.water_volume[slot];
      in_pores += layer.in_pores[slot] * water, all += water;
    }
    if (all > 0) layer.tied[i] = in_pores / all;
  });
}

template <int D>
void push_by_drag(World<D>& world, double end, double dt) {
  WaterLayer<D>& layer = *world.pore_water->layer;
  mpm::Skeleton<D>& skeleton = world.skeleton;
  const std::vector<std::uint8_t>& held = skeleton.boundaries().held_components();
  const std::vector<std::uint8_t>& walled = layer.fluid.held_components();
  const double floor = water_floor(world);
  const Reals &grains_old = skeleton.v_old(), &water_old = layer.fluid.velocity_old();
  Reals& trial = skeleton.v_trial();
  const std::vector<int>& nodes = layer.nodes;
  parallel_for(static_cast<int>(nodes.size()), [&](int k) {
    for (std::size_t j = static_cast<std::size_t>(nodes[k]) * kStride, end = j + D; j < end; ++j)
      layer.grains[j] = trial[j];
  });
  skeleton.boundaries().apply(end, dt, skeleton.sums(), layer.grains, false, false);
  layer.node_drag.resize(nodes.size());
  parallel_for(static_cast<int>(nodes.size()), [&](int k) {
    const int i = nodes[k];
    const NodeDrag node = layer.node_drag[k] = node_drag(world, i, dt, floor);
    for (int d = 0; d < D; ++d) {
      const std::size_t j = static_cast<std::size_t>(i) * kStride + d;
      const double own = layer.grains[j];  // where a boundary holds the grains
      const bool fixed = held[i] >> d & 1, wall = walled[i] >> d & 1;
      if (node.b > 0)
        trial[j] +=
            node.push(node.trial(layer.fluid.velocity()[j], water_old[j], fixed ? own : grains_old[j], wall),
                      own, fixed, wall);
      layer.grains[j] = trial[j];
    }
  });
}

template <int D>
void share_drag(World<D>& world, double dt) {
  WaterLayer<D>& layer = *world.pore_water->layer;
  mpm::Skeleton<D>& skeleton = world.skeleton;
  const std::vector<std::uint8_t>& held = skeleton.boundaries().held_components();
  const std::vector<std::uint8_t>& walled = layer.fluid.held_components();
  const double per_density = 1 / world.scene.water.density, floor = water_floor(world);
  const Reals &grains_old = skeleton.v_old(), &water_old = layer.fluid.velocity_old();
  Reals& velocity = skeleton.v_new();
  const std::vector<int>& nodes = layer.nodes;
  parallel_for(static_cast<int>(nodes.size()), [&](int k) {
    const int i = nodes[k];
    const NodeDrag& node = layer.node_drag[k];
    if (!layer.relative_inertia) layer.following[i] = node.following();
    const bool has_soil = node.soil > skeleton.mass_floor(), has_water = node.water > floor;
    const double* s = &skeleton.sums()[static_cast<std::size_t>(i) * 8];
    const double push_soil = has_soil ? dt * s[mpm::Transfer<D>::kVolume] / node.soil : 0.0;
    const double push_water = has_water ? dt * per_density : 0.0;
    for (int d = 0; d < D; ++d) {
      const std::size_t j = static_cast<std::size_t>(i) * kStride + d;
      const bool stopped = (held[i] >> d & 1) || (velocity[j] == 0 && layer.grains[j] != 0);
      const bool wall = walled[i] >> d & 1;
      const double w = layer.fluid.velocity()[j];
      double &v = velocity[j], &rs = layer.grains_response[j], &rw = layer.water_response[j];
      layer.water[j] = w;
      rs = stopped ? 0.0 : push_soil;
      rw = wall ? 0.0 : push_water;
      if (!has_soil || !has_water) {
        if (!has_soil) rs = rw;
        if (!has_water) rw = rs;
        continue;
      }
      if (!stopped) {
        v = node.after(v, wall);
        rs = node.after(push_soil + (wall ? 0.0 : node.share * node.ratio * push_water), wall);
      }
      if (wall) continue;
      // Grains that something stops are not accelerated, whatever velocity their points bring to the node.
      const double trial = node.trial(w, water_old[j], stopped ? v : grains_old[j], wall);
      layer.water[j] = node.water_after(trial, v);
      rw = node.water_after(push_water, rs);
    }
  });
}

namespace {

// Velocity of the water relative to the grains around a point, from the nodes that have both [m/s].
template <int D>
double relative_speed(const World<D>& world, const ParticleSet<D>& set, int p) {
  const Grid<D>& grid = world.skeleton.grid();
  const mpm::FluidLayer<D>& fluid = world.pore_water->layer->fluid;
  const WaterLayer<D>& layer = *world.pore_water->layer;
  const Reals& grains = layer.relative_inertia ? world.skeleton.v_new() : layer.grains;
  const double floor = water_floor(world);
  Point<D> x;
  for (int d = 0; d < D; ++d) x[d] = set.position[d][p];
  const mpm::PointStencil<D> s = mpm::point_stencil<D>(grid, mpm::ShapeKind::linear, x, Point<D>{});
  Point<D> sum{};
  double whole = 0;
  for (int k = 0; k < s.count; ++k) {
    const std::size_t slot = static_cast<std::size_t>(s.slot[k]);
    if (!(world.skeleton.sums()[slot * 8] > world.skeleton.mass_floor()) || !(fluid.sums()[slot * 8] > floor))
      continue;
    whole += s.weight[k];
    for (int d = 0; d < D; ++d)
      sum[d] += s.weight[k] * (fluid.velocity()[slot * kStride + d] - grains[slot * kStride + d]);
  }
  double square = 0;
  for (int d = 0; d < D; ++d) square += sum[d] * sum[d];
  return whole > 0 ? std::sqrt(square) / whole : 0.0;
}

}  // namespace

template <int D>
void follow_flow(World<D>& world) {
  const PoreWater<D>& w = *world.pore_water;
  const Grid<D>& grid = world.skeleton.grid();
  const DragFluid fluid = drag_fluid(world);
  for (auto& body : world.skeleton.bodies()) {
    ParticleSet<D>& set = *body;
    const Material& material = world.scene.materials[set.material];
    if (set.conductivity.empty() || material.drag_law == DragLaw::darcy) continue;
    parallel_for(set.slots(), [&](int p) {
      if (set.id[p] < 0) return;
      const double porosity =
          std::clamp(1 - set.mass[p] / (set.density_solid * set.volume[p]), kLeastPorosity, 1.0);
      const int slot = grid.slot(set.cell_of(grid, p));
      // Beside water that stands alone in the cell the soil's own water is faster, by the ratio of
      // porosities. What the grains retain does not flow.
      const double retained = set.retained_water.empty()
                                  ? 0.0
                                  : set.retained_water[p] / (world.scene.water.density * set.volume[p]);
      const double faster = std::max(porosity - retained, slot < 0 ? 0.0 : w.porosity[slot]) / porosity;
      set.conductivity[p] =
          apparent_conductivity(material, fluid, porosity, faster * relative_speed(world, set, p));
    });
  }
}

template void follow_flow<2>(World<2>&);
template void follow_flow<3>(World<3>&);
template void find_tied_water<2>(World<2>&);
template void find_tied_water<3>(World<3>&);
template void push_by_drag<2>(World<2>&, double, double);
template void push_by_drag<3>(World<3>&, double, double);
template void share_drag<2>(World<2>&, double);
template void share_drag<3>(World<3>&, double);

}  // namespace polder::coupling
