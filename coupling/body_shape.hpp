// The shape of a body: what it contains, how far it reaches, what stands above a point.
#pragma once

#include <utility>
#include <vector>

#include "coupling/scene.hpp"

namespace polder::coupling {

class BodyShape {
 public:
  // The last axis of the grid is vertical.
  BodyShape(const Body& body, const GridSpec& grid);

  bool inside(const Vector3& x) const;
  const Vector3& lower() const { return lower_; }
  const Vector3& upper() const { return upper_; }
  // Axes along which the body ends at lower() and upper() everywhere: all of a box, the length of a prism.
  bool is_flat(int axis) const { return body_.box || (prism() && axis == 1); }
  Vector3 centroid() const;

  // Stretches of the vertical line through x that lie inside, bottom up.
  std::vector<std::pair<double, double>> vertical_intervals(const Vector3& x) const;

 private:
  bool prism() const { return up_ == 2 && !body_.polygon.empty(); }

  const Body& body_;
  int up_;  // vertical axis
  Vector3 lower_{}, upper_{};
};

// Height of a polyline y(x), x ascending; constant beyond its ends.
double height_at(const std::vector<Vector3>& polyline, double x);

}  // namespace polder::coupling
