// Prints the tables of docs/validation/seepage.md: unsaturated flow in cells with known answers, measured
// with the functions that the tests use.
#define DOCTEST_CONFIG_IMPLEMENT
#include <doctest/doctest.h>

#include <cstdio>
#include <string>

#include "tests/verify/report.hpp"
#include "tests/verify/seepage_infiltration.hpp"

using namespace polder::verify;

namespace {

void infiltration_row(const char* soil, const InfiltrationChoice& choice, const Infiltration& r) {
  const std::string step = choice.step > 0 ? std::to_string(static_cast<int>(choice.step)) : "chosen";
  std::printf("| %s | %d | %s%s | %.2f | %.2f | %+.2f | %.0e | %ld | %.1f | %.2f |\n", soil, choice.cells,
              step.c_str(), choice.upstream ? ", upstream" : "", 100 * r.profile_error, 100 * r.front_error,
              100 * r.inflow_error, std::abs(r.defect), r.steps, r.iterations, r.seconds);
  std::fflush(stdout);
}

void infiltration_table() {
  std::printf(
      "| soil | cells | step [s] | profile L2 [%%] | of the increase [%%] | inflow [%%] | balance | steps | "
      "iterations a step | wall [s] |\n|---|---|---|---|---|---|---|---|---|---|\n");
  const auto celia = [](const InfiltrationChoice& c) {
    infiltration_row("New Mexico", c, celia_new_mexico(c));
  };
  const auto sand = [](const InfiltrationChoice& c) { infiltration_row("Haverkamp", c, celia_haverkamp(c)); };
  for (const int cells : {50, 100, 200, 400}) celia({.cells = cells, .step = 60});
  for (const double step : {3600, 1800, 900, 450}) celia({.cells = 100, .step = step});
  celia({.cells = 100, .step = 0});
  celia({.cells = 100, .step = 600, .upstream = true});
  for (const int cells : {20, 40, 80, 160}) sand({.cells = cells, .step = 1});
  for (const double step : {20, 10, 5}) sand({.cells = 160, .step = step});
}

}  // namespace

int main(int count, char** names) {
  doctest::Context context;  // the reader of the reference solutions asserts
  context.setAsDefaultForAssertsOutOfTestCases();
  return print_tables("seepage_report", {{"infiltration", infiltration_table}}, count, names);
}
