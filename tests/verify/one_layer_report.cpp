// Prints the tables of docs/validation/one_layer.md: one-layer scenes with known answers, measured with the
// functions that the tests use.
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "core/threads.hpp"
#include "tests/verify/one_layer_consolidation.hpp"
#include "tests/verify/one_layer_limit.hpp"
#include "tests/verify/one_layer_rest.hpp"
#include "tests/verify/report.hpp"

using namespace polder;
using namespace polder::verify;

namespace {

const char* name_of(ShapeKind shape) {
  return shape == ShapeKind::gimp ? "GIMP" : "B-spline";
}
constexpr ShapeKind kShapes[] = {ShapeKind::gimp, ShapeKind::quadratic_bspline};

// ---- consolidation

void terzaghi_table() {
  std::printf(
      "| shape | k [m/s] | T_v = 0.05 | 0.2 | 0.5 | settlement / exact | steps | step [s] | wall [s] |\n"
      "|---|---|---|---|---|---|---|---|---|\n");
  for (const ShapeKind shape : kShapes)
    for (const double k : {1e-3, 1e-4, 1e-5, 1e-6}) {
      const Consolidation r = terzaghi({.shape = shape, .conductivity = k}, {0.05, 0.2, 0.5});
      std::printf("| %s | %g | %.4f | %.4f | %.4f | %.4f | %ld | %.2e | %.1f |\n", name_of(shape), k,
                  r.pressure_error[0], r.pressure_error[1], r.pressure_error[2], r.settlement_ratio, r.steps,
                  r.step, r.seconds);
      std::fflush(stdout);
    }
}

// Rows of errors on halved cells with the orders between them.
void series(const std::string& name, const std::vector<double>& cells,
            const std::function<Consolidation(double)>& run) {
  std::vector<double> before;
  for (const double h : cells) {
    const Consolidation r = run(h);
    std::printf("| %s | %g |", name.c_str(), h);
    for (std::size_t i = 0; i < r.pressure_error.size(); ++i) {
      std::printf(" %.1e", r.pressure_error[i]);
      if (!before.empty()) std::printf(" (%.1f)", std::log2(before[i] / r.pressure_error[i]));
      std::printf(" |");
    }
    std::printf(" %.4f | %ld |\n", r.settlement_ratio, r.steps);
    std::fflush(stdout);
    before = r.pressure_error;
  }
}

void order_table() {
  std::printf(
      "| column | h [m] | T_v = 0.05 | 0.2 | 0.5 | settlement / exact | steps "
      "|\n|---|---|---|---|---|---|---|\n");
  struct Run {
    double conductivity, load;
  };
  for (const ShapeKind shape : kShapes)
    for (const Run& run : {Run{1e-4, 100}, Run{1e-4, 1e4}, Run{1e-3, 100}}) {
      char name[64];
      std::snprintf(name, sizeof name, "%s, k = %g m/s, %g Pa", name_of(shape), run.conductivity, run.load);
      series(name, {0.2, 0.1, 0.05, 0.025}, [&](double h) {
        return terzaghi({.cell = h, .shape = shape, .conductivity = run.conductivity}, {0.05, 0.2, 0.5},
                        run.load);
      });
    }
}

// What is left on the finest grid when the step is cut and when the column's inertia counts less.
void floor_table() {
  std::printf("| k [m/s] | courant | T_v = 0.05 | 0.2 | 0.5 |\n|---|---|---|---|---|\n");
  struct Run {
    double conductivity, courant;
  };
  for (const Run& run : {Run{1e-3, 0.5}, Run{1e-3, 0.125}, Run{5e-4, 0.5}, Run{2.5e-4, 0.5}}) {
    const Consolidation r = terzaghi(
        {.cell = 0.025, .courant = run.courant, .conductivity = run.conductivity}, {0.05, 0.2, 0.5}, 100);
    std::printf("| %g | %g | %.1e | %.1e | %.1e |\n", run.conductivity, run.courant, r.pressure_error[0],
                r.pressure_error[1], r.pressure_error[2]);
  }
}

void layers_table() {
  std::printf(
      "| layers | h [m] | 0.1 t90 | 0.4 t90 | t90 | settlement / exact | steps "
      "|\n|---|---|---|---|---|---|---|\n");
  for (const char* name : {"soft_over_stiff", "stiff_over_soft"})
    for (const ShapeKind shape : kShapes)
      series(std::string(name_of(shape)) + ", " + name, {0.1, 0.05},
             [&](double h) { return two_layer({.cell = h, .shape = shape}, name); });
}

void finite_table() {
  std::printf(
      "| shape | h [m] | 146 s | 583 s | 1457 s | settlement / reference | steps "
      "|\n|---|---|---|---|---|---|---|\n");
  const auto rows = [](const char* name, const Choice& choice) {
    series(name, {0.4, 0.2, 0.1, 0.05}, [&](double h) {
      Choice c = choice;
      c.cell = h;
      return large_strain(c);
    });
  };
  rows("GIMP, no cell average", {.locking = coupling::LockingCure::none});
  rows("GIMP", {});
  rows("B-spline", {.shape = ShapeKind::quadratic_bspline});
  rows("B-spline, 4 points an axis", {.shape = ShapeKind::quadratic_bspline, .per_axis = 4});
}

// ---- rest

void rest_row(const char* shape, double value, const Rest& r) {
  std::printf("| %s | %g | %.1e | %.1e | %.1e | %.1e |", shape, value, r.pressure_error, r.point_stress_error,
              r.cell_stress_error, r.speed);
}

void hydrostatic_table() {
  std::printf(
      "| shape | surface | pressure | stress, points | stress, cells | speed [m/s] | motion [m/s] |\n"
      "|---|---|---|---|---|---|---|\n");
  for (const ShapeKind shape : kShapes)
    for (const double offset :
         {0.0, 0.02, 0.0625, 0.1875, 0.3125, 0.4375, 0.5, 0.52, 0.5625, 0.6875, 0.76, 0.8125, 0.9375}) {
      const Rest r = hydrostatic({.shape = shape, .offset = offset}, 8);
      rest_row(name_of(shape), offset, r);
      std::printf(" %.0e |\n", r.motion);
      std::fflush(stdout);
    }
}

void upward_table() {
  std::printf(
      "| shape | gradient over critical | pressure | stress, points | stress, cells | speed [m/s] "
      "|\n|---|---|---|---|---|---|\n");
  for (const ShapeKind shape : kShapes)
    for (const double share : {0.3, 0.6, 0.9}) {
      rest_row(name_of(shape), share, upward_seepage({.shape = shape}, share));
      std::printf("\n");
    }
}

void strip_table() {
  std::printf("| shape | cells in 1 m | K_w | jitter | roughness | middle |\n|---|---|---|---|---|---|\n");
  for (const ShapeKind shape : kShapes)
    for (const int cells : {16, 32})
      for (const double jitter : {0.0, 0.3}) {
        if (cells == 32 && jitter > 0) continue;
        const Strip r = strip_load(
            {.cell = 1.0 / cells, .shape = shape, .conductivity = 1e-12, .bulk_modulus = 1e20}, 0.5, jitter);
        std::printf("| %s | %d | %g | %g | %.1e | %.3f |\n", name_of(shape), cells, 1e20, jitter, r.roughness,
                    r.middle);
        std::fflush(stdout);
      }
}

void checkerboard_table() {
  std::printf("| shape | k [m/s] | 10 steps | 100 | 200 | 1000 |\n|---|---|---|---|---|---|\n");
  for (const ShapeKind shape : kShapes)
    for (const double k : {1e-12, 1e-4}) {
      std::printf("| %s | %g |", name_of(shape), k);
      for (const int steps : {10, 100, 200, 1000})
        std::printf(" %.1e |", checkerboard_left({.shape = shape, .conductivity = k}, steps));
      std::printf("\n");
    }
}

void slump_row(const Choice& c, const char* locking) {
  const Slump r = slump(c, 2);
  std::printf("| %s | %s | %s | %g | %g | %.3f | %.3f | %.4f | %.0f | %.0f | %.1e | %.2f | %+.1e | %ld |\n",
              name_of(c.shape), c.musl ? "MUSL" : "USL", locking, c.conductivity, c.courant, r.height,
              r.runout, r.volume, r.energy, r.released, r.roughness, r.largest_speed, r.water_error, r.steps);
  std::fflush(stdout);
}

void slump_table() {
  std::printf(
      "| shape | order | cell average | k [m/s] | courant | height [m] | run-out [m] | volume | energy [J] | "
      "released [J] | "
      "roughness | largest speed | water error | steps "
      "|\n|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  for (const double courant : {0.4, 1.0})
    for (const ShapeKind shape : kShapes)
      for (const bool average : {true, false})
        slump_row({.shape = shape,
                   .courant = courant,
                   .conductivity = 1e-5,
                   .locking = average ? coupling::LockingCure::cell_average : coupling::LockingCure::none},
                  average ? "yes" : "no");
  for (const ShapeKind shape : kShapes)
    slump_row({.shape = shape, .musl = false, .courant = 0.4, .conductivity = 1e-5}, "default");
}

// Four times as long, of a skeleton that hardly changes its volume.
void cure_table() {
  std::printf(
      "| shape | order | cell average | Poisson's ratio | height [m] | volume | energy [J] | released [J] | "
      "largest speed "
      "| steps |\n|---|---|---|---|---|---|---|---|---|---|\n");
  for (const double poisson : {0.3, 0.49})
    for (const ShapeKind shape : kShapes)
      for (const bool musl : {true, false})
        for (const bool average : {true, false}) {
          if (shape == ShapeKind::quadratic_bspline && !musl) continue;
          const Slump r =
              slump({.shape = shape,
                     .musl = musl,
                     .courant = 0.4,
                     .conductivity = 1e-5,
                     .locking = average ? coupling::LockingCure::cell_average : coupling::LockingCure::none},
                    8, poisson);
          std::printf("| %s | %s | %s | %g | %.3f | %.4f | %.0f | %.0f | %.2f | %ld |\n", name_of(shape),
                      musl ? "MUSL" : "USL", average ? "yes" : "no", poisson, r.height, r.volume, r.energy,
                      r.released, r.largest_speed, r.steps);
          std::fflush(stdout);
        }
}

// ---- time step

void limit_table() {
  std::printf(
      "| shape | order | k [m/s] | predicted | first unstable, surface at 0 | 0.25 | 0.5 | 0.75 | corner, "
      "0.75 | search [s] |\n"
      "|---|---|---|---|---|---|---|---|---|---|\n");
  for (const ShapeKind shape : kShapes)
    for (const bool musl : {true, false})
      for (const double k : {0.0, 1e-12, 1e-3, 1e-2, 1.0}) {
        Block b{{32, 16}, {.shape = shape, .musl = musl, .conductivity = k}};
        const double unit = wave_step(b);
        const auto start = std::chrono::steady_clock::now();
        const double predicted = predicted_step(b);
        const double seconds =
            std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        char soil[32];
        std::snprintf(soil, sizeof soil, k == 0 ? "dry" : "%g", k);
        std::printf("| %s | %s | %s | %.2f |", name_of(shape), musl ? "MUSL" : "USL", soil, predicted / unit);
        for (const double offset : {0.0, 0.25, 0.5, 0.75}) {
          b.choice.offset = offset;
          std::printf(" %.2f |", first_unstable_step(b) / unit);
        }
        b.free_side = true;
        std::printf(" %.2f | %.2f |\n", first_unstable_step(b) / unit, seconds);
        std::fflush(stdout);
      }
}

// Scenes at courant 1 under MUSL.
void courant_one_table() {
  std::printf(
      "| shape | k [m/s] | hydrostatic: pressure | speed [m/s] | strip: roughness | speed [m/s] | slump: "
      "height [m] | "
      "largest speed [m/s] | volume |\n|---|---|---|---|---|---|---|---|---|\n");
  for (const ShapeKind shape : kShapes)
    for (const double k : {1e-12, 1e-9, 1e-6, 1e-3, 1e-2, 1.0}) {
      Choice c{.shape = shape, .courant = 1, .conductivity = k};
      const Slump slumped = slump(c, 2);
      const Strip strip = strip_load(c, 2);
      c.offset = 0.3;
      const Rest rest = hydrostatic(c, 3);
      std::printf("| %s | %g | %.1e | %.1e | %.1e | %.1e | %.3f | %.2f | %.4f |\n", name_of(shape), k,
                  rest.pressure_error, rest.speed, strip.roughness, strip.largest_speed, slumped.height,
                  slumped.largest_speed, slumped.volume);
      std::fflush(stdout);
    }
}

}  // namespace

int main(int count, char** names) {
  const std::map<std::string, std::function<void()>> tables = {{"terzaghi", terzaghi_table},
                                                               {"order", order_table},
                                                               {"floor", floor_table},
                                                               {"layers", layers_table},
                                                               {"finite", finite_table},
                                                               {"hydrostatic", hydrostatic_table},
                                                               {"upward", upward_table},
                                                               {"strip", strip_table},
                                                               {"checkerboard", checkerboard_table},
                                                               {"slump", slump_table},
                                                               {"cure", cure_table},
                                                               {"limit", limit_table},
                                                               {"courant-one", courant_one_table}};
  return print_tables("one_layer_report", tables, count, names);
}
