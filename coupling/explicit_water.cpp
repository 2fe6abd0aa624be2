#include "coupling/explicit_water.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/threads.hpp"
#include "coupling/one_layer.hpp"
#include "coupling/unsaturated.hpp"

namespace polder::coupling {
namespace {

// Velocities of the nodes are those of the points of the last step, smoothed by the way to them and back,
// plus the acceleration of this one, which is not. Where these velocities themselves strain the soil (USL)
// the change within a step counts up to twice (docs/theory/higo.md); mapped once more (MUSL) at most once.
constexpr double kUslFactor = 2;

// Water on points of its own is not mapped once more.
template <int D>
double inertia_factor(const World<D>& world) {
  return world.skeleton.options().musl && !world.pore_water->layer ? 1 : kUslFactor;
}

// 1 / rho of the mixture in the cells, times that factor.
template <int D>
void find_specific_volume(World<D>& world) {
  PoreWater<D>& w = *world.pore_water;
  // Cells do not know which of several soils their grains are: the lightest, which shortens the step.
  double grains = std::numeric_limits<double>::infinity();
  for (const Material& m : world.scene.materials)
    if (m.porosity > 0) grains = std::min(grains, m.density_solid);
  const double factor = inertia_factor(world);
  if (w.layer) {  // both phases by themselves: an upper bound of what drag leaves
    const double water = 1 / world.scene.water.density;
    w.specific_volume.resize(w.fill.size());
    parallel_for(static_cast<int>(w.fill.size()), [&](int i) {
      const double n = w.porosity[i];
      w.specific_volume[i] = factor * (std::isinf(grains) ? water : (1 - n) / grains + n * water);
    });
    return;
  }
  w.specific_volume.resize(w.fill.size());
  parallel_for(static_cast<int>(w.fill.size()), [&](int i) {
    const double* s = &w.cell_sums[static_cast<std::size_t>(i) * 4];
    const double mass = grains * s[1] + s[3];
    w.specific_volume[i] = mass > 0 ? factor * s[0] / mass : 0;
  });
}

template <int D>
fdm::PressureStep saturated_step(const World<D>& world, double dt) {
  const PoreWater<D>& w = *world.pore_water;
  fdm::PressureStep p;
  p.dt = dt;
  p.porosity = w.porosity;
  p.darcy_mobility = w.darcy_mobility;
  p.rhie_chow = world.scene.numerics.rhie_chow;
  return p;
}

}  // namespace

template <int D>
void advance_water(World<D>& world, double dt, const Reals& strain_velocity) {
  PoreWater<D>& w = *world.pore_water;
  find_specific_volume(world);
  if (w.unsaturated) {
    FlowInput flow;
    flow.dt = dt;
    flow.velocity = strain_velocity, flow.mobility = w.mobility, flow.pressure_gradient = w.node_gradient;
    flow_unsaturated_explicitly(world, flow);
    return;
  }
  fdm::PressureStep p = saturated_step(world, dt);
  p.velocity = strain_velocity;
  p.mobility = w.mobility;
  p.pressure_gradient = w.node_gradient;
  w.explicit_limit = w.pressure.explicit_limit(p, w.specific_volume);
  w.pressure.advance(p);
  w.outflow += dt * w.pressure.balance().outflow;
  w.storage += dt * w.pressure.balance().storage;
}

template <int D>
void advance_mixture(World<D>& world, double dt) {
  PoreWater<D>& w = *world.pore_water;
  WaterLayer<D>& layer = *w.layer;
  fdm::PressureStep p = saturated_step(world, dt);
  p.divergence = layer.divergence;
  p.face_mobility = layer.face_mobility;
  p.pressure_gradient = w.node_gradient;
  layer.specific_volume = layer.face_mobility;
  const double factor = inertia_factor(world) / dt;
  for (double& v : layer.specific_volume) v *= factor;
  w.explicit_limit = w.pressure.explicit_limit_of_faces(p, layer.specific_volume);
  w.pressure.advance(p);
  w.storage += dt * w.pressure.balance().storage;
}

template <int D>
const fdm::ExplicitLimit& explicit_limit(World<D>& world, double time) {
  PoreWater<D>& w = *world.pore_water;
  if (w.explicit_limit.dt > 0) return w.explicit_limit;
  if (world.skeleton.sort()) carry_water(world);
  update_water_cells(world, time);
  find_specific_volume(world);
  w.explicit_limit = w.unsaturated ? unsaturated_explicit_limit(world)
                                   : w.pressure.explicit_limit(saturated_step(world, 1.0), w.specific_volume);
  return w.explicit_limit;
}

template <int D>
void blend_for_step(World<D>& world, double dt, double skeleton_step) {
  const double pic = 1 - world.scene.numerics.flip;
  const double share = std::min(1.0, dt / skeleton_step);
  world.skeleton.set_flip(1 - pic * share);
  if (world.pore_water->layer)
    world.pore_water->layer->fluid.set_flip(1 - (1 - world.scene.numerics.water_flip) * share);
}

MotionLimit combined_limit(const fdm::ExplicitLimit& water, double cell, double wave_speed) {
  const double skeleton = cell / wave_speed;
  MotionLimit limit;
  limit.dt = 1 / std::hypot(1 / water.dt, 1 / skeleton);
  limit.reason = water.dt > skeleton ? "skeleton wave" : water.darcy ? "Darcy flow" : "water wave";
  return limit;
}

#define POLDER_INSTANTIATE(D)                                      \
  template void blend_for_step<D>(World<D>&, double, double);      \
  template void advance_water<D>(World<D>&, double, const Reals&); \
  template void advance_mixture<D>(World<D>&, double);             \
  template const fdm::ExplicitLimit& explicit_limit<D>(World<D>&, double);
POLDER_INSTANTIATE(2)
POLDER_INSTANTIATE(3)

}  // namespace polder::coupling
