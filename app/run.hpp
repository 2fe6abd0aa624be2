// Running a case: from its file to a folder of results.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "app/expectations.hpp"
#include "core/error.hpp"
#include "coupling/simulation.hpp"
#include "io/log.hpp"
#include "io/run_folder.hpp"

namespace polder::app {

struct RunOptions {
  std::string case_file;
  std::vector<std::string> settings;  // "key=value"
  std::filesystem::path folder;       // of the results
  bool overwrite = false, restart = false, quiet = false;
  bool progress_only = false;        // on the terminal; the log has everything
  int threads = 0;                   // 0: see choose_threads()
  std::optional<double> until;       // simulated time [s] at which to stop
  std::vector<std::string> remarks;  // told in the log before the run
  // Called when all stages are done, after the other results have been written.
  std::function<void(const coupling::Simulation&, const RunFolder&, Log&)> at_end;
};

struct RunOutcome {
  ExitCode code = ExitCode::done;
  double wall_seconds = 0;
  std::vector<ExpectationResult> expectations;  // of a completed run
};

// Throws InputError and EnvironmentError before anything has been computed; what happens later is in the
// outcome, the log and summary.json.
RunOutcome run_case(const RunOptions& options);

// The same for a scene that has been read from the options' case and changed; their settings are not applied.
RunOutcome run_scene(const RunOptions& options, coupling::Scene scene);

// The text of case.toml in the folder of a run: the scene with every default, its references beside it.
std::string resolved_case(const coupling::Scene& scene);

// Throws EnvironmentError if the machine has less memory than the scene needs.
void check_memory(const coupling::Scene& scene);

// Where the results of a case go unless the user says otherwise: results/NAME.
std::filesystem::path default_folder(const std::string& case_file);

}  // namespace polder::app
