// Prints the tables of docs/validation/higo.md: higo_report TABLE ...
#include <chrono>
#include <cstdio>
#include <limits>
#include <string>

#include "tests/verify/higo_scenes.hpp"
#include "tests/verify/one_layer_consolidation.hpp"
#include "tests/verify/one_layer_limit.hpp"
#include "tests/verify/one_layer_rest.hpp"
#include "tests/verify/report.hpp"

using namespace polder;
using namespace polder::verify;

namespace {

const char* const kFormulations[] = {"one-layer", "higo"};

// Ten cells, the water's true stiffness.
void terzaghi_table() {
  std::printf(
      "| k [m/s] | formulation | T_v = 0.05 | 0.2 | 0.5 | settlement / exact | steps | longest step [s] | "
      "time [s] |\n|---|---|---|---|---|---|---|---|---|\n");
  for (const double k : {1e-3, 1e-4})
    for (const char* f : kFormulations) {
      const Consolidation r = terzaghi({.formulation = f, .conductivity = k}, {0.05, 0.2, 0.5});
      std::printf("| %g | `%s` | %.4f | %.4f | %.4f | %.4f | %ld | %.2e | %.2f |\n", k, f,
                  r.pressure_error[0], r.pressure_error[1], r.pressure_error[2], r.settlement_ratio, r.steps,
                  r.step, r.seconds);
      std::fflush(stdout);
    }
}

void limit_table() {
  std::printf(
      "| order | k [m/s] | analysis [s] | formula | printed | first unstable, surface at 0 | 0.25 | 0.5 | "
      "0.75 "
      "| corner, 0.75 |\n|---|---|---|---|---|---|---|---|---|---|\n");
  for (const bool musl : {true, false})
    for (const double k : {1e-12, 1e-5, 1e-4, 1e-3, 1e-2}) {
      Block b{{16, 12}, {.formulation = "higo", .musl = musl, .conductivity = k}};
      const double analysed = analysed_limit(b.choice, 0.4, 1990);
      std::printf("| %s | %g | %.2e | %.2f | %.2f |", musl ? "MUSL" : "USL", k, analysed,
                  wave_step(b) / analysed, predicted_step(b) / analysed);
      for (const double offset : {0.0, 0.25, 0.5, 0.75}) {
        b.choice.offset = offset;
        std::printf(" %.2f |", first_unstable_step(b) / analysed);
      }
      b.free_side = true;
      std::printf(" %.2f |\n", first_unstable_step(b) / analysed);
      std::fflush(stdout);
    }
}

void hydrostatic_table() {
  std::printf(
      "| shape | surface | pressure | stress, points | stress, cells | speed [m/s] "
      "|\n|---|---|---|---|---|---|\n");
  for (const ShapeKind shape : {ShapeKind::gimp, ShapeKind::quadratic_bspline})
    for (const double offset : {0.0625, 0.1875, 0.3125, 0.4375, 0.52, 0.5625, 0.6875, 0.8125, 0.9375}) {
      const Rest r =
          hydrostatic({.formulation = "higo", .shape = shape, .bulk_modulus = 2.2e8, .offset = offset}, 4);
      std::printf("| %s | %g | %.1e | %.1e | %.1e | %.1e |\n", shape == ShapeKind::gimp ? "GIMP" : "B-spline",
                  offset, r.pressure_error, r.point_stress_error, r.cell_stress_error, r.speed);
      std::fflush(stdout);
    }
}

void rain_table() {
  std::printf(
      "| formulation | h [m] | S at 0.1 m | 0.3 m | 0.5 m | heave [mm] | water error | steps | time [s] "
      "|\n|---|---|---|---|---|---|---|---|---|\n");
  for (const double h : {0.2, 0.1, 0.05})
    for (const char* f : kFormulations) {
      const Rain r = rain({.formulation = f, .cell = h});
      std::printf("| `%s` | %g | %.4f | %.4f | %.4f | %.4f | %.1e | %ld | %.1f |\n", f, h, r.saturation[0],
                  r.saturation[1], r.saturation[2], -1e3 * r.settlement, r.water_error, r.steps, r.seconds);
      std::fflush(stdout);
    }
}

void slump_table() {
  std::printf(
      "| formulation | K_w [Pa] | courant | height at 0.25 s | 0.5 s | 1 s | 2 s | run-out at 0.25 s | 0.5 s "
      "| 1 "
      "s | 2 s | steps | time [s] |\n|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  const auto row = [](const char* f, double stiffness, double courant) {
    const Slumped r =
        slump_in_time({.formulation = f, .courant = courant, .conductivity = 1e-5, .bulk_modulus = stiffness},
                      {0.25, 0.5, 1, 2});
    std::printf("| `%s` | %g | %g |", f, stiffness, courant);
    for (const std::vector<double>* list : {&r.height, &r.runout})
      for (double x : *list) std::printf(" %.3f |", x);
    std::printf(" %ld | %.1f |\n", r.steps, r.seconds);
    std::fflush(stdout);
  };
  row("one-layer", 2.2e9, 0.4);
  row("higo", 2.2e7, 0.4);
  row("higo", 2.2e8, 0.4);
  row("higo", 2.2e9, 0.4);
}

}  // namespace

int main(int count, char** names) {
  return print_tables("higo_report",
                      {{"terzaghi", terzaghi_table},
                       {"limit", limit_table},
                       {"hydrostatic", hydrostatic_table},
                       {"rain", rain_table},
                       {"slump", slump_table}},
                      count, names);
}
