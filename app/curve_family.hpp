// Differences between curves, and the discretisation error that a family of them tells.
//
// A trace is what a run has measured: a curve over time for each stage, from its start, or over a coordinate
// for each of some times. Two runs are compared over what a curve has in both; curves count alike, as the ten
// seconds of a slide do beside the days of seepage before it.
//
// Error of the finest of a family by Richardson's extrapolation (Richardson 1911; Roache 1994): with curves
// f1, f2 of the two finest sizes h1 < h2, |f1 - f| = |f2 - f1| / ((h2 / h1)^p - 1). The order p is observed
// from the three finest, |f3 - f2| / |f2 - f1| = (h3^p - h2^p) / (h2^p - h1^p), and used between 0.5 and 2;
// with two it is taken as 1. Where the differences do not fall with the size the larger one is the error.
#pragma once

#include <limits>
#include <span>
#include <vector>

#include "app/measured.hpp"

namespace polder::app {

using Trace = std::vector<Curve>;

// In the unit of the curves. NaN: no time in common.
struct CurveDifference {
  double l2 = std::numeric_limits<double>::quiet_NaN();   // root of the mean square
  double max = std::numeric_limits<double>::quiet_NaN();  // largest magnitude
  double max_at = 0;  // where: as if the curves followed each other, since the start of the first [s]
  std::size_t max_curve = 0;
};

// Both piecewise linear. Where one of them has no number (NaN) there is nothing to compare.
CurveDifference difference(const Trace& a, const Trace& b);

struct Extremes {
  double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();
  double range() const { return high > low ? high - low : 0.0; }
};
void extend(Extremes& extremes, const Trace& trace);

// Of the finest member.
struct FamilyError {
  int members = 1;  // 1: not known
  double l2 = std::numeric_limits<double>::quiet_NaN(), max = std::numeric_limits<double>::quiet_NaN();
  double order = std::numeric_limits<double>::quiet_NaN();  // observed; NaN with fewer than three
  bool converges = true;                                    // the differences fall with the size
  bool known() const { return members > 1; }
};

// Sizes (of cells or steps) from coarse to fine, and a trace for each.
FamilyError family_error(std::span<const double> sizes, std::span<const Trace> traces);

// Orders are sought between this and its negative; beyond them is noise.
inline constexpr double kMostOrderSought = 8;

// The order p for which differences fall as those between three sizes from coarse to fine; NaN where one of
// the differences is 0.
double observed_order(double coarse_difference, double fine_difference, double h_coarse, double h_middle,
                      double h_fine);

}  // namespace polder::app
