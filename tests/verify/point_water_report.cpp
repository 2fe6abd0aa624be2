// Prints the tables of docs/validation/point_water.md: point_water_report TABLE ...
#include <cmath>
#include <cstdio>
#include <string>

#include "tests/verify/one_layer_consolidation.hpp"
#include "tests/verify/one_layer_limit.hpp"
#include "tests/verify/one_layer_rest.hpp"
#include "tests/verify/point_water_scenes.hpp"
#include "tests/verify/report.hpp"
#include "tests/verify/two_layer_scenes.hpp"
#include "tests/verify/two_layer_waves.hpp"

using namespace polder;
using namespace polder::verify;

namespace {

constexpr const char* kAll[] = {"one-layer", "higo", "two-layer", "v-w", "u-p"};
constexpr const char* kPoints[] = {"v-w", "u-p"};

void terzaghi_table() {
  std::printf(
      "| k [m/s] | formulation | T_v = 0.05 | 0.2 | 0.5 | settlement / exact | steps | longest step [s] | "
      "time [s] |\n|---|---|---|---|---|---|---|---|---|\n");
  for (const double k : {1e-3, 1e-4})
    for (const char* f : kAll) {
      const Consolidation r = terzaghi({.formulation = f, .conductivity = k}, {0.05, 0.2, 0.5});
      std::printf("| %g | `%s` | %.4f | %.4f | %.4f | %.4f | %ld | %.2e | %.2f |\n", k, f,
                  r.pressure_error[0], r.pressure_error[1], r.pressure_error[2], r.settlement_ratio, r.steps,
                  r.step, r.seconds);
      std::fflush(stdout);
    }
}

void waves_table() {
  std::printf(
      "| formulation | beside | h [m] | courant | pressure | effective stress | grains | water | speed | "
      "amplitude | steps | time [s] |\n|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  struct Run {
    const char* formulation;
    ColumnEquations equations;
    int cells;
    double courant;
  };
  using enum ColumnEquations;
  for (const Run& run : {Run{"v-w", uw, 40, 0.5}, Run{"v-w", uw, 80, 0.5}, Run{"v-w", uw, 160, 0.5},
                         Run{"v-w", uw, 160, 0.25}, Run{"two-layer", uw, 160, 0.1}, Run{"u-p", uw, 40, 0.5},
                         Run{"u-p", up, 40, 0.5}, Run{"one-layer", uw, 160, 0.1}}) {
    const TwoWaves r = two_waves(
        {.formulation = run.formulation, .cell = 1.0 / run.cells, .courant = run.courant}, run.equations);
    std::printf("| `%s` | %s | 1/%d | %g | %.3f | %.3f | %.3f | %.3f | %.3f | %.3f | %ld | %.1f |\n",
                run.formulation, run.equations == uw ? "u-w" : "u-p", run.cells, run.courant, r.pressure,
                r.stress, r.grains, r.water, r.speed, r.amplitude, r.steps, r.seconds);
    std::fflush(stdout);
  }
}

void harmonic_table() {
  using enum ColumnEquations;
  constexpr int kMostSteps = 250000;  // of u-p, which Darcy flow slows down
  std::printf(
      "| Pi1 | Pi2 | h | v-w: u-w | u-p | u-p: u-w | its own | exact: u-p against u-w | change "
      "|\n|---|---|---|---|---|---|---|---|---|\n");
  struct Run {
    double pi1, pi2;
    int cells, periods;
  };
  for (const Run& run :
       {Run{0.1, 0.1, 40, 6}, Run{0.1, 1, 40, 24}, Run{1, 0.001, 20, 6}, Run{1, 0.1, 20, 6}, Run{1, 1, 20, 8},
        Run{1, 1, 40, 8}, Run{10, 0.1, 20, 8}, Run{10, 1, 20, 24}, Run{10, 1, 40, 24}}) {
    HarmonicGroups g;
    g.pi1 = run.pi1, g.pi2 = run.pi2;
    // Steps of a period at half the limits of the wave and of Darcy flow.
    const double h = 1.0 / run.cells, wave = 2 * M_PI / std::sqrt(g.pi2) / h;
    const double darcy = 4 * M_PI * g.kappa * g.pi1 / (h * h);
    const auto steps = [](double least) { return static_cast<int>(std::ceil(std::max(400.0, 2 * least))); };
    Choice c{.formulation = "v-w", .cell = h};
    const Harmonic all = harmonic_column(c, g, steps(wave), run.periods);
    std::printf("| %g | %g | 1/%d | %.3f | %.3f |", g.pi1, g.pi2, run.cells, all.error(uw, g),
                all.error(up, g));
    if (steps(wave + darcy) * run.periods < kMostSteps) {
      c.formulation = "u-p";
      const Harmonic some = harmonic_column(c, g, steps(wave + darcy), run.periods);
      std::printf(" %.3f | %.3f | %.3f | %.0e |\n", some.error(uw, g), some.error(up, g),
                  harmonic_difference(up, uw, g), std::max(all.change, some.change));
    } else {
      std::printf(" – | – | %.3f | %.0e |\n", harmonic_difference(up, uw, g), all.change);
    }
    std::fflush(stdout);
  }
}

const char* name_of(coupling::PointPressure p) {
  return p == coupling::PointPressure::cell_mean ? "cell-mean"
         : p == coupling::PointPressure::mixed   ? "mixed"
                                                 : "points";
}

void jitter_table() {
  std::printf(
      "| formulation | point_pressure | smooth_rates | pressure, RMS | largest | speed [m/s] "
      "|\n|---|---|---|---|---|---|\n");
  for (const char* f : kAll) {
    const bool on_points = std::string(f) == "v-w" || std::string(f) == "u-p";
    using enum coupling::PointPressure;
    for (const coupling::PointPressure p : {cell_mean, points, mixed})
      for (const bool smooth : {false, true}) {
        if (!on_points && (p != cell_mean || smooth)) continue;
        const WaterRest r = jittered_column(
            {.formulation = f, .bulk_modulus = 2.2e7, .point_pressure = p, .smooth_rates = smooth}, 0.5, 1);
        std::printf("| `%s` | %s | %s | %.4f | %.4f | %.1e |\n", f, on_points ? name_of(p) : "–",
                    !on_points ? "–"
                    : smooth   ? "true"
                               : "false",
                    r.pressure_error, r.pressure_largest, r.speed);
        std::fflush(stdout);
      }
  }
}

void level_table() {
  std::printf(
      "| formulation | k [m/s] | point_pressure | discharge | pressure over the head that drives it "
      "|\n|---|---|---|---|---|\n");
  using enum coupling::PointPressure;
  for (const char* f : kPoints)
    for (const double k : {1e-3, 1e-4})
      for (const coupling::PointPressure p : {cell_mean, mixed}) {
        const LevelSeepage r = level_seepage(
            {.formulation = f, .conductivity = k, .bulk_modulus = 2.2e7, .point_pressure = p}, 4);
        std::printf("| `%s` | %g | %s | %+.2f %% | %.1e |\n", f, k, name_of(p), 100 * r.outflow_error,
                    r.pressure_error);
        std::fflush(stdout);
      }
}

void rest_table() {
  std::printf("| formulation | surface | pressure | stress, points | stress, cells | speed [m/s] |\n");
  std::printf("|---|---|---|---|---|---|\n");
  for (const char* f : kPoints)
    for (const double offset : {0.0, 0.25, 0.5, 0.75}) {
      const Rest r = hydrostatic({.formulation = f, .bulk_modulus = 2.2e8, .offset = offset}, 3);
      std::printf("| `%s` | %g | %.1e | %.1e | %.1e | %.1e |\n", f, offset, r.pressure_error,
                  r.point_stress_error, r.cell_stress_error, r.speed);
    }
}

void slump_table() {
  std::printf(
      "| formulation | K_w [Pa] | point_pressure | smooth_rates | height [m] | run-out [m] | volume | "
      "roughness "
      "| largest speed | water error | steps |\n|---|---|---|---|---|---|---|---|---|---|---|\n");
  const auto row = [](const Choice& c, bool on_points) {
    const char* pressure = on_points ? name_of(c.point_pressure) : "–";
    const char* smooth = !on_points ? "–" : c.smooth_rates ? "true" : "false";
    try {
      const Slump r = slump(c, 2);
      std::printf("| `%s` | %g | %s | %s | %.3f | %.3f | %.4f | %.1e | %.2f | %.0e | %ld |\n",
                  c.formulation.c_str(), c.bulk_modulus, pressure, smooth, r.height, r.runout, r.volume,
                  r.roughness, r.largest_speed, r.water_error, r.steps);
    } catch (const std::exception& e) {
      std::printf("| `%s` | %g | %s | %s | %s | | | | | | |\n", c.formulation.c_str(), c.bulk_modulus,
                  pressure, smooth, "breaks down");
    }
    std::fflush(stdout);
  };
  for (const char* f : {"one-layer", "two-layer"})
    row({.formulation = f, .courant = 0.4, .conductivity = 1e-5}, false);
  row({.formulation = "higo", .courant = 0.4, .conductivity = 1e-5, .bulk_modulus = 2.2e7}, false);
  for (const char* f : kPoints) {
    Choice c{.formulation = f, .courant = 0.4, .conductivity = 1e-5, .bulk_modulus = 2.2e7};
    for (const auto p : {coupling::PointPressure::cell_mean, coupling::PointPressure::mixed,
                         coupling::PointPressure::points})
      for (const bool smooth : {false, true}) c.point_pressure = p, c.smooth_rates = smooth, row(c, true);
    c = {.formulation = f, .courant = 0.4, .conductivity = 1e-5, .bulk_modulus = 2.2e8};
    row(c, true);
  }
}

// Measured first unstable steps beside formulas and analysis.
void stability_table() {
  std::printf(
      "| formulation | drag | k [m/s] | K_w [Pa] | 2 / r [s] | h / c_u [s] | h^2 / 2 kappa Q [s] | analysis "
      "[s] "
      "| first unstable [s] | over the analysis | step at courant 1, over it | printed, over it "
      "|\n|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  using enum coupling::DragStep;
  struct Scheme {
    const char* formulation;
    coupling::DragStep drag;
  };
  for (const Scheme& s :
       {Scheme{"v-w", by_last_velocities}, Scheme{"v-w", implicit}, Scheme{"u-p", implicit}})
    for (const double stiffness : {2.2e8, 2.2e9})
      for (const double k : {1e-5, 1e-4, 1e-3, 1e-2, 1e-1}) {
        const Block b{
            {12, 8},
            {.formulation = s.formulation, .conductivity = k, .bulk_modulus = stiffness, .drag = s.drag}};
        const FormulaLimits f = formula_limits(b.choice, 0.4, 2650);
        const double analysed = analysed_point_limit(b.choice, 0.4, 2650);
        const double measured = first_unstable_step(b);
        std::printf(
            "| `%s` | %s | %g | %g | %.2e | %.2e | %.2e | %.3e | %.3e |", s.formulation,
            s.drag == implicit ? (std::string(s.formulation) == "v-w" ? "implicit" : "–") : "explicit", k,
            stiffness, f.drag, f.wave, f.darcy, analysed, measured);
        std::printf(" %.2f | %.2f | %.2f |\n", measured / analysed, wave_step(b) / analysed,
                    predicted_step(b) / analysed);
        std::fflush(stdout);
      }
}

// Pressure projected: the water limits nothing.
void implicit_table() {
  std::printf(
      "| formulation | k [m/s] | K_w [Pa] | formula [s] | first unstable [s] | over it "
      "|\n|---|---|---|---|---|---|\n");
  for (const char* f : {"one-layer", "two-layer"})
    for (const double stiffness : {2.2e8, 2.2e9})
      for (const double k : {1e-5, 1e-3, 1e-1}) {
        const Block b{{12, 8}, {.formulation = f, .conductivity = k, .bulk_modulus = stiffness}};
        const double formula = wave_step(b), measured = first_unstable_step(b);
        std::printf("| `%s` | %g | %g | %.3e | %.3e | %.2f |\n", f, k, stiffness, formula, measured,
                    measured / formula);
        std::fflush(stdout);
      }
}

}  // namespace

int main(int count, char** names) {
  return print_tables("point_water_report",
                      {{"terzaghi", terzaghi_table},
                       {"waves", waves_table},
                       {"harmonic", harmonic_table},
                       {"jitter", jitter_table},
                       {"rest", rest_table},
                       {"level", level_table},
                       {"slump", slump_table},
                       {"stability", stability_table},
                       {"implicit", implicit_table}},
                      count, names);
}
