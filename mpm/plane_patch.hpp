// A plane polygon in space: the part of a surface on which a boundary or a load acts in 3D.
//
// The corners run counter-clockwise seen from the soil, so the normal by the right-hand rule points into it.
// Plane coordinates (u, v) are measured from the first corner, u along the first edge. Lengths in metres.
#pragma once

#include <vector>

#include "core/grid.hpp"

namespace polder::mpm {

class PlanePatch {
 public:
  // At least three corners that enclose an area. Corners off the common plane are projected onto it.
  explicit PlanePatch(const std::vector<Point<3>>& corners);

  const Point<3>& normal() const { return normal_; }
  const std::vector<Point<2>>& corners() const { return corners_; }
  double area() const;

  Point<2> project(const Point<3>& x) const;
  // Distance from the plane, positive on the soil's side.
  double height(const Point<3>& x) const;
  Point<3> position(const Point<2>& uv) const;
  // Inside the outline, or no farther than `tolerance` [m] from it.
  bool contains(const Point<2>& uv, double tolerance) const;

 private:
  Point<3> origin_, normal_;
  std::array<Point<3>, 2> axes_;
  std::vector<Point<2>> corners_;
};

// Vector area of a closed polygon in space, plane or not: 1/2 sum x_i x x_(i+1). It depends on the outline
// only.
Point<3> vector_area(const std::vector<Point<3>>& corners);

// The polygon cut into pieces no larger than `size` along u and v: the cells of a lattice, as many as fit the
// extent of the polygon, cut off at its edges. A rectangle becomes equal rectangles.
struct PatchPieces {
  std::vector<Point<2>> vertices;        // shared by the pieces that meet there
  std::vector<std::vector<int>> pieces;  // vertices of each, counter-clockwise
};
PatchPieces cut_patch(const std::vector<Point<2>>& polygon, double size);

}  // namespace polder::mpm
