#include "bench/case_trial.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "app/case.hpp"
#include "app/expectations.hpp"
#include "app/measured.hpp"
#include "app/profiles.hpp"
#include "app/run.hpp"
#include "app/tables.hpp"
#include "app/version.hpp"
#include "bench/measure.hpp"
#include "core/error.hpp"
#include "core/threads.hpp"
#include "coupling/simulation.hpp"
#include "io/run_folder.hpp"

namespace polder::bench {
namespace {

namespace fs = std::filesystem;
using coupling::Scene;
using coupling::Simulation;

// A run with its tables, timed step by step.
class TimedRun {
 public:
  TimedRun(const Scene& scene, const Place& place)
      : folder_(place.output / "run", RunFolder::Mode::overwrite), simulation_(scene) {
    app::Tables tables(simulation_, folder_, CsvWriter::Mode::fresh);
    app::Profiles profiles(simulation_, folder_, CsvWriter::Mode::fresh);
    tables.see(simulation_), profiles.see(simulation_);
    while (!simulation_.finished()) {
      const double before = processor_clock();
      simulation_.step();
      seconds_ += processor_clock() - before;
      tables.see(simulation_), profiles.see(simulation_);
    }
    tables.finish(simulation_), profiles.finish(simulation_);
  }
  const Simulation& simulation() const { return simulation_; }
  const RunFolder& folder() const { return folder_; }
  double seconds() const { return seconds_; }
  double start_of(const std::string& stage) const {
    double start = 0;
    if (stage.empty()) return start;
    for (const coupling::StageReport& s : simulation_.stages()) {
      if (s.name == stage) return start;
      start += s.time;
    }
    throw std::runtime_error("the case has no stage " + stage);
  }

 private:
  RunFolder folder_;
  Simulation simulation_;
  double seconds_ = 0;
};

std::vector<double> errors_of(const TimedRun& run, const fs::path& case_folder) {
  std::vector<double> errors;
  for (const app::ExpectationResult& r :
       app::compare_with_expectations(run.simulation(), run.folder(), case_folder)) {
    if (!r.problem.empty()) throw std::runtime_error(r.measure + ": " + r.problem);
    errors.push_back(r.error);
  }
  if (errors.empty()) throw std::runtime_error("nothing to compare with");
  return errors;
}

std::string with_commit(const Scene& scene) {
  return std::string("# commit ") + app::kCommit + "\n" + app::write_case(scene);
}

bool holds(const fs::path& file, const std::string& text) {
  std::ifstream in(file);
  std::stringstream there;
  there << in.rdbuf();
  return in && there.str() == text;
}

const coupling::Measure& measure_of(const Scene& scene, const std::string& name) {
  for (const coupling::Measure& m : scene.measures)
    if (m.name == name) return m;
  throw std::runtime_error("the case has no measure " + name);
}

void write_curve(const app::Curve& curve, const std::string& what, const fs::path& file) {
  std::ofstream out(file);
  out.precision(12);
  out << "# " << what << "\ntime[s],value\n";
  for (std::size_t i = 0; i < curve.x.size(); ++i) out << curve.x[i] << "," << curve.value[i] << "\n";
  if (!out) throw EnvironmentError("cannot write " + file.string());
}

}  // namespace

fs::path CaseVariant::path() const {
  return fs::path(POLDER_SOURCE_DIR) / "cases" / file;
}

Scene CaseVariant::scene() const {
  Scene scene = app::read_case(path().string(), settings);
  std::erase_if(scene.expectations, [](const coupling::Expectation& e) { return e.has_bounds(); });
  if (change) change(scene);
  return scene;
}

Outcome run_trial(const CaseVariant& variant, const Place& place) {
  const Scene scene = variant.scene();
  return in_own_process(place, scene.expectations.size(), [&] {
    const TimedRun run(scene, place);
    return Outcome{errors_of(run, variant.path().parent_path()), run.seconds(),
                   static_cast<double>(run.simulation().steps()),
                   static_cast<double>(run.simulation().particles())};
  });
}

FineSolution::FineSolution(std::string name, CaseVariant variant, std::vector<std::string> measures,
                           std::string from_stage, Place place)
    : name_(std::move(name)),
      variant_(std::move(variant)),
      measures_(std::move(measures)),
      from_stage_(std::move(from_stage)),
      place_(std::move(place)) {}

fs::path FineSolution::file(const std::string& measure) const {
  return fs::absolute(place_.output) / "fine" / (name_ + "_" + measure + ".csv");
}

void FineSolution::compute() const {
  const Scene scene = variant_.scene();
  const fs::path made_from = file("case").replace_extension(".toml");
  const std::string text = with_commit(scene);
  if (holds(made_from, text)) return;
  fs::create_directories(made_from.parent_path());
  fs::remove(made_from);  // an interrupted run must not pass for a complete one
  std::fprintf(stderr, "%s: fine solution with cells of %g m\n", name_.c_str(), scene.grid.cell);
  in_child([&] {
    set_threads(place_.threads);
    const TimedRun run(scene, place_);
    const double start = run.start_of(from_stage_);
    for (const std::string& name : measures_)
      write_curve(app::read_measure(measure_of(scene, name), run.folder(), start, run.simulation().time()),
                  name_ + ", " + name + ", cells of " + std::to_string(scene.grid.cell) + " m", file(name));
    return std::vector<double>{run.seconds()};
  });
  std::ofstream(made_from) << text;
}

void FineSolution::expect(Scene& scene) const {
  scene.expectations.clear();
  for (const std::string& name : measures_) {
    measure_of(scene, name);
    coupling::Expectation e;
    e.measure = name;
    e.reference = file(name).string();
    e.norm = "l2";
    e.from_stage = from_stage_;
    scene.expectations.push_back(e);
  }
}

}  // namespace polder::bench
