// Equilibrium stages that relax (coupling/relaxation.hpp): one step of the relaxation is one step of the
// simulation.
//
// The clock goes on, so that tables, frames and the stage's duration mean something: a step counts as the
// time a wave takes to cross a cell, as if the masses were real. No other process of the scene depends on it
// but loads and ramps that the stage itself has in time.
#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "coupling/simulation_run.hpp"
#include "coupling/stopwatch.hpp"
#include "coupling/strength_reduction.hpp"

namespace polder::coupling {

template <int D>
void Simulation::Run<D>::throw_unrest(const std::string& advice) const {
  throw NumericalError(
      "stage '" + present().name + "' did not come to rest within its duration: out-of-balance force ratio " +
      std::to_string(force_ratio) + " (tolerance " + std::to_string(present().force_tolerance) +
      "), kinetic energy ratio " + std::to_string(energy_ratio) + " (tolerance " +
      std::to_string(present().energy_tolerance) + "); " + advice);
}

template <int D>
void Simulation::Run<D>::begin_relaxation() {
  RelaxationOptions options;
  options.force_tolerance = present().force_tolerance;
  options.energy_tolerance = present().energy_tolerance;
  options.most_steps = std::numeric_limits<long>::max();  // the stage's duration ends it
  options.stop_runaway = false;
  relaxation = std::make_unique<Relaxation<D>>(*world, options);
}

template <int D>
void Simulation::Run<D>::relax_step() {
  const Stage& spec = present();
  if (!relaxation) begin_relaxation();
  if (stage_steps % 64 == 0) wave_speed = world->skeleton.wave_speed(world->materials);
  dt = world->skeleton.grid().spacing() / wave_speed;
  reason = "relaxation";
  const double gravity =
      spec.gravity_ramp > 0 ? std::min(1.0, (time + dt - stage_start) / spec.gravity_ramp) : 1.0;
  bool goes_on = false;
  {
    Stopwatch mechanics(timing.mechanics);
    goes_on = relaxation->step(time + dt, gravity);
  }
  force_ratio = relaxation->report().force_ratio, energy_ratio = relaxation->report().energy_ratio;
  marked = false;
  if (goes_on) {
    time += dt;
    ++steps, ++stage_steps;
    reports[stage].steps = stage_steps;
    reports[stage].time = time - stage_start;
    if (time - stage_start >= spec.duration)
      throw_unrest("raise its duration, or let plasticity rest (plastic = false)");
    return;
  }
  relaxation.reset();
  speed = 0;
  audit->rebase(*world);
  end_stage("equilibrium");
}

template <int D>
void Simulation::Run<D>::visit_relaxation(StateVisitor& v) {
  std::int64_t runs = relaxation != nullptr;
  v.count("relaxing", runs);
  if (v.reading()) {
    relaxation.reset();
    if (runs != 0) begin_relaxation();
  }
  if (relaxation) relaxation->visit(v);
}

template <int D>
StabilityTrial Simulation::Run<D>::try_reduced_strength(double factor, const StabilityOptions& options) {
  relaxation.reset();
  laws_set = false;
  if (mpm::Sleep<D>* sleep = world->skeleton.sleep()) sleep->wake_all();
  for (auto& body : world->skeleton.bodies())
    for (int d = 0; d < D; ++d) body->initial_position[d] = body->position[d];  // displacements of the trial
  return coupling::try_reduced_strength(*world, factor, options, time);
}

#define POLDER_INSTANTIATE(D)                                               \
  template void Simulation::Run<D>::throw_unrest(const std::string&) const; \
  template void Simulation::Run<D>::begin_relaxation();                     \
  template void Simulation::Run<D>::relax_step();                           \
  template void Simulation::Run<D>::visit_relaxation(StateVisitor&);        \
  template StabilityTrial Simulation::Run<D>::try_reduced_strength(double, const StabilityOptions&);
POLDER_INSTANTIATE(2)
POLDER_INSTANTIATE(3)

}  // namespace polder::coupling
