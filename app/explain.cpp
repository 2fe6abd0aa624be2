// `polder explain`: what a case needs and what it skips, its size, its step limit, and how long it would
// take.
#include <chrono>
#include <cmath>
#include <ostream>

#include "app/case.hpp"
#include "app/check_scene.hpp"
#include "app/commands.hpp"
#include "app/digits.hpp"
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
      << name_of(f.pressure,
                 {{PressureMethod::projected,
                   "projected: stiff water and low conductivity do not limit the step"},
                  {PressureMethod::compressible, "from the bulk modulus: the water wave limits the step"}})
      << '\n';
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

// Seconds of wall clock for one step, from a short trial of the first stage.
double trial(Simulation& simulation) {
  constexpr double kPatience = 1.0;  // [s]
  constexpr int kWarmUp = 2, kMost = 200;
  const auto now = [] { return std::chrono::steady_clock::now(); };
  const auto seconds = [](auto duration) { return std::chrono::duration<double>(duration).count(); };
  for (int i = 0; i < kWarmUp && !simulation.finished(); ++i) simulation.step();
  const auto start = now();
  int steps = 0;
  while (steps < kMost && !simulation.finished() && seconds(now() - start) < kPatience) {
    simulation.step();
    ++steps;
  }
  return steps > 0 ? seconds(now() - start) / steps : 0;
}

}  // namespace

int explain_command(const Arguments& a, std::ostream& out, std::ostream&) {
  const Scene scene = read_case(a.words.front(), a.all("--set"));
  set_threads(choose_threads(a.integer("--threads", 1, kMostThreads).value_or(0), scene));
  Simulation simulation(scene);
  const coupling::StepLimit limit = simulation.step_limit();
  const double step = scene.numerics.time_step.value_or(simulation.automatic_step());

  out << "case          " << a.words.front() << (scene.title.empty() ? "" : ": " + scene.title) << '\n';
  explain_formulation(scene, out);
  out << "space         "
      << name_of(scene.grid.space, {{Space::plane_strain, "plane strain"},
                                    {Space::axisymmetric, "axisymmetric"},
                                    {Space::three_d, "3D"}})
      << ", cells of " << format_number(scene.grid.cell) << " m\n";
  out << "particles     " << simulation.particles() << " in " << scene.bodies.size()
      << (scene.bodies.size() == 1 ? " body\n" : " bodies\n");
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
  if (step > limit.dt) out << "warning       the step is beyond the limit of stability\n";
  out << "stages\n";
  double steps = 0;
  for (const coupling::Stage& s : scene.stages) {
    const double n = s.moves() ? std::ceil(s.duration / step) : 0;
    steps += n;
    out << "  " << s.name << ": " << stage_text(s, n) << '\n';
  }
  out << "off\n";
  for (const std::string& s : simulation.skipped()) out << "  " << s << '\n';
  for (const std::string& n : notes(scene)) out << "  " << n << '\n';
  if (steps == 0) {
    out << "run time      not known before: the water's steps follow its iterations\n";
    return static_cast<int>(ExitCode::done);
  }
  // Last, because it changes the state.
  const double seconds = trial(simulation);
  out << "run time      about " << duration_text(seconds * steps) << " for " << digits(steps, 3)
      << " steps of motion with " << threads() << (threads() == 1 ? " thread" : " threads")
      << ", from a trial of " << digits(seconds * 1e3, 2) << " ms a step, without output\n";
  return static_cast<int>(ExitCode::done);
}

}  // namespace polder::app
