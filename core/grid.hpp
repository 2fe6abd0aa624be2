// The background grid: a uniform box of square or cubic cells, stored in blocks only where something is.
//
// A block is kSide^D cells. Cell (i, j, k) covers [i, i+1) h x [j, j+1) h ... from the origin; node (i, j, k)
// is its lower corner. One *slot* addresses both: slot = block * kCells + local, local = (k * kSide + j) *
// kSide + i inside the block. Every array over cells or nodes has slots() entries (times components). Blocks
// that hold particles come first, in lexicographic order, then their neighbours; so a particle's whole
// stencil is always stored.
//
// When the set of blocks changes, revision() changes and carry() moves a field to the new numbering.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/aligned.hpp"

namespace polder {

constexpr int ipow(int base, int exponent) {
  return exponent == 0 ? 1 : base * ipow(base, exponent - 1);
}

// Geometry of the plane: 2D grids carry a unit thickness (plane strain) or one radian about the axis x = 0.
enum class Space { plane_strain, axisymmetric, three_d };

template <int D>
using Point = std::array<double, D>;
template <int D>
using Index = std::array<int, D>;

template <int D>
class Grid {
 public:
  static constexpr int kSide = D == 2 ? 8 : 4;
  static constexpr int kCells = ipow(kSide, D);
  static constexpr int kNeighbours = ipow(3, D);

  // origin: lower corner [m]; cells: number along each axis; spacing h [m].
  Grid(Point<D> origin, Index<D> cells, double spacing);

  const Point<D>& origin() const { return origin_; }
  const Index<D>& cells() const { return cells_; }
  double spacing() const { return spacing_; }
  Point<D> upper() const;

  // Store exactly the blocks of `occupied` (linear block numbers, any order, repeats allowed) and their
  // neighbours. Returns true if the numbering of slots changed.
  bool activate(std::vector<int> occupied);

  int occupied_blocks() const { return occupied_; }  // blocks 0 .. occupied_blocks()-1 hold particles
  int blocks() const { return static_cast<int>(block_index_.size()); }
  int slots() const { return blocks() * kCells; }
  std::uint64_t revision() const { return revision_; }

  // Linear block number of a cell (may be outside the stored set); the cell must lie in the box.
  int block_number(const Index<D>& cell) const;
  int block_numbers() const;  // size of the range of block_number
  // Stored block of a linear block number, -1 if it is not stored.
  int stored_block(int number) const { return stored_[number]; }
  const Index<D>& block_index(int block) const { return block_index_[block]; }  // in blocks
  Index<D> block_origin(int block) const;                                       // in cells
  // The 3^D neighbours of a block (itself in the middle), x fastest; -1 where nothing is stored.
  const std::array<int, kNeighbours>& neighbours(int block) const { return neighbours_[block]; }

  // Slot of a cell or node; -1 if it is outside the box's nodes or not stored.
  int slot(const Index<D>& index) const;
  Index<D> index(int slot) const;
  bool is_cell(const Index<D>& index) const;  // nodes on the upper sides are not cells
  Point<D> position(const Index<D>& node) const;

  // Move a field of `components` values a slot from the numbering before the last change to the present one;
  // new slots get `fill`.
  void carry(Reals& field, int components = 1, double fill = 0) const;

 private:
  Point<D> origin_;
  Index<D> cells_;
  double spacing_;
  Index<D> block_count_;  // along each axis, covering all nodes
  int occupied_ = 0;
  std::uint64_t revision_ = 0;
  std::vector<Index<D>> block_index_;
  std::vector<std::array<int, kNeighbours>> neighbours_;
  std::vector<int> stored_;    // linear block number -> stored block
  std::vector<int> previous_;  // stored block -> stored block before the last change, -1 if new
};

extern template class Grid<2>;
extern template class Grid<3>;

}  // namespace polder
