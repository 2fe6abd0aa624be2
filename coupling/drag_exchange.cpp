#include "coupling/drag_exchange.hpp"

#include <algorithm>
#include <cmath>

#include "core/threads.hpp"

namespace polder::coupling {
namespace {

constexpr int kStride = 4;
constexpr double kLeastPorosity = 0.05;

// Drag at a node over the step, b = dt B / M_w with B the drag of the node's water; 0 where a layer is
// missing.
template <int D>
struct NodeDrag {
  NodeDrag(const World<D>& world, int i, double dt, double floor)
      : soil(world.skeleton.sums()[static_cast<std::size_t>(i) * 8]),
        water(world.pore_water->layer->fluid.sums()[static_cast<std::size_t>(i) * 8]),
        has_soil(soil > world.skeleton.mass_floor()),
        has_water(water > floor) {
    if (has_soil && has_water)
      b = dt *
          world.pore_water->layer->fluid.sums()[static_cast<std::size_t>(i) * 8 + mpm::FluidLayer<D>::kDrag] /
          water;
  }
  double soil, water;  // masses [kg]
  bool has_soil, has_water;
  double b = 0;
};

}  // namespace

template <int D>
void push_by_drag(World<D>& world, double end, double dt) {
  WaterLayer<D>& layer = *world.pore_water->layer;
  mpm::Skeleton<D>& skeleton = world.skeleton;
  const std::vector<std::uint8_t>& held = skeleton.boundaries().held_components();
  const std::vector<std::uint8_t>& walled = layer.fluid.held_components();
  const double floor = water_floor(world);
  Reals& trial = skeleton.v_trial();
  layer.grains = trial;
  skeleton.boundaries().apply(end, dt, skeleton.sums(), layer.grains, false, false);
  parallel_for(skeleton.grid().slots(), [&](int i) {
    const NodeDrag<D> node(world, i, dt, floor);
    for (int d = 0; d < D; ++d) {
      const std::size_t j = static_cast<std::size_t>(i) * kStride + d;
      const bool fixed = held[i] >> d & 1, wall = walled[i] >> d & 1;
      const double w = layer.fluid.velocity()[j];
      // A wall that holds the water takes its momentum, so grains there drag on something immovable.
      if (node.b > 0 && wall) {
        if (!fixed) trial[j] += node.b * node.water / node.soil * w;
      } else if (node.b > 0) {
        // Held grains have their velocity already, and that drags on the water.
        const double own = fixed ? layer.grains[j] : 0.0;
        trial[j] += node.b / (1 + node.b) * node.water / node.soil * (w - own);
      }
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
  Reals& velocity = skeleton.v_new();
  for (Reals* r : {&layer.water, &layer.grains_response, &layer.water_response}) r->resize(velocity.size());
  parallel_for(skeleton.grid().slots(), [&](int i) {
    const NodeDrag<D> node(world, i, dt, floor);
    const double b = node.b, a = b / (1 + b);
    const double* s = &skeleton.sums()[static_cast<std::size_t>(i) * 8];
    const double push_soil = node.has_soil ? dt * s[mpm::Transfer<D>::kVolume] / node.soil : 0.0;
    const double push_water = node.has_water ? dt * per_density : 0.0;
    for (int d = 0; d < D; ++d) {
      const std::size_t j = static_cast<std::size_t>(i) * kStride + d;
      const bool stopped = (held[i] >> d & 1) || (velocity[j] == 0 && layer.grains[j] != 0);
      const bool wall = walled[i] >> d & 1;
      const double w = layer.fluid.velocity()[j];
      double &rs = layer.grains_response[j], &rw = layer.water_response[j];
      layer.water[j] = w;
      rs = stopped ? 0.0 : push_soil;
      rw = wall ? 0.0 : push_water;
      if (!node.has_soil || !node.has_water) {
        if (!node.has_soil) rs = rw;
        if (!node.has_water) rw = rs;
      } else if (wall) {
        const double carried = 1 + b * node.water / node.soil;
        if (!stopped) velocity[j] /= carried, rs /= carried;
      } else {
        if (!stopped) {
          const double carried = 1 + a * node.water / node.soil;
          velocity[j] /= carried;
          rs = (push_soil + a * node.water / node.soil * push_water) / carried;
        }
        layer.water[j] = (w + b * velocity[j]) / (1 + b);
        rw = (push_water + b * rs) / (1 + b);
      }
    }
  });
}

namespace {

// Velocity of the water relative to the grains around a point, from the nodes that have both [m/s].
template <int D>
double relative_speed(const World<D>& world, const ParticleSet<D>& set, int p) {
  const Grid<D>& grid = world.skeleton.grid();
  const mpm::FluidLayer<D>& fluid = world.pore_water->layer->fluid;
  const Reals& grains = world.skeleton.v_new();
  const double floor = water_floor(world);
  Index<D> base;
  double share[D];
  for (int d = 0; d < D; ++d) {
    const double x = (set.position[d][p] - grid.origin()[d]) / grid.spacing();
    base[d] = std::clamp(static_cast<int>(std::floor(x)), 0, grid.cells()[d] - 1);
    share[d] = x - base[d];
  }
  Point<D> sum{};
  double whole = 0;
  for (int k = 0; k < ipow(2, D); ++k) {
    Index<D> node = base;
    double weight = 1;
    for (int d = 0; d < D; ++d) {
      const int one = k >> d & 1;
      node[d] += one;
      weight *= one ? share[d] : 1 - share[d];
    }
    const int slot = grid.slot(node);
    if (slot < 0 ||
        !(world.skeleton.sums()[static_cast<std::size_t>(slot) * 8] > world.skeleton.mass_floor()) ||
        !(fluid.sums()[static_cast<std::size_t>(slot) * 8] > floor))
      continue;
    whole += weight;
    for (int d = 0; d < D; ++d) {
      const std::size_t j = static_cast<std::size_t>(slot) * kStride + d;
      sum[d] += weight * (fluid.velocity()[j] - grains[j]);
    }
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
      // porosities.
      const double faster = slot < 0 ? 1.0 : std::max(1.0, w.porosity[slot] / porosity);
      set.conductivity[p] =
          apparent_conductivity(material, fluid, porosity, faster * relative_speed(world, set, p));
    });
  }
}

template void follow_flow<2>(World<2>&);
template void follow_flow<3>(World<3>&);
template void push_by_drag<2>(World<2>&, double, double);
template void push_by_drag<3>(World<3>&, double, double);
template void share_drag<2>(World<2>&, double);
template void share_drag<3>(World<3>&, double);

}  // namespace polder::coupling
