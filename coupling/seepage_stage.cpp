// Stages in which water sets the pace: seepage through a rigid skeleton, and quasi-static stages, where the
// skeleton follows in equilibrium.
//
// Steps of the water are implicit; their size follows the number of iterations (Paniconi & Putti 1994, Water
// Resour. Res. 30): few let it grow, many shrink it, one that does not converge is undone and cut to a third.
// A quasi-static stage seeks equilibrium (relaxation.hpp) whenever the pore pressure has changed enough
// anywhere. Where soil yields on and on a search ends without equilibrium, and the next one goes on from
// there: a toe may slump and come to rest. The soil has failed when a part of it, and not a point only, has
// moved too far; the search in which that happens is undone, so that what comes next starts from the state
// before it, under the new pressure.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/error.hpp"
#include "coupling/memory_state.hpp"
#include "coupling/one_layer.hpp"
#include "coupling/relaxation.hpp"
#include "coupling/simulation_run.hpp"
#include "coupling/stopwatch.hpp"
#include "coupling/unsaturated.hpp"
#include "coupling/volume_feedback.hpp"
#include "coupling/water_pace.hpp"

namespace polder::coupling {
namespace {

constexpr int kHard = 20;             // iterations
constexpr double kShrink = 0.7;       // of the step after a hard one
constexpr double kBack = 1.0 / 3;     // after one that did not converge
constexpr double kRelaxShare = 0.02;  // of the hydrostatic pressure over the height of the soil

// One step of water through a saturated scene at rest, with what the soil's change of volume takes.
template <int D>
void flow_saturated(World<D>& world, double dt, const Reals& withdrawal) {
  PoreWater<D>& w = *world.pore_water;
  if (w.cells.count() == 0) return;
  const Reals at_rest(w.cells.interior_faces().size() + w.cells.boundary_faces().size(), 0.0);
  const Reals nothing(static_cast<std::size_t>(w.cells.count()), 0.0);
  fdm::PressureStep p;
  p.dt = dt;
  p.divergence = withdrawal.empty() ? nothing : withdrawal;
  p.face_mobility = at_rest;
  p.porosity = w.porosity;
  p.darcy_mobility = w.darcy_mobility;
  p.skeleton_compressibility = w.feedback.compressibility;
  p.rhie_chow = 0;
  w.pressure.solve(p);
  w.outflow += dt * w.pressure.discharge().total();
  w.storage += dt * w.pressure.balance().storage;
}

}  // namespace

std::string Event::text() const {
  char text[300];
  std::snprintf(
      text, sizeof text,
      "%s: the point at (%.4g, %.4g, %.4g) m has moved %.3g m since the stage began, %.2g of the soil as far "
      "as a failure; out-of-balance force ratio %.2g",
      is_failure() ? "failure" : "local failure", place[0], place[1], place[2], displacement, share,
      force_ratio);
  return text;
}

template <int D>
double Simulation::Run<D>::flow(double left) {
  const Stage& spec = present();
  PoreWater<D>& w = *world->pore_water;
  const WaterPace pace = water_pace(spec);
  const double largest = pace.largest, growth = pace.growth;
  if (water_step == 0) water_step = std::min(largest, pace.first);
  for (;;) {
    const bool whole = water_step < left;
    const double step_size = std::min(water_step, left);
    reason = whole ? "iterations of the water" : "end of stage or time of an expectation";
    update_water_cells(*world, time + step_size);  // keeps its own time
    Stopwatch watch(w.wall_seconds);
    const bool follows = spec.mode == Stage::Mode::quasi_static;
    const Reals before = follows ? w.pore_pressure() : Reals();
    if (!w.unsaturated) {
      flow_saturated(*world, step_size, follows ? withdrawal(*world, step_size) : Reals());
      if (follows) settle_withdrawal(*world, step_size, before);
      water_step = std::min(largest, growth * water_step);
      return step_size;
    }
    FlowInput in;
    in.dt = step_size;
    if (follows) {
      in.skeleton_compressibility = w.feedback.compressibility;
      in.withdrawal = withdrawal(*world, step_size);
    }
    const fdm::StepReport report = flow_unsaturated(*world, in);
    if (report.converged) {
      if (follows) settle_withdrawal(*world, step_size, before);
      if (report.iterations <= pace.easy && whole) water_step = std::min(largest, growth * water_step);
      if (report.iterations >= kHard && !report.lagged) water_step = kShrink * step_size;
      return step_size;
    }
    water_step = kBack * step_size;
    if (water_step < pace.smallest)
      throw NumericalError("stage '" + spec.name + "': the flow of water did not converge with a step of " +
                           fdm::number(step_size) + " s at " + fdm::number(time) + " s: residual " +
                           fdm::number(report.residual) + " after " + std::to_string(report.iterations) +
                           " iterations, last change " + fdm::number(report.largest_change) + " Pa");
  }
}

template <int D>
bool Simulation::Run<D>::is_steady(const Reals& before, double step_size) const {
  const PoreWater<D>& w = *world->pore_water;
  double change = 0;
  for (const fdm::ActiveCell<D>& cell : w.cells.cells())
    change = std::max(change, std::abs(w.pore_pressure()[cell.slot] - before[cell.slot]));
  return change / world->unit_weight() / step_size < present().steady_rate;
}

template <int D>
void Simulation::Run<D>::begin_water_stage() {
  stage_position.clear();
  for (const auto& body : world->skeleton.bodies()) {
    Reals x(static_cast<std::size_t>(body->count()) * D);
    for (int id = 0; id < body->count(); ++id)
      for (int d = 0; d < D; ++d) x[static_cast<std::size_t>(id) * D + d] = body->position[d][body->find(id)];
    stage_position.push_back(std::move(x));
  }
  relaxed_pressure.clear();
  for (auto& body : world->skeleton.bodies()) {  // nothing moves in such a stage
    for (Reals& v : body->velocity) std::fill(v.begin(), v.end(), 0.0);
    for (Reals& c : body->affine) std::fill(c.begin(), c.end(), 0.0);
  }
  audit->rebase(*world);
  if (present().mode == Stage::Mode::quasi_static) begin_feedback(*world);
}

template <int D>
void Simulation::Run<D>::step_water() {
  PoreWater<D>& w = *world->pore_water;
  const Stage& spec = present();
  if (world->skeleton.sort()) {
    carry_water(*world);
    if (!relaxed_pressure.empty()) world->skeleton.grid().carry(relaxed_pressure);
  }
  if (stage_steps == 0) {
    begin_water_stage();
    if (spec.mode == Stage::Mode::quasi_static && !follow()) return fail();
  }
  const double stage_end = stage_start + spec.duration, mark = next_mark(stage_end);
  const double end = std::min(stage_end, mark);
  const Reals before = spec.until == Stage::Until::steady ? w.pore_pressure() : Reals();
  dt = flow(end - time);
  if (w.unsaturated) update_suction(*world);
  const bool lands = dt >= (end - time) * (1 - 1e-9), last = lands && stage_end <= mark;
  time = lands ? end : time + dt;
  marked = lands;
  if (!lands) smallest = smallest == 0 ? dt : std::min(smallest, dt), largest = std::max(largest, dt);
  ++steps, ++stage_steps;
  reports[stage].steps = stage_steps, reports[stage].time = time - stage_start;
  timing.water = w.wall_seconds;

  if (spec.mode == Stage::Mode::quasi_static && (last || is_relaxation_due()) && !follow()) return fail();
  if (!before.empty() && is_steady(before, dt)) return end_stage("steady");
  if (last) end_stage("duration");
}

// ---- quasi-static
// ----------------------------------------------------------------------------------------------------

template <int D>
bool Simulation::Run<D>::is_relaxation_due() const {
  const PoreWater<D>& w = *world->pore_water;
  double change = 0;
  for (const fdm::ActiveCell<D>& cell : w.cells.cells())
    change = std::max(change, std::abs(w.pore_pressure()[cell.slot] - relaxed_pressure[cell.slot]));
  return change > relax_change;
}

// Seeks equilibrium under the present pressure. False where the soil has failed.
template <int D>
bool Simulation::Run<D>::follow() {
  const Stage& spec = present();
  PoreWater<D>& w = *world->pore_water;
  Stopwatch watch(timing.mechanics);
  const double water_seconds = w.wall_seconds;
  if (relax_change == 0) {
    const Totals t = audit->totals(*world);
    relax_change = spec.relax_change > 0
                       ? spec.relax_change
                       : kRelaxShare * world->unit_weight() * (t.height - scene.grid.origin[D - 1]);
  }
  const std::vector<Reals> volumes = point_volumes(*world);
  MemoryState rest;
  rest.save(*this);
  RelaxationOptions options;
  options.force_tolerance = spec.force_tolerance;
  options.most_steps = spec.relaxation_steps;
  options.stop_runaway = false;
  const RelaxationReport report = relax(*world, options, time);
  timing.mechanics -= w.wall_seconds - water_seconds;
  relaxation_steps += report.steps;
  ++relaxations;
  unbalanced_relaxations += !report.converged;
  force_ratio = report.force_ratio, energy_ratio = report.energy_ratio;

  const double limit = spec.failure_displacement > 0 ? spec.failure_displacement : 0.5 * scene.grid.cell;
  const Displaced displaced = displaced_soil(limit);
  Event event{
      Event::Kind::local_failure, spec.name, time, displaced.place, displaced.largest, displaced.share,
      report.force_ratio};
  if (displaced.largest > limit && !locally_failed) {
    locally_failed = true;
    events.push_back(event);
  }
  if (displaced.share >= spec.failure_share) {
    event.kind = Event::Kind::failure;
    if (spec.until == Stage::Until::failure) {  // back to the last state of rest
      const std::vector<Event> told = events;
      rest.load(*this);
      events = told;
    }
    events.push_back(event);
    return false;
  }
  if (world->skeleton.sort()) carry_water(*world);
  update_water_cells(*world, time);
  if (w.unsaturated) update_suction(*world);
  // Pores that have opened or closed take or give water: the cells' in the next step, where there are any.
  const double taken = charge_volume(*world, volumes);
  initial_water_volume += taken;
  relaxation_water += taken;
  relaxed_pressure = w.pore_pressure();
  return true;
}

template <int D>
void Simulation::Run<D>::fail() {
  if (present().until == Stage::Until::failure) return end_stage("failure");
  throw NumericalError("stage '" + present().name + "' has failed at " + fdm::number(time) + " s: " +
                       events.back().text() + "; until = \"failure\" lets the next stage go on from there");
}

template <int D>
typename Simulation::Run<D>::Displaced Simulation::Run<D>::displaced_soil(double limit) const {
  Displaced result;
  double largest = -1, far = 0, all = 0;
  for (std::size_t b = 0; b < stage_position.size(); ++b) {
    const ParticleSet<D>& set = *world->skeleton.bodies()[b];
    for (int id = 0; id < set.count(); ++id) {
      const int p = set.find(id);
      double r = 0;
      for (int d = 0; d < D; ++d) {
        const double u = set.position[d][p] - stage_position[b][static_cast<std::size_t>(id) * D + d];
        r += u * u;
      }
      all += set.volume[p];
      if (r > limit * limit) far += set.volume[p];
      if (r <= largest) continue;
      largest = r;
      for (int d = 0; d < D; ++d) result.place[d] = stage_position[b][static_cast<std::size_t>(id) * D + d];
    }
  }
  result.largest = std::sqrt(std::max(0.0, largest));
  result.share = all > 0 ? far / all : 0;
  return result;
}

template <int D>
void Simulation::Run<D>::visit_water_stage(StateVisitor& v) {
  const auto integer = [&](const std::string& name, auto& value) {
    std::int64_t n = static_cast<std::int64_t>(value);
    v.count(name, n);
    value = static_cast<std::remove_reference_t<decltype(value)>>(n);
  };
  v.number("water_step", water_step), v.number("relax_change", relax_change);
  v.number("relaxation_water", relaxation_water);
  integer("relaxations", relaxations), integer("relaxation_steps", relaxation_steps);
  integer("unbalanced_relaxations", unbalanced_relaxations);
  integer("locally_failed", locally_failed);
  v.reals("relaxed_pressure", relaxed_pressure);
  stage_position.resize(world->skeleton.bodies().size());
  for (std::size_t b = 0; b < stage_position.size(); ++b)
    v.reals("stage_position_" + std::to_string(b), stage_position[b]);
  std::int64_t count = static_cast<std::int64_t>(events.size());
  v.count("events", count);
  events.resize(static_cast<std::size_t>(count));
  for (std::size_t e = 0; e < events.size(); ++e) {
    const std::string n = "event_" + std::to_string(e) + "_";
    Event& event = events[e];
    std::int64_t of_stage = 0;
    for (std::size_t s = 0; s < scene.stages.size(); ++s)
      if (scene.stages[s].name == event.stage) of_stage = static_cast<std::int64_t>(s);
    integer(n + "kind", event.kind), v.count(n + "stage", of_stage);
    event.stage = scene.stages[static_cast<std::size_t>(of_stage)].name;
    v.number(n + "time", event.time), v.number(n + "displacement", event.displacement);
    v.number(n + "force_ratio", event.force_ratio), v.number(n + "share", event.share);
    for (int d = 0; d < 3; ++d) v.number(n + "place_" + std::to_string(d), event.place[d]);
  }
}

#define POLDER_INSTANTIATE(D)                                              \
  template void Simulation::Run<D>::step_water();                          \
  template void Simulation::Run<D>::visit_water_stage(StateVisitor&);      \
  template double Simulation::Run<D>::flow(double);                        \
  template bool Simulation::Run<D>::is_steady(const Reals&, double) const; \
  template void Simulation::Run<D>::begin_water_stage();                   \
  template bool Simulation::Run<D>::is_relaxation_due() const;             \
  template bool Simulation::Run<D>::follow();                              \
  template void Simulation::Run<D>::fail();                                \
  template Simulation::Run<D>::Displaced Simulation::Run<D>::displaced_soil(double) const;
POLDER_INSTANTIATE(2)
POLDER_INSTANTIATE(3)

}  // namespace polder::coupling
