// Collapse of a dry granular column against a wall, plane strain: run-out, height, and whether every point
// stays sane.
#pragma once

#include "tests/verify/mpm_scene.hpp"

namespace polder::verify {

struct CollapseOptions {
  ShapeKind shape = ShapeKind::gimp;
  bool musl = true;
  AffineKind affine = AffineKind::none;
  bool cell_average = true;
  double flip = 0.98;
  double courant = 0.5;   // step = courant h / c
  double aspect = 1;      // H0 / L0
  double width = 0.1;     // L0 [m]
  int cells_across = 10;  // cells over L0
  double friction = 30;   // of the material, degrees
  double base = 0.5;      // coefficient at the base; < 0: fixed
  double cohesion = 0;    // [Pa]
  double young = 1e6;     // [Pa]
  double duration = 6;    // in units of sqrt(H0 / g)
};

struct CollapseResult {
  double runout = 0;         // (L - L0) / L0, front of the connected mass (all but the foremost 1 %)
  double front = 0;          // the same for the foremost point
  double height = 0;         // H / L0 at the wall
  double fastest = 0;        // largest speed ever, as a share of sqrt(2 g H0)
  double volume_change = 0;  // of all points, relative
  double kinetic = 0;        // at the end, as a share of the potential energy at the start
  int lost = 0;              // points outside the grid or not finite
  long steps = 0;
  double wall = 0;  // [s]
};

CollapseResult collapse(const CollapseOptions& options);

}  // namespace polder::verify
