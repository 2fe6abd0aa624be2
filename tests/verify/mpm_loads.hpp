// Boundaries and loads: friction on an incline, prescribed velocity, traction, follower pressure, an inner
// segment, and a footing at failure.
#pragma once

#include "tests/verify/mpm_motion.hpp"

namespace polder::verify {

// Elastic block on an incline of `angle` degrees (gravity turned, base horizontal) with Coulomb friction,
// released at rest or with `speed` down the slope; after `duration`.
struct SlideResult {
  double distance = 0, velocity = 0;  // of the centre of mass
};
SlideResult slide_block(ShapeKind shape, double angle, double coefficient, double speed, double duration);

// The same down a frictionless segment inside the grid, inclined by `angle` degrees.
struct SegmentResult {
  double acceleration = 0;  // of the block over that of a rigid one, g sin(angle), minus one
  double depth = 0;         // of the deepest point behind the segment [cells]
  double lift = 0;          // mean motion of the points away from the segment [cells]
};
SegmentResult slide_on_segment(ShapeKind shape, double angle, double spacing);

// Block confined by rollers, loaded uniformly on its top: RMS error of the vertical stress over all points,
// relative.
enum class TopLoad { traction, pressure, velocity };
double press_block(ShapeKind shape, TopLoad load, double top_offset);

// Thick cylinder a = 1 m, b = 2 m in axisymmetry (plane strain along the axis) under pressure inside: RMS
// errors against Lame's solution, relative to the pressure and to the displacement of the inner face.
struct CylinderResult {
  double radial = 0, hoop = 0, axial = 0, displacement = 0;
};
CylinderResult press_cylinder(ShapeKind shape, bool cell_average, double spacing);

// Smooth rigid strip footing on weightless Tresca clay: bearing pressure over shear strength; exact 2 + pi
// (Prandtl 1921).
struct FootingResult {
  double factor = 0;         // mean over the last tenth of the push
  double initial_slope = 0;  // of factor against settlement, from the first tenth: elastic part [1/m]
  double last_slope = 0;     // over the last third
  double roughness =
      0;  // RMS difference of the mean stresses of the points of a cell from their mean, over strength
  long steps = 0;
  double wall = 0;  // [s]
};
struct FootingOptions {
  ShapeKind shape = ShapeKind::gimp;
  bool cell_average = true;
  int cells = 6;             // in half the footing's width, less half a cell: its edge lies between two nodes
  double settlement = 0.02;  // in half widths
  double rigidity = 2000;    // E / c
  double poisson = 0.49;
  double speed = 0.02;  // half widths a second
};
FootingResult push_footing(const FootingOptions& options);

}  // namespace polder::verify
