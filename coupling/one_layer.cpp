#include "coupling/one_layer.hpp"

#include <algorithm>
#include <cmath>

#include "core/threads.hpp"
#include "coupling/initial_state.hpp"
#include "coupling/stopwatch.hpp"

namespace polder::coupling {
namespace {

constexpr int kWettingInterval = 16;  // steps between two looks for points that water has reached

template <int D>
fdm::WaterConditions<D> conditions_at(const World<D>& world, double time) {
  fdm::WaterConditions<D> c;
  c.unit_weight = world.unit_weight();
  if (world.scene.water.outside_level) c.outside_level = world.scene.water.outside_level->at(time);
  for (const WaterBoundary& b : world.scene.water_boundaries) {
    fdm::WaterBoundary<D> w;
    w.name = b.name;
    w.side = b.side;
    w.value = b.value.at(time);
    w.kind = b.kind == WaterBoundary::Kind::head       ? fdm::WaterBoundary<D>::Kind::head
             : b.kind == WaterBoundary::Kind::pressure ? fdm::WaterBoundary<D>::Kind::pressure
             : b.kind == WaterBoundary::Kind::surface  ? fdm::WaterBoundary<D>::Kind::surface
                                                       : fdm::WaterBoundary<D>::Kind::impermeable;
    for (int d = 0; d < D; ++d) {
      if (b.from) w.from[d] = std::min((*b.from)[d], b.to ? (*b.to)[d] : (*b.from)[d]);
      if (b.to) w.to[d] = std::max((*b.to)[d], b.from ? (*b.from)[d] : (*b.to)[d]);
    }
    c.boundaries.push_back(std::move(w));
  }
  return c;
}

// out = -factor(node) * gradient, factor = scale * V / m of nodes that carry mass.
template <int D>
void pressure_push(const mpm::Skeleton<D>& skeleton, const Reals& gradient, double scale, Reals& out) {
  const Reals& sums = skeleton.sums();
  const int slots = skeleton.grid().slots();
  out.resize(static_cast<std::size_t>(slots) * 4);
  constexpr int kBlock = Grid<D>::kCells;
  parallel_for(skeleton.grid().blocks(), [&](int block) {
    for (int i = block * kBlock; i < (block + 1) * kBlock; ++i) {
      const double* s = &sums[static_cast<std::size_t>(i) * 8];
      const double f = s[0] > skeleton.mass_floor() ? -scale * s[mpm::Transfer<D>::kVolume] / s[0] : 0.0;
      for (int d = 0; d < 4; ++d)
        out[static_cast<std::size_t>(i) * 4 + d] = f * gradient[static_cast<std::size_t>(i) * 4 + d];
    }
  });
}

}  // namespace

template <int D>
void update_water_cells(World<D>& world, double end) {
  PoreWater<D>& w = *world.pore_water;
  Stopwatch watch(w.wall_seconds);
  const Grid<D>& grid = world.skeleton.grid();
  world.skeleton.scatter_cells(w.cell_sums);
  const int slots = grid.slots();
  for (Reals* r : {&w.fill, &w.porosity, &w.darcy_mobility}) r->resize(slots);
  const double cell = std::pow(grid.spacing(), D), unit_weight = world.unit_weight();
  const bool radial = world.scene.grid.space == Space::axisymmetric;
  parallel_for(grid.blocks(), [&](int block) {
    for (int i = block * Grid<D>::kCells; i < (block + 1) * Grid<D>::kCells; ++i) {
      const double* s = &w.cell_sums[static_cast<std::size_t>(i) * 4];
      double volume = cell;
      if (radial) volume *= grid.origin()[0] + (grid.index(i)[0] + 0.5) * grid.spacing();
      const bool some = s[0] > 1e-9 * volume;
      w.fill[i] = s[0] / volume;
      w.porosity[i] = some ? std::clamp(1 - s[1] / s[0], 0.05, 0.95) : 0.0;
      w.darcy_mobility[i] = some ? s[2] / s[0] / unit_weight : 0.0;
    }
  });
  w.conditions = conditions_at(world, end);
  w.cells.update(w.fill, w.conditions);
  w.pressure.refresh();
  if (w.sealed_revision == w.cells.revision()) return;
  w.sealed_revision = w.cells.revision();
  std::vector<std::uint8_t> sealed(slots, 0);
  for (const fdm::ActiveCell<D>& cell : w.cells.cells())
    for (int node : cell.nodes) sealed[node] = 1;
  world.skeleton.boundaries().set_sealed(std::move(sealed));
}

template <int D>
void push_by_pressure(World<D>& world) {
  PoreWater<D>& w = *world.pore_water;
  w.node_gradient.resize(static_cast<std::size_t>(world.skeleton.grid().slots()) * 4);
  w.pressure.node_gradient(w.pressure.pressure(), fdm::BoundaryValues::present, fdm::WallNormal::inward,
                           w.node_gradient);
  pressure_push(world.skeleton, w.node_gradient, 1.0, w.acceleration);
}

template <int D>
mpm::MoveResult step_one_layer(World<D>& world, const StepInput& in, long step) {
  PoreWater<D>& w = *world.pore_water;
  mpm::Skeleton<D>& skeleton = world.skeleton;
  const double end = in.time + in.dt;
  Point<D> gravity = world.gravity;
  for (double& g : gravity) g *= in.gravity;

  if (skeleton.sort()) w.pressure.carry();
  update_water_cells(world, end);
  skeleton.scatter(end);

  push_by_pressure(world);
  skeleton.predict(in.dt, gravity, in.damping, &w.acceleration);

  skeleton.constrain(end, in.dt);
  w.correction.clear();
  if (in.water_flows) {
    const Reals& strain_velocity = skeleton.strain_velocity(end, in.dt);
    const Reals& sums = skeleton.sums();
    w.mobility.resize(skeleton.grid().slots());
    parallel_for(skeleton.grid().slots(), [&](int i) {
      const double* s = &sums[static_cast<std::size_t>(i) * 8];
      w.mobility[i] = s[0] > skeleton.mass_floor() ? in.dt * s[mpm::Transfer<D>::kVolume] / s[0] : 0.0;
    });
    fdm::PressureStep p;
    p.dt = in.dt;
    p.velocity = strain_velocity;
    p.mobility = w.mobility;
    p.porosity = w.porosity;
    p.darcy_mobility = w.darcy_mobility;
    p.rhie_chow = world.scene.numerics.rhie_chow;
    p.pressure_gradient = w.node_gradient;
    {
      Stopwatch watch(w.wall_seconds);
      w.pressure.solve(p);
      w.pressure.node_gradient(w.pressure.increment(), fdm::BoundaryValues::homogeneous,
                               fdm::WallNormal::inward, w.node_gradient);
      pressure_push(skeleton, w.node_gradient, in.dt, w.correction);
    }
    skeleton.correct(end, in.dt, w.correction);
    w.outflow += in.dt * w.pressure.discharge().total();
    w.storage += in.dt * w.pressure.balance().storage;
  }
  const mpm::MoveResult moved = skeleton.gather(in.time, in.dt);
  if (step % kWettingInterval == 0) wet_points(world);
  return moved;
}

template <int D>
mpm::MoveResult step_dry(World<D>& world, const StepInput& in) {
  mpm::Skeleton<D>& skeleton = world.skeleton;
  const double end = in.time + in.dt;
  Point<D> gravity = world.gravity;
  for (double& g : gravity) g *= in.gravity;
  skeleton.sort();
  skeleton.scatter(end);
  skeleton.predict(in.dt, gravity, in.damping, nullptr);
  skeleton.constrain(end, in.dt);
  return skeleton.gather(in.time, in.dt);
}

#define POLDER_INSTANTIATE(D)                                                    \
  template void update_water_cells<D>(World<D>&, double);                        \
  template void push_by_pressure<D>(World<D>&);                                  \
  template mpm::MoveResult step_one_layer<D>(World<D>&, const StepInput&, long); \
  template mpm::MoveResult step_dry<D>(World<D>&, const StepInput&);
POLDER_INSTANTIATE(2)
POLDER_INSTANTIATE(3)

}  // namespace polder::coupling
