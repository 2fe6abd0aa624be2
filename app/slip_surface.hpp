// The slip surface of a plane slope that fails, from the displacements of its points: the line along which
// the displacement is half of what the moving mass makes, prolonged to the ground at both ends.
//
// Points are averaged in the cells of the grid, so the line is sharp to about half a cell. 2D; lengths in
// metres.
#pragma once

#include <array>
#include <span>
#include <vector>

namespace polder::app {

struct SlipSurface {
  std::vector<std::array<double, 2>> line;  // from the upper end to the lower; empty: nothing moves
  double displacement = 0;                  // of the moving mass, median [m]
  double area = 0;                          // of the moving mass, in the plane [m2]
};

// positions: three numbers a point; displacement: its magnitude; area: of the point in the plane.
SlipSurface find_slip_surface(std::span<const double> positions, std::span<const double> displacement,
                              std::span<const double> area, double cell);

}  // namespace polder::app
