#include "app/expectations.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "app/columns.hpp"
#include "app/tables.hpp"
#include "core/error.hpp"
#include "io/csv.hpp"

namespace polder::app {
namespace {

using coupling::Expectation;
using coupling::Measure;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

struct Curve {
  std::vector<double> time, value;
};

double interpolate(const std::vector<double>& x, const std::vector<double>& y, double at) {
  const auto after = std::upper_bound(x.begin(), x.end(), at);
  if (after == x.begin()) return y.front();
  if (after == x.end()) return y.back();
  const auto i = static_cast<std::size_t>(after - x.begin());
  return y[i - 1] + (at - x[i - 1]) / (x[i] - x[i - 1]) * (y[i] - y[i - 1]);
}

// Column of times: the one called so, else the first.
std::string time_column(const CsvTable& table) {
  for (const char* name : {"time", "t"})
    if (const std::string c = find_column(table.columns(), name); !c.empty()) return c;
  return table.columns().front();
}

Curve read_curve(const CsvTable& table, const std::string& time, const std::string& value) {
  const auto t = table.column(time), v = table.column(value);
  return {{t.begin(), t.end()}, {v.begin(), v.end()}};
}

Curve read_measure(const Measure& m, const RunFolder& folder) {
  bool in_history = false;
  const std::string name = measure_column(m, in_history);
  const CsvTable table(in_history ? folder.history() : folder.probes(),
                       in_history ? std::vector<std::string>{"dt_limit"} : std::vector<std::string>{});
  const std::string column = find_column(table.columns(), name);
  if (column.empty()) throw InputError("the run has no column \"" + name + "\"");
  return read_curve(table, "time[s]", column);
}

Curve read_reference(const Expectation& e, const std::filesystem::path& folder) {
  const CsvTable table(folder / e.reference);
  const std::string column =
      e.column.empty() ? table.columns().at(1) : find_column(table.columns(), e.column);
  return read_curve(table, time_column(table), column);
}

// Time counted from the start of a stage; what lies before it goes.
void count_from(Curve& c, double start) {
  const auto first = std::lower_bound(c.time.begin(), c.time.end(), start * (1 - 1e-9)) - c.time.begin();
  c.time.erase(c.time.begin(), c.time.begin() + first);
  c.value.erase(c.value.begin(), c.value.begin() + first);
  for (double& t : c.time) t -= start;
}

double number_of(const std::string& norm, const std::vector<double>& values) {
  if (norm == "largest") return *std::max_element(values.begin(), values.end());
  if (norm == "smallest") return *std::min_element(values.begin(), values.end());
  return values.back();
}

double error_of_number(double number, double reference) {
  return std::abs(number - reference) / (reference != 0 ? std::abs(reference) : 1.0);
}

double error_of(const Expectation& e, const Curve& measured, const std::filesystem::path& folder) {
  if (measured.value.empty()) return kNone;
  if (e.value) return error_of_number(number_of(e.norm, measured.value), *e.value);
  const Curve reference = read_reference(e, folder);
  if (reference.value.empty()) return kNone;
  if (e.norm == "l2" || e.norm == "max")
    return curve_error(e.norm, measured.time, measured.value, reference.time, reference.value);
  return error_of_number(number_of(e.norm, measured.value), number_of(e.norm, reference.value));
}

}  // namespace

double curve_error(const std::string& norm, const std::vector<double>& time, const std::vector<double>& value,
                   const std::vector<double>& reference_time, const std::vector<double>& reference) {
  if (time.empty() || reference_time.size() < 2) return kNone;
  const double span = reference_time.back() - reference_time.front();
  constexpr double kEnds = 0.01;  // share of the reference's duration by which the curve may be shorter
  if (!(span > 0) || time.back() < reference_time.back() - kEnds * span ||
      time.front() > reference_time.front() + kEnds * span)
    return kNone;
  double difference = 0, size = 0;
  const auto miss = [&](std::size_t i) { return interpolate(time, value, reference_time[i]) - reference[i]; };
  if (norm == "max") {
    for (std::size_t i = 0; i < reference.size(); ++i) {
      const double m = std::abs(miss(i));
      if (std::isnan(m)) return kNone;  // std::max would lose it
      difference = std::max(difference, m);
      size = std::max(size, std::abs(reference[i]));
    }
    return difference / (size > 0 ? size : 1.0);
  }
  for (std::size_t i = 1; i < reference.size(); ++i) {
    const double dt = reference_time[i] - reference_time[i - 1];
    difference += dt / 2 * (miss(i - 1) * miss(i - 1) + miss(i) * miss(i));
    size += dt / 2 * (reference[i - 1] * reference[i - 1] + reference[i] * reference[i]);
  }
  return std::sqrt(difference / (size > 0 ? size : span));
}

std::vector<ExpectationResult> compare_with_expectations(const coupling::Simulation& simulation,
                                                         const RunFolder& folder,
                                                         const std::filesystem::path& case_folder) {
  const coupling::Scene& scene = simulation.scene();
  std::vector<ExpectationResult> results;
  for (const Expectation& e : scene.expectations) {
    ExpectationResult r{e.measure, e.norm, kNone, e.tolerance, false, ""};
    const auto measure = std::find_if(scene.measures.begin(), scene.measures.end(),
                                      [&](const Measure& m) { return m.name == e.measure; });
    double start = 0;
    for (const coupling::StageReport& s : simulation.stages()) {
      if (s.name == e.from_stage) break;
      if (!e.from_stage.empty()) start += s.time;
    }
    try {
      Curve curve = read_measure(*measure, folder);
      count_from(curve, start);
      r.error = error_of(e, curve, case_folder);
      if (std::isnan(r.error))
        r.problem = "the measure has no number for it, or the run ends before the reference";
    } catch (const InputError& problem) {
      r.problem = problem.what();
    }
    r.pass = r.error <= e.tolerance;
    results.push_back(std::move(r));
  }
  return results;
}

}  // namespace polder::app
