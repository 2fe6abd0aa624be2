#include "coupling/two_layer.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/threads.hpp"
#include "coupling/drag_exchange.hpp"
#include "coupling/explicit_water.hpp"
#include "coupling/fluidisation.hpp"
#include "coupling/initial_state.hpp"
#include "coupling/layer_cells.hpp"
#include "coupling/point_water.hpp"
#include "coupling/stopwatch.hpp"
#include "fdm/mixture_flow.hpp"

namespace polder::coupling {
namespace {

constexpr int kStride = 4;
constexpr int kDriftInterval = 8;    // steps between two corrections of the water's volume
constexpr double kDriftShare = 0.3;  // of the drift that one of them takes back
constexpr int kWettingInterval = 8;  // steps between two looks for soil that water has reached

// Nodes with grains or water. Nothing moves at the others.
template <int D>
void find_nodes(World<D>& world) {
  PoreWater<D>& w = *world.pore_water;
  WaterLayer<D>& layer = *w.layer;
  const Reals &soil = world.skeleton.sums(), &water = layer.fluid.sums();
  const std::size_t slots = world.skeleton.grid().slots();
  std::vector<int>& found = layer.found_nodes;
  found.clear();
  for (std::size_t i = 0; i < slots; ++i)
    if (soil[i * 8] > 0 || water[i * 8] > 0) found.push_back(static_cast<int>(i));
  if (found == layer.nodes && layer.water.size() == slots * kStride) return;
  layer.nodes.swap(found);
  for (Reals* r :
       {&layer.fluid.velocity(), &layer.grains, &layer.water, &layer.grains_response, &layer.water_response})
    r->assign(slots * kStride, 0.0);
  if (!w.compressible) w.correction.assign(slots * kStride, 0.0);
  if (!layer.relative_inertia) layer.following.assign(slots, 0.0);
}

// f(slot) for them.
template <int D, class F>
void each_node(const World<D>& world, const F& f) {
  const std::vector<int>& nodes = world.pore_water->layer->nodes;
  parallel_for(static_cast<int>(nodes.size()), [&](int k) { f(nodes[k]); });
}

// w_trial = w_old + dt (g - grad p / rho_w) of nodes with water, under the walls.
template <int D>
void predict_water(World<D>& world, double end, double dt, const Point<D>& gravity) {
  PoreWater<D>& w = *world.pore_water;
  mpm::FluidLayer<D>& fluid = w.layer->fluid;
  const double per_density = 1 / world.scene.water.density, floor = water_floor(world);
  each_node(world, [&](int i) {
    const bool some = fluid.sums()[static_cast<std::size_t>(i) * 8] > floor;
    for (int d = 0; d < D; ++d) {
      const std::size_t j = static_cast<std::size_t>(i) * kStride + d;
      fluid.velocity()[j] =
          fluid.velocity_old()[j] + (some ? dt * (gravity[d] - w.node_gradient[j] * per_density) : 0.0);
    }
  });
  fluid.constrain(end, dt, fluid.velocity());
}

// The mixture's velocities: a node without one of the two layers gives the other's velocity to it. Flow that
// knows no inertia of its own is that of Darcy's law with the velocity, and the acceleration, which strains
// the soil: with those before the second mapping columns whose surface cuts a cell become unstable at k > 5
// mm/s.
template <int D>
void complete_velocities(World<D>& world, const Reals& grains) {
  WaterLayer<D>& layer = *world.pore_water->layer;
  const mpm::Skeleton<D>& skeleton = world.skeleton;
  const std::vector<std::uint8_t>& walled = layer.fluid.held_components();
  const double floor = water_floor(world);
  each_node(world, [&](int i) {
    const bool has_soil = skeleton.sums()[static_cast<std::size_t>(i) * 8] > skeleton.mass_floor();
    const bool has_water = layer.fluid.sums()[static_cast<std::size_t>(i) * 8] > floor;
    for (int d = 0; d < D; ++d) {
      const std::size_t j = static_cast<std::size_t>(i) * kStride + d;
      if (!layer.relative_inertia && !(walled[i] >> d & 1))
        layer.water[j] += layer.following[i] * (grains[j] - skeleton.v_new()[j]);
      layer.grains[j] = has_soil ? grains[j] : layer.water[j];
      if (!has_water) layer.water[j] = layer.grains[j];
    }
  });
}

template <int D>
fdm::MixtureMotion motion_of(const PoreWater<D>& w, const Reals& grains, const Reals& water) {
  const WaterLayer<D>& layer = *w.layer;
  return {grains, water, layer.grains_response, layer.water_response, w.porosity};
}

template <int D>
void solve_pressure(World<D>& world, double dt) {
  PoreWater<D>& w = *world.pore_water;
  WaterLayer<D>& layer = *w.layer;
  fdm::PressureStep p;
  p.dt = dt;
  p.divergence = layer.divergence;
  p.face_mobility = layer.face_mobility;
  p.porosity = w.porosity;
  p.darcy_mobility = w.darcy_mobility;
  p.rhie_chow = world.scene.numerics.rhie_chow;
  p.pressure_gradient = w.node_gradient;
  w.pressure.solve(p);
  w.storage += dt * w.pressure.balance().storage;
}

// What the second mapping of the grains' momenta made of their correction, handed on to the water in pores,
// which follows the same law. Leaves the grains' velocities in layer.grains.
template <int D>
void follow_grains(World<D>& world, double end, double dt) {
  WaterLayer<D>& layer = *world.pore_water->layer;
  mpm::Skeleton<D>& skeleton = world.skeleton;
  const Reals &grains = skeleton.strain_velocity(end, dt), &correction = world.pore_water->correction;
  const double floor = water_floor(world);
  each_node(world, [&](int i) {
    const bool has_soil = skeleton.sums()[static_cast<std::size_t>(i) * 8] > skeleton.mass_floor();
    const bool has_water = layer.fluid.sums()[static_cast<std::size_t>(i) * 8] > floor;
    for (int d = 0; d < D && has_soil; ++d) {
      const std::size_t j = static_cast<std::size_t>(i) * kStride + d;
      if (has_water)
        layer.fluid.velocity()[j] += layer.following[i] * (grains[j] - layer.grains[j] - correction[j]);
      layer.grains[j] = grains[j];
    }
  });
}

// Corrections of both velocities by grad dp.
template <int D>
void correct(World<D>& world, double end, double dt) {
  PoreWater<D>& w = *world.pore_water;
  WaterLayer<D>& layer = *w.layer;
  const mpm::Skeleton<D>& skeleton = world.skeleton;
  each_node(world, [&](int i) {
    const bool has_soil = skeleton.sums()[static_cast<std::size_t>(i) * 8] > skeleton.mass_floor();
    for (int d = 0; d < D; ++d) {
      const std::size_t j = static_cast<std::size_t>(i) * kStride + d;
      w.correction[j] = has_soil ? -layer.grains_response[j] * w.node_gradient[j] : 0.0;
      layer.fluid.velocity()[j] = layer.water[j] - layer.water_response[j] * w.node_gradient[j];
    }
  });
  world.skeleton.correct(end, dt, w.correction);
  if (!layer.relative_inertia) follow_grains(world, end, dt);
  layer.fluid.constrain(end, dt, layer.fluid.velocity());
}

// The velocities with drag exchanged are those of the step.
template <int D>
void take_over(World<D>& world, double end, double dt) {
  WaterLayer<D>& layer = *world.pore_water->layer;
  std::swap(layer.fluid.velocity(), layer.water);
  layer.fluid.constrain(end, dt, layer.fluid.velocity());
  world.pore_water->correction.clear();
}

template <int D>
void measure_discharge(World<D>& world) {
  PoreWater<D>& w = *world.pore_water;
  WaterLayer<D>& layer = *w.layer;
  const fdm::MixtureMotion motion = motion_of(w, world.skeleton.v_new(), layer.fluid.velocity());
  layer.discharge.boundary.assign(world.scene.water_boundaries.size(), 0.0);
  for (const fdm::BoundaryFace<D>& f : w.cells.boundary_faces())
    if (f.boundary >= 0 && !f.free_surface && f.open)
      layer.discharge.boundary[f.boundary] += fdm::mixture_outflow(w.cells, motion, f);
}

// Moves the water's points so that grains and water together fill the cells.
template <int D>
void take_back_drift(World<D>& world) {
  PoreWater<D>& w = *world.pore_water;
  WaterLayer<D>& layer = *w.layer;
  const Grid<D>& grid = world.skeleton.grid();
  Reals& excess = layer.divergence;  // work space
  excess.assign(grid.slots(), 0.0);
  for (const fdm::ActiveCell<D>& cell : w.cells.cells()) {
    const double water = layer.water_volume[cell.slot];
    excess[cell.slot] = (layer.grain_volume[cell.slot] + water) / cell.volume - 1;
  }
  layer.correction.solve(excess, w.porosity, kDriftShare, layer.displacement);
  const double h = grid.spacing();
  world.skeleton.add_travel(layer.fluid.shift(layer.displacement, 0.1 * h) / h);
}

}  // namespace

template <int D>
void update_layer_cells(World<D>& world) {
  PoreWater<D>& w = *world.pore_water;
  WaterLayer<D>& layer = *w.layer;
  const Grid<D>& grid = world.skeleton.grid();
  layer.fluid.scatter_volume(layer.water_volume);
  const std::size_t slots = grid.slots();
  for (Reals* r : {&layer.drag, &layer.soil_fill, &layer.submerged, &layer.grain_volume}) r->resize(slots);
  if (!layer.relative_inertia) layer.in_pores.resize(slots);
  const double density = world.scene.water.density, cell_volume = std::pow(grid.spacing(), D);
  LayerCells c{};
  c.soil = w.cell_sums.data(), c.water = layer.water_volume.data(), c.slots = grid.slots();
  c.cell_volume = cell_volume, c.unit_weight = world.unit_weight();
  if (world.scene.grid.space == Space::axisymmetric) {
    layer.cell_volume.resize(slots);
    parallel_for(grid.slots(), [&](int i) {
      layer.cell_volume[i] = cell_volume * (grid.origin()[0] + (grid.index(i)[0] + 0.5) * grid.spacing());
    });
    c.volumes = layer.cell_volume.data();
  }
  c.per_density = world.scene.retains_water() ? 1 / density : 0.0;
  c.kozeny_carman = world.scene.kozeny_carman();
  c.fill = w.fill.data(), c.porosity = w.porosity.data();
  c.soil_fill = layer.soil_fill.data(), c.submerged = layer.submerged.data();
  c.drag = layer.drag.data(), c.grain_volume = layer.grain_volume.data();
  if (!layer.relative_inertia) c.in_pores = layer.in_pores.data();
  POLDER_SIMD_CALL(find_layer_cells, c);
  std::fill(w.darcy_mobility.begin(), w.darcy_mobility.end(), 0.0);  // water has a velocity of its own
  layer.fluid.set_cell_drag(layer.drag);
  // All of the soil where it holds its water.
  world.skeleton.set_cell_weight({&layer.submerged, !layer.held, density});
}

double wave_factor(const Scene& scene) {
  double factor = 1;
  if (find_formulation(scene.formulation)->inertia == RelativeInertia::kept) return factor;
  for (const Material& m : scene.materials)
    if (m.porosity > 0)
      factor = std::max(factor, std::sqrt(m.density_solid / (m.density_solid - scene.water.density)));
  return factor;
}

template <int D>
double surface_wave_speed(const World<D>& world) {
  const ParticleSet<D>& set = world.pore_water->layer->fluid.points();
  double low = std::numeric_limits<double>::infinity(), high = -low, gravity = 0;
  for (int p = 0; p < set.slots(); ++p)
    if (set.id[p] >= 0)
      low = std::min(low, set.position[D - 1][p]), high = std::max(high, set.position[D - 1][p]);
  for (double g : world.gravity) gravity += g * g;
  return high > low ? std::sqrt(std::sqrt(gravity) * (high - low)) : 0.0;
}

template <int D>
mpm::MoveResult step_two_layer(World<D>& world, const StepInput& in, long step) {
  PoreWater<D>& w = *world.pore_water;
  WaterLayer<D>& layer = *w.layer;
  mpm::Skeleton<D>& skeleton = world.skeleton;
  const double end = in.time + in.dt;
  Point<D> gravity = world.gravity;
  for (double& g : gravity) g *= in.gravity;

  if (skeleton.sort()) carry_water(world);
  layer.fluid.follow_grid();
  update_water_cells(world, end);
  skeleton.scatter(end);
  layer.fluid.scatter();
  find_nodes(world);

  push_by_pressure(world);  // leaves grad p^n at the nodes
  skeleton.predict(in.dt, gravity, in.damping, &w.acceleration);
  predict_water<D>(world, end, in.dt, gravity);
  if (layer.viscosity)
    layer.viscosity->diffuse(layer.fluid, layer.water_volume, in.dt, layer.fluid.velocity());
  if (!layer.relative_inertia) find_tied_water(world);
  push_by_drag(world, end, in.dt);
  skeleton.constrain(end, in.dt);
  share_drag(world, in.dt);
  {
    Stopwatch watch(w.wall_seconds);
    complete_velocities(world, skeleton.strain_velocity(end, in.dt));
    const fdm::MixtureMotion motion = motion_of(w, layer.grains, layer.water);
    fdm::mixture_flow(w.cells, motion, layer.face_flow, layer.face_mobility, layer.divergence);
    if (w.compressible) {
      advance_mixture(world, in.dt);
    } else {
      solve_pressure(world, in.dt);
      w.pressure.node_gradient(w.pressure.increment(), fdm::BoundaryValues::homogeneous,
                               fdm::WallNormal::inward, w.node_gradient);
    }
  }
  if (w.compressible)
    take_over(world, end, in.dt);
  else
    correct(world, end, in.dt);
  measure_discharge(world);

  mpm::MoveResult moved = skeleton.gather(in.time, in.dt);
  const mpm::MoveResult flowed = layer.fluid.gather(in.time, in.dt);
  skeleton.add_travel(std::max(0.0, flowed.largest_displacement - moved.largest_displacement));
  moved.largest_speed = std::max(moved.largest_speed, flowed.largest_speed);
  fluidise(world);
  if (world.scene.drag_follows_flow()) follow_flow(world);
  pass_open_sides(world, in.dt);
  if (step % kDriftInterval == 0) {
    Stopwatch watch(w.wall_seconds);
    take_back_drift(world);
  }
  if (step % kWettingInterval == 0) {
    wet_points(world);
    split_points(world);
  }
  return moved;
}

template <int D>
HeldWater<D>::HeldWater(World<D>& world) : world_(world) {
  if (!world.pore_water) return;
  if (world.pore_water->points) hold_point_water(world, true);
  if (!world.pore_water->layer) return;
  world.pore_water->layer->held = true;
  give_pore_water(true);
}

template <int D>
HeldWater<D>::~HeldWater() {
  if (!world_.pore_water) return;
  if (world_.pore_water->points) hold_point_water(world_, false);
  if (!world_.pore_water->layer) return;
  world_.pore_water->layer->held = false;
  give_pore_water(false);
}

// To points of soil in water: with what they retain their pores are full. Or takes it away again.
template <int D>
void HeldWater<D>::give_pore_water(bool full) {
  const PoreWater<D>& w = *world_.pore_water;
  const Grid<D>& grid = world_.skeleton.grid();
  const double density = world_.scene.water.density;
  for (auto& body : world_.skeleton.bodies()) {
    ParticleSet<D>& set = *body;
    for (int p = 0; p < set.slots() && !set.pore_water.empty(); ++p) {
      if (set.id[p] < 0) continue;
      const int slot = grid.slot(set.cell_of(grid, p));
      set.pore_water[p] = 0;
      if (!full || slot < 0 || !w.cells.active(slot)) continue;
      const double pores = set.volume[p] - set.mass[p] / set.density_solid;
      const double retained = set.retained_water.empty() ? 0.0 : set.retained_water[p] / pores;
      set.pore_water[p] = std::max(0.0, density - retained);
    }
  }
}

#define POLDER_INSTANTIATE(D)                             \
  template class HeldWater<D>;                            \
  template void update_layer_cells<D>(World<D>&);         \
  template double surface_wave_speed<D>(const World<D>&); \
  template mpm::MoveResult step_two_layer<D>(World<D>&, const StepInput&, long);
POLDER_INSTANTIATE(2)
POLDER_INSTANTIATE(3)

}  // namespace polder::coupling
