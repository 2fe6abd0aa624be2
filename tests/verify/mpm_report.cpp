// Tables of the validation book (docs/validation/mpm.md): mpm_report NAME ... prints one each.
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <map>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "core/threads.hpp"
#include "tests/verify/mpm_collapse.hpp"
#include "tests/verify/mpm_column.hpp"
#include "tests/verify/mpm_loads.hpp"
#include "tests/verify/mpm_motion.hpp"
#include "tests/verify/report.hpp"

using namespace polder::verify;

namespace {

const char* name_of(ShapeKind s) {
  return s == ShapeKind::linear ? "linear" : s == ShapeKind::gimp ? "GIMP" : "B-spline";
}

void column() {
  std::printf(
      "| start | shape | cell average | h [m] | RMS, points | RMS, recovered | RMS, cell means | worst point "
      "| at height [m] "
      "| "
      "lowest cell | recovered | settlement | base reaction | unbalanced | steps |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  for (const bool exact : {false, true})
    for (const ShapeKind shape : {ShapeKind::gimp, ShapeKind::quadratic_bspline})
      for (const bool average : {false, true})
        for (const double h : {0.1, 0.05, 0.025}) {
          ColumnOptions o;
          o.shape = shape, o.cell_average = average, o.spacing = h, o.from_exact_stress = exact;
          const ColumnResult r = settle_column(o);
          std::printf(
              "| %s | %s | %s | %g | %.3f %% | %.3f %% | %.3f %% | %.2f %% | %.3f | %.2f %% | %.2f %% | %.1e "
              "| %.1e | %.1e | %ld "
              "|\n",
              exact ? "exact stress" : "no stress", name_of(shape), average ? "yes" : "no", h, 100 * r.rms,
              100 * r.recovered_rms, 100 * r.cell_rms, 100 * r.worst, r.where, 100 * r.bottom,
              100 * r.recovered_bottom, r.settlement_error, r.reaction_error, r.unbalanced, r.steps);
        }
}

void collapse_table() {
  // Lube et al. (2005) and Lajeunesse et al. (2005), fits to experiments between walls
  // (tests/reference/collapse_plane.csv).
  const std::map<double, std::array<double, 3>> fits = {
      {0.5, {0.6, 0.9, 0.5}}, {1, {1.2, 1.8, 1.0}}, {2, {2.483, 3.6, 1.320}}, {4, {4.788, 5.796, 1.741}}};
  std::printf(
      "| H/L | shape | transfer | c [Pa] | run-out | front | height | Lube | Lajeunesse | height, Lube | "
      "fastest / free fall | points lost | change of volume | wall [s] |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  struct Transfer {
    const char* name;
    double flip;
    AffineKind affine;
  };
  for (const auto& [aspect, fit] : fits)
    for (const ShapeKind shape : {ShapeKind::gimp, ShapeKind::quadratic_bspline})
      for (const Transfer& scheme :
           {Transfer{"FLIP 0.98", 0.98, AffineKind::none}, Transfer{"FLIP 0.99", 0.99, AffineKind::none},
            Transfer{"FLIP 0.999", 0.999, AffineKind::none}, Transfer{"FLIP 1", 1, AffineKind::none},
            Transfer{"APIC", 1, AffineKind::apic}})
        for (const double cohesion : {0.0, 1.0, 100.0}) {
          CollapseOptions o;
          o.aspect = aspect, o.shape = shape, o.flip = scheme.flip, o.affine = scheme.affine,
          o.cohesion = cohesion;
          o.musl = scheme.affine == AffineKind::none;
          const CollapseResult r = collapse(o);
          std::printf(
              "| %g | %s | %s | %g | %.2f | %.2f | %.2f | %.2f | %.2f | %.2f | %.2f | %d | %.2f %% | %.1f "
              "|\n",
              aspect, name_of(shape), scheme.name, cohesion, r.runout, r.front, r.height, fit[0], fit[1],
              fit[2], r.fastest, r.lost, 100 * r.volume_change, r.wall);
        }
}

constexpr Scheme kSchemes[] = {
    {"GIMP, MUSL, FLIP 1", ShapeKind::gimp, true, 1, AffineKind::none},
    {"GIMP, USL, FLIP 1", ShapeKind::gimp, false, 1, AffineKind::none},
    {"GIMP, MUSL, FLIP 0.99", ShapeKind::gimp, true, 0.99, AffineKind::none},
    {"GIMP, APIC", ShapeKind::gimp, false, 1, AffineKind::apic},
    {"B-spline, MUSL, FLIP 1", ShapeKind::quadratic_bspline, true, 1, AffineKind::none},
    {"B-spline, USL, FLIP 1", ShapeKind::quadratic_bspline, false, 1, AffineKind::none},
    {"B-spline, MUSL, FLIP 0.99", ShapeKind::quadratic_bspline, true, 0.99, AffineKind::none},
    {"B-spline, APIC", ShapeKind::quadratic_bspline, false, 1, AffineKind::apic},
    {"B-spline, TPIC", ShapeKind::quadratic_bspline, false, 1, AffineKind::tpic}};

// One row of errors over grids, with the orders between them.
void orders(const char* name, const std::vector<double>& errors) {
  std::printf("| %s |", name);
  for (std::size_t i = 0; i < errors.size(); ++i) {
    std::printf(" %.2e", errors[i]);
    if (i > 0) std::printf(" (%.2f)", std::log2(errors[i - 1] / errors[i]));
    std::printf(" |");
  }
  std::printf("\n");
}

void bar() {
  std::printf("| scheme | 8 cells | 16 | 32 | 64 |\n|---|---|---|---|---|\n");
  for (const Scheme& scheme : kSchemes) {
    std::vector<double> errors;
    for (const int cells : {8, 16, 32, 64}) errors.push_back(vibrate_bar(scheme, cells, 0.5).displacement);
    orders(scheme.name, errors);
  }
}

void manufactured_table() {
  std::printf("| scheme | 8 cells | 16 | 32 | 64 |\n|---|---|---|---|---|\n");
  for (const Scheme& scheme : kSchemes)
    for (const auto& [amplitude, per_axis] : {std::pair{0.05, 2}, std::pair{0.05, 4}, std::pair{0.01, 2}}) {
      if (scheme.shape == ShapeKind::gimp && (per_axis != 2 || amplitude != 0.05)) continue;
      std::vector<double> errors;
      for (const int cells : {8, 16, 32, 64})
        errors.push_back(manufactured(scheme, cells, 0.5, amplitude, per_axis).displacement);
      char name[96];
      std::snprintf(name, sizeof name, "%s; A = %g, %d points an axis", scheme.name, amplitude, per_axis);
      orders(name, errors);
    }
}

void spin() {
  std::printf(
      "| scheme | energy | angular momentum | shape (RMS / R) | stretch | angle short of 360 deg | steps |\n"
      "|---|---|---|---|---|---|---|\n");
  for (const Scheme& scheme : kSchemes) {
    const SpinResult r = spin_disk(scheme, 10, 0.5);
    std::printf("| %s | %.1e | %.1e | %.1e | %.1e | %.2f | %ld |\n", scheme.name, r.energy, r.angular,
                r.shape, r.area, -r.angle, r.steps);
  }
}

void slide() {
  std::printf(
      "| incline | friction | start [m/s] | shape | distance [m] | exact | velocity [m/s] | exact |\n"
      "|---|---|---|---|---|---|---|---|\n");
  struct Run {
    double angle, coefficient, speed;
  };
  for (const ShapeKind shape : {ShapeKind::gimp, ShapeKind::quadratic_bspline})
    for (const Run& run : {Run{20, 0, 0}, Run{20, 0.2, 0}, Run{20, 0.3, 0}, Run{20, 0.4, 0}, Run{45, 0.5, 0},
                           Run{10, 0.3, 2}, Run{0, 0.3, 2}}) {
      const SlideResult r = slide_block(shape, run.angle, run.coefficient, run.speed, 0.5);
      const double angle = run.angle * std::numbers::pi / 180;
      const bool sticks = run.speed == 0 && std::tan(angle) < run.coefficient;
      const double a = sticks ? 0 : 9.81 * (std::sin(angle) - run.coefficient * std::cos(angle));
      std::printf("| %g deg | %g | %g | %s | %.4f | %.4f | %.4f | %.4f |\n", run.angle, run.coefficient,
                  run.speed, name_of(shape), r.distance, 0.5 * run.speed + 0.125 * a, r.velocity,
                  run.speed + 0.5 * a);
    }
}

void cylinder() {
  std::printf(
      "| shape | cell average | h [m] | radial | hoop | axial | displacement "
      "|\n|---|---|---|---|---|---|---|\n");
  for (const ShapeKind shape : {ShapeKind::gimp, ShapeKind::quadratic_bspline})
    for (const bool average : {false, true})
      for (const double h : {0.2, 0.1, 0.05}) {
        const CylinderResult r = press_cylinder(shape, average, h);
        std::printf("| %s | %s | %g | %.2e | %.2e | %.2e | %.2e |\n", name_of(shape), average ? "yes" : "no",
                    h, r.radial, r.hoop, r.axial, r.displacement);
      }
}

void footing() {
  std::printf(
      "| shape | cell average | cells in half the width | q / c | error | slope, last over first | mean "
      "stress in "
      "cells, RMS / c | steps |\n|---|---|---|---|---|---|---|---|\n");
  for (const ShapeKind shape : {ShapeKind::gimp, ShapeKind::quadratic_bspline})
    for (const bool average : {true, false})
      for (const int cells : {4, 8, 12}) {
        FootingOptions o;
        o.shape = shape, o.cell_average = average, o.cells = cells, o.speed = 0.03;
        const FootingResult r = push_footing(o);
        std::printf("| %s | %s | %g | %.3f | %+.1f %% | %.3f | %.3f | %ld |\n", name_of(shape),
                    average ? "yes" : "no", cells + 0.5, r.factor,
                    100 * (r.factor / (2 + std::numbers::pi) - 1), r.last_slope / r.initial_slope,
                    r.roughness, r.steps);
      }
}

}  // namespace

int main(int count, char** names) {
  const std::map<std::string, std::function<void()>> tables = {
      {"bar", bar},         {"collapse", collapse_table},         {"column", column}, {"cylinder", cylinder},
      {"footing", footing}, {"manufactured", manufactured_table}, {"slide", slide},   {"spin", spin}};
  return print_tables("mpm_report", tables, count, names);
}
