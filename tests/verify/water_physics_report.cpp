// Prints the tables of docs/validation/water_physics.md: drag and the water's own stresses in two layers,
// measured with the functions that the tests use.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <string>

#include "tests/verify/report.hpp"
#include "tests/verify/water_drag.hpp"
#include "tests/verify/water_lift.hpp"
#include "tests/verify/water_shear.hpp"
#include "tests/verify/water_wetting.hpp"

using namespace polder;
using namespace polder::verify;

namespace {

void beds_table() {
  using coupling::DragLaw;
  struct Law {
    const char* name;
    DragLaw law;
    double porosity;
  };
  std::printf(
      "| law | porosity | d [m] | gradient | Re | q / exact - 1 | outlet against inlet | steps "
      "|\n|---|---|---|---|---|---|---|---|\n");
  for (const Law& l : {Law{"ergun", DragLaw::ergun, 0.4}, Law{"di-felice", DragLaw::di_felice, 0.4},
                       Law{"gidaspow", DragLaw::gidaspow, 0.9}})
    for (const double d : {2e-4, 1e-3, 5e-3, 2e-2})
      for (const double gradient : {0.01, 1.0}) {
        coupling::Material m;
        m.porosity = l.porosity;
        m.drag_law = l.law;
        m.grain_diameter = d;
        const Permeameter r = permeameter({.formulation = "two-layer"}, m, gradient);
        std::printf("| %s | %g | %g | %g | %.3g | %.1e | %.0e | %ld |\n", l.name, l.porosity, d, gradient,
                    r.reynolds, r.discharge / r.exact - 1, r.difference, r.steps);
      }
}

void plates_table() {
  std::printf(
      "| drive | points | h | nu t / L2 | travelled | q / exact - 1 | points, L2 | largest | "
      "across |\n|---|---|---|---|---|---|---|---|---|\n");
  using Drive = PlateFlow::Drive;
  for (const Drive drive : {Drive::pressure, Drive::upper_plate})
    for (const bool affine : {true, false})
      for (const double h : {0.2, 0.1, 0.05})
        for (const int kind : {0, 1, 2}) {
          PlateFlow f{.drive = drive, .affine = affine, .flip = 0.99};
          if (kind == 0) f.duration = 0.03;
          if (kind == 2) f.viscosity = 10, f.speed = 0.1, f.duration = 100, f.time_step = 0.02;
          const PlateProfile r = plate_flow({.formulation = "two-layer", .cell = h}, f);
          std::printf("| %s | %s | %g | %g | %.2g m | %+.4f | %.4f | %.4f | %.4f |\n",
                      drive == Drive::pressure ? "pressure" : "plate", affine ? "affine" : "FLIP 0.99", h,
                      f.viscosity / 1000 * f.duration, f.speed * f.duration, r.discharge - 1, r.error,
                      r.largest, r.across);
        }
}

void lift_table() {
  std::printf(
      "| h [m] | threshold | risen to | critical / exact | fluidised | highest [m] | at the end: fluidised | "
      "height [m] | stress / at rest | water error | steps "
      "|\n|---|---|---|---|---|---|---|---|---|---|---|\n");
  for (const double h : {0.1, 0.05})
    for (const double threshold : {0.42, 0.45})
      for (const double most : {0.9, 1.1, 1.2}) {
        const Lifting r =
            lifting({.formulation = "two-layer", .cell = h}, loose_sand(0.4, 1e-3, threshold), most);
        std::printf("| %g | %g | %g | ", h, threshold, most);
        if (r.critical > 0)
          std::printf("%.4f", r.critical);
        else
          std::printf("not reached");
        std::printf(" | %.3f | %.3f | %.3f | %.3f | %.3f | %.0e | %ld |\n", r.fluidised, r.height,
                    r.settled_share, r.settled_height, r.settled_stress, r.water_error, r.steps);
      }
}

void settling_table() {
  std::printf(
      "| law | porosity | d [m] | h [m] | n u of the law [m/s] | Richardson and Zaki / n u | grains / n u | "
      "surface / n u | steps |\n|---|---|---|---|---|---|---|---|---|\n");
  using coupling::DragLaw;
  for (const DragLaw law : {DragLaw::gidaspow, DragLaw::di_felice})
    for (const double n : {0.7, 0.9, 0.97})
      for (const double d : {3e-4, 1e-3})
        for (const double h : {0.1, 0.05}) {
          coupling::Material m = loose_sand(n, d, 0.5);
          m.drag_law = law;
          const Settling r = settling({.formulation = "two-layer", .cell = h}, m, 1);
          std::printf("| %s | %g | %g | %g | %.4f | %.3f | %.3f | %.3f | %ld |\n",
                      law == DragLaw::gidaspow ? "gidaspow" : "di-felice", n, d, h, r.exact,
                      r.richardson_zaki / r.exact, r.grains / r.exact, r.velocity / r.exact, r.steps);
        }
}

void wetting_table() {
  std::printf(
      "| retained | h [m] | front | inflow | stress before | after | level falling | water "
      "|\n|---|---|---|---|---|---|---|---|\n");
  for (const double retained : {0.0, 0.5, 0.8})
    for (const double h : {0.1, 0.05}) {
      const Choice c{.formulation = "two-layer", .cell = h, .conductivity = 1e-2};
      const Wetting up = rising_front(c, retained);
      const Draining down = falling_front(c, retained);
      std::printf("| %g | %g | %.2f | %+.1f %% | %+.3f | %+.3f | %.2f | %.0e |\n", retained, h,
                  up.front_error, 100 * up.inflow_error, up.stress_before, up.stress_after, down.level_error,
                  std::max(std::abs(up.water_error), std::abs(down.water_error)));
      std::fflush(stdout);
    }
}

}  // namespace

int main(int count, char** names) {
  return print_tables("water_physics_report",
                      {{"beds", beds_table},
                       {"plates", plates_table},
                       {"lift", lift_table},
                       {"settling", settling_table},
                       {"wetting", wetting_table}},
                      count, names);
}
