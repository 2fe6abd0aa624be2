// Elastic column at rest under its own weight, confined sideways: vertical stress against the exact state.
//
// The weight above a material point does not change while the column settles, so sigma_yy = -rho0 g (H - Y)
// at the reference height Y whatever the stress law (Bardenhagen & Kober 2004). With nu = 0 and the rate law
// the stretch is exp(sigma / E), which gives the settlement of the top.
#pragma once

#include "tests/verify/mpm_scene.hpp"

namespace polder::verify {

struct ColumnResult {
  double rms = 0;               // of the error of sigma_yy over all points, as a share of rho g H
  double recovered_rms = 0;     // of the stresses recovered from the means over cells
  double recovered_bottom = 0;  // largest error of those in the lowest cell
  double cell_rms = 0;          // the same of the means over the points that started in one cell
  double worst = 0, where = 0;  // largest error of a point and its reference height [m]
  double bottom = 0;            // largest error of the points in the lowest cell
  double settlement_error =
      0;  // of the highest points, as a share of the exact value (of the height if that is 0)
  double reaction_error = 0;  // of the base, as a share of the weight
  double unbalanced = 0;      // out-of-balance force at the end, as a share of the load
  long steps = 0;
};

struct ColumnOptions {
  ShapeKind shape = ShapeKind::gimp;
  bool cell_average = false;
  double spacing = 0.05;
  double height = 1.0;
  double young = 1e6;
  Space space = Space::plane_strain;
  bool three_d = false;
  bool from_exact_stress =
      false;  // start from the exact stress in the undeformed shape instead of zero stress
};

ColumnResult settle_column(const ColumnOptions& options);

}  // namespace polder::verify
