#include "app/expectations.hpp"

#include <algorithm>
#include <cmath>

#include "app/digits.hpp"
#include "app/measured.hpp"
#include "core/error.hpp"
#include "core/units.hpp"

namespace polder::app {
namespace {

using coupling::Expectation;
using coupling::Measure;

double error_of_number(double number, double reference) {
  return std::abs(number - reference) / (reference != 0 ? std::abs(reference) : 1.0);
}

bool compares_curves(const Expectation& e) {
  return !e.reference.empty() && (e.norm == "l2" || e.norm == "max");
}

std::string bounds_text(const Expectation& e) {
  if (!e.at_most) return ">= " + format_number(*e.at_least);
  if (!e.at_least) return "<= " + format_number(*e.at_most);
  return format_number(*e.at_least) + " .. " + format_number(*e.at_most);
}

void compare(const Expectation& e, const Measure& m, const Curve& measured,
             const std::filesystem::path& case_folder, ExpectationResult& r) {
  const bool profile = m.is_profile();
  if (!compares_curves(e)) r.measured = number_of(e.norm, measured, profile);
  if (e.has_bounds()) {
    r.expected = bounds_text(e);
    if (!std::isnan(r.measured))
      r.error = std::max(
          {0.0, e.at_least ? *e.at_least - r.measured : 0.0, e.at_most ? r.measured - *e.at_most : 0.0});
    return;
  }
  if (e.value) {
    r.expected = format_number(*e.value);
    r.error = error_of_number(r.measured, *e.value);
    return;
  }
  Curve reference = read_reference(CsvTable(case_folder / e.reference), e.column, profile);
  if (e.time && !profile) reference = cut(reference, *e.time);
  if (reference.value.empty()) return;
  if (compares_curves(e)) {
    r.expected = std::filesystem::path(e.reference).filename().string();
    r.error = profile ? profile_error(e.norm, measured, reference)
                      : curve_error(e.norm, measured.x, measured.value, reference.x, reference.value);
    return;
  }
  const double expected = number_of(e.norm, reference, profile);
  r.expected = digits(expected, 5);
  r.error = error_of_number(r.measured, expected);
}

}  // namespace

std::vector<ExpectationResult> compare_with_expectations(const coupling::Simulation& simulation,
                                                         const RunFolder& folder,
                                                         const std::filesystem::path& case_folder) {
  const coupling::Scene& scene = simulation.scene();
  std::vector<ExpectationResult> results;
  for (const Expectation& e : scene.expectations) {
    ExpectationResult r;
    r.measure = e.measure, r.norm = e.norm, r.tolerance = e.tolerance.value_or(0);
    const auto measure = std::find_if(scene.measures.begin(), scene.measures.end(),
                                      [&](const Measure& m) { return m.name == e.measure; });
    const bool at = measure->is_profile() || e.norm == "last";
    if (e.time) r.when = (at ? "at " : "to ") + format_number(*e.time) + " s";
    double start = 0;
    for (const coupling::StageReport& s : simulation.stages()) {
      if (s.name == e.from_stage) break;
      if (!e.from_stage.empty()) start += s.time;
    }
    try {
      const double end = e.time ? start + *e.time : simulation.time();
      compare(e, *measure, read_measure(*measure, folder, start, end), case_folder, r);
      if (e.time && end > simulation.time() * (1 + 1e-9))
        r.error = std::nan(""), r.problem = "the run ends before";
      else if (std::isnan(r.error))
        r.problem = measure->is_profile()
                        ? "the profile has no number for it, or lies outside the reference"
                        : "the measure has no number for it, or the run ends before the reference";
    } catch (const InputError& problem) {
      r.problem = problem.what();
    }
    r.pass = r.error <= r.tolerance;
    results.push_back(std::move(r));
  }
  return results;
}

std::string describe(const ExpectationResult& r) {
  std::string text = r.measure + " (" + r.norm + (r.when.empty() ? "" : ", " + r.when) + "): ";
  if (!std::isnan(r.measured)) text += digits(r.measured, 5) + ", expected " + r.expected + ", ";
  if (!r.problem.empty()) return text + r.problem;
  if (r.tolerance == 0) return text + (r.pass ? "within" : "beyond by " + digits(r.error, 3));
  return text + "error " + digits(r.error, 3) + ", tolerance " + format_number(r.tolerance);
}

}  // namespace polder::app
