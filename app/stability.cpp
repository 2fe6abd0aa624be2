#include "app/stability.hpp"

#include <chrono>
#include <cmath>
#include <filesystem>
#include <iomanip>
#include <optional>
#include <ostream>
#include <sstream>

#include "app/case.hpp"
#include "app/checkpoint_state.hpp"
#include "app/commands.hpp"
#include "app/digits.hpp"
#include "app/frames.hpp"
#include "app/interrupt.hpp"
#include "app/nearest.hpp"
#include "app/size_estimate.hpp"
#include "app/slip_surface.hpp"
#include "core/error.hpp"
#include "core/threads.hpp"
#include "coupling/memory_state.hpp"
#include "coupling/strength_reduction.hpp"
#include "io/atomic_file.hpp"
#include "io/csv.hpp"
#include "io/json.hpp"
#include "io/log.hpp"
#include "io/vtkhdf.hpp"

namespace polder::app {
namespace {

namespace fs = std::filesystem;
using coupling::Scene;
using coupling::Simulation;
using coupling::StabilityResult;
using coupling::StabilityTrial;
using coupling::Stage;

// How far beyond failure the mechanism is shown: far enough for its motion to outgrow the elastic one.
constexpr double kBeyond = 1.05;

struct Interrupted {};

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// What a word of the command line means: a case, or the folder of a run with its checkpoint.
struct Source {
  fs::path case_file;
  std::optional<fs::path> checkpoint;
  fs::path folder;  // of the results, unless another is given
};

Source source_of(const Arguments& a) {
  const fs::path word = a.words.front();
  std::error_code none;
  if (!fs::is_directory(word, none))
    return {word, std::nullopt, fs::path("results") / (word.stem().string() + "-stability")};
  if (!fs::exists(word / "checkpoint.h5", none))
    throw InputError("polder stability: " + word.string() +
                     ": holds no checkpoint.h5; allowed: a case file, or the folder of a run");
  for (const char* option : {"--at", "--stage", "--set"})
    if (a.has(option))
      throw InputError(std::string("polder stability: ") + option +
                       ": the folder's checkpoint is taken as it is; allowed: with a case file");
  return {word / "case.toml", word / "checkpoint.h5", word / "stability"};
}

void check_interrupt() {
  if (InterruptGuard::requested()) throw Interrupted{};
}

// Runs the case up to the moment asked for; without one, through the equilibrium stages it begins with.
void go_to_moment(Simulation& simulation, const Arguments& a) {
  const Scene& scene = simulation.scene();
  const std::optional<double> at = a.time("--at");
  const std::optional<std::string> stage = a.value("--stage");
  if (at && stage)
    throw InputError("polder stability: --at and --stage contradict each other; allowed: one of them");
  std::size_t stages = 0;  // to be completed
  if (stage) {
    std::vector<std::string> names;
    for (const Stage& s : scene.stages) names.push_back(s.name);
    const auto found = std::find(names.begin(), names.end(), *stage);
    if (found == names.end())
      throw InputError("polder stability: --stage " + *stage + ": the case has no such stage" +
                       did_you_mean(*stage, names) + "; allowed: " + join(names));
    stages = static_cast<std::size_t>(found - names.begin()) + 1;
  } else if (!at) {
    while (stages < scene.stages.size() && scene.stages[stages].mode == Stage::Mode::equilibrium) ++stages;
  }
  while (!simulation.finished() &&
         (at ? simulation.time() < *at : static_cast<std::size_t>(simulation.stage()) < stages)) {
    simulation.step();
    check_interrupt();
  }
  if (at && simulation.time() < *at)
    throw InputError("polder stability: --at " + *a.value("--at") + ": the case ends at " +
                     digits(simulation.time(), 6) + " s; allowed: up to that time");
}

void print_heading(std::ostream& out) {
  out << "    factor  verdict       steps  force ratio  displacement [m]\n" << std::flush;
}

const char* verdict(const StabilityTrial& t) {
  return t.stands ? "stands" : t.runs_away ? "runs away" : "no balance";
}

void print(const StabilityTrial& t, std::ostream& out) {
  std::ostringstream line;
  line << std::fixed << std::setprecision(4) << std::setw(10) << t.factor << "  " << std::left
       << std::setw(12) << verdict(t) << std::right << std::setw(7) << t.steps << "  " << std::setw(11)
       << digits(t.force_ratio, 3) << "  " << std::setw(16) << digits(t.largest_displacement, 3) << '\n';
  out << line.str() << std::flush;
}

// What the mechanism's frame shows: motion and strain since the start of the trial, with the soil's own
// stiffness.
struct Mechanism {
  StabilityTrial trial;
  coupling::PointFrame points;  // displacement, deviatoric_strain, effective_stress, volume
  SlipSurface slip;
};

Mechanism find_mechanism(Simulation& simulation, const coupling::StabilityOptions& options, double factor) {
  using coupling::kStiffening;
  coupling::MemoryState state;
  state.save(simulation);
  const std::vector<double> before = simulation.points({"deviatoric_strain"}).fields.front().values;
  Mechanism m;
  m.trial = simulation.try_reduced_strength(factor, options);
  m.points = simulation.points({"displacement", "deviatoric_strain", "effective_stress", "volume"});
  state.load(simulation);
  std::vector<double>& motion = m.points.fields[0].values;
  std::vector<double>& strain = m.points.fields[1].values;
  std::vector<double> magnitude(m.points.count());
  for (std::size_t p = 0; p < magnitude.size(); ++p) {
    for (int d = 0; d < 3; ++d) motion[3 * p + d] *= kStiffening;
    magnitude[p] = std::hypot(motion[3 * p], motion[3 * p + 1], motion[3 * p + 2]);
    strain[p] = (strain[p] - before[p]) * kStiffening;
  }
  if (simulation.scene().dimension() == 2) {
    std::vector<double> area = m.points.fields[3].values;
    if (simulation.scene().grid.space == Space::axisymmetric)
      for (std::size_t p = 0; p < area.size(); ++p) area[p] /= m.points.positions[3 * p];
    m.slip = find_slip_surface(m.points.positions, magnitude, area, simulation.scene().grid.cell);
  }
  return m;
}

void write_trials(const fs::path& path, const StabilityResult& result) {
  CsvWriter table(
      path, {"factor[-]", "stands", "steps", "force_ratio[-]", "displacement[m]", "largest_displacement[m]"},
      CsvWriter::Mode::fresh);
  for (const StabilityTrial& t : result.trials)
    table.row({t.factor, static_cast<std::int64_t>(t.stands), static_cast<std::int64_t>(t.steps),
               t.force_ratio, t.displacement, t.largest_displacement});
}

void write_mechanism(const fs::path& folder, const Mechanism& m, double time) {
  Frame frame;
  frame.time = time;
  frame.points = m.points.positions;
  for (const coupling::FieldView& f : m.points.fields)
    frame.point_data.push_back({f.name, f.components, std::span<const double>(f.values)});
  FrameSeries(folder, "soil").write(frame);
  if (m.slip.line.empty()) return;
  CsvWriter table(folder / "slip_surface.csv", {"x[m]", "y[m]"}, CsvWriter::Mode::fresh);
  for (const auto& x : m.slip.line) table.row({x[0], x[1]});
}

Json json_of(const StabilityTrial& t) {
  Json j = Json::object();
  j["factor"] = t.factor;
  j["verdict"] = verdict(t);
  j["steps"] = t.steps;
  j["force_ratio"] = t.force_ratio;
  j["displacement"] = t.displacement;
  j["largest_displacement"] = t.largest_displacement;
  return j;
}

// null where no bracket was found.
Json factor_of(const StabilityResult& r) {
  return r.stands > 0 && std::isfinite(r.fails) ? Json(r.factor()) : Json();
}

void write_json(const fs::path& path, const Source& source, const Simulation& s,
                const StabilityResult& result, const std::optional<Mechanism>& mechanism, double wall) {
  Json root = Json::object();
  root["case"] = source.case_file.string();
  root["title"] = s.scene().title;
  root["time"] = s.time();
  root["factor_of_safety"] = factor_of(result);
  Json bracket = Json::object();
  bracket["stands"] = result.stands > 0 ? Json(result.stands) : Json();
  bracket["fails"] = result.fails;  // null if none did
  root["bracket"] = bracket;
  Json trials = Json::array();
  for (const StabilityTrial& t : result.trials) trials.push_back(json_of(t));
  root["trials"] = trials;
  if (mechanism) {
    Json m = json_of(mechanism->trial);
    if (!mechanism->slip.line.empty()) {
      m["moving_area"] = mechanism->slip.area;
      m["entry"] = Json::array_of(mechanism->slip.line.front());
      m["exit"] = Json::array_of(mechanism->slip.line.back());
    }
    root["mechanism"] = m;
  }
  root["particles"] = s.particles();
  root["wall_seconds"] = wall;
  write_file_atomically(path, root.text());
}

int search(const Arguments& a, std::ostream& out) {
  const auto start = std::chrono::steady_clock::now();
  const Source source = source_of(a);
  const Scene scene = read_case(source.case_file.string(), a.all("--set"));
  set_threads(choose_threads(a.integer("--threads", 1, kMostThreads).value_or(0), scene));
  Simulation simulation(scene);
  const RunFolder folder(a.value("--output").value_or(source.folder.string()),
                         a.has("--overwrite") ? RunFolder::Mode::overwrite : RunFolder::Mode::fresh);
  if (source.checkpoint) {
    const CheckpointReader reader(*source.checkpoint);
    CheckpointVisitor visitor(reader);
    simulation.visit(visitor);
  } else {
    go_to_moment(simulation, a);
  }
  write_file_atomically(folder.case_file(), write_case(scene));
  out << source.case_file.string() << (scene.title.empty() ? "" : ": " + scene.title) << "\n"
      << simulation.particles() << " particles, at " << digits(simulation.time(), 6) << " s\n\n";
  print_heading(out);
  const coupling::StabilityOptions options;
  const StabilityResult result = find_factor_of_safety(simulation, options, [&](const StabilityTrial& t) {
    print(t, out);
    check_interrupt();
    return true;
  });
  std::optional<Mechanism> mechanism;
  if (std::isfinite(result.fails)) {
    mechanism = find_mechanism(simulation, options, kBeyond * result.fails);
    write_mechanism(folder.path(), *mechanism, simulation.time());
  }
  write_trials(folder.path() / "trials.csv", result);
  const double wall = seconds_since(start);
  write_json(folder.path() / "stability.json", source, simulation, result, mechanism, wall);
  out << '\n';
  if (!std::isfinite(result.fails))
    out << "no factor up to " << digits(result.stands, 4) << " makes the soil fail\n";
  else if (!(result.stands > 0))
    out << "the soil fails even with its strength multiplied by " << digits(1 / result.fails, 4) << '\n';
  else
    out << "factor of safety " << digits(result.factor(), 4) << ", stands at " << digits(result.stands, 4)
        << ", fails at " << digits(result.fails, 4) << '\n';
  if (mechanism && !mechanism->slip.line.empty()) {
    const auto& line = mechanism->slip.line;
    out << "slip surface from (" << digits(line.front()[0], 3) << ", " << digits(line.front()[1], 3)
        << ") to (" << digits(line.back()[0], 3) << ", " << digits(line.back()[1], 3) << ") m, moving mass "
        << digits(mechanism->slip.area, 3) << " m2\n";
  }
  out << folder.path().string() << ", " << duration_text(wall) << '\n';
  return static_cast<int>(ExitCode::done);
}

int stability(const Arguments& a, std::ostream& out, std::ostream& err) {
  const InterruptGuard guard;
  try {
    return search(a, out);
  } catch (const Interrupted&) {
    err << "polder stability: interrupted\n";
    return static_cast<int>(ExitCode::interrupted);
  }
}

}  // namespace

Command stability_command() {
  return {"stability",
          "CASE",
          1,
          1,
          "Factor of safety by strength reduction, and the slip surface. CASE: a case file, or the folder of "
          "a run, "
          "whose checkpoint is taken.",
          {{"--at", "", "T", "Moment of the run, e.g. 12.5 or \"2 h\".", false},
           {"--stage", "", "NAME",
            "The end of this stage. Without --at and --stage: the end of the equilibrium stages that the "
            "case begins "
            "with, or its start.",
            false},
           {"--output", "-o", "DIR",
            "Folder of the results, default results/NAME-stability, or DIR/stability.", false},
           {"--set", "", "KEY=VALUE",
            "Replace a key of the case, e.g. --set grid.cell=0.05; KEY= removes it.", true},
           {"--threads", "", "N", "Number of threads; the results do not depend on it.", false},
           {"--overwrite", "", "", "Replace results that are in the folder.", false}},
          stability};
}

}  // namespace polder::app
