// Prints the tables of docs/validation/water_physics.md: drag and the water's own stresses in two layers,
// measured with the functions that the tests use.
#include <cmath>
#include <cstdio>
#include <map>
#include <string>

#include "tests/verify/report.hpp"
#include "tests/verify/water_drag.hpp"

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

}  // namespace

int main(int count, char** names) {
  return print_tables("water_physics_report", {{"beds", beds_table}}, count, names);
}
