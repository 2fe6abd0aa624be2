#include "coupling/point_water.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.hpp"
#include "core/threads.hpp"
#include "coupling/drag_exchange.hpp"
#include "coupling/point_pressure.hpp"
#include "coupling/point_quadrature.hpp"
#include "coupling/point_sides.hpp"
#include "coupling/stopwatch.hpp"
#include "coupling/two_layer.hpp"

namespace polder::coupling {
namespace {

constexpr int kStride = 4;
constexpr int kLimitInterval = 64;  // steps between two looks at the step limit

template <int D>
constexpr int kForce = 1 + D;  // first force lane of a node's sums
template <int D>
constexpr int kVolume = mpm::Transfer<D>::kVolume;

// Nodal sums of one node of soil and of its water.
template <int D>
struct NodeSums {
  const double* soil;
  const double* water;
  NodeSums(const World<D>& world, int i)
      : soil(&world.skeleton.sums()[static_cast<std::size_t>(i) * 8]),
        water(&world.pore_water->points->sums[static_cast<std::size_t>(i) * 8]) {}
};

// n of the soil at a node.
template <int D>
double porosity_of(const NodeSums<D>& s, double density) {
  return s.soil[kVolume<D>] > 0 ? std::min(1.0, s.water[0] / (density * s.soil[kVolume<D>])) : 0.0;
}

template <int D>
void follow_grid(World<D>& world) {
  PointWater<D>& w = *world.pore_water->points;
  const Grid<D>& grid = world.skeleton.grid();
  if (w.revision == grid.revision()) return;
  w.revision = grid.revision();
  w.transfer.resize();
  for (Reals* r : {&w.velocity_old, &w.velocity, &w.mapped, &w.flow})
    r->assign(static_cast<std::size_t>(grid.slots()) * kStride, 0.0);
  w.walls.update(grid);
  find_sides(world);
}

// Water at the nodes: mass, momentum and force, with that of the pressures prescribed at the sides.
template <int D>
void scatter_water(World<D>& world) {
  PointWater<D>& w = *world.pore_water->points;
  follow_grid(world);
  const bool mixed = world.scene.numerics.point_pressure == PointPressure::mixed;
  if (mixed) set_full_cells_aside(world);
  mpm::scatter_pore_water(w.transfer, world.scene.water.density, world.scene.kozeny_carman(), w.sums,
                          w.velocity_old);
  if (mixed) add_force_of_full_cells(world);
  push_at_sides(world);
}

// Drag of a node with grains and water. locked: the soil holds its water.
template <int D>
NodeDrag node_drag(const World<D>& world, int i, double dt, bool locked = false) {
  const NodeSums<D> s(world, i);
  const double n = porosity_of(s, world.scene.water.density);
  NodeDrag node{s.soil[0], s.water[0]};
  if (node.soil > world.skeleton.mass_floor() && node.water > water_floor(world))
    node.set(locked ? std::numeric_limits<double>::infinity()
                    : dt * n * n * world.unit_weight() * s.water[kVolume<D>] / node.water);
  return node;
}

double damped(double a, double v, double damping) {
  return a * v > 0 ? (1 - damping) * a : a * v < 0 ? (1 + damping) * a : a;
}

// w_trial = w_old + dt (F_p / (rho_w V) + g) of nodes with water, under the walls.
template <int D>
void predict_water(World<D>& world, const StepInput& in, const Point<D>& gravity) {
  PointWater<D>& w = *world.pore_water->points;
  const double density = world.scene.water.density, floor = water_floor(world);
  const std::vector<std::uint8_t>& walled = w.walls.held_components();
  parallel_for(world.skeleton.grid().slots(), [&](int i) {
    const NodeSums<D> s(world, i);
    const bool some = s.water[0] > floor;
    for (int d = 0; d < D; ++d) {
      const std::size_t j = static_cast<std::size_t>(i) * kStride + d;
      const double old = w.velocity_old[j];
      double a = 0;
      if (some) a = s.water[kForce<D> + d] / (density * s.soil[kVolume<D>]) + gravity[d];
      if (in.damping > 0 && !(walled[i] >> d & 1)) a = damped(a, old, in.damping);
      w.velocity[j] = old + in.dt * a;
    }
  });
  w.walls.apply(in.time + in.dt, in.dt, w.sums, w.velocity, false, false);
}

// Drag by the velocities of the last step, explicitly. Where a boundary holds the grains it takes the
// reaction from their trial velocity.
template <int D>
void drag_by_old_velocities(World<D>& world, double dt) {
  PointWater<D>& w = *world.pore_water->points;
  mpm::Skeleton<D>& skeleton = world.skeleton;
  const std::vector<std::uint8_t>& walled = w.walls.held_components();
  parallel_for(skeleton.grid().slots(), [&](int i) {
    const NodeDrag node = node_drag(world, i, dt);
    for (int d = 0; d < D && node.b > 0; ++d) {
      const std::size_t j = static_cast<std::size_t>(i) * kStride + d;
      const double push = node.b * (w.velocity_old[j] - skeleton.v_old()[j]);
      skeleton.v_trial()[j] += node.water / node.soil * push;
      if (!(walled[i] >> d & 1)) w.velocity[j] -= push;
    }
  });
}

// The halves of an implicit exchange, before and after the boundaries of the grains (drag_exchange.hpp).
// locked: soil holds its water.
template <int D>
void push_by_drag(World<D>& world, double end, double dt, bool locked) {
  PointWater<D>& w = *world.pore_water->points;
  mpm::Skeleton<D>& skeleton = world.skeleton;
  const std::vector<std::uint8_t>& held = skeleton.boundaries().held_components();
  const std::vector<std::uint8_t>& walled = w.walls.held_components();
  Reals& trial = skeleton.v_trial();
  w.grains = trial;
  skeleton.boundaries().apply(end, dt, skeleton.sums(), w.grains, false, false);
  parallel_for(skeleton.grid().slots(), [&](int i) {
    const NodeDrag node = node_drag(world, i, dt, locked);
    for (int d = 0; d < D; ++d) {
      const std::size_t j = static_cast<std::size_t>(i) * kStride + d;
      if (node.b > 0) trial[j] += node.push(w.velocity[j], w.grains[j], held[i] >> d & 1, walled[i] >> d & 1);
      w.grains[j] = trial[j];
    }
  });
}

template <int D>
void share_drag(World<D>& world, double dt, bool locked) {
  PointWater<D>& w = *world.pore_water->points;
  mpm::Skeleton<D>& skeleton = world.skeleton;
  const std::vector<std::uint8_t>& held = skeleton.boundaries().held_components();
  const std::vector<std::uint8_t>& walled = w.walls.held_components();
  parallel_for(skeleton.grid().slots(), [&](int i) {
    const NodeDrag node = node_drag(world, i, dt, locked);
    for (int d = 0; d < D && node.b > 0; ++d) {
      const std::size_t j = static_cast<std::size_t>(i) * kStride + d;
      double& v = skeleton.v_new()[j];
      const bool stopped = (held[i] >> d & 1) || (v == 0 && w.grains[j] != 0);
      const bool wall = walled[i] >> d & 1;
      if (!stopped) v = node.after(v, wall);
      if (!wall) w.velocity[j] = node.water_after(w.velocity[j], v);
    }
  });
}

// Velocities of the water that its divergence is taken of: as Skeleton::strain_velocity().
template <int D>
const Reals& water_strain_velocity(World<D>& world, const StepInput& in) {
  PointWater<D>& w = *world.pore_water->points;
  const mpm::SkeletonOptions& options = world.skeleton.options();
  mpm::update_pore_velocities(w.transfer, world.scene.water.density, options.flip, w.velocity_old, w.velocity,
                              w.sums, options.musl ? &w.mapped : nullptr);
  if (!options.musl) return w.velocity;
  w.walls.apply(in.time + in.dt, in.dt, w.sums, w.mapped, false, false);
  return w.mapped;
}

// q = n (w - v).
template <int D>
void flow_of_velocities(World<D>& world, const Reals& grains, const Reals& water) {
  PointWater<D>& w = *world.pore_water->points;
  const double density = world.scene.water.density, floor = water_floor(world);
  parallel_for(world.skeleton.grid().slots(), [&](int i) {
    const NodeSums<D> s(world, i);
    const bool some = s.water[0] > floor && s.soil[0] > world.skeleton.mass_floor();
    const double n = some ? porosity_of(s, density) : 0.0;
    for (int d = 0; d < D; ++d) {
      const std::size_t j = static_cast<std::size_t>(i) * kStride + d;
      w.flow[j] = n * (water[j] - grains[j]);
    }
  });
}

// Volume that the force at a node is shared out to at least: that of a corner of soil. Where soil only begins
// to reach a node its volume vanishes as the square of the force, F_p / V grows without bounds and, however
// little soil it is, would drain the cell once more through its surface.
template <int D>
double least_volume(const World<D>& world, int slot) {
  const Grid<D>& grid = world.skeleton.grid();
  double volume = std::pow(0.5 * grid.spacing(), D);
  if (world.scene.grid.space == Space::axisymmetric)
    volume *= std::max(grid.position(grid.index(slot))[0], 0.25 * grid.spacing());
  return volume;
}

// q = k / gamma_w (F_p / V + rho_w (g - a)), a the acceleration of the grains. The walls take what would
// cross them: q + v obeys them as the velocity of water does.
template <int D>
void flow_by_darcy(World<D>& world, const StepInput& in, const Point<D>& gravity) {
  PointWater<D>& w = *world.pore_water->points;
  const mpm::Skeleton<D>& skeleton = world.skeleton;
  const double density = world.scene.water.density, floor = water_floor(world), weight = world.unit_weight();
  parallel_for(skeleton.grid().slots(), [&](int i) {
    const NodeSums<D> s(world, i);
    const bool some = s.water[0] > floor && s.soil[0] > skeleton.mass_floor();
    double conducted = 0;  // k / (gamma_w V)
    if (some) {
      const double volume = s.soil[kVolume<D>];
      conducted = volume / (weight * s.water[kVolume<D>] * std::max(volume, least_volume(world, i)));
    }
    for (int d = 0; d < D; ++d) {
      const std::size_t j = static_cast<std::size_t>(i) * kStride + d;
      const double a = (skeleton.v_new()[j] - skeleton.v_old()[j]) / in.dt;
      const double push = s.water[kForce<D> + d] + density * s.soil[kVolume<D>] * (gravity[d] - a);
      w.flow[j] = skeleton.v_new()[j] + (some ? conducted * push : 0.0);
    }
  });
  w.walls.apply(in.time + in.dt, in.dt, w.sums, w.flow, false, false);
  parallel_for(skeleton.grid().slots(), [&](int i) {
    for (int d = 0; d < D; ++d) {
      const std::size_t j = static_cast<std::size_t>(i) * kStride + d;
      w.flow[j] -= skeleton.v_new()[j];
    }
  });
}

}  // namespace

template <int D>
void add_point_water(World<D>& world) {
  PoreWater<D>& water = *world.pore_water;
  const Scene& scene = world.scene;
  const bool kept = find_formulation(scene.formulation)->inertia == RelativeInertia::kept;
  if (!std::isfinite(scene.water.bulk_modulus))
    throw InputError("formulation '" + scene.formulation +
                     "' needs water that can be compressed: its pressure follows from its bulk modulus");
  water.points = std::make_unique<PointWater<D>>(kept, water_walls<D>(scene, world.skeleton.boundaries()));
  PointWater<D>& w = *water.points;
  w.transfer.grid = &world.skeleton.grid();
  w.transfer.space = scene.grid.space;
  w.transfer.shape = scene.grid.shape;
  for (auto& body : world.skeleton.bodies()) {
    w.transfer.bodies.push_back({body.get(), nullptr, 0.0});
    ParticleSet<D>& set = *body;
    if (set.wet.empty()) continue;
    set.group_by_cell = true;
    set.home_cell.resize(set.slots());
    set.pore_pressure.assign(set.slots(), 0.0);
    set.expelled.assign(set.slots(), 0.0);
    if (!kept) continue;
    for (int d = 0; d < D; ++d) set.water_velocity[d] = set.velocity[d];
    // With a velocity of its own the water is no mass of the grains.
    for (int p = 0; p < set.slots(); ++p)
      if (set.wet[p] > 0) set.pore_water[p] = 0;
  }
}

template <int D>
void push_by_points(World<D>& world) {
  PoreWater<D>& water = *world.pore_water;
  PointWater<D>& w = *water.points;
  scatter_water(world);
  const mpm::Skeleton<D>& skeleton = world.skeleton;
  const double density = world.scene.water.density;
  const bool all = !w.relative_inertia || w.held;  // the mixture feels all of it, grains their share
  water.acceleration.resize(static_cast<std::size_t>(skeleton.grid().slots()) * kStride);
  parallel_for(skeleton.grid().slots(), [&](int i) {
    const NodeSums<D> s(world, i);
    const double share = all ? 1 : 1 - porosity_of(s, density);
    const double f = s.soil[0] > skeleton.mass_floor() ? share / s.soil[0] : 0.0;
    for (int d = 0; d < kStride; ++d)
      water.acceleration[static_cast<std::size_t>(i) * kStride + d] =
          d < D ? f * s.water[kForce<D> + d] : 0.0;
  });
}

template <int D>
void hold_point_water(World<D>& world, bool held) {
  PointWater<D>& w = *world.pore_water->points;
  if (!w.relative_inertia) return;
  w.held = held;
  for (auto& body : world.skeleton.bodies()) {
    ParticleSet<D>& set = *body;
    if (set.pore_pressure.empty()) continue;
    for (int p = 0; p < set.slots(); ++p) {
      if (set.wet[p] == 0) continue;
      set.pore_water[p] = held ? world.scene.water.density : 0;
      for (Reals& u : set.water_velocity) u[p] = 0;
    }
  }
}

template <int D>
mpm::MoveResult step_point_water(World<D>& world, const StepInput& in, long step) {
  PoreWater<D>& water = *world.pore_water;
  PointWater<D>& w = *water.points;
  mpm::Skeleton<D>& skeleton = world.skeleton;
  const double end = in.time + in.dt;
  Point<D> gravity = world.gravity;
  for (double& g : gravity) g *= in.gravity;

  if (skeleton.sort()) water.pressure.carry();
  w.time = end, w.gravity = in.gravity, w.cells_found = false;
  if (step % kLimitInterval == 0) water.explicit_limit.dt = 0;  // found anew when asked for
  skeleton.scatter(end);
  {
    Stopwatch watch(water.wall_seconds);
    push_by_points(world);
  }
  skeleton.predict(in.dt, gravity, in.damping, &water.acceleration);
  const bool by_old_velocities = in.water_flows && world.scene.numerics.drag == DragStep::by_last_velocities;
  if (w.relative_inertia) {
    Stopwatch watch(water.wall_seconds);
    predict_water<D>(world, in, gravity);
    if (by_old_velocities)
      drag_by_old_velocities(world, in.dt);
    else
      push_by_drag(world, end, in.dt, !in.water_flows);
  }
  skeleton.constrain(end, in.dt);
  if (w.relative_inertia) {
    Stopwatch watch(water.wall_seconds);
    if (!by_old_velocities) share_drag(world, in.dt, !in.water_flows);
    w.walls.apply(end, in.dt, w.sums, w.velocity, false, false);
  }
  water.correction.clear();
  const Reals& grains = skeleton.strain_velocity(end, in.dt);
  {
    Stopwatch watch(water.wall_seconds);
    if (w.relative_inertia)
      flow_of_velocities(world, grains, water_strain_velocity(world, in));
    else if (in.water_flows)
      flow_by_darcy<D>(world, in, gravity);
    if (in.water_flows) {
      close_sides(world);
      begin_rates(world, in.dt, grains);
    }
  }
  const mpm::MoveResult moved = skeleton.gather(in.time, in.dt);
  Stopwatch watch(water.wall_seconds);
  if (in.water_flows) update_point_pressure<D>(world, in.dt, gravity);
  return moved;
}

#define POLDER_INSTANTIATE(D)                         \
  template void add_point_water<D>(World<D>&);        \
  template void push_by_points<D>(World<D>&);         \
  template void hold_point_water<D>(World<D>&, bool); \
  template mpm::MoveResult step_point_water<D>(World<D>&, const StepInput&, long);
POLDER_INSTANTIATE(2)
POLDER_INSTANTIATE(3)

}  // namespace polder::coupling
