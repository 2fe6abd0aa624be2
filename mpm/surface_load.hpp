// Tractions and pressures on a material surface.
//
// The loaded surface is a line of pieces in 2D (plane strain, axisymmetric) and a patch of plane polygons,
// mostly quadrilaterals, in 3D, whose vertices move with the material. Every piece carries its force at its
// middle to the grid, at the surface itself and not at the centres of the particles below it. A pressure acts
// along the present normal on the present area (a follower load); a traction acts in its own direction on the
// initial area. A deformed quadrilateral is not plane: its pressure acts on its vector area, which depends on
// its outline only, so the pieces together carry exactly the pressure times the vector area of the whole
// surface.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "core/grid.hpp"
#include "mpm/shape_kind.hpp"

namespace polder::mpm {

template <int D>
class SurfaceLoad {
 public:
  // pieces: the vertices of each; two with the material to the left (2D), or a polygon counter-clockwise seen
  // from the material (3D).
  SurfaceLoad(std::string name, std::vector<Point<D>> vertices, const std::vector<std::vector<int>>& pieces,
              Space space);

  std::string name;
  std::function<double(double)> pressure;  // [Pa] at time t, compression positive; may be empty
  std::array<std::function<double(double)>, D> traction;  // [Pa] at time t; may be empty

  // Add the load's nodal forces to the force lanes of sums (stride 8), whose first lane is the nodes' mass.
  // Pieces that no soil lies under carry nothing. Returns the total force.
  Point<D> apply(const Grid<D>& grid, ShapeKind shape, double time, Reals& sums) const;
  // Move the vertices with the velocities v (stride 4) of the nodes that have mass.
  void move(const Grid<D>& grid, ShapeKind shape, double dt, const Reals& v, const Reals& sums);

  int pieces() const { return static_cast<int>(piece_area_.size()); }
  std::vector<Point<D>>& vertices() { return vertices_; }
  const std::vector<Point<D>>& vertices() const { return vertices_; }

 private:
  std::vector<Point<D>> vertices_;
  std::vector<int> corners_;        // vertices of all pieces, one piece after the other
  std::vector<int> first_;          // of a piece in corners_; one more entry than pieces
  std::vector<double> piece_area_;  // initial length (2D) or area (3D)
  Space space_;
};

// Load on the segment from -> to with the material to its left, in pieces of at most `piece` [m].
SurfaceLoad<2> line_load(std::string name, const Point<2>& from, const Point<2>& to, double piece,
                         Space space);
// Load on a plane polygon, its corners counter-clockwise seen from the material, in pieces of at most `piece`
// [m] along and across its first edge.
SurfaceLoad<3> patch_load(std::string name, const std::vector<Point<3>>& corners, double piece);

extern template class SurfaceLoad<2>;
extern template class SurfaceLoad<3>;

}  // namespace polder::mpm
