// Prints the tables of docs/validation/free_surface.md with the functions that the tests use.
#define DOCTEST_CONFIG_IMPLEMENT
#include <doctest/doctest.h>

#include <cstdio>

#include "tests/unit/reference_csv.hpp"
#include "tests/verify/free_surface.hpp"
#include "tests/verify/report.hpp"

using namespace polder::verify;

namespace {

double per_cent(double found, double exact) {
  return 100 * (found / exact - 1);
}

void dam_table() {
  std::printf(
      "| L/h1 | h2/h1 | cells | q - q Charny [%%] at alpha h1 = 20, 40, 80, 160 | limit | exit/h1 exact | at "
      "160 | limit | [%%] |\n|---|---|---|---|---|---|---|---|---|\n");
  const ReferenceCsv table("rect_dam_table.csv");
  for (const auto& row : table.rows) {
    const bool chosen =
        (row[0] == 0.5 || row[0] == 1 || row[0] == 2) && (row[1] == 0 || row[1] == 0.3 || row[1] == 0.5);
    if (!chosen) continue;
    for (const int cells : {40, 80}) {
      const FreeSurfaceLimit dam = rectangular_dam(row[0], 1, row[1], cells, 160);
      const double exact = charny_discharge(row[0], 1, row[1]);
      std::printf("| %g | %g | %d |", row[0], row[1], cells);
      for (const FreeSurface& f : dam.found) std::printf(" %+.2f", per_cent(f.outflow, exact));
      std::printf(" | %+.2f | %.4f | %.4f | %.4f | %+.1f |\n", per_cent(dam.discharge, exact), row[2],
                  dam.found.back().exit, dam.exit, per_cent(dam.exit, row[2]));
      std::fflush(stdout);
    }
  }
}

void levee_table() {
  std::printf(
      "| base [m] | slopes | h2 [m] | cell [m] | q - q reference [%%] at alpha h1 = 20, 40, 80 | limit "
      "|\n|---|---|---|---|---|---|\n");
  const ReferenceCsv table("levee_summary.csv");
  for (const auto& row : table.rows)
    for (const double cell : {0.1, 0.05}) {
      const FreeSurfaceLimit levee = trapezoidal_levee(row[0], row[1], row[2], row[3], row[4], cell, 80);
      std::printf("| %g | 1 : %g | %g | %g |", row[0], row[1], row[4], cell);
      for (const FreeSurface& f : levee.found) std::printf(" %+.2f", per_cent(f.outflow, row[6]));
      std::printf(" | %+.2f |\n", per_cent(levee.discharge, row[6]));
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

}  // namespace

int main(int count, char** names) {
  doctest::Context context;  // the reader of the reference solutions asserts
  context.setAsDefaultForAssertsOutOfTestCases();
  return print_tables("free_surface_report",
                      {{"dams", dam_table}, {"levees", levee_table}, {"levels", level_table}}, count, names);
}
