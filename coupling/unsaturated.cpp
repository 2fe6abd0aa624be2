#include "coupling/unsaturated.hpp"

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "core/threads.hpp"
#include "coupling/between_centres.hpp"
#include "coupling/cell_overlap.hpp"
#include "coupling/initial_state.hpp"

namespace polder::coupling {
namespace {

// Water left over by the iteration, as a share of what moves in a step: the case's tolerance where the
// skeleton rests. Steps of motion move little, and there are many of them.
constexpr double kMotionFactor = 100;
constexpr double kNoPoints = -1;
constexpr double kFull = 1 - 1e-9;           // saturation beyond which suction is not looked for
constexpr double kFirstSteadyStep = 1000.0;  // [s]

template <int D>
Point<D> position_of(const ParticleSet<D>& set, int p) {
  Point<D> x;
  for (int d = 0; d < D; ++d) x[d] = set.position[d][p];
  return x;
}

// The material of most of the soil in each cell, by the overlap of the points' domains.
template <int D>
void find_soils(const World<D>& world, std::vector<int>& soil) {
  const Grid<D>& grid = world.skeleton.grid();
  int porous = 0, only = 0;
  for (std::size_t m = 0; m < world.scene.materials.size(); ++m)
    if (world.scene.materials[m].porosity > 0) ++porous, only = static_cast<int>(m);
  soil.assign(grid.slots(), only);
  if (porous == 1) return;
  std::vector<double> most(grid.slots(), 0.0), sum(grid.slots());
  for (std::size_t m = 0; m < world.scene.materials.size(); ++m) {
    if (world.scene.materials[m].porosity <= 0) continue;
    std::fill(sum.begin(), sum.end(), 0.0);
    for (const auto& body : world.skeleton.bodies()) {
      if (body->material != static_cast<int>(m)) continue;
      for (int p = 0; p < body->slots(); ++p) {
        if (body->id[p] < 0) continue;
        const Overlap<D> o = overlap_of(grid, *body, p);
        for (int k = 0; k < ipow(2, D); ++k)
          if (o.slot[k] >= 0) sum[o.slot[k]] += o.share[k] * body->volume[p];
      }
    }
    for (int i = 0; i < grid.slots(); ++i)
      if (sum[i] > most[i]) most[i] = sum[i], soil[i] = static_cast<int>(m);
  }
}

double bishop_factor(const Material& m, double saturation) {
  switch (m.bishop) {
    case BishopFactor::saturation:
      return saturation;
    case BishopFactor::effective_saturation: {
      const double least = m.retention.residual;
      return std::clamp((saturation - least) / (1 - least), 0.0, 1.0);
    }
    case BishopFactor::none:
      break;
  }
  return 0;
}

template <int D>
fdm::UnsaturatedStep make_step(const World<D>& world, double dt) {
  const PoreWater<D>& w = *world.pore_water;
  fdm::UnsaturatedStep step;
  step.dt = dt;
  step.porosity = w.porosity;
  step.volume_fraction = w.unsaturated->volume_fraction;
  step.darcy_mobility = w.darcy_mobility;
  step.soil = w.unsaturated->soil;
  step.rhie_chow = world.scene.numerics.rhie_chow;
  return step;
}

// Of a skeleton that is held in plan: it swells and shrinks upwards with the pore pressure.
template <int D>
const Reals& compressibility(World<D>& world) {
  UnsaturatedWater<D>& u = *world.pore_water->unsaturated;
  u.compressibility.resize(u.soil.size());
  for (std::size_t i = 0; i < u.soil.size(); ++i)
    u.compressibility[i] = 1 / world.scene.materials[u.soil[i]].wave_modulus();
  return u.compressibility;
}

// Soil in cells too thinly filled to be active counts to the active cells beside it (fdm::soil_fraction): it
// has the mean of their values.
template <int D>
void spread_to_slivers(const World<D>& world, Reals& values) {
  const PoreWater<D>& w = *world.pore_water;
  const Grid<D>& grid = world.skeleton.grid();
  parallel_for(grid.slots(), [&](int i) {
    if (w.cells.active(i)) return;
    if (w.fill[i] <= 0) {
      values[i] = 0;
      return;
    }
    const Index<D> index = grid.index(i);
    double faces = 0, all = 0;
    int n_faces = 0, n_all = 0;
    for (int k = 0; k < ipow(3, D); ++k) {
      Index<D> beside = index;
      int apart = 0;
      for (int d = 0, j = k; d < D; ++d, j /= 3) beside[d] += j % 3 - 1, apart += j % 3 != 1;
      const int slot = apart > 0 ? grid.slot(beside) : -1;
      if (slot < 0 || !w.cells.active(slot)) continue;
      all += values[slot], ++n_all;
      if (apart == 1) faces += values[slot], ++n_faces;
    }
    values[i] = n_faces > 0 ? faces / n_faces : n_all > 0 ? all / n_all : 0.0;
  });
}

// Points at the start: the saturation of the cells that they overlap.
template <int D>
void fill_points(World<D>& world) {
  PoreWater<D>& w = *world.pore_water;
  UnsaturatedWater<D>& u = *w.unsaturated;
  u.change = u.field.saturation();
  spread_to_slivers(world, u.change);
  for (auto& body : world.skeleton.bodies()) {
    ParticleSet<D>& set = *body;
    if (set.pore_water.empty()) continue;
    parallel_for(set.slots(), [&](int p) {
      if (set.id[p] < 0) return;
      const Overlap<D> o = overlap_of(world.skeleton.grid(), set, p);
      double sum = 0;
      for (int k = 0; k < ipow(2, D); ++k)
        if (o.slot[k] >= 0) sum += o.share[k] * u.change[o.slot[k]];
      set.pore_water[p] = world.scene.water.density * sum;
    });
  }
}

// Gives the change of the cells to the points: each takes the part of its own room (what it lacks to be full,
// or what it can lose) that the cell's change is of the mean room of its points. So none overflows while
// others in the cell have room, and the water in all points changes by what the cells took up. What goes
// beyond the room of all points is shared evenly.
template <int D>
void change_points(World<D>& world) {
  PoreWater<D>& w = *world.pore_water;
  UnsaturatedWater<D>& u = *w.unsaturated;
  spread_to_slivers(world, u.change);
  u.room_share.assign(u.change.size(), 0.0), u.even_share.assign(u.change.size(), 0.0);
  parallel_for(static_cast<int>(u.change.size()), [&](int i) {
    const double change = u.change[i], mean = u.point_saturation[i];
    if (change == 0 || mean < 0) return;
    const fdm::Retention& r = u.field.curve(u.soil[i]).parameters();
    const double room = change > 0 ? r.maximum - mean : mean - r.residual;
    const double share = room > 0 ? std::min(1.0, std::abs(change) / room) : 0.0;
    u.room_share[i] = change > 0 ? share : -share;
    u.even_share[i] = change - u.room_share[i] * std::max(room, 0.0);
  });
  const double density = world.scene.water.density;
  for (auto& body : world.skeleton.bodies()) {
    ParticleSet<D>& set = *body;
    if (set.pore_water.empty()) continue;
    const fdm::Retention& r = u.field.curve(set.material).parameters();
    parallel_for(set.slots(), [&](int p) {
      if (set.id[p] < 0) return;
      const Overlap<D> o = overlap_of(world.skeleton.grid(), set, p);
      const double own = set.pore_water[p] / density;
      double sum = 0;
      for (int k = 0; k < ipow(2, D); ++k) {
        if (o.slot[k] < 0) continue;
        const double part = u.room_share[o.slot[k]];
        sum +=
            o.share[k] * (part * (part > 0 ? r.maximum - own : own - r.residual) + u.even_share[o.slot[k]]);
      }
      set.pore_water[p] += density * sum;
    });
  }
}

template <int D>
void find_pushing_pressure(World<D>& world) {
  UnsaturatedWater<D>& u = *world.pore_water->unsaturated;
  const Reals& pressure = u.field.pressure();
  u.pushing.resize(pressure.size());
  parallel_for(static_cast<int>(pressure.size()),
               [&](int i) { u.pushing[i] = std::max(pressure[i], -u.field.full_suction(u.soil[i])); });
}

}  // namespace

template <int D>
void carry_unsaturated(World<D>& world) {
  UnsaturatedWater<D>& u = *world.pore_water->unsaturated;
  u.field.carry();
  if (!u.mapped) return;
  world.skeleton.grid().carry(u.point_saturation, 1, kNoPoints);
  world.skeleton.grid().carry(u.was_active);
  world.skeleton.grid().carry(u.travel);
}

template <int D>
void update_unsaturated_cells(World<D>& world) {
  PoreWater<D>& w = *world.pore_water;
  UnsaturatedWater<D>& u = *w.unsaturated;
  const Grid<D>& grid = world.skeleton.grid();
  const int slots = grid.slots();
  u.field.refresh();
  if (u.soil_revision != w.cells.revision() || static_cast<int>(u.soil.size()) != slots) {
    find_soils(world, u.soil);
    u.soil_revision = w.cells.revision();
  }
  u.volume_fraction.resize(slots);
  fdm::soil_fraction<D>(w.cells, w.fill, u.volume_fraction);

  // The mean saturation of the points as they lie now.
  u.point_saturation.resize(slots, kNoPoints), u.was_active.resize(slots, 0.0), u.travel.resize(slots, 0.0);
  const double density = world.scene.water.density;
  Reals& saturation = u.field.saturation();
  Reals& pressure = u.field.pressure();
  parallel_for(slots, [&](int i) {
    const double* s = &w.cell_sums[static_cast<std::size_t>(i) * 4];
    const double pores = s[0] - s[1];
    const double now = pores > 0 ? s[3] / (density * pores) : kNoPoints, before = u.point_saturation[i];
    const bool active = w.cells.active(i);
    if (active && u.mapped && now >= 0) {
      const fdm::RetentionCurve& curve = u.field.curve(u.soil[i]);
      const double most = curve.parameters().maximum;
      if (u.was_active[i] > 0 && before >= 0) {
        double s = saturation[i] + (now - before);
        s += u.travel[i] * (now - s);
        saturation[i] = std::clamp(s, curve.parameters().residual, most);
      } else if (now < most * kFull &&
                 !curve.always_saturated()) {  // soil that has moved here brings its water
        saturation[i] = std::max(now, curve.parameters().residual);
        pressure[i] = curve.pressure(saturation[i]);
      }
    }
    u.point_saturation[i] = now;
    u.was_active[i] = active ? 1.0 : 0.0;
    u.travel[i] = 0;
  });
  u.mapped = true;
  find_pushing_pressure(world);
}

template <int D>
void set_unsaturated_state(World<D>& world) {
  PoreWater<D>& w = *world.pore_water;
  UnsaturatedWater<D>& u = *w.unsaturated;
  const WaterSpec& spec = world.scene.water;
  Reals& pressure = u.field.pressure();
  Reals& saturation = u.field.saturation();
  set_cell_pressure(world, pressure);  // hydrostatic beyond the water table, into the suction
  for (const fdm::ActiveCell<D>& cell : w.cells.cells()) {
    const fdm::RetentionCurve& curve = u.field.curve(u.soil[cell.slot]);
    double& p = pressure[cell.slot];
    if (spec.initial_saturation && !curve.always_saturated()) {
      const double dry = curve.pressure(*spec.initial_saturation);
      p = spec.phreatic.empty() ? dry : std::max(p, dry);
    }
    saturation[cell.slot] = curve.saturation(p);
  }
  if (spec.initial == WaterSpec::Initial::steady) {
    fdm::UnsaturatedStep step = make_step(world, kFirstSteadyStep);
    u.field.set_tolerance(world.scene.numerics.solver_tolerance);
    const Reals start = pressure, held = saturation;
    fdm::StepReport r = u.field.steady(step);
    if (!r.converged && !world.scene.numerics.cell_means) {
      // Curves that are too steep for values at centres have their means over cells. What follows begins with
      // that pressure and the saturation that goes with it.
      pressure = start, saturation = held;
      u.field.set_averages(true);
      r = u.field.steady(step);
      u.field.set_averages(false);
      for (const fdm::ActiveCell<D>& cell : w.cells.cells())
        saturation[cell.slot] = u.field.curve(u.soil[cell.slot]).saturation(pressure[cell.slot]);
    }
    if (!r.converged)
      throw NumericalError("the steady flow that the pore water starts from was not found: " +
                           std::to_string(r.iterations) + " iterations, residual " + fdm::number(r.residual));
  }
  fill_points(world);
  update_suction(world);
  world.skeleton.scatter_cells(w.cell_sums);  // with the points' saturation
  u.mapped = false;
  update_unsaturated_cells(world);
}

namespace {

// Gives what a step of the cells has changed to the points; u.change is the saturation before it.
template <int D>
void pass_on(World<D>& world, const FlowInput& in) {
  PoreWater<D>& w = *world.pore_water;
  UnsaturatedWater<D>& u = *w.unsaturated;
  const double per_cell = in.dt / world.skeleton.grid().spacing() / ipow(2, D);
  parallel_for(w.cells.count(), [&](int c) {
    const fdm::ActiveCell<D>& cell = w.cells.cells()[c];
    const int i = cell.slot;
    u.change[i] = u.field.saturation()[i] - u.change[i];
    double speed = 0;
    for (std::size_t k = 0; !in.velocity.empty() && k < cell.nodes.size(); ++k) {
      double square = 0;
      for (int d = 0; d < D; ++d) {
        const double v = in.velocity[static_cast<std::size_t>(cell.nodes[k]) * 4 + d];
        square += v * v;
      }
      speed += std::sqrt(square);
    }
    u.travel[i] = std::min(1.0, speed * per_cell);
  });
  change_points(world);
  parallel_for(w.cells.count(), [&](int c) {
    const int i = w.cells.cells()[c].slot;
    u.point_saturation[i] += u.change[i];
  });
  find_pushing_pressure(world);
  w.outflow += in.dt * u.field.balance().outflow;
  // What the cells took up beyond the filling of pores, which the points have got.
  double filled = 0;
  for (const fdm::ActiveCell<D>& cell : w.cells.cells())
    filled += w.porosity[cell.slot] * u.volume_fraction[cell.slot] * cell.volume * u.change[cell.slot];
  w.storage += in.dt * u.field.balance().storage - filled;
}

template <int D>
fdm::UnsaturatedStep moving_step(const World<D>& world, const FlowInput& in) {
  fdm::UnsaturatedStep step = make_step(world, in.dt);
  step.velocity = in.velocity, step.mobility = in.mobility, step.pressure_gradient = in.pressure_gradient;
  return step;
}

}  // namespace

template <int D>
fdm::StepReport flow_unsaturated(World<D>& world, const FlowInput& in) {
  UnsaturatedWater<D>& u = *world.pore_water->unsaturated;
  fdm::UnsaturatedStep step = moving_step(world, in);
  if (!in.skeleton_compressibility.empty())
    step.skeleton_compressibility = in.skeleton_compressibility;
  else if (in.velocity.empty())
    step.skeleton_compressibility = compressibility(world);
  step.withdrawal = in.withdrawal;
  u.change = u.field.saturation();
  u.field.set_tolerance(world.scene.numerics.solver_tolerance * (in.velocity.empty() ? 1 : kMotionFactor));
  const fdm::StepReport report = u.field.solve(step);
  if (report.converged) pass_on(world, in);
  return report;
}

template <int D>
void flow_unsaturated_explicitly(World<D>& world, const FlowInput& in) {
  PoreWater<D>& w = *world.pore_water;
  UnsaturatedWater<D>& u = *w.unsaturated;
  u.change = u.field.saturation();
  w.explicit_limit = u.field.advance_explicitly(moving_step(world, in), w.specific_volume);
  pass_on(world, in);
}

template <int D>
fdm::ExplicitLimit unsaturated_explicit_limit(World<D>& world) {
  const PoreWater<D>& w = *world.pore_water;
  return w.unsaturated->field.explicit_limit(make_step(world, 1.0), w.specific_volume);
}

template <int D>
void update_suction(World<D>& world) {
  PoreWater<D>& w = *world.pore_water;
  UnsaturatedWater<D>& u = *w.unsaturated;
  const Reals& pressure = u.field.pressure();
  const Reals& saturation = u.field.saturation();
  u.suction.assign(pressure.size(), 0.0), u.suction_stress.assign(pressure.size(), 0.0);
  parallel_for(w.cells.count(), [&](int c) {
    const int i = w.cells.cells()[c].slot;
    const Material& m = world.scene.materials[u.soil[i]];
    const double s = m.retains() ? std::max(0.0, -pressure[i]) : 0.0;
    u.suction[i] = s;
    // What the nodes do not feel as a gradient.
    u.suction_stress[i] =
        m.retains() ? bishop_factor(m, saturation[i]) * s + std::min(0.0, w.pushing_pressure()[i]) : 0.0;
  });
  for (auto& body : world.skeleton.bodies()) {
    ParticleSet<D>& set = *body;
    const Material& m = world.scene.materials[set.material];
    // Soil that is always saturated has no suction of its own, whatever the cells of its neighbours say.
    if (set.suction_stress.empty() || !m.retains()) continue;
    const int capillary = world.layouts[set.material].capillary_factor;
    parallel_for(set.slots(), [&](int p) {
      if (set.id[p] < 0) return;
      const BetweenCentres<D> between(w.cells, position_of(set, p));
      set.suction_stress[p] = between.value(u.suction_stress);
      if (capillary < 0) return;
      const double s = between.value(u.suction);
      set.state[capillary][p] = m.capillary_suction > 0 ? std::min(1.0, s / m.capillary_suction)
                                : s > 0                 ? 1.0
                                                        : 0.0;
    });
  }
}

template <int D>
double pushing_pressure_at(const World<D>& world, const ParticleSet<D>& set, int p) {
  const PoreWater<D>& w = *world.pore_water;
  return BetweenCentres<D>(w.cells, position_of(set, p)).value(w.unsaturated->pushing);
}

#define POLDER_INSTANTIATE(D)                                                \
  template void carry_unsaturated<D>(World<D>&);                             \
  template void update_unsaturated_cells<D>(World<D>&);                      \
  template void set_unsaturated_state<D>(World<D>&);                         \
  template fdm::StepReport flow_unsaturated<D>(World<D>&, const FlowInput&); \
  template void flow_unsaturated_explicitly<D>(World<D>&, const FlowInput&); \
  template fdm::ExplicitLimit unsaturated_explicit_limit<D>(World<D>&);      \
  template void update_suction<D>(World<D>&);                                \
  template double pushing_pressure_at<D>(const World<D>&, const ParticleSet<D>&, int);
POLDER_INSTANTIATE(2)
POLDER_INSTANTIATE(3)

}  // namespace polder::coupling
