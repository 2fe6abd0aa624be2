// The shape of a body: what it contains, how far it reaches, what stands above a point.
#pragma once

#include <utility>
#include <vector>

#include "coupling/scene.hpp"

namespace polder::coupling {

class BodyShape {
 public:
  // dimension 2 or 3; the last axis is vertical.
  BodyShape(const Body& body, int dimension);

  bool inside(const Vector3& x) const;
  const Vector3& lower() const { return lower_; }
  const Vector3& upper() const { return upper_; }
  bool is_box() const { return body_.box.has_value(); }
  Vector3 centroid() const;

  // Stretches of the vertical line through x that lie inside, bottom up.
  std::vector<std::pair<double, double>> vertical_intervals(const Vector3& x) const;

 private:
  const Body& body_;
  int up_;  // vertical axis
  Vector3 lower_{}, upper_{};
};

// Height of a polyline y(x), x ascending; constant beyond its ends.
double height_at(const std::vector<Vector3>& polyline, double x);

}  // namespace polder::coupling
