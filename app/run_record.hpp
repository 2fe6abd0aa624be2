// A run as its folder tells it: the case it computed, summary.json, and what its history says of steps and
// balances. What was measured is read by measured.hpp.
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "app/expectations.hpp"
#include "coupling/scene.hpp"

namespace polder::app {

struct RunRecord {
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

  struct Stage {
    std::string name, mode, ended_by;
    std::int64_t steps = 0;
    double start = 0, time = 0;  // when it began; how long it was [s]
  };
  struct Wall {  // [s], of the last call; a restarted run has computed other steps before
    double mechanics = 0, water = 0, audit = 0, output = 0, total = 0;
    double other() const { return total - mechanics - water - audit - output; }
  };
  // Relative errors: the largest magnitude over the history; NaN where the formulation has none.
  struct Balances {
    double solid_mass = kNone, water_mass = kNone, momentum = kNone;
    double energy = kNone;  // at the end, transfer loss beside all work done
  };

  std::filesystem::path folder;
  coupling::Scene scene;
  std::string case_file, program;  // as the run named it; version, commit and build of what computed it
  std::string status, message;     // "completed", "failed", "interrupted"; why it failed
  std::vector<Stage> stages;
  double time = 0;  // [s], reached
  std::int64_t steps = 0, computed_steps = 0;
  int threads = 1;
  // Steps [s]; the mean is that of the dynamic stages, of all of them where there is none.
  double dt_min = 0, dt_mean = 0, dt_max = 0;
  std::string limited_by, limit_reason;  // what set most steps of the history; the limit at the end, in words
  double limited_share = 0;              // [-], of the history's rows
  Wall wall;
  double particle_steps_per_second = 0, peak_memory = 0;  // peak_memory [bytes]
  std::int64_t solid_particles = 0, water_particles = 0, active_cells = 0, pressure_cells = 0;
  Balances balances;
  double roughness_last = kNone, roughness_largest = kNone;  // of the pore pressure from cell to cell [Pa]
  std::vector<ExpectationResult> expectations;

  bool completed() const { return status == "completed"; }
  // All stages are done: a run that --until stopped completed without.
  bool finished() const;
};

// InputError if the folder is none of a run or cannot be read by this version.
RunRecord read_run(const std::filesystem::path& folder);

}  // namespace polder::app
