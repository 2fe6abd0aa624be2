// Gradient of a cell field (the pore pressure or its increment) at the grid's nodes.
//
// First the gradient normal to every face of WaterCells: interior (p_high - p_low) / h; boundary faces from
// the prescribed pressure at its distance. A face one layer outside the surface copies the gradient of the
// surface face before it (the mean where it lies outside two surfaces), so that soil in the sliver beyond the
// surface, too thin for an active cell, is carried by the pressure as well. Then, for each axis, a node takes
// the mean over the faces normal to that axis which meet in it and have a value; faces without one (walls)
// are left out, not counted as zero.
//
// At a wall the normal component is thus zero: the wall's reaction balances it. With WallNormal::inward the
// wall face copies the opposite face of its cell instead; that is the gradient which the effective normal
// force (Coulomb friction) needs.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/grid.hpp"
#include "fdm/water_cells.hpp"

namespace polder::fdm {

enum class BoundaryValues {
  present,      // the prescribed pressures: gradient of the total pore pressure
  homogeneous,  // zero where pressure is prescribed: gradient of an increment
};
enum class WallNormal { none, inward };

template <int D>
class NodeGradient {
 public:
  static constexpr int kStride =
      4;  // values a slot in nodal vector arrays; components D .. 3 are written as zero

  // Rebuilds the lists after WaterCells::update has returned true.
  void build(const WaterCells<D>& cells);

  // field: value of each cell (slots); out: slots * kStride, [field unit / m], zero away from water.
  void evaluate(const WaterCells<D>& cells, std::span<const double> field, BoundaryValues values,
                WallNormal walls, std::span<double> out) {
    evaluate(cells, cells.boundary_faces(), field, values, walls, out);
  }
  // The same with other pressures at the boundary faces, and others of them open.
  void evaluate(const WaterCells<D>& cells, std::span<const BoundaryFace<D>> boundary,
                std::span<const double> field, BoundaryValues values, WallNormal walls,
                std::span<double> out);

 private:
  static constexpr int kMeeting = ipow(2, D - 1);  // faces of one axis that meet in a node
  struct Node {
    std::array<std::array<int, kMeeting>, D> faces;  // numbers into gradient_, unused: the empty face
  };
  // A face that copies others: extensions beyond the surface, walls and closed boundaries.
  struct Copy {
    int first, second;  // sources (equal if there is one only)
  };

  std::vector<Node> nodes_;
  std::vector<int> node_at_;  // of each slot, -1: away from water
  std::vector<Copy> extensions_;
  std::vector<Copy> walls_;
  std::vector<int> opposite_;     // of each boundary face: the face on the other side of its cell
  std::vector<double> gradient_;  // interior, boundary, extension and wall faces, then the empty face
  std::vector<double> weight_;    // 1 where the face has a value, else 0
};

extern template class NodeGradient<2>;
extern template class NodeGradient<3>;

}  // namespace polder::fdm
