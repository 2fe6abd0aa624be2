// Prints the tables of docs/validation/free_surface.md with the functions that the tests use.
#define DOCTEST_CONFIG_IMPLEMENT
#include <doctest/doctest.h>

#include <algorithm>
#include <cstdio>

#include "tests/unit/reference_csv.hpp"
#include "tests/verify/free_surface.hpp"
#include "tests/verify/report.hpp"
#include "tests/verify/steady_flow.hpp"

using namespace polder::verify;

namespace {

double per_cent(double found, double exact) {
  return 100 * (found / exact - 1);
}

void dam_table() {
  std::printf(
      "| L/h1 | h2/h1 | q - q Charny [%%] at 20, 40, 80 cells | exit/h1 exact | exit - exact [%%] | "
      "iterations | "
      "seconds |\n|---|---|---|---|---|---|---|\n");
  const ReferenceCsv table("rect_dam_table.csv");
  for (const auto& row : table.rows) {
    const bool chosen =
        (row[0] == 0.5 || row[0] == 1 || row[0] == 2) && (row[1] == 0 || row[1] == 0.3 || row[1] == 0.5);
    if (!chosen) continue;
    std::vector<FreeSurface> dams;
    for (const int cells : {20, 40, 80}) dams.push_back(rectangular_dam(row[0], 1, row[1], cells));
    std::printf("| %g | %g |", row[0], row[1]);
    for (const FreeSurface& f : dams)
      std::printf(" %+.3f", per_cent(f.outflow, charny_discharge(row[0], 1, row[1])));
    std::printf(" | %.4f |", row[2]);
    for (const FreeSurface& f : dams) std::printf(" %+.2f", per_cent(f.exit, row[2]));
    std::printf(" |");
    for (const FreeSurface& f : dams) std::printf(" %d%s", f.iterations, f.converged ? "" : " (none)");
    std::printf(" |");
    for (const FreeSurface& f : dams) std::printf(" %.2f", f.seconds);
    std::printf(" |\n");
    std::fflush(stdout);
  }
}

void fringe_table() {
  std::printf(
      "| alpha h1 | curves | q - q Charny [%%] at 20, 40, 80 cells | (h1 - exit)/alpha [%%] | exit - exact "
      "[%%] | "
      "iterations |\n|---|---|---|---|---|---|\n");
  const double exact = charny_discharge(1, 1, 0), exit = 0.368238271;
  for (const double steepness : {20.0, 40.0, 80.0, 160.0, 2000.0})
    for (const bool averages : {true, false}) {
      std::vector<FreeSurface> dams;
      for (const int cells : {20, 40, 80})
        dams.push_back(rectangular_dam(1, 1, 0, cells, {.steepness = steepness, .averages = averages}));
      std::printf("| %g | %s |", steepness, averages ? "means" : "centres");
      const auto column = [&](const char* format, auto&& value) {
        for (const FreeSurface& f : dams) f.converged ? std::printf(format, value(f)) : std::printf(" none");
        std::printf(" |");
      };
      column(" %+.2f", [&](const FreeSurface& f) { return per_cent(f.outflow, exact); });
      std::printf(" %.2f |", 100 * 1e-4 * (1 - exit) / steepness / exact);
      column(" %+.2f", [&](const FreeSurface& f) { return per_cent(f.exit, exit); });
      column(" %d", [&](const FreeSurface& f) { return f.iterations; });
      std::printf("\n");
      std::fflush(stdout);
    }
}

void levee_table() {
  std::printf(
      "| base [m] | slopes | h2 [m] | cell [m] | q - q reference [%%] | exit [m] | reference | difference in "
      "cells | iterations | seconds |\n|---|---|---|---|---|---|---|---|---|---|\n");
  const ReferenceCsv table("levee_summary.csv");
  for (const auto& row : table.rows)
    for (const double cell : {0.2, 0.1, 0.05, 0.025}) {
      const FreeSurface levee = trapezoidal_levee(row[0], row[1], row[2], row[3], row[4], cell);
      std::printf("| %g | 1 : %g | %g | %g | %+.2f | %.4f | %.4f | %+.2f | %d%s | %.2f |\n", row[0], row[1],
                  row[4], cell, per_cent(levee.outflow, row[6]), levee.exit, row[7],
                  (levee.exit - row[7]) / cell, levee.iterations, levee.converged ? "" : " (none)",
                  levee.seconds);
      std::fflush(stdout);
    }
}

void level_table() {
  const std::vector<double> times{5e3, 1e4, 2e4, 5e4, 1e5};
  std::printf(
      "| cell [m] | alpha [1/m] | | 5e3 s | 1e4 s | 2e4 s | 5e4 s | 1e5 s "
      "|\n|---|---|---|---|---|---|---|---|\n");
  for (const double cell : {0.05, 0.025})
    for (const double alpha : {10.0, 20.0}) {
      const LevelChange down = level_change(1, 0.9, cell, alpha, times);
      const LevelChange up = level_change(0.9, 1, cell, alpha, times);
      const auto row = [&](const char* name, auto&& volume) {
        std::printf("| %g | %g | %s |", cell, alpha, name);
        for (std::size_t i = 0; i < times.size(); ++i)
          std::printf(" %+.1f |", per_cent(volume(i), linearised_volume(1, 0.9, 1 / alpha, times[i])));
        std::printf("\n");
      };
      row("drawdown", [&](std::size_t i) { return down.volume[i]; });
      row("rise", [&](std::size_t i) { return -up.volume[i]; });
      row("mean", [&](std::size_t i) { return 0.5 * (down.volume[i] - up.volume[i]); });
    }
}

void steady_table() {
  std::printf(
      "| soil | | iterations (solver's) from near, still, dry: means | seconds | centres | seconds "
      "|\n|---|---|---|---|---|---|\n");
  for (const SteadyScene& scene : steady_scenes()) {
    std::printf("| %s | %s |", scene.name.c_str(),
                !scene.levee  ? "dam"
                : scene.drain ? "levee with drain"
                              : "levee");
    for (const bool averages : {true, false}) {
      double seconds = 0;
      for (const SteadyStart start : {SteadyStart::near, SteadyStart::still, SteadyStart::dry}) {
        const SteadyFlow f = steady_flow(scene, start, averages);
        seconds = std::max(seconds, f.seconds);
        f.converged ? std::printf(" %d (%d)", f.iterations, f.linear_iterations) : std::printf(" none");
      }
      std::printf(" | %.2f |", seconds);
    }
    std::printf("\n");
    std::fflush(stdout);
  }
}

}  // namespace

int main(int count, char** names) {
  doctest::Context context;  // the reader of the reference solutions asserts
  context.setAsDefaultForAssertsOutOfTestCases();
  return print_tables("free_surface_report",
                      {{"dams", dam_table},
                       {"fringes", fringe_table},
                       {"levees", levee_table},
                       {"levels", level_table},
                       {"steady", steady_table}},
                      count, names);
}
