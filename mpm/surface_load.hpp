// Tractions and pressures on a material surface (2D: plane strain, axisymmetric).
//
// The loaded surface is a polyline whose vertices move with the material. Every piece between two vertices
// carries its force at its middle to the grid, at the surface itself and not at the centres of the particles
// below it. A pressure acts along the present normal on the present length (a follower load); a traction acts
// in its own direction on the initial length.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "core/grid.hpp"
#include "mpm/shape_kind.hpp"

namespace polder::mpm {

class SurfaceLoad {
 public:
  // Surface from -> to with the material to its left, in pieces of at most `piece` [m].
  SurfaceLoad(std::string name, Point<2> from, Point<2> to, double piece, Space space);

  std::string name;
  std::function<double(double)> pressure;  // [Pa] at time t, compression positive; may be empty
  std::array<std::function<double(double)>, 2> traction;  // [Pa] at time t; may be empty

  // Add the load's nodal forces to sums (stride 8, force lanes). Returns the total force.
  Point<2> apply(const Grid<2>& grid, ShapeKind shape, double time, Reals& sums) const;
  // Move the vertices with the nodal velocities v (stride 4).
  void move(const Grid<2>& grid, ShapeKind shape, double dt, const Reals& v);

  std::vector<Point<2>>& vertices() { return vertices_; }
  const std::vector<Point<2>>& vertices() const { return vertices_; }

 private:
  std::vector<Point<2>> vertices_;
  double piece_length_;  // initial
  Space space_;
};

}  // namespace polder::mpm
