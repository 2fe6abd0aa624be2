// What `polder compare CASE` is going to run: every formulation or variant with every cell and step asked
// for, each read and checked before the first one starts.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/command_line.hpp"
#include "coupling/scene.hpp"

namespace polder::app {

struct PlannedRun {
  // fresh: nothing is there. reuse: a complete run of the same case. go_on: one that was interrupted or
  // stopped, from its checkpoint. again: one that failed, or is to be replaced.
  enum class Action { fresh, reuse, go_on, again };

  std::string variant;           // the formulation, or the name of a --variant
  std::string label;             // "one-layer, cell 0.1 m": what tells it from the others
  std::filesystem::path folder;  // of its results, made from all of them: "one-layer_cell0.1_courant0.5"
  coupling::Scene scene;
  Action action = Action::fresh;
};

struct ComparePlan {
  std::string case_file;
  std::vector<PlannedRun> runs;    // variants as given, in each from coarse to fine
  std::vector<std::string> notes;  // of the checks, each once
};

// InputError with all that is wrong in any of them. overwrite: results that lie in the folder are replaced.
ComparePlan plan_comparison(const Arguments& arguments, const std::filesystem::path& folder, bool overwrite);

}  // namespace polder::app
