// A mobilised parameter in the form the kernels read: fixed size, no allocation, safe at every vector level.
#pragma once

#include "mpm/material/parameters.hpp"

namespace polder::mpm {

inline constexpr int kMaxKnots = 16;  // of a piecewise linear curve

struct Curve {
  enum class Kind { constant, piecewise_linear, exponential };
  Kind kind = Kind::constant;
  int knots = 0;  // piecewise linear
  double strain[kMaxKnots] = {};
  double value[kMaxKnots] = {};
  double slope[kMaxKnots] = {};   // between knot i and i + 1; beyond the last knot 0
  double start = 0;               // value at kappa = 0, and everywhere for a constant
  double residual = 0, rate = 0;  // exponential: residual + (start - residual) exp(-rate kappa)
  double lowest = 0, highest = 0;

  bool varies() const { return kind != Kind::constant; }
};

// Curves that do not vary come out as constants. Expects parameters that pass check_parameters().
Curve compile_curve(const Mobilised& parameter);

}  // namespace polder::mpm
