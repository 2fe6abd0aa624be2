// Trials of `polder bench precision`: errors fall with the cells, and a fine solution is what it is compared
// with.
#include "bench/precision.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>

#include "bench/case_trial.hpp"
#include "core/error.hpp"

using namespace polder::bench;
namespace fs = std::filesystem;

namespace {

Place place() {
  return {fs::temp_directory_path() / "polder_precision_test", 1};
}

// Errors of the quick trials of the default, from coarse to fine.
std::vector<double> quick_errors(const Benchmark& benchmark) {
  std::vector<double> errors;
  for (const Trial& t : benchmark.trials)
    if (t.quick && t.is_default) {
      const Outcome o = t.run();
      CHECK(o.errors.size() == benchmark.errors.size());
      CHECK(o.steps > 0);
      CHECK(o.seconds > 0);
      errors.push_back(o.error());
    }
  return errors;
}

Benchmark named(std::vector<Benchmark> all, const std::string& name) {
  for (Benchmark& b : all)
    if (b.name == name) return b;
  FAIL("no benchmark " << name);
  return {};
}

}  // namespace

TEST_CASE("consolidation: the error falls with the cells, nearly by their square") {
  const std::vector<double> e = quick_errors(named(case_benchmarks(place()), "terzaghi"));
  REQUIRE(e.size() == 3);
  CHECK(e[0] > 3 * e[1]);
  CHECK(e[1] > 3 * e[2]);
  CHECK(e[2] < 2e-3);
}

TEST_CASE("manufactured motion: the error falls by the square of the cells") {
  const std::vector<double> e = quick_errors(manufactured_benchmark(place()));
  REQUIRE(e.size() == 3);
  CHECK(e[0] > 3 * e[1]);
  CHECK(e[1] > 3 * e[2]);
}

TEST_CASE("a case against its own fine solution: no error with its cells, some with coarser ones") {
  const auto shorten = [](polder::coupling::Scene& s) { s.stages[0].duration = 0.2; };
  const CaseVariant fine{"column-collapse/column-collapse.toml", {"grid.cell=0.025"}, shorten};
  const FineSolution solution("collapse", fine, {"run-out", "max-speed"}, "", place());
  const fs::path there = place().output / "fine" / "collapse_run-out.csv";
  fs::remove_all(place().output);
  solution.compute();
  const auto written = fs::last_write_time(there);
  solution.compute();  // lies there
  CHECK(fs::last_write_time(there) == written);

  CaseVariant same = fine, coarse = fine;
  same.change = coarse.change = [&](polder::coupling::Scene& s) { shorten(s), solution.expect(s); };
  coarse.settings = {"grid.cell=0.05"};
  const Outcome a = run_trial(same, place()), b = run_trial(coarse, place());
  REQUIRE(a.errors.size() == 2);
  CHECK(a.error() < 1e-9);
  CHECK(b.error() > 1e-3);
  CHECK(b.error() < 0.5);
  CHECK(a.points > 3.5 * b.points);

  // Another scene under the same name is another solution.
  CaseVariant other = coarse;
  other.change = shorten;
  const FineSolution second("collapse", other, {"run-out", "max-speed"}, "", place());
  second.compute();
  CHECK(run_trial(coarse, place()).error() < 1e-9);
}

TEST_CASE("a run that breaks down has no error, and the next one does not know") {
  const auto broken =
      in_own_process(place(), 2, []() -> Outcome { throw polder::NumericalError("on purpose"); });
  CHECK(broken.errors.size() == 2);
  CHECK(std::isnan(broken.error()));
}
