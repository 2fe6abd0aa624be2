// summary.json: what a run was and how it went, for scripts. The keys are stable.
#pragma once

#include <string>
#include <vector>

#include "app/expectations.hpp"
#include "coupling/simulation.hpp"
#include "io/json.hpp"
#include "io/run_folder.hpp"

namespace polder::app {

struct RunSummary {
  std::string case_file;
  std::string status;   // "completed", "failed", "interrupted"
  std::string message;  // why it failed
  int threads = 1;
  double wall_seconds = 0, output_seconds = 0;
  // Part of output_seconds that the run waited for the thread that writes frames and checkpoints, and how
  // long that thread worked beside the run [s].
  double waited_for_writer = 0, writer_seconds = 0;
  std::vector<double> stage_wall_seconds;
  std::int64_t first_step = 0;  // of this call; a restarted run has computed others before
  std::vector<ExpectationResult> expectations;
};

void write_summary(const coupling::Simulation& simulation, const RunFolder& folder,
                   const RunSummary& summary);

Json expectation_json(const ExpectationResult& expectation);

// "0.1.0", and how the program was built: "Release, vector level avx2".
std::string program_version();
std::string program_build();
std::string program_commit();  // empty if it was not built from a repository

}  // namespace polder::app
