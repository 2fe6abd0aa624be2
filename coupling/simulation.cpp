// Stages and the step loop.
#include "coupling/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "core/error.hpp"
#include "coupling/explicit_water.hpp"
#include "coupling/initial_state.hpp"
#include "coupling/one_layer.hpp"
#include "coupling/point_water.hpp"
#include "coupling/simulation_run.hpp"
#include "coupling/step_limit.hpp"
#include "coupling/stopwatch.hpp"
#include "coupling/strength_reduction.hpp"
#include "coupling/two_layer.hpp"
#include "coupling/volume_feedback.hpp"

namespace polder::coupling {
namespace {

constexpr int kRestInterval = 20;  // steps between two looks at the equilibrium ratios
constexpr int kWaveInterval = 64;  // steps between two looks at the wave speed
// In two layers longer steps stay stable, but slides come out shorter the longer they are
// (docs/theory/two-layer.md).
constexpr double kLayeredCourant = 0.5;
constexpr double kSpeedShare = 0.2;  // of a cell that a particle may cross in one step

const char* mode_name(Stage::Mode mode) {
  switch (mode) {
    case Stage::Mode::equilibrium:
      return "equilibrium";
    case Stage::Mode::seepage:
      return "seepage";
    case Stage::Mode::quasi_static:
      return "quasi-static";
    case Stage::Mode::dynamic:
      break;
  }
  return "dynamic";
}

}  // namespace

// ---- one dimension
// ---------------------------------------------------------------------------------------------------

template <int D>
Simulation::Run<D>::Run(const Scene& s) : world(build_world<D>(s)) {
  scene = world->scene;  // with what the materials were told about the bodies
  if (world->pore_water) {
    PoreWater<D>& water = *world->pore_water;
    update_water_cells(*world, 0.0);
    set_initial_pressure(*world);
    if (water.unsaturated)
      set_initial_stress(*world);
    else
      wet_points(*world);
    if (water.points) set_point_water(*world);
  }
  audit = std::make_unique<Audit<D>>(*world);
  const Totals t = audit->totals(*world);
  initial_solid_mass = t.solid_mass;
  initial_water_volume = t.water_volume;
  for (const Stage& stage : scene.stages) reports.push_back({stage.name, mode_name(stage.mode), 0, 0, ""});
}

// Local damping enlarges a force against the motion by 1 + alpha, and shortens the stable step by the root of
// it.
template <int D>
double Simulation::Run<D>::courant_share(int of_stage) const {
  const bool damped = scene.stages.at(of_stage).damping > 0;
  const double most = scene.layered() ? kLayeredCourant : damped ? 1.0 : scene.numerics.courant;
  return std::min(scene.numerics.courant, most);
}

// Fastest wave that an explicit part of the step must follow, without those of the water's pressure.
template <int D>
double Simulation::Run<D>::fastest_wave() const {
  const double skeleton = world->skeleton.wave_speed(world->materials);
  const bool layered = world->pore_water && world->pore_water->layer;
  return layered ? std::max(skeleton * wave_factor(scene), surface_wave_speed(*world)) : skeleton;
}

template <int D>
std::pair<double, const char*> Simulation::Run<D>::chosen_step(int of_stage, double wave) const {
  const double h = world->skeleton.grid().spacing(), share = courant_share(of_stage);
  const Stage& spec = scene.stages[of_stage];
  if (!world->pore_water || !world->pore_water->compressible || !spec.water_flows || spec.relaxes())
    return {share * h / wave, scene.bodies.empty() ? "surface wave" : "skeleton wave"};
  const MotionLimit limit = world->pore_water->points ? point_water_limit(*world)
                                                      : combined_limit(explicit_limit(*world, time), h, wave);
  return {share * limit.dt, limit.reason};
}

template <int D>
double Simulation::Run<D>::automatic_step(int of_stage) const {
  return chosen_step(of_stage, fastest_wave()).first;
}

template <int D>
void Simulation::Run<D>::begin_stage() {
  world->skeleton.set_laws(world->materials, present().plastic);
  world->skeleton.boundaries().set_sticking(present().sticking);
  if (mpm::Sleep<D>* sleep = world->skeleton.sleep())
    sleep->set_active(present().mode == Stage::Mode::dynamic);
  laws_set = true;
}

// The first time after now and well before the end of the stage at which an expectation looks.
template <int D>
double Simulation::Run<D>::next_mark(double stage_end) const {
  const double slack = 1e-9 * present().duration;
  double next = std::numeric_limits<double>::infinity();
  for (const Expectation& e : scene.expectations) {
    if (!e.time) continue;
    double start = 0;
    int first = 0;
    if (!e.from_stage.empty())
      for (; scene.stages[first].name != e.from_stage; ++first) start += reports[first].time;
    const double at = start + *e.time;
    if (first <= stage && at > time + slack && at < stage_end - slack) next = std::min(next, at);
  }
  return next;
}

template <int D>
void Simulation::Run<D>::step() {
  Stopwatch watch(timing.total);
  if (!laws_set) begin_stage();
  if (relaxes()) return relax_step();
  if (present().moves())
    step_motion();
  else
    step_water();
}

template <int D>
void Simulation::Run<D>::step_motion() {
  const Stage& stage_spec = present();
  mpm::Skeleton<D>& skeleton = world->skeleton;
  const double h = skeleton.grid().spacing();
  if (steps % kWaveInterval == 0) wave_speed = fastest_wave();

  // Time step: a share of the limit of the waves; never more than a share of a cell for the fastest point.
  const auto chosen = chosen_step(stage, wave_speed);
  double step_size = chosen.first;
  reason = chosen.second;
  if (scene.numerics.time_step) step_size = *scene.numerics.time_step, reason = "fixed by the case";
  if (speed * step_size > kSpeedShare * h) step_size = kSpeedShare * h / speed, reason = "particle speed";
  const double stage_end = stage_start + stage_spec.duration, mark = next_mark(stage_end);
  const double left = std::min(stage_end, mark) - time;
  const bool lands = step_size >= left * (1 - 1e-9), last = lands && stage_end <= mark;
  if (lands) step_size = left, reason = last ? "end of stage" : "time of an expectation";

  StepInput in;
  in.time = time;
  in.dt = dt = step_size;
  in.damping = stage_spec.damping;
  in.water_flows = stage_spec.water_flows;
  if (stage_spec.gravity_ramp > 0)
    in.gravity = std::min(1.0, (time + dt - stage_start) / stage_spec.gravity_ramp);
  if (world->pore_water && world->pore_water->compressible)
    blend_for_step(*world, dt, courant_share(stage) * h / wave_speed);
  {
    Stopwatch mechanics(timing.mechanics);
    const mpm::MoveResult moved = !world->pore_water          ? step_dry(*world, in)
                                  : world->pore_water->layer  ? step_two_layer(*world, in, steps)
                                  : world->pore_water->points ? step_point_water(*world, in, steps)
                                                              : step_one_layer(*world, in, steps);
    speed = moved.largest_speed;
  }
  {
    if (world->pore_water) {
      timing.mechanics += timing.water - world->pore_water->wall_seconds;  // of this step
      timing.water = world->pore_water->wall_seconds;
    }
    Stopwatch watch_audit(timing.audit);
    audit->add_step(*world, dt, in.damping, in.gravity);
    if (mpm::Sleep<D>* sleep = world->skeleton.sleep()) {
      Point<D> impulse = sleep->take_stopped();
      for (double& x : impulse) x = -x;
      audit->add_impulse(impulse);
    }
  }
  if (!lands) {
    smallest = smallest == 0 ? dt : std::min(smallest, dt);
    largest = std::max(largest, dt);
  }
  time = lands ? std::min(stage_end, mark) : time + dt;
  marked = lands;
  ++steps, ++stage_steps;
  reports[stage].steps = stage_steps;
  reports[stage].time = time - stage_start;

  if (stage_spec.mode == Stage::Mode::equilibrium) {
    const bool ramped = time - stage_start >= stage_spec.gravity_ramp;
    if (ramped && stage_steps % kRestInterval == 0 && at_rest()) return end_stage("equilibrium");
    if (last) throw_unrest("raise its duration or damping, or let plasticity rest (plastic = false)");
  } else if (last) {
    end_stage("duration");
  }
}

template <int D>
bool Simulation::Run<D>::at_rest() {
  const mpm::Skeleton<D>& skeleton = world->skeleton;
  force_ratio = skeleton.load_norm() > 0 ? skeleton.unbalanced_force() / skeleton.load_norm() : 0.0;
  const Totals t = audit->totals(*world);
  energy_ratio =
      t.elastic_energy > 0 ? t.kinetic_energy / t.elastic_energy : (t.kinetic_energy > 0 ? 1.0 : 0.0);
  return force_ratio < present().force_tolerance && energy_ratio < present().energy_tolerance;
}

template <int D>
void Simulation::Run<D>::end_stage(const std::string& by) {
  reports[stage].ended_by = by;
  marked = true;
  if (mpm::Sleep<D>* sleep = world->skeleton.sleep()) sleep->wake_all();
  const Stage& ended = present();
  for (auto& body : world->skeleton.bodies()) {
    ParticleSet<D>& set = *body;
    const int strain = world->layouts[set.material].plastic_strain;
    for (int p = 0; p < set.slots(); ++p) {
      if (set.id[p] < 0) continue;
      for (int d = 0; d < D; ++d) {
        if (ended.reset_displacement) set.initial_position[d][p] = set.position[d][p];
        if (ended.reset_velocity) set.velocity[d][p] = 0;
        if (ended.reset_velocity && !set.water_velocity[d].empty()) set.water_velocity[d][p] = 0;
      }
      if (ended.reset_displacement && strain >= 0) set.state[strain][p] = 0;
    }
    if (ended.reset_velocity)
      for (Reals& c : set.affine) std::fill(c.begin(), c.end(), 0.0);
  }
  if (ended.reset_velocity) audit->rebase(*world);
  const bool follows_on = stage + 1 < static_cast<int>(scene.stages.size()) &&
                          scene.stages[stage + 1].mode == Stage::Mode::quasi_static;
  if (world->pore_water && !follows_on) {  // what is still owed goes without account
    const double left = end_feedback(*world);
    initial_water_volume += left, relaxation_water += left;
  }
  if (world->pore_water && !ended.water_flows) {
    // Pressure was held, so pores opened and closed without any account of the water: the balance starts
    // anew.
    const PoreWater<D>& water = *world->pore_water;
    initial_water_volume = audit->totals(*world).water_volume + water.outflow + water.storage;
  }
  if (world->pore_water) world->pore_water->explicit_limit.dt = 0;
  ++stage;
  stage_start = time;
  stage_steps = 0;
  water_step = relax_change = 0;
  locally_failed = false;
  laws_set = false;
}

// ---- the interface
// ---------------------------------------------------------------------------------------------------

Simulation::Simulation(const Scene& scene) {
  const Formulation* f = find_formulation(scene.formulation);
  if (f == nullptr || !f->available)
    throw InputError("formulation '" + scene.formulation + "' is not in this version");
  if (scene.dimension() == 2)
    run_ = std::make_unique<Run<2>>(scene);
  else
    run_ = std::make_unique<Run<3>>(scene);
}
Simulation::~Simulation() = default;
Simulation::Simulation(Simulation&&) noexcept = default;

const Scene& Simulation::scene() const {
  return run_->scene;
}
bool Simulation::finished() const {
  return run_->finished();
}
void Simulation::step() {
  run_->step();
}
double Simulation::time() const {
  return run_->time;
}
double Simulation::end_time() const {
  double end = run_->stage_start;
  for (std::size_t s = run_->stage; s < run_->scene.stages.size(); ++s) end += run_->scene.stages[s].duration;
  return end;
}
long Simulation::steps() const {
  return run_->steps;
}
int Simulation::stage() const {
  return run_->stage;
}
const std::vector<StageReport>& Simulation::stages() const {
  return run_->reports;
}
const std::vector<Event>& Simulation::events() const {
  return run_->events;
}
bool Simulation::at_mark() const {
  return run_->marked;
}
double Simulation::last_step() const {
  return run_->dt;
}
const std::string& Simulation::step_reason() const {
  return run_->reason;
}
double Simulation::smallest_step() const {
  return run_->smallest;
}
double Simulation::largest_step() const {
  return run_->largest;
}
double Simulation::automatic_step(int stage) const {
  return run_->automatic_step(stage);
}
StepLimit Simulation::step_limit() const {
  if (!run_->limit) {
    const Scene& scene = run_->scene;
    if (scene.layered() && !scene.compressible()) {
      run_->limit = StepLimit{
          run_->automatic_step(0) / std::min(scene.numerics.courant, kLayeredCourant) * kLayeredCourant,
          "two layers, " + fdm::number(kLayeredCourant) + " of cell over " +
              (scene.bodies.empty() ? "the speed of long waves" : "the skeleton's wave speed")};
      return *run_->limit;
    }
    const StabilityLimit found = find_stability_limit(run_->scene);
    char text[160];
    std::snprintf(text, sizeof text, "%s in %s'%s', %.3g of cell over skeleton wave speed",
                  found.mechanism.c_str(), found.with_water ? "saturated " : "", found.material.c_str(),
                  found.courant_number);
    run_->limit = StepLimit{found.dt, text};
  }
  return *run_->limit;
}
double Simulation::step_beyond_limit() const {
  const Scene& s = run_->scene;
  const double limit = step_limit().dt;
  if (s.numerics.time_step) return *s.numerics.time_step > limit ? *s.numerics.time_step : 0;
  const bool compressible = s.compressible();
  if (compressible && s.unsaturated()) return s.numerics.courant > 1 ? s.numerics.courant * limit : 0;
  for (std::size_t i = 0; i < s.stages.size(); ++i) {
    const Stage& stage = s.stages[i];
    if (compressible && (stage.relaxes() || !stage.water_flows)) continue;  // the water limits nothing there
    const double step = automatic_step(static_cast<int>(i));
    if (step > limit) return step;
  }
  return 0;
}
double Simulation::equilibrium_force_ratio() const {
  return run_->force_ratio;
}
double Simulation::equilibrium_energy_ratio() const {
  return run_->energy_ratio;
}
long Simulation::particles() const {
  return run_->particles();
}
long Simulation::cells() const {
  return run_->cells();
}
long Simulation::pressure_cells() const {
  return run_->pressure_cells();
}
const char* Simulation::pressure_solver() const {
  return run_->pressure_solver();
}
std::vector<Column> Simulation::history() const {
  return run_->history();
}
int Simulation::probe_particle(const Vector3& at) const {
  return run_->probe_particle(at);
}
double Simulation::particle_quantity(int n, const std::string& q) const {
  return run_->particle_quantity(n, q);
}
double Simulation::cell_quantity(const Vector3& at, const std::string& q) const {
  return run_->cell_quantity(at, q);
}
double Simulation::body_quantity(const std::string& body, const std::string& q) const {
  return run_->body_quantity(body, q);
}
Profile Simulation::profile(const Measure& m) const {
  return run_->profile(m);
}
std::vector<std::pair<double, double>> Simulation::phreatic_line() const {
  return run_->phreatic_line();
}
PointFrame Simulation::points(const std::vector<std::string>& fields) const {
  return run_->points(fields);
}
PointFrame Simulation::water_points() const {
  return run_->water_points();
}
FlowNet Simulation::flow_net() const {
  return run_->flow_net();
}
CellFrame Simulation::water_cells() const {
  return run_->water_cells();
}
Timing Simulation::timing() const {
  return run_->timing;
}
void Simulation::visit(StateVisitor& v) {
  run_->visit(v);
}
StabilityTrial Simulation::try_reduced_strength(double factor, const StabilityOptions& options) {
  return run_->try_reduced_strength(factor, options);
}

template struct Simulation::Run<2>;
template struct Simulation::Run<3>;

}  // namespace polder::coupling
