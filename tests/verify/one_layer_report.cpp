// Prints the tables of docs/validation/one_layer.md: one-layer scenes with known answers, measured with the
// functions that the tests use.
#include <cmath>
#include <cstdio>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "core/threads.hpp"
#include "tests/verify/one_layer_consolidation.hpp"
#include "tests/verify/one_layer_rest.hpp"

using namespace polder;
using namespace polder::verify;

namespace {

const char* name_of(ShapeKind shape) {
  return shape == ShapeKind::gimp ? "GIMP" : "B-spline";
}
constexpr ShapeKind kShapes[] = {ShapeKind::gimp, ShapeKind::quadratic_bspline};

// ---- consolidation

void terzaghi_row(const Choice& c) {
  const Consolidation r = terzaghi(c, {0.05, 0.2, 0.5});
  std::printf("| %s | %g | %g | %.2f | %.4f | %.4f | %.4f | %.4f | %ld | %.2e | %.1f |\n", name_of(c.shape),
              c.conductivity, c.cell, c.courant, r.pressure_error[0], r.pressure_error[1],
              r.pressure_error[2], r.settlement_ratio, r.steps, r.step, r.seconds);
  std::fflush(stdout);
}

void terzaghi_head() {
  std::printf(
      "| shape | k [m/s] | h [m] | courant | T_v = 0.05 | 0.2 | 0.5 | settlement / exact | steps | step [s] "
      "| wall [s] |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|\n");
}

void terzaghi_conductivity() {
  terzaghi_head();
  for (const ShapeKind shape : kShapes)
    for (const double k : {1e-3, 1e-4, 1e-5, 1e-6}) terzaghi_row({.shape = shape, .conductivity = k});
}
void terzaghi_fast() {
  terzaghi_head();
  for (const ShapeKind shape : kShapes)
    for (const double k : {1e-3, 1e-4}) terzaghi_row({.shape = shape, .conductivity = k});
}

void terzaghi_order() {
  terzaghi_head();
  for (const ShapeKind shape : kShapes)
    for (const double k : {1e-3, 1e-4})
      for (const double h : {0.2, 0.1, 0.05, 0.025})
        terzaghi_row({.cell = h, .shape = shape, .conductivity = k});
}

// ---- rest

void rest_row(const char* shape, double value, const Rest& r) {
  std::printf("| %s | %g | %.1e | %.1e | %.1e | %.1e |", shape, value, r.pressure_error, r.point_stress_error,
              r.cell_stress_error, r.speed);
  std::printf(r.motion > 0 ? " %.1e |\n" : "\n", r.motion);
  std::fflush(stdout);
}

void hydrostatic_table() {
  std::printf(
      "| shape | surface | pressure | stress, points | stress, cells | speed [m/s] "
      "|\n|---|---|---|---|---|---|\n");
  for (const ShapeKind shape : kShapes)
    for (const double offset :
         {0.0, 0.02, 0.0625, 0.1875, 0.3125, 0.4375, 0.5625, 0.6875, 0.76, 0.8125, 0.9375})
      rest_row(name_of(shape), offset, hydrostatic({.shape = shape, .offset = offset}, 8));
}

void upward_table() {
  std::printf(
      "| shape | gradient over critical | pressure | stress, points | stress, cells | speed [m/s] "
      "|\n|---|---|---|---|---|---|\n");
  for (const ShapeKind shape : kShapes)
    for (const double share : {0.3, 0.6, 0.9})
      rest_row(name_of(shape), share, upward_seepage({.shape = shape}, share));
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

}  // namespace

int main(int count, char** names) {
  const std::map<std::string, std::function<void()>> tables = {{"terzaghi", terzaghi_conductivity},
                                                               {"terzaghi-fast", terzaghi_fast},
                                                               {"order", terzaghi_order},
                                                               {"hydrostatic", hydrostatic_table},
                                                               {"upward", upward_table},
                                                               {"strip", strip_table},
                                                               {"checkerboard", checkerboard_table},
                                                               {"slump", slump_table}};
  set_threads(1);
  int status = count > 1 ? 0 : 2;
  for (int i = 1; i < count; ++i) {
    const auto table = tables.find(names[i]);
    if (table != tables.end())
      table->second();
    else
      status = 2;
  }
  if (status != 0) {
    std::fprintf(stderr, "usage: one_layer_report TABLE ...   tables:");
    for (const auto& [name, f] : tables) std::fprintf(stderr, " %s", name.c_str());
    std::fprintf(stderr, "\n");
  }
  return status;
}
