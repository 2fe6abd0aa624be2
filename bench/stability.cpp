// Maps of where the schemes are stable, noisy or drift, and where they break down: conductivity, stiffness of
// the water, points, porosity, saturation and dilation against the step and against each other.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>

#include "bench/measure.hpp"
#include "bench/stability_maps.hpp"
#include "core/threads.hpp"

using namespace polder;
using namespace polder::bench;

namespace {

const char* const kUsage =
    "bench stability [--only MAP]... [--panel NAME] [--x VALUE] [--y VALUE] [--quick] [--threads N = 1] "
    "[--output DIR = results/bench/stability]\n"
    "  only: these maps (conductivity, bulk-modulus, points, porosity, saturation, dilation); panel, x, y: "
    "of them only\n"
    "  this scheme and these places of the axes; quick: every third place of each axis\n";

std::string brief(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return std::isnan(value) ? "" : text;
}

struct Point {
  double x = 0, y = 0, step = 0;  // step over the chosen one
  Verdict verdict;
};

// One panel, computed.
struct Field {
  std::vector<Point> points;
  // Over the chosen step, for each x; NaN where the map does not vary the step.
  std::vector<double> x, printed, theory;
};

struct Choice {
  std::vector<double> x, y;
};

std::vector<double> chosen(const std::vector<double>& all, const std::string& word, bool quick) {
  std::vector<double> some;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const bool asked =
        word.empty() || std::abs(all[i] - std::strtod(word.c_str(), nullptr)) <= 1e-9 * std::abs(all[i]);
    if (asked && (!quick || i % 3 == 0)) some.push_back(all[i]);
  }
  return some;
}

Field compute(const Map& map, const Panel& panel, const Choice& at) {
  Field f;
  for (const double x : at.x) {
    Specimen column = panel.specimen;
    map.x.apply(column, x);
    f.x.push_back(x);
    double unit = chosen_step(column);
    f.printed.push_back(map.varies_step() ? printed_limit(column) / unit : std::nan(""));
    f.theory.push_back(map.varies_step() ? theoretical_limit(column) / unit : std::nan(""));
    for (const double y : at.y) {
      Specimen s = column;
      if (!map.varies_step()) map.y.apply(s, y), unit = chosen_step(s);
      const double ratio = map.varies_step() ? y : 1.0;
      f.points.push_back({x, y, ratio, probe(s, ratio * unit)});
    }
  }
  return f;
}

// Where a step lies: what the program takes by itself, what it prints as its limit, or beyond.
std::string region(double ratio, double printed) {
  return ratio <= 1 ? "chosen" : ratio <= printed ? "printed" : "beyond";
}

std::string words_of(const Axis& axis, double value) {
  for (std::size_t i = 0; i < axis.words.size(); ++i)
    if (axis.values[i] == value) return axis.words[i];
  return "";
}

void add_rows(ResultTable& table, const Map& map, const Panel& panel, const Field& f, std::size_t rows) {
  for (std::size_t i = 0; i < f.points.size(); ++i) {
    const Point& p = f.points[i];
    const std::size_t column = i / rows;
    const Verdict& v = p.verdict;
    table.add({map.name, panel.name, brief(p.x), brief(p.y), to_string(v.mark()),
               region(p.step, f.printed[column]), brief(v.growth), brief(v.noise), brief(v.water),
               brief(v.gain), brief(f.printed[column]), brief(f.theory[column]), words_of(map.x, p.x),
               words_of(map.y, p.y), map.x.name, map.y.name});
  }
}

std::string range(double low, double high) {
  return low > high ? "-" : brief(low) + " ... " + brief(high);
}

// One line for a panel, and each place inside the chosen or printed step that is not stable as a line of the
// other.
void add_summary(ResultTable& summary, ResultTable& inside, const Map& map, const Panel& panel,
                 const Field& f, std::size_t rows) {
  int count[5] = {}, within_chosen = 0, within_printed = 0;
  double low[2] = {1e300, 1e300}, high[2] = {0, 0};  // first unstable over the printed limit, over theory
  for (std::size_t c = 0; c < f.x.size(); ++c) {
    double first = 0;
    for (std::size_t r = 0; r < rows; ++r) {
      const Point& p = f.points[c * rows + r];
      const Mark mark = p.verdict.mark();
      ++count[static_cast<int>(mark)];
      if (mark >= Mark::grows && first == 0) first = p.step;
      const std::string where = region(p.step, f.printed[c]);
      if (mark == Mark::stable || where == "beyond") continue;
      ++(where == "chosen" ? within_chosen : within_printed);
      inside.add({map.name, panel.name, brief(p.x), brief(p.y), where, to_string(mark),
                  brief(p.verdict.growth), brief(p.verdict.noise), brief(p.verdict.water),
                  brief(p.verdict.gain),
                  "bench stability --only " + map.name + " --panel \"" + panel.name + "\" --x " + brief(p.x) +
                      " --y " + brief(p.y)});
    }
    if (!map.varies_step() || first == 0) continue;
    const double over[2] = {first / f.printed[c], first / f.theory[c]};
    for (int k = 0; k < 2; ++k) low[k] = std::min(low[k], over[k]), high[k] = std::max(high[k], over[k]);
  }
  std::vector<std::string> row{map.name, panel.name};
  for (const int n : count) row.push_back(std::to_string(n));
  row.push_back(std::to_string(within_chosen));
  row.push_back(map.varies_step() ? std::to_string(within_printed) : "-");
  for (int k = 0; k < 2; ++k) row.push_back(map.varies_step() ? range(low[k], high[k]) : "-");
  summary.add(row);
}

}  // namespace

int main(int count, char** words) {
  const Options options(count, words, {"--only", "--panel", "--x", "--y", "--threads", "--output"}, kUsage,
                        {"--quick"});
  const std::vector<std::string> only = options.all("--only");
  const std::string name = options.text("--panel", "");
  set_threads(static_cast<int>(options.number("--threads", 1)));
  try {
    ResultTable table(
        "stability", "Stability maps",
        {"map", "scheme", "x", "y", "mark", "region", "growth", "noise", "water error", "energy gain",
         "printed limit over chosen", "theory over chosen", "x in words", "y in words", "x axis", "y axis"});
    ResultTable summary(
        "summary", "Stability maps, summary",
        {"map", "scheme", "stable", "drift", "noise", "grows", "breaks down", "marked within chosen",
         "marked within printed", "first unstable over printed", "over theory"});
    ResultTable inside("inside", "Marked although within the step that is chosen or printed",
                       {"map", "scheme", "x", "y", "step", "mark", "growth", "noise", "water error",
                        "energy gain", "command"});
    bool any = false;
    for (const Map& map : stability_maps()) {
      if (!only.empty() && std::find(only.begin(), only.end(), map.name) == only.end()) continue;
      const Choice at{chosen(map.x.values, options.text("--x", ""), options.flag("--quick")),
                      chosen(map.y.values, options.text("--y", ""), options.flag("--quick"))};
      for (const Panel& panel : map.panels) {
        if ((!name.empty() && panel.name != name) || at.x.empty() || at.y.empty()) continue;
        const double start = processor_clock();
        const Field f = compute(map, panel, at);
        add_rows(table, map, panel, f, at.y.size());
        add_summary(summary, inside, map, panel, f, at.y.size());
        any = true;
        std::fprintf(stderr, "%-14s %-28s %5zu places, %.1f s\n", map.name.c_str(), panel.name.c_str(),
                     f.points.size(), processor_clock() - start);
      }
    }
    if (!any) {
      std::fprintf(stderr, "error: no map, scheme or place of these names\n%s", kUsage);
      return 2;
    }
    const std::string folder = options.text("--output", "results/bench/stability");
    table.write_files(folder);
    summary.write(folder), inside.write(folder);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "error: %s\n", e.what());
    return 3;
  }
  return 0;
}
