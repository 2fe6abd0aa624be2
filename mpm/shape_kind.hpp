// The shape functions a case can choose.
#pragma once

namespace polder::mpm {

enum class ShapeKind {
  linear,            // Sulsky et al. 1994
  gimp,              // Bardenhagen & Kober 2004, particle domains tracked along the axes
  quadratic_bspline  // Steffen et al. 2008, modified at the grid's sides to stay complete and interpolatory
                     // there
};

}  // namespace polder::mpm
