// Prints the tables of docs/validation/two_layer.md: two-layer scenes with known answers, measured with the
// functions that the tests use.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <string>

#include "tests/verify/one_layer_consolidation.hpp"
#include "tests/verify/one_layer_limit.hpp"
#include "tests/verify/one_layer_rest.hpp"
#include "tests/verify/report.hpp"
#include "tests/verify/two_layer_scenes.hpp"
#include "tests/verify/two_layer_waves.hpp"
#include "tests/verify/water_lift.hpp"

using namespace polder;
using namespace polder::verify;

namespace {

constexpr const char* kLayered[] = {"two-layer", "two-layer-darcy"};
constexpr auto kCompressible = coupling::PressureMethod::compressible;
constexpr const char* kFormulations[] = {"one-layer", "two-layer", "two-layer-darcy"};

void terzaghi_table() {
  std::printf(
      "| formulation | k [m/s] | surface | T_v = 0.05 | 0.2 | 0.5 | settlement / exact | steps "
      "|\n|---|---|---|---|---|---|---|---|\n");
  for (const char* f : kLayered)
    for (const double k : {1e-3, 1e-4, 1e-5})
      for (const double offset : {0.0, 0.25, 0.5, 0.8}) {
        if (k < 1e-4 && offset > 0) continue;
        const Consolidation r =
            terzaghi({.formulation = f, .conductivity = k, .offset = offset}, {0.05, 0.2, 0.5}, 100);
        std::printf("| %s | %g | %g | %.4f | %.4f | %.4f | %.4f | %ld |\n", f, k, offset, r.pressure_error[0],
                    r.pressure_error[1], r.pressure_error[2], r.settlement_ratio, r.steps);
        std::fflush(stdout);
      }
  for (const double k : {1e-3, 1e-4}) {
    const Consolidation r = terzaghi(
        {.formulation = "two-layer", .conductivity = k, .pressure = kCompressible}, {0.05, 0.2, 0.5}, 100);
    std::printf("| two-layer, compressible | %g | 0 | %.4f | %.4f | %.4f | %.4f | %ld |\n", k,
                r.pressure_error[0], r.pressure_error[1], r.pressure_error[2], r.settlement_ratio, r.steps);
  }
}

void rest_table() {
  std::printf(
      "| formulation | scene | pressure, RMS | largest | speed [m/s] | drift |\n|---|---|---|---|---|---|\n");
  const auto rows = [](const char* name, const Choice& c) {
    const auto row = [&](const char* scene, const WaterRest& r) {
      std::printf("| %s | %s | %.1e | %.1e | %.1e | %.1e |\n", name, scene, r.pressure_error,
                  r.pressure_largest, r.speed, r.drift);
    };
    row("soil, jitter 0.5, 1 s", jittered_column(c, 0.5, 1));
    row("soil, jitter 0.5, 3 s", jittered_column(c, 0.5, 3));
    row("pond over soil, 2 s", pond_over_soil(c, 0, 2));
    row("pond over soil, jitter 0.5, 2 s", pond_over_soil(c, 0.5, 2));
  };
  for (const char* f : kLayered) rows(f, {.formulation = f});
  rows("two-layer, compressible", {.formulation = "two-layer", .pressure = kCompressible});
}

void hydrostatic_table() {
  std::printf(
      "| formulation | k [m/s] | surface | pressure | stress, points | speed [m/s] "
      "|\n|---|---|---|---|---|---|\n");
  for (const double k : {1e-3, 1e-6})
    for (const double offset : {0.0, 0.1875, 0.4375, 0.5625, 0.8125})
      for (const char* f : kFormulations) {
        const Rest r = hydrostatic({.formulation = f, .conductivity = k, .offset = offset}, 3);
        std::printf("| %s | %g | %g | %.1e | %.1e | %.1e |\n", f, k, offset, r.pressure_error,
                    r.point_stress_error, r.speed);
      }
}

void falling_table() {
  std::printf(
      "| formulation | k [m/s] | h [m] | jitter | discharge | pressure, RMS | largest | water | drift, RMS | "
      "at the interface | elsewhere |\n|---|---|---|---|---|---|---|---|---|---|---|\n");
  struct Run {
    double conductivity, cell, jitter, duration;
  };
  for (const char* f : kLayered)
    for (const Run& run :
         {Run{1e-2, 0.1, 0, 10}, Run{1e-2, 0.1, 0.3, 10}, Run{1e-2, 0.05, 0, 10}, Run{1e-3, 0.1, 0, 40}}) {
      const FallingHead r = falling_head(
          {.formulation = f, .cell = run.cell, .conductivity = run.conductivity}, run.jitter, run.duration);
      std::printf("| %s | %g | %g | %g | %+.1f %% | %.4f | %.4f | %.0e | %.4f | %.4f | %.4f |\n", f,
                  run.conductivity, run.cell, run.jitter, 100 * r.outflow_error, r.pressure_error,
                  r.pressure_largest, r.water_error, r.drift_rms, r.drift_interface, r.drift_elsewhere);
      std::fflush(stdout);
    }
}

void upward_table() {
  std::printf(
      "| formulation | gradient over critical | pressure | stress, points | stress, cells "
      "|\n|---|---|---|---|---|\n");
  for (const double share : {0.6, 0.9})
    for (const char* f : kFormulations) {
      const Rest r = upward_seepage({.formulation = f}, share);
      std::printf("| %s | %g | %.1e | %.1e | %.1e |\n", f, share, r.pressure_error, r.point_stress_error,
                  r.cell_stress_error);
    }
}

void level_table() {
  std::printf(
      "| formulation | k [m/s] | courant | discharge | pressure over the head that drives it "
      "|\n|---|---|---|---|---|\n");
  for (const double k : {1e-3, 1e-4})
    for (const char* f : kFormulations)
      for (const double courant : {0.5, 1.0}) {
        if (courant > 0.5 && std::string(f) != "one-layer") continue;  // two layers take no longer steps
        const LevelSeepage r = level_seepage({.formulation = f, .courant = courant, .conductivity = k}, 1);
        std::printf("| %s | %g | %g | %+.2f %% | %.1e |\n", f, k, courant, 100 * r.outflow_error,
                    r.pressure_error);
      }
}

void slump_table() {
  std::printf(
      "| formulation | k [m/s] | height [m] | run-out [m] | volume | roughness | largest speed | water error "
      "|\n"
      "|---|---|---|---|---|---|---|---|\n");
  for (const double k : {1e-5, 1e-3})
    for (const char* f : kFormulations) {
      const Slump r = slump({.formulation = f, .courant = 0.4, .conductivity = k}, 2);
      std::printf("| %s | %g | %.3f | %.3f | %.4f | %.1e | %.2f | %.0e |\n", f, k, r.height, r.runout,
                  r.volume, r.roughness, r.largest_speed, r.water_error);
    }
}

void drag_table() {
  std::printf("| k [m/s] | step over 2 / r | momentum | relative velocity left |\n|---|---|---|---|\n");
  for (const double k : {1e-2, 1e-4, 1e-6}) {
    const Exchange r = exchange_of_momentum({.formulation = "two-layer", .conductivity = k}, 0.5, 200);
    std::printf("| %g | %.3g | %.0e | %.0e |\n", k, r.explicit_ratio, r.momentum_error, std::abs(r.relative));
  }
}

void dam_table() {
  std::printf(
      "| h [m] | T = 0.9 | 1.3 | 2.0 | 2.7 | 3.3 | depth at the wall, tau = 0.9 | 1.4 | 2.0 | 2.5 | 3.1 | "
      "steps |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  for (const double h : {0.1, 0.05}) {
    const DamBreak r = dam_break({.formulation = "two-layer", .cell = h}, 1, 2, 6, 1.0, 0.01);
    const auto at = [&](const std::vector<double>& values, double time) {
      std::size_t i = 0;
      while (i + 1 < r.time.size() && r.time[i] < time) ++i;
      return values[i];
    };
    std::printf("| %g |", h);
    for (const double t : {0.9, 1.3, 2.0, 2.7, 3.3})
      std::printf(" %.2f |", at(r.front, t / std::sqrt(2 * kGravity)));
    for (const double t : {0.9, 1.4, 2.0, 2.5, 3.1})
      std::printf(" %.2f |", at(r.height, t / std::sqrt(kGravity)) / 2);
    std::printf(" %ld |\n", r.steps);
  }
}

void ritter_table() {
  std::printf(
      "| h [m] | x = -2.5 | -1.5 | -0.5 | 0.5 | 1.5 | 2.5 | 3.5 |\n|---|---|---|---|---|---|---|---|\n");
  const double xs[] = {-2.5, -1.5, -0.5, 0.5, 1.5, 2.5, 3.5};
  for (const double h : {0.1, 0.05}) {
    const DamBreak r = dam_break({.formulation = "two-layer", .cell = h}, 5, 1, 12, 1.0, 0.1);
    std::printf("| %g |", h);
    for (const double x : xs) {  // means over 0.4 m
      double sum = 0;
      int n = 0;
      for (const auto& [at, depth] : r.profile)
        if (std::abs(at - x) < 0.2) sum += depth, ++n;
      std::printf(" %.3f |", sum / n);
    }
    std::printf("\n");
  }
  std::printf("| Ritter |");
  for (const double x : xs)
    std::printf(" %.3f |", std::min(1.0, std::pow(2 * std::sqrt(kGravity) - x, 2) / 9 / kGravity));
  std::printf("\n");
}

void sloshing_table() {
  std::printf(
      "| h [m] | points an axis | period / exact | amplitude after 9 half swings | steps "
      "|\n|---|---|---|---|---|\n");
  for (const double h : {0.05, 0.025})
    for (const int n : {2, 4}) {
      const Sloshing r = sloshing({.formulation = "two-layer", .cell = h, .per_axis = n}, 0.02, 6);
      std::printf("| %g | %d | %.4f | %.2f | %ld |\n", h, n, r.period / r.exact, r.amplitude, r.steps);
    }
}

void harmonic_table() {
  using enum ColumnEquations;
  std::printf(
      "| Pi1 | Pi2 | h | two-layer: u-w | two-layer-darcy: u-p | u-w | one-layer: its own | u-p | u-w | "
      "exact: "
      "u-p against u-w | its own against u-w | change "
      "|\n|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  struct Run {
    double pi1, pi2;
    int cells, periods;
  };
  for (const Run& run : {Run{0.1, 0.01, 40, 6}, Run{0.1, 0.1, 40, 6}, Run{0.1, 1, 40, 24},
                         Run{1, 0.001, 20, 6}, Run{1, 0.1, 20, 6}, Run{1, 1, 20, 8}, Run{1, 1, 40, 8},
                         Run{10, 0.1, 20, 8}, Run{10, 1, 20, 24}, Run{10, 1, 40, 24}}) {
    HarmonicGroups g;
    g.pi1 = run.pi1, g.pi2 = run.pi2;
    const int steps = static_cast<int>(std::lround(std::max(400.0, 400 * run.cells / 20.0)));
    Choice c{.formulation = "two-layer", .cell = 1.0 / run.cells};
    const Harmonic two = harmonic_column(c, g, steps, run.periods);
    c.formulation = "two-layer-darcy";
    const Harmonic tied = harmonic_column(c, g, steps, run.periods);
    c.formulation = "one-layer";
    const Harmonic one = harmonic_column(c, g, steps, run.periods);
    std::printf("| %g | %g | 1/%d | %.3f | %.3f | %.3f | %.3f | %.3f | %.3f | %.3f | %.3f | %.0e |\n", g.pi1,
                g.pi2, run.cells, two.error(uw, g), tied.error(up, g), tied.error(uw, g), one.error(darcy, g),
                one.error(up, g), one.error(uw, g), harmonic_difference(up, uw, g),
                harmonic_difference(darcy, uw, g), std::max({one.change, tied.change, two.change}));
    std::fflush(stdout);
  }
}

void waves_table() {
  std::printf(
      "| formulation | against | h [m] | courant | pressure | effective stress | grains | water | speed | "
      "amplitude | steps |\n|---|---|---|---|---|---|---|---|---|---|---|\n");
  struct Run {
    const char* formulation;
    ColumnEquations equations;
    int cells;
    double courant;
    bool compressible = false;
  };
  using enum ColumnEquations;
  for (const Run& run : {Run{"two-layer", uw, 40, 0.1}, Run{"two-layer", uw, 80, 0.2},
                         Run{"two-layer", uw, 80, 0.1}, Run{"two-layer", uw, 160, 0.1},
                         Run{"two-layer", uw, 80, 0.5, true}, Run{"two-layer", uw, 160, 0.5, true},
                         Run{"two-layer-darcy", uw, 160, 0.1}, Run{"two-layer-darcy", up, 80, 0.1},
                         Run{"two-layer-darcy", up, 160, 0.1}, Run{"one-layer", uw, 160, 0.1}}) {
    Choice c{.formulation = run.formulation, .cell = 1.0 / run.cells, .courant = run.courant};
    if (run.compressible) c.pressure = kCompressible;
    const TwoWaves r = two_waves(c, run.equations);
    // In u-p no second wave passes.
    const double none = run.equations == up ? std::nan("") : 1.0;
    std::printf("| %s%s | %s | 1/%d | %g | %.3f | %.3f | %.3f | %.3f | %.3f | %.3f | %ld |\n",
                run.formulation, run.compressible ? ", compressible" : "",
                run.equations == uw ? "u-w" : "u-p", run.cells, run.courant, r.pressure, r.stress, r.grains,
                r.water, none * r.speed, none * r.amplitude, r.steps);
    std::fflush(stdout);
  }
}

void limit_table() {
  std::printf(
      "| order | K_w [Pa] | k [m/s] | analysis [s] | measured over it | step at courant 1 over it "
      "|\n|---|---|---|---|---|---|\n");
  for (const bool musl : {true, false})
    for (const double stiffness : {2.2e8, 2.2e9})
      for (const double k : {1e-6, 1e-4, 1e-3, 1e-2, 1.0}) {
        const Block b{{12, 8},
                      {.formulation = "two-layer",
                       .musl = musl,
                       .conductivity = k,
                       .bulk_modulus = stiffness,
                       .pressure = kCompressible}};
        const double analysed = analysed_mixture_limit(b.choice, 0.4, 2650);
        // Halfway between the two steps of which one grows; steps of two layers are half of the limit at
        // most.
        std::printf("| %s | %g | %g | %.2e | %.3f | %.3f |\n", musl ? "MUSL" : "USL", stiffness, k, analysed,
                    first_unstable_step(b) / 1.01 / analysed, 2 * wave_step(b) / analysed);
        std::fflush(stdout);
      }
}

void mixture_table() {
  std::printf(
      "| formulation | without contact, largest share | at the end | height at the end [m] | mean vertical "
      "stress at the end over the weight under water |\n|---|---|---|---|---|\n");
  for (const char* f : {"two-layer", "mixture"}) {
    const Lifting r = lifting({.formulation = f}, loose_sand(0.4, 1e-3, 0.38), 0.1);
    std::printf("| %s | %.2f | %.2f | %.4f | %.3f |\n", f, r.fluidised, r.settled_share, r.settled_height,
                r.settled_compression / (0.5 * 0.6 * 1650 * kGravity));
  }
}

void cost_table() {
  std::printf(
      "| h [m] | points, one / two | one-layer [ms] | two-layer [ms] | ratio |\n|---|---|---|---|---|\n");
  for (const double h : {0.1, 0.05, 0.025}) {
    const Cost r = cost_of_a_step({.cell = h, .courant = 0.4, .conductivity = 1e-3}, 5, 0.4);
    std::printf("| %g | %ld / %ld | %.2f | %.2f | %.2f |\n", h, r.particles_one, r.particles_two,
                1e3 * r.one_layer, 1e3 * r.two_layer, r.two_layer / r.one_layer);
  }
}

}  // namespace

int main(int count, char** names) {
  const std::map<std::string, std::function<void()>> tables = {
      {"terzaghi", terzaghi_table}, {"rest", rest_table},         {"hydrostatic", hydrostatic_table},
      {"falling", falling_table},   {"upward", upward_table},     {"level", level_table},
      {"slump", slump_table},       {"drag", drag_table},         {"dam", dam_table},
      {"ritter", ritter_table},     {"sloshing", sloshing_table}, {"harmonic", harmonic_table},
      {"waves", waves_table},       {"limit", limit_table},       {"mixture", mixture_table},
      {"cost", cost_table}};
  return print_tables("two_layer_report", tables, count, names);
}
