#include "app/run_traces.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "app/columns.hpp"
#include "app/measured.hpp"
#include "app/profiles.hpp"
#include "app/stability_measures.hpp"
#include "app/tables.hpp"

namespace polder::app {
namespace {

namespace fs = std::filesystem;
using coupling::Measure;

constexpr double kSameTime = 1e-6;   // share of the run, by which times that are sums of steps differ
constexpr double kSamePlace = 1e-9;  // of coordinates, share of their range

bool is_there(const fs::path& file) {
  std::error_code failure;
  return fs::exists(file, failure);
}

// Rows of one time by their coordinate; where several share one, cells beside each other, their mean.
Curve profile(std::vector<std::pair<double, double>> rows) {
  Curve c;
  if (rows.empty()) return c;
  std::sort(rows.begin(), rows.end());
  const double same = kSamePlace * (rows.back().first - rows.front().first);
  for (std::size_t i = 0; i < rows.size();) {
    double sum = 0;
    std::size_t n = i;
    for (; n < rows.size() && rows[n].first <= rows[i].first + same; ++n) sum += rows[n].second;
    c.x.push_back(rows[i].first), c.value.push_back(sum / static_cast<double>(n - i));
    i = n;
  }
  return c;
}

}  // namespace

RunTraces::RunTraces(const RunRecord& run) : run_(&run), folder_(run.folder, RunFolder::Mode::read) {
  history_.emplace(folder_.history(), history_words());
  if (is_there(folder_.probes())) probes_.emplace(folder_.probes());
  for (std::size_t i = 0; i < run.scene.stages.size() && i < run.stages.size(); ++i)
    if (run.scene.stages[i].mode != coupling::Stage::Mode::equilibrium) stages_.push_back(i);
}

double RunTraces::start() const {
  return stages_.empty() ? 0.0 : run_->stages[stages_.front()].start;
}

double RunTraces::same_time() const {
  return kSameTime * (run_->time - start());
}

// The table of histories that may hold it.
const CsvTable* RunTraces::table(const Measure& m) const {
  bool in_history = false;
  measure_column(m, in_history);
  return in_history ? &*history_ : probes_ ? &*probes_ : nullptr;
}

std::string RunTraces::column(const Measure& m) const {
  bool in_history = false;
  const std::string name = measure_column(m, in_history);
  const CsvTable* t = table(m);
  return t ? find_column(t->columns(), name) : std::string();
}

std::optional<double> RunTraces::factor_of_safety(const Measure& m) const {
  if (!is_there(StabilityMeasures::file(folder_, m))) return std::nullopt;
  const Curve found = read_measure(m, folder_, 0, run_->time);
  if (found.value.empty() || !std::isfinite(found.value.back())) return std::nullopt;
  return found.value.back();
}

Trace RunTraces::histories(const Measure& m) const {
  Trace trace;
  if (column(m).empty()) return trace;
  const Curve all = measured_curve(m, *table(m));
  if (stages_.empty() && !all.x.empty()) return {{{0.0}, {all.value.back()}}};  // the equilibrium found
  for (const std::size_t s : stages_) {
    const RunRecord::Stage& stage = run_->stages[s];
    trace.push_back(part(all, stage.start, stage.start + stage.time));
  }
  return trace;
}

std::vector<double> RunTraces::profile_times(const Measure& m) const {
  std::vector<double> times;
  if (!is_there(Profiles::file(folder_, m))) return times;
  const CsvTable table(Profiles::file(folder_, m));
  // A table's times are rounded, the start is not.
  for (const double row : table.column("time[s]"))
    if (const double t = row - start(); t >= -same_time() && (times.empty() || t > times.back()))
      times.push_back(t);
  if (stages_.empty() && !times.empty()) times = {times.back()};
  return times;
}

// Between two times at which it was recorded it is linear in time, as histories are; each run records at
// times of its own, whose search for equilibrium ended when it did.
Trace RunTraces::profiles(const Measure& m, const std::vector<double>& wanted) const {
  const std::vector<double> recorded = profile_times(m);
  if (recorded.empty()) return {};
  const CsvTable table(Profiles::file(folder_, m));
  const auto time = table.column(0), at = table.column(1), value = table.column(2);
  const auto at_record = [&](std::size_t r) {
    std::vector<std::pair<double, double>> rows;
    for (std::size_t i = 0; i < time.size(); ++i)
      if (time[i] - start() == recorded[r]) rows.emplace_back(at[i], value[i]);
    return profile(std::move(rows));
  };
  const double slack = same_time();
  Trace trace;
  for (const double t : wanted) {
    const auto after = static_cast<std::size_t>(
        std::lower_bound(recorded.begin(), recorded.end(), t - slack) - recorded.begin());
    if (stages_.empty()) {  // the equilibrium found, whenever that was
      trace.push_back(at_record(recorded.size() - 1));
    } else if (after < recorded.size() && std::abs(recorded[after] - t) <= slack) {
      trace.push_back(at_record(after));
    } else if (after == 0 || after == recorded.size()) {
      trace.emplace_back();
    } else {
      Curve before = at_record(after - 1);
      const Curve later = at_record(after);
      const double share = (t - recorded[after - 1]) / (recorded[after] - recorded[after - 1]);
      for (std::size_t i = 0; i < before.x.size(); ++i)
        before.value[i] += share * (interpolate(later.x, later.value, before.x[i]) - before.value[i]);
      trace.push_back(std::move(before));
    }
  }
  return trace;
}

Trace RunTraces::trace(const Measure& m, const std::vector<double>& times) const {
  if (m.is_profile()) return profiles(m, times);
  if (m.kind != Measure::Kind::stability) return histories(m);
  const std::optional<double> factor = factor_of_safety(m);
  return factor ? Trace{{{0.0}, {*factor}}} : Trace();
}

Extremes RunTraces::extremes(const Measure& m, const std::vector<double>& times) const {
  Extremes e;
  extend(e, trace(m, times));
  const bool in_tables = !m.is_profile() && m.kind != Measure::Kind::stability && !column(m).empty();
  if (stages_.empty() && in_tables) extend(e, {measured_curve(m, *table(m))});
  return e;
}

double RunTraces::last(const Measure& m) const {
  if (m.is_profile()) return RunRecord::kNone;
  if (m.kind == Measure::Kind::stability) return factor_of_safety(m).value_or(RunRecord::kNone);
  const std::string name = column(m);
  return name.empty() || table(m)->rows() == 0 ? RunRecord::kNone : table(m)->column(name).back();
}

std::string RunTraces::unit(const Measure& m) const {
  if (m.kind == Measure::Kind::stability) return "-";
  std::string name = column(m);
  if (m.is_profile() && is_there(Profiles::file(folder_, m)))
    name = CsvTable(Profiles::file(folder_, m)).columns().at(2);
  const std::size_t open = name.find('[');
  return open == std::string::npos ? "" : name.substr(open + 1, name.size() - open - 2);
}

}  // namespace polder::app
