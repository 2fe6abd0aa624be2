#include "app/run.hpp"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <memory>

#include "app/case.hpp"
#include "app/check_scene.hpp"
#include "app/checkpoint_state.hpp"
#include "app/digits.hpp"
#include "app/frames.hpp"
#include "app/interrupt.hpp"
#include "app/profiles.hpp"
#include "app/size_estimate.hpp"
#include "app/stability_measures.hpp"
#include "app/summary.hpp"
#include "app/tables.hpp"
#include "core/threads.hpp"
#include "core/units.hpp"
#include "coupling/simulation.hpp"
#include "io/atomic_file.hpp"
#include "io/background_writer.hpp"
#include "io/log.hpp"

namespace polder::app {
namespace {

using coupling::Scene;
using coupling::Simulation;

class Clock {
 public:
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

// One run: the simulation with everything that watches it.
class Run {
 public:
  Run(const RunOptions& options, Scene scene);
  RunOutcome go();

 private:
  void restore();
  void copy_references() const;
  void announce();
  void step();
  bool is_over() const { return simulation_.finished() || simulation_.time() >= until_; }
  void write_checkpoint();
  void finish(RunOutcome& outcome);
  void summarise(const std::string& status, const std::string& message);

  const RunOptions& options_;
  std::string resolved_;
  RunFolder folder_;
  Log log_;
  Clock clock_;
  Simulation simulation_;
  Tables tables_;
  Profiles profiles_;
  StabilityMeasures stability_;
  std::unique_ptr<Frames> frames_;
  BackgroundWriter writer_;  // of frames and checkpoints; gone before the frames
  RunSummary summary_;
  double until_ = 0;
  double next_checkpoint_ = 0;  // wall clock [s]
  std::size_t told_ = 0;        // events that the log has
};

constexpr const char* kReferencePrefix = "reference_";

// What a reference is called in the run's folder, where the resolved case finds it and pictures show it.
std::string reference_name(const Scene& scene, const std::string& reference) {
  int before = 0;  // others of the same name in other folders
  const std::string name = std::filesystem::path(reference).filename().string();
  std::vector<std::string> seen;
  for (const coupling::Expectation& e : scene.expectations) {
    if (e.reference == reference) break;
    if (std::filesystem::path(e.reference).filename() != name ||
        std::find(seen.begin(), seen.end(), e.reference) != seen.end())
      continue;
    seen.push_back(e.reference);
    ++before;
  }
  return (name.starts_with(kReferencePrefix) ? "" : kReferencePrefix) +
         (before > 0 ? std::to_string(before + 1) + "_" : "") + name;
}

Scene with_references_beside(const Scene& scene) {
  Scene resolved = scene;
  for (coupling::Expectation& e : resolved.expectations)
    if (!e.reference.empty()) e.reference = reference_name(scene, e.reference);
  return resolved;
}

RunFolder::Mode folder_mode(const RunOptions& o) {
  return o.restart     ? RunFolder::Mode::restart
         : o.overwrite ? RunFolder::Mode::overwrite
                       : RunFolder::Mode::fresh;
}

Log::Options log_options(const RunOptions& o, const RunFolder& folder) {
  Log::Options log;
  log.file = folder.log();
  log.append = o.restart;
  log.quiet = o.quiet;
  log.progress_only = o.progress_only;
  return log;
}

CsvWriter::Mode table_mode(const RunOptions& o) {
  return o.restart ? CsvWriter::Mode::append : CsvWriter::Mode::fresh;
}

Run::Run(const RunOptions& options, Scene scene)
    : options_(options),
      resolved_(resolved_case(scene)),
      folder_(options.folder, folder_mode(options)),
      log_(log_options(options, folder_)),
      simulation_(scene),
      tables_(simulation_, folder_, table_mode(options)),
      profiles_(simulation_, folder_, table_mode(options)),
      stability_(simulation_, folder_, options.restart) {
  summary_.case_file = options.case_file;
  summary_.threads = threads();
  summary_.stage_wall_seconds.resize(scene.stages.size());
  if (options_.restart) {
    restore();
  } else {
    write_file_atomically(folder_.case_file(), resolved_);
    copy_references();
  }
  if (!frames_) frames_ = std::make_unique<Frames>(simulation_, folder_, std::nullopt, writer_);
  summary_.first_step = simulation_.steps();
  until_ = options.until.value_or(std::numeric_limits<double>::infinity());
  next_checkpoint_ = scene.output.checkpoint_every;
}

// A folder is complete by itself: its case runs again, its pictures show what was expected.
void Run::copy_references() const {
  const std::filesystem::path from = std::filesystem::path(options_.case_file).parent_path();
  for (const coupling::Expectation& e : simulation_.scene().expectations) {
    if (e.reference.empty()) continue;
    std::error_code failure;
    const std::filesystem::path to = folder_.path() / reference_name(simulation_.scene(), e.reference);
    std::filesystem::copy_file(from / e.reference, to, std::filesystem::copy_options::overwrite_existing,
                               failure);
    if (failure) throw EnvironmentError(to.string() + ": cannot be written: " + failure.message());
  }
}

void Run::restore() {
  const CheckpointReader reader(folder_.checkpoint());
  reader.require_case(resolved_);
  CheckpointVisitor visitor(reader);
  simulation_.visit(visitor);
  frames_ = std::make_unique<Frames>(simulation_, folder_, simulation_.time(), writer_);
  tables_.visit(visitor);
  profiles_.visit(visitor);
  frames_->visit(visitor);
  tables_.drop_after(simulation_.time());
  profiles_.drop_after(simulation_.time());
  stability_.drop_after(simulation_.time());
  told_ = simulation_.events().size();
}

void Run::write_checkpoint() {
  // What the checkpoint counts as written must be on the disk before it; frames are, by the order of the
  // jobs.
  tables_.sync();
  profiles_.sync();
  const auto content = std::make_shared<CheckpointWriter>(folder_.checkpoint(), program_version(), resolved_);
  CheckpointVisitor visitor(*content);
  simulation_.visit(visitor);
  tables_.visit(visitor);
  profiles_.visit(visitor);
  frames_->visit(visitor);
  writer_.submit([content] { content->commit(); });
  next_checkpoint_ = clock_.seconds() + simulation_.scene().output.checkpoint_every;
}

void Run::announce() {
  const Scene& scene = simulation_.scene();
  const coupling::StepLimit limit = simulation_.step_limit();
  log_.heading(program_version() + (program_commit().empty() ? "" : " " + program_commit()), program_build(),
               threads());
  log_.line("case         " + options_.case_file + (scene.title.empty() ? "" : ": " + scene.title));
  log_.line("results      " + folder_.path().string());
  log_.line("formulation  " + scene.formulation + ", " +
            coupling::find_formulation(scene.formulation)->source);
  log_.line("size         " + std::to_string(simulation_.particles()) + " particles, " +
            std::to_string(simulation_.cells()) + " cells stored" +
            (simulation_.pressure_cells() > 0 ? ", " + std::to_string(simulation_.pressure_cells()) +
                                                    " with pressure (" + simulation_.pressure_solver() + ")"
                                              : ""));
  log_.line("step limit   " + digits(limit.dt, 4) + " s (" + limit.reason + ")");
  for (const std::string& s : simulation_.skipped()) log_.line("skipped      " + s);
  for (const std::string& remark : options_.remarks) log_.line(remark);
  for (const std::string& note : notes(scene)) log_.warning(note);
  if (const double step = simulation_.step_beyond_limit(); step > 0)
    log_.warning("the step of " + digits(step, 4) + " s (" +
                 (scene.numerics.time_step ? "numerics.time_step" : "numerics.courant") +
                 ") is beyond the limit of stability");
  if (options_.restart)
    log_.line("restarted at " + digits(simulation_.time(), 6) + " s, step " +
              std::to_string(simulation_.steps()));
}

void Run::step() {
  const int stage = simulation_.stage();
  const auto index = static_cast<std::size_t>(stage);
  const double before = clock_.seconds();
  simulation_.step();
  const double computed = clock_.seconds();
  for (; told_ < simulation_.events().size(); ++told_) {
    const coupling::Event& e = simulation_.events()[told_];
    log_.line("stage " + e.stage + " at " + duration_text(e.time) + " (" + digits(e.time, 7) +
              " s): " + e.text());
  }
  tables_.see(simulation_);
  profiles_.see(simulation_);
  frames_->see(simulation_);
  // A stage that fails must not cost the ones before it.
  const bool stage_ended = simulation_.stage() != stage && !simulation_.finished();
  if (computed >= next_checkpoint_ || stage_ended) write_checkpoint();
  writer_.check();
  const double after = clock_.seconds();
  summary_.stage_wall_seconds[index] += after - before;
  summary_.output_seconds += after - computed;

  const coupling::StageReport& report = simulation_.stages()[index];
  if (log_.progress_due()) {
    Progress p;
    p.stage = report.name;
    p.time = report.time;
    p.end = simulation_.scene().stages[index].duration;
    p.step = simulation_.steps();
    p.dt = simulation_.last_step();
    p.dt_limit = simulation_.step_reason();
    p.particles = simulation_.particles();
    log_.progress(p);
  }
  if (simulation_.stage() != stage)
    log_.line("stage " + report.name + ": ended by " + report.ended_by + " after " +
              std::to_string(report.steps) + " steps, " + digits(report.time, 5) + " s; wall " +
              duration_text(summary_.stage_wall_seconds[index]));
}

void Run::summarise(const std::string& status, const std::string& message) {
  summary_.status = status;
  summary_.message = message;
  summary_.wall_seconds = clock_.seconds();
  summary_.waited_for_writer = writer_.waited();
  summary_.writer_seconds = writer_.worked();
  write_summary(simulation_, folder_, summary_);
}

void Run::finish(RunOutcome& outcome) {
  const double before = clock_.seconds();
  tables_.finish(simulation_);
  profiles_.finish(simulation_);
  frames_->finish(simulation_);
  write_checkpoint();
  writer_.flush();
  summary_.output_seconds += clock_.seconds() - before;
  if (simulation_.finished())
    summary_.expectations = compare_with_expectations(
        simulation_, folder_, std::filesystem::path(options_.case_file).parent_path());
  summarise("completed", "");
  for (const ExpectationResult& e : summary_.expectations)
    log_.line("expectation  " + describe(e) + (e.pass ? ": passed" : ": MISSED"));
  outcome.expectations = summary_.expectations;
  if (options_.at_end && simulation_.finished()) options_.at_end(simulation_, folder_, log_);
  const coupling::Timing t = simulation_.timing();
  const double speed = t.total > 0 ? static_cast<double>(simulation_.steps() - summary_.first_step) *
                                         static_cast<double>(simulation_.particles()) / t.total
                                   : 0;
  const coupling::Savings saved = simulation_.savings();
  if (simulation_.scene().numerics.sleep)
    log_.line(
        "asleep       " + count_text(static_cast<double>(saved.skipped_particle_steps)) + " of " +
        count_text(static_cast<double>(simulation_.steps()) * static_cast<double>(simulation_.particles())) +
        " particle-steps were skipped, blocks put to sleep " + std::to_string(saved.blocks_asleep) +
        " times");
  log_.line("done in " + duration_text(summary_.wall_seconds) + ": mechanics " + duration_text(t.mechanics) +
            ", water " + duration_text(t.water) + ", balances " + duration_text(t.audit) + ", output " +
            duration_text(summary_.output_seconds) + " (waiting for the writer " +
            duration_text(summary_.waited_for_writer) + ", which worked " +
            duration_text(summary_.writer_seconds) + "); " + count_text(speed) + " particle-steps/s");
}

RunOutcome Run::go() {
  RunOutcome outcome;
  const InterruptGuard guard;
  announce();
  try {
    if (!options_.restart) {
      tables_.see(simulation_);
      profiles_.see(simulation_);
      frames_->see(simulation_);
    }
    const auto goes_on = [] { return !InterruptGuard::requested(); };
    bool complete = stability_.see(simulation_, goes_on);
    while (complete && !is_over() && goes_on()) {
      step();
      complete = stability_.see(simulation_, goes_on);
    }
    if (complete && is_over()) {
      finish(outcome);
    } else {
      write_checkpoint();
      writer_.flush();
      summarise("interrupted", "");
      log_.line("interrupted at " + digits(simulation_.time(), 6) + " s; --restart goes on from here");
      outcome.code = ExitCode::interrupted;
    }
  } catch (const NumericalError& e) {
    log_.error(e.what());
    try {
      writer_.flush();
    } catch (const EnvironmentError& also) {
      log_.error(also.what());
    }
    std::error_code none;
    log_.error(std::filesystem::exists(folder_.checkpoint(), none)
                   ? "the last checkpoint is " + folder_.checkpoint().string()
                   : "no checkpoint had been written yet");
    tables_.sync();
    profiles_.sync();
    summarise("failed", e.what());
    outcome.code = ExitCode::numerical_failure;
  }
  outcome.wall_seconds = clock_.seconds();
  return outcome;
}

}  // namespace

std::filesystem::path default_folder(const std::string& case_file) {
  return std::filesystem::path("results") / std::filesystem::path(case_file).stem();
}

std::string resolved_case(const Scene& scene) {
  return write_case(with_references_beside(scene));
}

// Better to refuse than to be killed halfway.
void check_memory(const Scene& scene) {
  const double available =
      static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
  const double needed = estimate_size(scene).memory;
  if (needed > available)
    throw EnvironmentError("the case needs about " + digits(needed / 1e9, 2) +
                           " GB of memory, this machine has " + digits(available / 1e9, 2) +
                           " GB; a larger grid.cell needs less");
}

RunOutcome run_case(const RunOptions& options) {
  return run_scene(options, read_case(options.case_file, options.settings));
}

RunOutcome run_scene(const RunOptions& options, Scene scene) {
  check_memory(scene);
  set_threads(choose_threads(options.threads, scene));
  return Run(options, std::move(scene)).go();
}

}  // namespace polder::app
