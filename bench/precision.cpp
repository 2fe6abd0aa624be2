// Error against processor time of whole runs, for formulations, shape functions, transfers and pressure
// methods over cell and step: one table of all runs, one of what an error costs with each setting.
#define DOCTEST_CONFIG_IMPLEMENT  // scenes of the tests read their references with its checks
#include "bench/precision.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <map>

#include "bench/front.hpp"
#include "bench/measure.hpp"

using namespace polder;
using namespace polder::bench;

namespace {

const char* const kUsage =
    "bench precision [--only NAME]... [--with NAME]... [--quick] [--threads N = 1] [--output DIR = "
    "results/bench/precision]\n"
    "  only: these benchmarks; with: also those that take long (levee); quick: a few coarse runs of the "
    "default\n"
    "  fine solutions are kept in DIR/fine and computed anew for another commit\n";

constexpr double kTarget = 0.01;  // error that the second table asks the price of

std::string brief(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return std::isnan(value) ? "broke down" : text;
}

struct Result {
  const Trial* trial;
  Outcome outcome;
  Cost cost() const { return {outcome.seconds, outcome.error()}; }
};

void add_rows(ResultTable& table, const Benchmark& b, const std::vector<Result>& results) {
  std::vector<Cost> costs;
  for (const Result& r : results) costs.push_back(r.cost());
  const std::vector<std::size_t> best = front(costs);
  for (std::size_t i = 0; i < results.size(); ++i) {
    const auto& [trial, o] = results[i];
    std::string parts;
    for (std::size_t k = 0; k < o.errors.size(); ++k)
      parts += (k > 0 ? ", " : "") + b.errors.at(k) + " " + brief(o.errors[k]);
    table.add({b.name, trial->setting, trial->is_default ? "yes" : "", brief(trial->cell), trial->step,
               digits(o.points, 0), digits(o.steps, 0), brief(o.seconds), brief(o.error()), parts,
               std::find(best.begin(), best.end(), i) != best.end() ? "yes" : ""});
  }
}

// For each setting: seconds to the target, or the smallest error it came to; and how far it is from the best.
void add_prices(ResultTable& table, const Benchmark& b, const std::vector<Result>& results) {
  std::vector<Cost> all;
  std::map<std::string, std::vector<Result>> settings;
  std::vector<std::string> order;
  for (const Result& r : results) {
    all.push_back(r.cost());
    if (settings[r.trial->setting].empty()) order.push_back(r.trial->setting);
    settings[r.trial->setting].push_back(r);
  }
  for (const std::string& name : order) {
    std::vector<Cost> own;
    for (const Result& r : settings[name]) own.push_back(r.cost());
    const double seconds = seconds_to_reach(own, kTarget);
    const std::vector<std::size_t> curve = front(own);
    const auto where = [&](const Trial& t) { return "cell " + brief(t.cell) + " m, " + t.step; };
    std::string reached = "broke down", at, smallest = "-", takes = "-";
    if (!curve.empty()) {
      const std::size_t last = curve.back();
      smallest = brief(own[last].error), takes = brief(own[last].seconds);
      std::size_t used = last;
      if (std::isfinite(seconds))
        for (const std::size_t i : curve)
          if (own[i].seconds == seconds) used = i;
      reached = std::isfinite(seconds) ? brief(seconds) : "not reached";
      at = where(*settings[name][used].trial);
    }
    table.add({b.name, name, settings[name][0].trial->is_default ? "yes" : "", reached, smallest, takes, at,
               curve.empty() ? "-" : brief(cost_over_best(own, all))});
  }
}

bool chosen(const Benchmark& b, const std::vector<std::string>& only, const std::vector<std::string>& with) {
  const auto named = [&](const std::vector<std::string>& names) {
    return std::find(names.begin(), names.end(), b.name) != names.end();
  };
  return named(only) || named(with) || (only.empty() && !b.only_if_asked);
}

void check_names(const std::vector<Benchmark>& all, const std::vector<std::string>& names) {
  for (const std::string& name : names)
    if (std::none_of(all.begin(), all.end(), [&](const Benchmark& b) { return b.name == name; })) {
      std::string known;
      for (const Benchmark& b : all) known += " " + b.name;
      std::fprintf(stderr, "error: there is no benchmark %s; there are:%s\n", name.c_str(), known.c_str());
      std::exit(2);
    }
}

}  // namespace

int main(int count, char** words) {
  const Options options(count, words, {"--only", "--with", "--threads", "--output"}, kUsage, {"--quick"});
  const Place place{options.text("--output", "results/bench/precision"),
                    static_cast<int>(options.number("--threads", 1))};
  doctest::Context context;
  context.setAsDefaultForAssertsOutOfTestCases();
  const std::string folder = place.output.string();
  try {
    std::vector<Benchmark> all = case_benchmarks(place);
    for (Benchmark& b : scene_benchmarks(place)) all.push_back(std::move(b));
    const auto only = options.all("--only"), with = options.all("--with");
    check_names(all, only), check_names(all, with);
    ResultTable table("precision", "Error against processor time",
                      {"benchmark", "setting", "default", "cell [m]", "step", "points", "steps", "seconds",
                       "error", "errors of", "on the curve"});
    ResultTable prices("prices", "Seconds to reach 1 %",
                       {"benchmark", "setting", "default", "seconds to 1 %", "smallest error", "its seconds",
                        "with", "seconds over the best"});
    for (const Benchmark& b : all) {
      if (!chosen(b, only, with)) continue;
      std::vector<Result> results;
      for (const Trial& t : b.trials) {
        if (options.flag("--quick") && !t.quick) continue;
        if (results.empty() && b.prepare) b.prepare();
        results.push_back({&t, t.run()});
        std::fprintf(stderr, "%-16s %-36s %8g m  %-14s %9.3g s  error %s\n", b.name.c_str(),
                     t.setting.c_str(), t.cell, t.step.c_str(), results.back().outcome.seconds,
                     brief(results.back().outcome.error()).c_str());
      }
      add_rows(table, b, results);
      add_prices(prices, b, results);
      table.write_files(folder), prices.write_files(folder);  // what an interrupted run has got so far
    }
    prices.write(folder);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "error: %s\n", e.what());
    return 3;
  }
  return 0;
}
