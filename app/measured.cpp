#include "app/measured.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "app/columns.hpp"
#include "app/profiles.hpp"
#include "app/stability_measures.hpp"
#include "app/tables.hpp"
#include "core/error.hpp"

namespace polder::app {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr double kSlack = 1e-9;  // of times that are sums of steps, relative

Curve read_profile(const coupling::Measure& m, const RunFolder& folder, double start, double end) {
  const CsvTable table(Profiles::file(folder, m));
  const auto time = table.column(0), at = table.column(1), value = table.column(2);
  Curve curve;
  for (std::size_t i = time.size(); i-- > 0;) {
    if (time[i] > end * (1 + kSlack)) continue;
    if (time[i] < start * (1 - kSlack) || (i + 1 < time.size() && !curve.x.empty() && time[i] < time[i + 1]))
      break;
    curve.x.push_back(at[i]), curve.value.push_back(value[i]);
  }
  return curve;
}

}  // namespace

double interpolate(const std::vector<double>& x, const std::vector<double>& y, double at) {
  const auto after = std::upper_bound(x.begin(), x.end(), at);
  if (after == x.begin()) return y.front();
  if (after == x.end()) return y.back();
  const auto i = static_cast<std::size_t>(after - x.begin());
  return y[i - 1] + (at - x[i - 1]) / (x[i] - x[i - 1]) * (y[i] - y[i - 1]);
}

Curve read_measure(const coupling::Measure& m, const RunFolder& folder, double start, double end) {
  if (m.is_profile()) return read_profile(m, folder, start, end);
  if (m.kind == coupling::Measure::Kind::stability) {
    const CsvTable table(StabilityMeasures::file(folder, m));
    const auto time = table.column(0), factor = table.column(1);
    return {{time.begin(), time.end()}, {factor.begin(), factor.end()}};
  }
  bool in_history = false;
  measure_column(m, in_history);
  const CsvTable table(in_history ? folder.history() : folder.probes(),
                       in_history ? history_words() : std::vector<std::string>{});
  return part(measured_curve(m, table), start, end);
}

Curve part(const Curve& all, double start, double end) {
  Curve curve;
  for (std::size_t i = 0; i < all.x.size(); ++i) {
    if (all.x[i] < start * (1 - kSlack) || all.x[i] > end * (1 + kSlack)) continue;
    curve.x.push_back(all.x[i] - start), curve.value.push_back(all.value[i]);
  }
  return curve;
}

std::vector<std::string> history_words() {
  return {"dt_limit"};
}

Curve measured_curve(const coupling::Measure& m, const CsvTable& table) {
  bool in_history = false;
  const std::string name = measure_column(m, in_history), column = find_column(table.columns(), name);
  if (column.empty()) throw InputError("the run has no column \"" + name + "\"");
  const auto time = table.column("time[s]"), value = table.column(column);
  return {{time.begin(), time.end()}, {value.begin(), value.end()}};
}

Curve read_reference(const CsvTable& table, const std::string& wanted, bool profile) {
  std::string x = table.columns().front();
  for (const char* name : {"t", "time"})
    if (const std::string c = find_column(table.columns(), name); !profile && !c.empty()) x = c;
  const std::string column = wanted.empty() ? table.columns().at(1) : find_column(table.columns(), wanted);
  const auto t = table.column(x), v = table.column(column);
  return {{t.begin(), t.end()}, {v.begin(), v.end()}};
}

Curve cut(const Curve& c, double end) {
  if (c.x.empty() || end >= c.x.back()) return c;
  const auto n = std::upper_bound(c.x.begin(), c.x.end(), end) - c.x.begin();
  Curve head{{c.x.begin(), c.x.begin() + n}, {c.value.begin(), c.value.begin() + n}};
  if (n > 0 && head.x.back() < end) {
    head.value.push_back(interpolate(c.x, c.value, end));
    head.x.push_back(end);
  }
  return head;
}

double number_of(const std::string& norm, const Curve& c, bool profile) {
  if (c.value.empty()) return kNone;
  for (const double v : c.value)
    if (std::isnan(v) && norm != "last" && norm != "change") return kNone;  // comparisons would lose it
  if (norm == "largest") return *std::max_element(c.value.begin(), c.value.end());
  if (norm == "smallest") return *std::min_element(c.value.begin(), c.value.end());
  if (norm == "magnitude") {
    double largest = 0;
    for (const double v : c.value) largest = std::max(largest, std::abs(v));
    return largest;
  }
  if (norm == "mean") {
    double sum = 0;
    if (profile || c.value.size() == 1) {
      for (const double v : c.value) sum += v;
      return sum / static_cast<double>(c.value.size());
    }
    for (std::size_t i = 1; i < c.x.size(); ++i)
      sum += 0.5 * (c.value[i - 1] + c.value[i]) * (c.x[i] - c.x[i - 1]);
    return sum / (c.x.back() - c.x.front());
  }
  return norm == "change" ? c.value.back() - c.value.front() : c.value.back();
}

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

double profile_error(const std::string& norm, const Curve& p, const Curve& r) {
  if (p.x.empty() || r.x.size() < 2) return kNone;
  constexpr double kEnds = 0.01;  // share of the reference's extent by which a point may lie outside
  const double span = r.x.back() - r.x.front();
  double difference = 0, size = 0, largest = 0, largest_size = 0;
  for (std::size_t i = 0; i < p.x.size(); ++i) {
    if (!(p.x[i] >= r.x.front() - kEnds * span && p.x[i] <= r.x.back() + kEnds * span)) return kNone;
    const double expected = interpolate(r.x, r.value, p.x[i]), miss = p.value[i] - expected;
    if (std::isnan(miss)) return kNone;
    difference += miss * miss, size += expected * expected;
    largest = std::max(largest, std::abs(miss)), largest_size = std::max(largest_size, std::abs(expected));
  }
  if (norm == "max") return largest / (largest_size > 0 ? largest_size : 1.0);
  return std::sqrt(difference / (size > 0 ? size : static_cast<double>(p.x.size())));
}

}  // namespace polder::app
