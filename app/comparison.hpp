// Runs of one case beside each other: what each measured, how far variants (formulations) differ, and how
// much of that is the error of their cells and steps (curve_family.hpp).
//
// Compared are all measures (run_traces.hpp) but errors and noise, and some columns of the history without
// being asked. Differences are given as shares of the range of the quantity in the finest runs; those of a
// factor of safety, one number, as shares of the largest.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "app/curve_family.hpp"
#include "app/run_record.hpp"

namespace polder::app {

struct ComparedRun {
  std::string variant, label;
  RunRecord run;        // without a folder where nothing could be read
  std::string failure;  // why it is not complete; empty: it is
  bool reused = false;  // made earlier
  double start = 0;     // of the times compared [s]
  double cell() const { return run.scene.grid.cell; }
  double step() const { return run.scene.numerics.time_step.value_or(run.scene.numerics.courant); }
  bool has_results() const { return !run.folder.empty(); }
};

// Shares of the scale. `run`: whose error it is, the finest of the variant.
struct DiscretisationError {
  std::size_t run = 0;
  FamilyError cells, steps;
  bool known() const { return cells.known() || steps.known(); }
  double l2() const;  // of cells and steps together
  double max() const;
};

enum class Verdict {
  unknown,   // no family tells the discretisation error of one of them
  alike,     // the difference is within the sum of both errors
  at_times,  // only its largest value is beyond
  differ     // beyond in the mean over time
};
const char* verdict_text(Verdict verdict);

struct VariantDifference {
  std::size_t first = 0, second = 0;   // runs
  CurveDifference difference;          // shares of the scale
  double error_l2 = 0, error_max = 0;  // sum of both discretisation errors, NaN: not known
  // The same in every size of cells that both have, from coarse to fine: a difference of the formulations
  // stays as the cells shrink, even where each has a larger error that both share.
  std::vector<double> by_cell, l2_by_cell;
  Verdict verdict = Verdict::unknown;
};

struct ComparedMeasure {
  coupling::Measure measure;
  std::string unit;
  std::vector<double> times;  // of a profile, since the start of the times compared [s]
  bool asked = true;          // a [[measure]] of the case
  Extremes extremes;          // of the finest runs
  double scale = 0;           // of differences: the range; of a single number its magnitude
  std::vector<double> last;   // of every run; NaN: it has none
  // Of one variant each, and of pairs of them; empty where the quantity is constant.
  std::vector<DiscretisationError> errors;
  std::vector<VariantDifference> differences;
};

struct Comparison {
  std::string case_file, title;
  std::vector<ComparedRun> runs;
  std::vector<std::string> variants;  // in the order of the runs
  std::vector<ComparedMeasure> measures;
};

// The order of a family: by cells, then by steps.
bool is_coarser(const coupling::Scene& a, const coupling::Scene& b);

// "one-layer, cell 0.1 m, courant 0.5": with cells or steps where these tell runs apart.
std::string run_label(const std::string& variant, const coupling::Scene& scene, bool cells, bool steps);

// Fills in starts, variants and measures.
void compare_runs(Comparison& comparison);

}  // namespace polder::app
