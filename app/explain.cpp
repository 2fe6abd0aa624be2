// `polder explain`: what a case needs and what it skips, its size, its step limit, and how long it would
// take.
#include <algorithm>
#include <cmath>
#include <ostream>

#include "app/case.hpp"
#include "app/check_scene.hpp"
#include "app/commands.hpp"
#include "app/digits.hpp"
#include "app/run_time.hpp"
#include "app/size_estimate.hpp"
#include "core/error.hpp"
#include "core/threads.hpp"
#include "coupling/simulation.hpp"
#include "io/log.hpp"

namespace polder::app {
namespace {

using coupling::Scene;
using coupling::Simulation;

template <class T>
std::string name_of(T value, std::initializer_list<std::pair<T, const char*>> names) {
  for (const auto& [v, name] : names)
    if (v == value) return name;
  return "?";
}

// What acts on water with particles of its own besides pressure.
void explain_layer(const Scene& scene, std::ostream& out) {
  using coupling::DragLaw;
  for (const coupling::Material& m : scene.materials) {
    if (m.porosity <= 0) continue;
    out << "  drag        \"" << m.name << "\": "
        << name_of(m.drag_law, {{DragLaw::darcy, "Darcy"},
                                {DragLaw::forchheimer, "Forchheimer"},
                                {DragLaw::ergun, "Ergun"},
                                {DragLaw::gidaspow, "Gidaspow"},
                                {DragLaw::di_felice, "Di Felice"}})
        << ", implicit: it does not limit the step";
    if (m.fluidisation_porosity > 0)
      out << "; no contact above porosity " << format_number(m.fluidisation_porosity)
          << (scene.dispersed() ? "" : " once effective stress has vanished");
    out << '\n';
  }
  if (scene.water.viscous)
    out << "  viscosity   " << format_number(scene.water.viscosity)
        << " Pa s, implicit: it does not limit the step\n";
  else
    out << "  viscosity   none: water slips along walls\n";
}

void explain_formulation(const Scene& scene, std::ostream& out) {
  using namespace coupling;
  const Formulation& f = *find_formulation(scene.formulation);
  out << "formulation   " << f.name << " (" << f.source << ")\n";
  if (f.carrier == WaterCarrier::none) {
    out << "  pore water  none\n";
    return;
  }
  out << "  pore water  in "
      << name_of(f.carrier, {{WaterCarrier::cells, "cells"},
                             {WaterCarrier::skeleton, "the skeleton's particles"},
                             {WaterCarrier::particles, "particles of its own"}})
      << ", its inertia relative to the skeleton "
      << name_of(f.inertia, {{RelativeInertia::neglected, "neglected"}, {RelativeInertia::kept, "kept"}})
      << ", pressure "
      << (!scene.compressible() ? "projected: stiff water and low conductivity do not limit the step"
          : scene.layered()     ? "explicitly from the bulk modulus: stiff water limits the step"
                            : "explicitly from the bulk modulus: stiff water and Darcy flow limit the step")
      << '\n';
  if (scene.layered()) explain_layer(scene, out);
  if (!scene.unsaturated()) return;
  out << "  saturation  from the retention curves of";
  for (const Material& m : scene.materials)
    if (m.retains()) out << " \"" << m.name << '"';
  out << '\n';
}

std::string stage_text(const coupling::Stage& s, double steps) {
  using Mode = coupling::Stage::Mode;
  const bool event = s.until != coupling::Stage::Until::duration;
  const std::string time = (event || s.mode == Mode::equilibrium ? "at most " : "") +
                           format_number(s.duration) + " s",
                    end = s.until == coupling::Stage::Until::failure  ? ", until failure"
                          : s.until == coupling::Stage::Until::steady ? ", until the flow is steady"
                                                                      : "";
  switch (s.mode) {
    case Mode::equilibrium:
      return "equilibrium, " + std::string(s.damping > 0 ? "damped motion, " : "relaxation, ") + time +
             ", at most " + digits(steps, 3) + " steps";
    case Mode::seepage:
      return "seepage through a rigid skeleton, " + time + end;
    case Mode::quasi_static:
      return "quasi-static, the skeleton follows the water in equilibrium, " + time + end;
    case Mode::dynamic:
      break;
  }
  return "dynamic, " + time + ", about " + digits(steps, 3) + " steps";
}

void explain_random_fields(const Scene& scene, std::ostream& out) {
  using R = coupling::RandomProperty;
  for (const coupling::Body& body : scene.bodies)
    for (const R& r : body.random) {
      out << "random        "
          << name_of(r.property, {{R::Property::cohesion, "cohesion"},
                                  {R::Property::friction, "friction"},
                                  {R::Property::shear_strength, "shear strength"},
                                  {R::Property::conductivity, "conductivity"}})
          << " of \"" << body.name << "\": "
          << name_of(r.distribution,
                     {{R::Distribution::lognormal, "lognormal"}, {R::Distribution::normal, "normal"}})
          << ", coefficient of variation " << format_number(r.coefficient_of_variation) << ", "
          << name_of(r.correlation,
                     {{R::Correlation::exponential, "exponential"}, {R::Correlation::gaussian, "Gaussian"}})
          << " correlation over ";
      for (int d = 0; d < scene.dimension(); ++d)
        out << (d > 0 ? " x " : "") << format_number(r.correlation_length[static_cast<std::size_t>(d)]);
      out << " m, seed " << r.seed << '\n';
    }
}

// The time step of each stage's motion as the scene begins.
std::vector<double> steps_of_motion(const Simulation& simulation) {
  const Scene& scene = simulation.scene();
  std::vector<double> steps;
  for (std::size_t i = 0; i < scene.stages.size(); ++i)
    steps.push_back(scene.numerics.time_step.value_or(simulation.automatic_step(static_cast<int>(i))));
  return steps;
}

void explain_run_time(const Scene& scene, const std::vector<double>& step, std::ostream& out) {
  const std::vector<StageTime> times = estimate_run_time(scene, step);
  double total = 0;
  bool water = false, factors = false;
  for (std::size_t i = 0; i < times.size(); ++i) {
    water = water || !scene.stages[i].moves();
    if (!std::isnan(times[i].seconds())) total += times[i].seconds();
  }
  for (const coupling::Measure& m : scene.measures)
    factors = factors || m.kind == coupling::Measure::Kind::stability;
  out << "run time      ";
  if (total > 0)
    out << (water || factors ? "at least " : "about ") << duration_text(total);
  else
    out << "not known before";
  out << " with " << threads() << (threads() == 1 ? " thread" : " threads")
      << ", from trials of each stage at the initial state, without output\n";
  for (std::size_t i = 0; i < times.size(); ++i) {
    const coupling::Stage& s = scene.stages[i];
    out << "  " << s.name << ": ";
    if (std::isnan(times[i].seconds())) {
      out << "not known before: it does not run from the initial state\n";
      continue;
    }
    const std::string one = (s.moves() ? " steps of " : " steps of the water of ") +
                            digits(times[i].seconds_per_step * 1e3, 2) + " ms";
    if (times[i].steps > 0)
      out << duration_text(times[i].seconds()) << " for "
          << (!s.moves()                                     ? "at least "
              : s.mode == coupling::Stage::Mode::equilibrium ? "at most "
                                                             : "about ")
          << digits(times[i].steps, 3) << one;
    else
      out << "not known before:" << one << " until the flow is steady";
    if (s.mode == coupling::Stage::Mode::quasi_static) out << ", searches for equilibrium besides";
    out << '\n';
  }
  for (const coupling::Measure& m : scene.measures)
    if (m.kind == coupling::Measure::Kind::stability)
      out << "  measure " << m.name << ": a search for the factor of safety besides, about ten relaxations\n";
}

// What an explicit pressure costs: what becomes of the step where pores fill, and the same case with a
// projected pressure.
void explain_cost(const Scene& scene, double limit, double longest, std::ostream& out) {
  const double filled = scene.numerics.courant * limit;
  if (scene.unsaturated() && !scene.numerics.time_step && longest > filled)
    out << "  with soil full of water or nearly so anywhere the step falls to about " << digits(filled, 2)
        << " s, and a run takes up to " << digits(longest / filled, 2) << " times as long\n";
  Scene projected = scene;
  if (scene.layered())
    projected.numerics.pressure = coupling::PressureMethod::projected;
  else
    projected.formulation = "one-layer";
  projected.numerics.time_step.reset();
  double seconds = 0;
  for (const StageTime& t : estimate_run_time(projected, steps_of_motion(Simulation(projected))))
    if (!std::isnan(t.seconds())) seconds += t.seconds();
  out << (scene.layered() ? "projected     about " : "one-layer     about ") << duration_text(seconds)
      << (scene.on_points() ? ": the same case with a projected pressure in cells\n"
                            : ": the same equations with a projected pressure\n");
}

}  // namespace

int explain_command(const Arguments& a, std::ostream& out, std::ostream&) {
  const Scene scene = read_case(a.words.front(), a.all("--set"));
  set_threads(choose_threads(a.integer("--threads", 1, kMostThreads).value_or(0), scene));
  Simulation simulation(scene);
  const coupling::StepLimit limit = simulation.step_limit();
  const std::vector<double> steps = steps_of_motion(simulation);
  // Shown: that of the first stage that moves with its water, if there is one.
  std::size_t typical = 0;
  for (std::size_t i = scene.stages.size(); i-- > 0;)
    if (scene.stages[i].moves() && scene.stages[i].water_flows && !scene.stages[i].relaxes()) typical = i;
  const double step = steps[typical];

  out << "case          " << a.words.front() << (scene.title.empty() ? "" : ": " + scene.title) << '\n';
  explain_formulation(scene, out);
  out << "space         "
      << name_of(scene.grid.space, {{Space::plane_strain, "plane strain"},
                                    {Space::axisymmetric, "axisymmetric"},
                                    {Space::three_d, "3D"}})
      << ", cells of " << format_number(scene.grid.cell) << " m\n";
  out << "particles     " << simulation.particles() << " in " << scene.bodies.size()
      << (scene.bodies.size() == 1 ? " body\n" : " bodies\n");
  explain_random_fields(scene, out);
  const double all_cells = estimate_size(scene).cells;
  out << "cells         " << simulation.cells() << " stored of " << digits(all_cells, 6) << " in the grid\n";
  if (simulation.pressure_cells() > 0)
    out << "pressure      " << simulation.pressure_cells() << " cells, " << simulation.pressure_solver()
        << '\n';
  out << "memory        about " << digits(estimate_size(scene).memory / 1e6, 2) << " MB\n";
  out << "step limit    " << digits(limit.dt, 4) << " s (" << limit.reason << "); step " << digits(step, 4)
      << " s ("
      << (scene.numerics.time_step ? "fixed by the case" : "courant " + format_number(scene.numerics.courant))
      << ")\n";
  if (simulation.step_beyond_limit() > 0) out << "warning       the step is beyond the limit of stability\n";
  out << "stages\n";
  for (std::size_t i = 0; i < scene.stages.size(); ++i) {
    const coupling::Stage& s = scene.stages[i];
    const double n = s.moves() ? std::ceil(s.duration / steps[i]) : 0;
    out << "  " << s.name << ": " << stage_text(s, n) << '\n';
  }
  out << "off\n";
  for (const std::string& s : simulation.skipped()) out << "  " << s << '\n';
  if (std::all_of(scene.bodies.begin(), scene.bodies.end(), [](const auto& b) { return b.random.empty(); }))
    out << "  random fields: no body has one, so none is generated\n";
  for (const std::string& n : notes(scene)) out << "  " << n << '\n';
  explain_run_time(scene, steps, out);
  if (scene.compressible()) explain_cost(scene, limit.dt, step, out);
  return static_cast<int>(ExitCode::done);
}

}  // namespace polder::app
