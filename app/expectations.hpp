// Comparison of a run's measures with what its case expects.
#pragma once

#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "coupling/simulation.hpp"
#include "io/run_folder.hpp"

namespace polder::app {

struct ExpectationResult {
  std::string measure, norm;
  std::string when;  // "at 0.5 s", "to 0.5 s"; empty: at the end, over the whole run
  double measured = std::numeric_limits<double>::quiet_NaN();  // NaN: a curve, no number
  std::string expected;                                        // as text: a number, bounds, a file
  // Relative where the reference is not 0, absolute otherwise; beyond a bound. NaN: could not be compared.
  double error = std::numeric_limits<double>::quiet_NaN();
  double tolerance = 0;
  bool pass = false;
  std::string problem;  // why it could not be compared
};

// Reads the tables of the finished run. case_folder: where references are looked for.
std::vector<ExpectationResult> compare_with_expectations(const coupling::Simulation& simulation,
                                                         const RunFolder& folder,
                                                         const std::filesystem::path& case_folder);

// "drop (l2, at 0.5 s): error 0.0031, tolerance 0.01" for logs.
std::string describe(const ExpectationResult& result);

}  // namespace polder::app
