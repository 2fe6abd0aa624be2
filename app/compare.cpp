#include "app/compare.hpp"

#include <algorithm>
#include <filesystem>
#include <ostream>

#include "app/commands.hpp"
#include "app/compare_folders.hpp"
#include "app/compare_plan.hpp"
#include "app/compare_report.hpp"
#include "app/comparison.hpp"
#include "app/digits.hpp"
#include "app/interrupt.hpp"
#include "app/run.hpp"
#include "app/run_record.hpp"
#include "core/error.hpp"
#include "io/log.hpp"

namespace polder::app {
namespace {

namespace fs = std::filesystem;
using Action = PlannedRun::Action;

constexpr std::size_t kAnyNumber = 100000;

void require_place_for_comparison(const fs::path& folder) {
  std::error_code failure;
  if (fs::exists(folder / "history.csv", failure))
    throw InputError(folder.string() +
                     ": holds the results of a run; allowed: -o for another folder, which will hold a folder "
                     "for each run");
}

void make_folder(const fs::path& folder) {
  std::error_code failure;
  fs::create_directories(folder, failure);
  if (failure) throw EnvironmentError(folder.string() + ": cannot be created: " + failure.message());
}

// Runs it, or takes what is there. Its exit code; what went wrong is in the record.
ExitCode carry_out(const PlannedRun& plan, const ComparePlan& all, const Arguments& a, ComparedRun& result,
                   std::ostream& err) {
  result.variant = plan.variant, result.label = plan.label;
  if (plan.action == Action::reuse) {
    result.run = read_run(plan.folder);
    result.reused = true;
    err << "  complete in " << plan.folder.string() << '\n' << std::flush;
    return ExitCode::done;
  }
  RunOptions o;
  o.case_file = all.case_file;
  o.folder = plan.folder;
  o.restart = plan.action == Action::go_on;
  o.overwrite = plan.action == Action::again;
  o.quiet = a.has("--quiet");
  o.progress_only = true;
  o.threads = a.integer("--threads", 1, kMostThreads).value_or(0);
  ExitCode code = ExitCode::done;
  try {
    const RunOutcome outcome = run_scene(o, plan.scene);
    code = outcome.code;
    if (code == ExitCode::interrupted) return code;
    result.run = read_run(plan.folder);
    if (code == ExitCode::done) {
      err << "  " << result.run.steps << " steps in " << duration_text(outcome.wall_seconds) << '\n';
    } else {  // the log has told why
      result.failure = result.run.message;
      err << "  FAILED, see " << RunFolder(plan.folder, RunFolder::Mode::read).log().string() << '\n';
    }
  } catch (const InputError& e) {  // what only building the scene finds out
    result.failure = e.what();
    err << "  FAILED: " << e.what() << '\n';
    code = ExitCode::numerical_failure;
  }
  err << std::flush;
  return code;
}

int finish(Comparison& c, const fs::path& folder, ExitCode code, std::ostream& out) {
  compare_runs(c);
  write_comparison(c, folder);
  out << compare_text(c) << '\n' << (folder / "compare.md").string() << '\n';
  return static_cast<int>(code);
}

int compare_case(const Arguments& a, std::ostream& out, std::ostream& err) {
  const fs::path folder = a.value("--output").value_or(default_folder(a.words.front()).string() + "-compare");
  require_place_for_comparison(folder);
  a.integer("--threads", 1, kMostThreads);
  const ComparePlan plan = plan_comparison(a, folder, a.has("--overwrite"));
  make_folder(folder);
  if (!a.has("--quiet"))
    for (const std::string& note : plan.notes) err << note << '\n';
  Comparison c;
  c.case_file = plan.case_file, c.title = plan.runs.front().scene.title;
  ExitCode code = ExitCode::done;
  for (std::size_t i = 0; i < plan.runs.size(); ++i) {
    if (!a.has("--quiet"))
      err << "run " << i + 1 << " of " << plan.runs.size() << ": " << plan.runs[i].label << '\n'
          << std::flush;
    c.runs.emplace_back();
    const ExitCode one = carry_out(plan.runs[i], plan, a, c.runs.back(), err);
    if (one == ExitCode::interrupted) {
      err << "polder compare: interrupted; the same command goes on from here\n";
      return static_cast<int>(one);
    }
    if (one != ExitCode::done && code == ExitCode::done) code = one;
  }
  return finish(c, folder, code, out);
}

// Whether there are two that differ in it.
template <class Size>
bool differs(const std::vector<ComparedRun>& runs, const Size& size) {
  return std::any_of(runs.begin(), runs.end(),
                     [&](const ComparedRun& r) { return size(r) != size(runs.front()); });
}

int compare_folders(const Arguments& a, std::ostream& out) {
  for (const char* option :
       {"--formulation", "--variant", "--cell", "--courant", "--step", "--set", "--threads", "--overwrite"})
    if (a.has(option))
      throw InputError(std::string("polder compare: ") + option +
                       ": runs made earlier are taken as they are; allowed: with a case file");
  const fs::path folder = a.value("--output").value_or("results/compare");
  require_place_for_comparison(folder);
  Comparison c;
  c.runs = read_runs(a.words);
  c.title = c.runs.front().run.scene.title;
  const bool cells = differs(c.runs, [](const ComparedRun&r) { return r.cell(); }),
             steps = differs(c.runs, [](const ComparedRun&r) { return r.step(); });
  for (ComparedRun& r : c.runs) r.label = run_label(r.variant, r.run.scene, cells, steps);
  make_folder(folder);
  return finish(c, folder, ExitCode::done, out);
}

int compare(const Arguments& a, std::ostream& out, std::ostream& err) {
  std::error_code failure;
  if (fs::is_directory(a.words.front(), failure)) return compare_folders(a, out);
  if (a.words.size() > 1)
    throw InputError("polder compare: " + a.words.front() +
                     ": is no folder; allowed: one case file, or the folders of runs");
  return compare_case(a, out, err);
}

}  // namespace

Command compare_command() {
  return {
      "compare",
      "CASE|DIR...",
      1,
      kAnyNumber,
      "Run a case with several formulations, cells or steps, and tell where they differ by more than their "
      "discretisation error. Runs that are complete in the folder already are taken as they are. DIR...: "
      "compare runs made earlier instead; a folder of runs stands for all in it.",
      {{"--formulation", "", "NAME", "A formulation to compare; default: the case's own.", true},
       {"--variant", "", "NAME:KEY=VALUE,...",
        "The case with these settings, under this name, beside the formulations.", true},
       {"--cell", "", "H", "A size of cells; several tell the error of the cells.", true},
       {"--courant", "", "C", "A step as a share of its limit; several tell the error of the steps.", true},
       {"--step", "", "DT", "A fixed step, instead of --courant.", true},
       {"--output", "-o", "DIR",
        "Folder of the comparison, with a folder for each run; default results/NAME-compare, of runs made "
        "earlier results/compare.",
        false},
       {"--set", "", "KEY=VALUE",
        "Replace a key of the case in all runs, e.g. --set stage.1.duration=2; KEY= removes it.", true},
       {"--threads", "", "N", "Number of threads; the results do not depend on it.", false},
       {"--quiet", "", "", "Say nothing but the tables and errors.", false},
       {"--overwrite", "", "", "Run all again and replace results that are in the folder.", false}},
      compare};
}

}  // namespace polder::app
