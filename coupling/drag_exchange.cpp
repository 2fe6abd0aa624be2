#include "coupling/drag_exchange.hpp"

#include <algorithm>
#include <cmath>

#include "core/threads.hpp"

namespace polder::coupling {
namespace {

constexpr int kStride = 4;
constexpr double kLeastPorosity = 0.05;

}  // namespace

template <int D>
void exchange_drag(World<D>& world, double end, double dt) {
  WaterLayer<D>& layer = *world.pore_water->layer;
  mpm::Skeleton<D>& skeleton = world.skeleton;
  const std::vector<std::uint8_t>& held = skeleton.boundaries().held_components();
  const std::vector<std::uint8_t>& walled = layer.fluid.held_components();
  const double per_density = 1 / world.scene.water.density, floor = water_floor(world);
  Reals& trial = skeleton.v_trial();
  Reals& held_velocity = layer.grains;
  held_velocity = trial;
  skeleton.boundaries().apply(end, dt, skeleton.sums(), held_velocity, false, false);
  for (Reals* r : {&layer.water, &layer.grains_response, &layer.water_response}) r->resize(trial.size());
  parallel_for(skeleton.grid().slots(), [&](int i) {
    const double* s = &skeleton.sums()[static_cast<std::size_t>(i) * 8];
    const double* f = &layer.fluid.sums()[static_cast<std::size_t>(i) * 8];
    const double soil = s[0], water = f[0];
    const bool has_soil = soil > skeleton.mass_floor(), has_water = water > floor;
    const double push_soil = has_soil ? dt * s[mpm::Transfer<D>::kVolume] / soil : 0.0;
    const double push_water = has_water ? dt * per_density : 0.0;
    const double b = has_soil && has_water ? dt * f[mpm::FluidLayer<D>::kDrag] / water : 0.0;
    const double whole = soil + b * (soil + water);
    for (int d = 0; d < D; ++d) {
      const std::size_t j = static_cast<std::size_t>(i) * kStride + d;
      const bool fixed = held[i] >> d & 1, wall = walled[i] >> d & 1;
      const double v = trial[j], w = layer.fluid.velocity()[j];
      double &rs = layer.grains_response[j], &rw = layer.water_response[j];
      layer.water[j] = w;
      rs = fixed ? 0.0 : push_soil;
      rw = wall ? 0.0 : push_water;
      if (!has_soil || !has_water) {
        if (!has_soil) rs = rw;
        if (!has_water) rw = rs;
      } else if (wall) {
        if (!fixed) trial[j] = (v + b * water / soil * w) / (1 + b * water / soil);
      } else if (fixed) {
        layer.water[j] = (w + b * held_velocity[j]) / (1 + b);
        trial[j] += water / soil * (w - layer.water[j]);
        rw = push_water / (1 + b);
      } else {
        trial[j] = ((1 + b) * soil * v + b * water * w) / whole;
        layer.water[j] = ((soil + b * water) * w + b * soil * v) / whole;
        rs = ((1 + b) * soil * push_soil + b * water * push_water) / whole;
        rw = ((soil + b * water) * push_water + b * soil * push_soil) / whole;
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
template void exchange_drag<2>(World<2>&, double, double);
template void exchange_drag<3>(World<3>&, double, double);

}  // namespace polder::coupling
