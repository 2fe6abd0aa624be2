#include "tests/counters/small_scenes.hpp"

#include <algorithm>

#include "coupling/simulation.hpp"
#include "coupling/world.hpp"

namespace polder::counters {
namespace {

bench::Slab default_slab(int dimension, const char* formulation) {
  bench::Slab s;
  s.dimension = dimension;
  s.plastic = s.softening = s.cell_average = true;
  s.points = 2000;
  s.formulation = formulation;
  return s;
}

bench::Slab one_grid(int dimension, coupling::Transfer transfer) {
  bench::Slab s;
  s.dimension = dimension;
  s.order = coupling::StressOrder::usl;
  s.transfer = transfer;
  s.shape = mpm::ShapeKind::quadratic_bspline;
  s.points = 2000;
  return s;
}

// What a dry step is when nothing but the soil's motion is left of it.
template <int D>
long make_bare_steps(const coupling::Scene& scene, long steps, const std::function<void(long)>& before_step) {
  const auto world = coupling::build_world<D>(scene);
  mpm::Skeleton<D>& skeleton = world->skeleton;
  const double dt =
      scene.numerics.courant * skeleton.grid().spacing() / skeleton.wave_speed(world->materials);
  double time = 0;
  for (long i = 0; i < steps; ++i, time += dt) {
    if (before_step) before_step(i);
    skeleton.sort();
    skeleton.scatter(time + dt);
    skeleton.predict(dt, world->gravity, 0, nullptr);
    skeleton.constrain(time + dt, dt);
    skeleton.gather(time, dt);
  }
  long points = 0;
  for (const auto& body : skeleton.bodies()) points += body->count();
  return points;
}

}  // namespace

const std::vector<SmallScene>& small_scenes() {
  static const std::vector<SmallScene> all{
      {"dry-2d", default_slab(2, "dry")},
      {"dry-3d", default_slab(3, "dry")},
      {"bare-2d", default_slab(2, "dry"), true},
      {"bare-3d", default_slab(3, "dry"), true},
      {"flip-2d", one_grid(2, coupling::Transfer::flip)},
      {"flip-3d", one_grid(3, coupling::Transfer::flip)},
      {"tpic-2d", one_grid(2, coupling::Transfer::tpic)},
      {"tpic-3d", one_grid(3, coupling::Transfer::tpic)},
      {"one-layer-2d", default_slab(2, "one-layer")},
      {"two-layer-2d", default_slab(2, "two-layer")},
  };
  return all;
}

const SmallScene* find_small_scene(std::string_view name) {
  const auto& all = small_scenes();
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const SmallScene& s) { return s.name == name; });
  return found == all.end() ? nullptr : &*found;
}

long make_steps(const SmallScene& small, long steps, const std::function<void(long)>& before_step) {
  const coupling::Scene scene = bench::make_scene(small.slab);
  if (small.bare)
    return scene.dimension() == 2 ? make_bare_steps<2>(scene, steps, before_step)
                                  : make_bare_steps<3>(scene, steps, before_step);
  coupling::Simulation simulation(scene);
  for (long i = 0; i < steps; ++i) {
    if (before_step) before_step(i);
    simulation.step();
  }
  return simulation.particles();
}

}  // namespace polder::counters
