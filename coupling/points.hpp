// Between the scene's points, which always have three components, and those of one dimension.
#pragma once

#include "core/grid.hpp"
#include "coupling/scene.hpp"

namespace polder::coupling {

template <int D>
Point<D> point(const Vector3& v) {
  Point<D> p;
  for (int d = 0; d < D; ++d) p[d] = v[d];
  return p;
}

template <int D>
Vector3 vector3(const Point<D>& p) {
  Vector3 v{};
  for (int d = 0; d < D; ++d) v[d] = p[d];
  return v;
}

}  // namespace polder::coupling
