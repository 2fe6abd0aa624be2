#include "coupling/drag_exchange.hpp"

#include "core/threads.hpp"

namespace polder::coupling {
namespace {

constexpr int kStride = 4;

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

template void exchange_drag<2>(World<2>&, double, double);
template void exchange_drag<3>(World<3>&, double, double);

}  // namespace polder::coupling
