// The cells that hold pore water and the faces between them: the mesh of the pressure equation.
//
// A cell is active when saturated soil fills at least kActiveFill of it. Its faces are
//   interior   to another active cell,
//   surface    to an inactive cell: the water ends at the distance theta h from the cell's centre, with
//              theta = min(fill_c, 1) + min(fill_e, 1) - 1/2 >= kActiveFill - 1/2, so that a surface moves
//              smoothly through the cells,
//   side       on a side of the grid, at h/2, where a boundary condition lets water through,
// and no face at all where a wall is. (A surface face that is named impermeable is kept, closed.) Cut cells
// by distance rather than by volume: Gibou et al. (2002), "A second-order accurate symmetric discretization
// of the Poisson equation on irregular domains", with one distance an axis.
//
// Areas and volumes are those of a unit thickness (plane strain, [m2] and [m3] per metre), of one radian
// about the axis x = 0 (axisymmetric) or plain (3D). Lists are rebuilt only when the mask, the grid's
// numbering or the geometry of the boundary conditions changes; the distances and boundary pressures are
// renewed every time.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/grid.hpp"
#include "fdm/water_conditions.hpp"

namespace polder::fdm {

// With the plain threshold 1/2 the surface may lie at the centre of its cell, theta -> 0. The pressure of
// such a cell is bound to zero while its gradient, the force on the nodes beyond, may take any value without
// an opposite force on the nodes below: the sliver then moves up and down with slowly growing amplitude. From
// 0.7 on theta is at least 0.2; and 0.7 is not a fill that whole particles of a lattice make (quarters,
// ninths, sixteenths), where rounding would decide.
inline constexpr double kActiveFill = 0.7;

// Nodes of a face: the 2 (2D) or 4 (3D) corners, as slots.
template <int D>
using FaceNodes = std::array<int, ipow(2, D - 1)>;

template <int D>
struct ActiveCell {
  int slot;
  Index<D> index;
  std::array<int, ipow(2, D)> nodes;  // corner slots, x fastest
  std::array<int, 2 * D> faces;       // face number at side 2 * axis + upper, -1 at a wall
  std::array<double, 2 * D> areas;    // of the sides, walls included [m2]
  double volume;                      // [m3]
};

// Between the active cells low and high, normal from low to high.
template <int D>
struct InteriorFace {
  int low, high;  // numbers of active cells
  int axis;
  FaceNodes<D> nodes;
  double area;  // [m2]
};

// Surface or side face of one active cell.
template <int D>
struct BoundaryFace {
  int cell;  // number of the active cell
  int axis;
  int outward;  // +1: the outward normal points along the axis, -1: against it
  FaceNodes<D> nodes;
  double area;        // [m2]
  int outside;        // slot of the inactive cell beyond, -1 if there is none
  int boundary;       // number of the boundary condition; -1: free surface without a name
  bool free_surface;  // where the soil ends inside the grid
  double distance;    // from the cell's centre to where the pressure is prescribed [m]
  double pressure;    // prescribed there [Pa]
  bool open;          // false: impermeable at present (above the level of its head)
};

template <int D>
class WaterCells {
 public:
  WaterCells(const Grid<D>& grid, Space space);

  // fill: volume fraction of water-saturated soil in each cell (slots; may exceed 1). Conditions are those at
  // the end of the step. A cell whose corner nodes are not all stored stays inactive. Returns true if the
  // lists were rebuilt.
  bool update(std::span<const double> fill, const WaterConditions<D>& conditions);

  // Horizontal distances to surfaces that are but slightly inclined are measured along themselves (see
  // surface_distance in the source): for water that flows freely. Off by default.
  void set_inclined_surfaces(bool on) { inclined_surfaces_ = on; }

  const Grid<D>& grid() const { return grid_; }
  Space space() const { return space_; }
  const WaterConditions<D>& conditions() const { return conditions_; }
  std::uint64_t revision() const { return revision_; }  // counts the rebuilds

  int count() const { return static_cast<int>(cells_.size()); }
  bool active(int slot) const { return number_[slot] >= 0; }
  int number(int slot) const { return number_[slot]; }  // number of the active cell in a slot, -1 if inactive

  // Face numbers: interior faces first, then boundary faces in the order of boundary_faces().
  std::span<const ActiveCell<D>> cells() const { return cells_; }
  std::span<const InteriorFace<D>> interior_faces() const { return interior_; }
  std::span<const BoundaryFace<D>> boundary_faces() const { return boundary_; }

  Point<D> centre(const Index<D>& cell) const;
  // Whether the soil may end on this side of the grid as at its free surface, there where the cell touches
  // it.
  bool is_open_surface(const Index<D>& cell, int side) const;

 private:
  void rebuild();
  double face_area(const Index<D>& cell, int axis, bool upper) const;
  void add_boundary_face(int cell, int axis, bool upper, int outside, int boundary, bool free_surface);
  int boundary_at(const Index<D>& cell, int side) const;
  int surface_boundary_at(const Index<D>& cell, int axis, bool upper) const;
  void refresh_distances(std::span<const double> fill);

  const Grid<D>& grid_;
  Space space_;
  WaterConditions<D> conditions_;
  std::uint64_t grid_revision_ = 0;
  std::uint64_t revision_ = 0;
  bool inclined_surfaces_ = false;
  std::vector<unsigned char> eligible_;  // slots that are cells with all corner nodes stored
  std::vector<unsigned char> mask_;      // the mask the lists were built for
  std::vector<int> number_;
  std::vector<ActiveCell<D>> cells_;
  std::vector<InteriorFace<D>> interior_;
  std::vector<BoundaryFace<D>> boundary_;
};

extern template class WaterCells<2>;
extern template class WaterCells<3>;

}  // namespace polder::fdm
