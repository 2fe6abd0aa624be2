// Scenes of water on the soil's points (formulations v-w and u-p) that the other formulations' scenes do not
// have, and the analysis of their step limit. Used by the tests and by the program that prints the tables of
// docs/validation/point_water.md. SI units.
#pragma once

#include "tests/verify/one_layer_scenes.hpp"

namespace polder::verify {

// First step at which a saturated block on a uniform grid becomes unstable: the worst plane wave with GIMP
// and two points in a cell along each axis, MUSL (docs/theory/point-water.md). density: of the grains.
double analysed_point_limit(const Choice& choice, double porosity, double density);

// 2 / r of explicit drag, and h / c_u and h^2 / (2 kappa Q) of an explicit pressure [s], without points.
struct FormulaLimits {
  double drag = 0, wave = 0, darcy = 0;
};
FormulaLimits formula_limits(const Choice& choice, double porosity, double density);

// Column 1 m high with no weight, a pressure of `head` metres of water at its base, its top drained: steady.
struct Flow {
  double discharge = 0, exact = 0;  // through the base per area [m/s]
  double pressure_error = 0;        // RMS over the pressure at the base [-]
  double water_error = 0;           // of the water's mass [-]
};
Flow upward_flow(const Choice& choice, double head);

// Largest less smallest pore pressure of all points at the end of a scene [Pa].
double pressure_range(const Scene& scene);

}  // namespace polder::verify
