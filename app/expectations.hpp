// Comparison of a run's measures with what its case expects.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "coupling/simulation.hpp"
#include "io/run_folder.hpp"

namespace polder::app {

struct ExpectationResult {
  std::string measure, norm;
  double error = 0;  // relative where the reference is not 0, absolute otherwise; NaN: could not be compared
  double tolerance = 0;
  bool pass = false;
  std::string problem;  // why it could not be compared
};

// Reads the tables of the finished run. case_folder: where references are looked for.
std::vector<ExpectationResult> compare_with_expectations(const coupling::Simulation& simulation,
                                                         const RunFolder& folder,
                                                         const std::filesystem::path& case_folder);

// Error of a curve against a reference at the reference's times, the curve linear between its points.
//   l2:  sqrt(integral (m - r)^2 dt / integral r^2 dt), trapezoidal rule; the denominator is the time where r
//   is 0 max: max |m - r| / max |r|; the denominator is 1 where r is 0
// NaN with fewer than two common times, or if the curve ends before the reference.
double curve_error(const std::string& norm, const std::vector<double>& time, const std::vector<double>& value,
                   const std::vector<double>& reference_time, const std::vector<double>& reference);

}  // namespace polder::app
