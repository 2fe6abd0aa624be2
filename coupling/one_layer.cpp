#include "coupling/one_layer.hpp"

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "core/threads.hpp"
#include "coupling/explicit_water.hpp"
#include "coupling/initial_state.hpp"
#include "coupling/point_water.hpp"
#include "coupling/stopwatch.hpp"
#include "coupling/two_layer.hpp"
#include "coupling/unsaturated.hpp"

namespace polder::coupling {
namespace {

constexpr int kWettingInterval = 16;  // steps between two looks for points that water has reached

template <int D>
fdm::WaterBoundary<D> condition_of(const WaterBoundary& b, double time, bool unsaturated) {
  using To = typename fdm::WaterBoundary<D>::Kind;
  fdm::WaterBoundary<D> w;
  w.name = b.name;
  w.side = b.side == WaterBoundary::kOnSurface ? fdm::kFreeSurface : b.side;
  w.value = b.value.at(time);
  switch (b.kind) {
    case WaterBoundary::Kind::head:
      w.kind = To::head;
      w.seepage_above = unsaturated;
      break;
    case WaterBoundary::Kind::pressure:
      w.kind = To::pressure;
      break;
    case WaterBoundary::Kind::impermeable:
      w.kind = To::impermeable;
      break;
    case WaterBoundary::Kind::surface:
      w.kind = To::surface;
      break;
    case WaterBoundary::Kind::flux:
      w.kind = To::flux;
      break;
    case WaterBoundary::Kind::rain:
      w.kind = To::atmosphere;
      break;
    case WaterBoundary::Kind::evaporation:
      w.kind = To::atmosphere;
      w.value = -w.value;
      w.limiting_pressure = -b.limit_suction;
      break;
    case WaterBoundary::Kind::seepage_face:
      w.kind = To::atmosphere;
      w.value = 0;
      break;
  }
  for (int d = 0; d < D; ++d) {
    if (b.from) w.from[d] = std::min((*b.from)[d], b.to ? (*b.to)[d] : (*b.from)[d]);
    if (b.to) w.to[d] = std::max((*b.to)[d], b.from ? (*b.from)[d] : (*b.to)[d]);
  }
  return w;
}

template <int D>
void add_line(const WaterLine& line, double time, fdm::WaterConditions<D>& c) {
  std::vector<Point<D>> points;
  for (const Vector3& corner : line.line) {
    Point<D> x;
    for (int d = 0; d < D; ++d) x[d] = corner[d];
    points.push_back(x);
  }
  switch (line.kind) {
    case WaterLine::Kind::well: {
      fdm::WaterWell<D> well{line.name, points, -line.rate.at(time)};
      if (line.limit_pressure) well.limiting_pressure = *line.limit_pressure;
      c.wells.push_back(std::move(well));
      break;
    }
    case WaterLine::Kind::drain:
      c.drains.push_back({line.name, points, line.limit_pressure.value_or(0)});
      break;
    case WaterLine::Kind::sheet:
      c.sheets.push_back({line.name, points});
      break;
  }
}

template <int D>
fdm::WaterConditions<D> conditions_at(const World<D>& world, double time) {
  fdm::WaterConditions<D> c;
  c.unit_weight = world.unit_weight();
  if (world.scene.water.outside_level) c.outside_level = world.scene.water.outside_level->at(time);
  for (const WaterBoundary& b : world.scene.water_boundaries)
    c.boundaries.push_back(condition_of<D>(b, time, world.pore_water->unsaturated != nullptr));
  for (const WaterLine& line : world.scene.water_lines) add_line(line, time, c);
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

// Where soil full of water lies on a wall, nothing can come between them.
template <int D>
void seal_walls(World<D>& world) {
  PoreWater<D>& w = *world.pore_water;
  if (!w.unsaturated && w.sealed_revision == w.cells.revision()) return;
  w.sealed_revision = w.cells.revision();
  std::vector<std::uint8_t> sealed(world.skeleton.grid().slots(), 0);
  const Reals* positive = w.unsaturated ? &w.unsaturated->pushing : nullptr;
  for (const fdm::ActiveCell<D>& cell : w.cells.cells())
    if (positive == nullptr || (*positive)[cell.slot] > 0)
      for (int node : cell.nodes) sealed[node] = 1;
  world.skeleton.boundaries().set_sealed(std::move(sealed));
}

template <int D>
void node_gradient(PoreWater<D>& w, const Reals& field, fdm::BoundaryValues values, Reals& out) {
  if (w.unsaturated)
    w.unsaturated->field.node_gradient(field, values, fdm::WallNormal::inward, out);
  else
    w.pressure.node_gradient(field, values, fdm::WallNormal::inward, out);
}

// Fill, porosity and mobility of the cells from the soil in them.
template <int D>
void update_soil_cells(World<D>& world) {
  PoreWater<D>& w = *world.pore_water;
  const Grid<D>& grid = world.skeleton.grid();
  const double cell = std::pow(grid.spacing(), D), unit_weight = world.unit_weight();
  const bool follows_porosity = world.scene.kozeny_carman();
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
      if (some && follows_porosity) w.darcy_mobility[i] *= kozeny_carman(w.porosity[i]);
    }
  });
}

}  // namespace

template <int D>
void carry_water(World<D>& world) {
  PoreWater<D>& w = *world.pore_water;
  if (w.unsaturated)
    carry_unsaturated(world);
  else
    w.pressure.carry();
  if (w.layer && !w.layer->owed.empty()) world.skeleton.grid().carry(w.layer->owed);
  for (Reals* r : {&w.feedback.compressibility, &w.feedback.foreseen, &w.feedback.owed})
    if (!r->empty()) world.skeleton.grid().carry(*r);
}

template <int D>
void update_water_cells(World<D>& world, double end) {
  PoreWater<D>& w = *world.pore_water;
  Stopwatch watch(w.wall_seconds);
  world.skeleton.scatter_cells(w.cell_sums);
  const int slots = world.skeleton.grid().slots();
  for (Reals* r : {&w.fill, &w.porosity, &w.darcy_mobility}) r->resize(slots);
  if (w.layer)
    update_layer_cells(world);
  else
    update_soil_cells(world);
  w.conditions = conditions_at(world, end);
  w.cells.update(w.fill, w.conditions);
  if (w.unsaturated)
    update_unsaturated_cells(world);
  else
    w.pressure.refresh();
  if (!w.layer && !w.points) seal_walls(world);
}

template <int D>
void push_by_pressure(World<D>& world) {
  PoreWater<D>& w = *world.pore_water;
  if (w.points) return push_by_points(world);
  w.node_gradient.resize(static_cast<std::size_t>(world.skeleton.grid().slots()) * 4);
  node_gradient(w, w.pushing_pressure(), fdm::BoundaryValues::present, w.node_gradient);
  pressure_push(world.skeleton, w.node_gradient, 1.0, w.acceleration);
}

namespace {

template <int D>
void solve_pressure(World<D>& world, double dt, const Reals& strain_velocity) {
  PoreWater<D>& w = *world.pore_water;
  if (w.unsaturated) {
    FlowInput flow;
    flow.dt = dt;
    flow.velocity = strain_velocity, flow.mobility = w.mobility, flow.pressure_gradient = w.node_gradient;
    const fdm::StepReport report = flow_unsaturated(world, flow);
    if (!report.converged)
      throw NumericalError("the pore pressure of the step was not found in " +
                           std::to_string(report.iterations) + " iterations: residual " +
                           fdm::number(report.residual) + ", last change " +
                           fdm::number(report.largest_change) + " Pa");
    return;
  }
  fdm::PressureStep p;
  p.dt = dt;
  p.velocity = strain_velocity;
  p.mobility = w.mobility;
  p.porosity = w.porosity;
  p.darcy_mobility = w.darcy_mobility;
  p.rhie_chow = world.scene.numerics.rhie_chow;
  p.pressure_gradient = w.node_gradient;
  w.pressure.solve(p);
  w.outflow += dt * w.pressure.discharge().total();
  w.storage += dt * w.pressure.balance().storage;
}

}  // namespace

template <int D>
mpm::MoveResult step_one_layer(World<D>& world, const StepInput& in, long step) {
  PoreWater<D>& w = *world.pore_water;
  mpm::Skeleton<D>& skeleton = world.skeleton;
  const double end = in.time + in.dt;
  Point<D> gravity = world.gravity;
  for (double& g : gravity) g *= in.gravity;

  if (skeleton.sort()) carry_water(world);
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
    if (w.compressible) {
      Stopwatch watch(w.wall_seconds);
      advance_water(world, in.dt, strain_velocity);
    } else {
      Stopwatch watch(w.wall_seconds);
      solve_pressure(world, in.dt, strain_velocity);
      node_gradient(w, w.unsaturated ? w.unsaturated->field.increment() : w.pressure.increment(),
                    fdm::BoundaryValues::homogeneous, w.node_gradient);
      pressure_push(skeleton, w.node_gradient, in.dt, w.correction);
    }
    if (!w.compressible) skeleton.correct(end, in.dt, w.correction);
    if (w.unsaturated) update_suction(world);
  }
  const mpm::MoveResult moved = skeleton.gather(in.time, in.dt);
  if (!w.unsaturated && step % kWettingInterval == 0) wet_points(world);
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
  template void carry_water<D>(World<D>&);                                       \
  template void update_water_cells<D>(World<D>&, double);                        \
  template void push_by_pressure<D>(World<D>&);                                  \
  template mpm::MoveResult step_one_layer<D>(World<D>&, const StepInput&, long); \
  template mpm::MoveResult step_dry<D>(World<D>&, const StepInput&);
POLDER_INSTANTIATE(2)
POLDER_INSTANTIATE(3)

}  // namespace polder::coupling
