// Demands on Terzaghi's consolidation that the quick and the long tests make of different columns.
#pragma once

#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

#include "tests/verify/one_layer_consolidation.hpp"

namespace polder::verify {

inline constexpr ShapeKind kShapes[] = {ShapeKind::gimp, ShapeKind::quadratic_bspline};

inline std::string name_of(ShapeKind shape) {
  return shape == ShapeKind::gimp ? "GIMP" : "B-spline";
}

// Ten cells, water of 2.2 GPa: the step is the skeleton wave's, whatever the conductivity.
inline void check_ten_cells(ShapeKind shape, double conductivity) {
  CAPTURE(name_of(shape));
  CAPTURE(conductivity);
  const Consolidation r = terzaghi({.shape = shape, .conductivity = conductivity}, {0.05, 0.2, 0.5});
  CHECK(r.pressure_error[0] <= 0.008);
  CHECK(r.pressure_error[1] <= 0.004);
  CHECK(r.pressure_error[2] <= 0.002);
  CHECK(r.settlement_ratio == doctest::Approx(1).epsilon(0.003));
  CHECK(r.step == doctest::Approx(0.5 * 0.1 / std::sqrt(1e8 / 9 / 1990)).epsilon(2e-3));
}

// Orders of convergence of Terzaghi's pressure between halved cells. k = 1e-4 m/s: for more the column's
// inertia, which consolidation theory leaves out, is an error that no grid removes. 100 Pa: at 10 kPa the
// strain, 0.1 %, is another.
inline void check_order(const std::vector<double>& cells) {
  for (const ShapeKind shape : kShapes) {
    CAPTURE(name_of(shape));
    std::vector<double> before;
    for (const double h : cells) {
      const Consolidation r =
          terzaghi({.cell = h, .shape = shape, .conductivity = 1e-4}, {0.05, 0.2, 0.5}, 100);
      CAPTURE(h);
      for (std::size_t i = 0; i < before.size(); ++i)
        CHECK(std::log2(before[i] / r.pressure_error[i]) >= 1.5);
      before = r.pressure_error;
    }
  }
}

// Errors of a consolidation on grids of which each has half the cell of the one before: bounds of the last at
// each time, and order over the whole range.
inline void check_series(const std::vector<Consolidation>& runs, const std::vector<double>& bounds,
                         double order) {
  for (std::size_t i = 0; i < bounds.size(); ++i) {
    CAPTURE(i);
    const double first = runs.front().pressure_error[i], last = runs.back().pressure_error[i];
    CHECK(last < bounds[i]);
    CHECK(std::log2(first / last) / static_cast<double>(runs.size() - 1) >= order);
  }
}

}  // namespace polder::verify
