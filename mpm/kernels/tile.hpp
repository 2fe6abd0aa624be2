// Helpers of the particle kernels: stencils in tile coordinates, tiles of node fields.
#pragma once

#include <cstring>

#include "core/simd.hpp"
#include "mpm/stencil.hpp"
#include "mpm/transfer.hpp"

namespace polder::POLDER_SIMD_NAMESPACE {

// Geometry of one block as its kernels need it.
template <int D>
struct BlockFrame {
  double origin[D];   // of the grid [m]
  double inverse_h;   // [1/m]
  int first_node[D];  // tile node 0, in grid nodes
  int last_node[D];   // of the grid
  int first, count;   // particle range

  BlockFrame(const Grid<D>& grid, int block) : inverse_h(1 / grid.spacing()) {
    const Index<D> o = grid.block_origin(block);
    for (int d = 0; d < D; ++d)
      origin[d] = grid.origin()[d], first_node[d] = o[d] - 1, last_node[d] = grid.cells()[d];
  }
};

template <int D>
struct TileStencil {
  AxisStencil axis[D];
  Mask start;  // tile index of the first node of the stencil

  POLDER_INLINE void set(const BlockFrame<D>& frame, mpm::ShapeKind shape, const Pack* position,
                         const Pack* half_size) {
    constexpr int kSide = mpm::Transfer<D>::kTileSide;
    start = Mask{};
    for (int d = D - 1; d >= 0; --d) {
      axis_stencil(shape, (position[d] - frame.origin[d]) * frame.inverse_h, half_size[d] * frame.inverse_h,
                   frame.last_node[d], axis[d]);
      start = start * kSide + (axis[d].base - frame.first_node[d]);
    }
  }
  // Distance of stencil node `a` from the particle along axis d [m].
  POLDER_INLINE Pack distance(const BlockFrame<D>& frame, int d, int a, Pack position, double h) const {
    return (to_real(axis[d].base) + double(a)) * h + frame.origin[d] - position;
  }
};

// Copy a node field with kWidth numbers a node (of which `stride` are stored side by side in the tile at
// `offset`) from the grid into a tile. Nodes that are not stored read as zero.
template <int D, int kWidth, int kStride>
void load_tile(const Grid<D>& grid, int block, const double* field, double* tile) {
  constexpr int kSide = Grid<D>::kSide, kTile = mpm::Transfer<D>::kTileSide;
  const auto& neighbours = grid.neighbours(block);
  for (int k = 0; k < Grid<D>::kNeighbours; ++k) {
    const int n = neighbours[k];
    const int shift[3] = {k % 3 - 1, k / 3 % 3 - 1, D == 3 ? k / 9 - 1 : 0};
    int lo[3] = {0, 0, 0}, hi[3] = {1, 1, 1}, to[3] = {0, 0, 0};
    for (int d = 0; d < D;
         ++d) {  // part of the neighbour that the tile covers: nodes [-1, kSide + 3) of this block
      lo[d] = shift[d] < 0 ? kSide - 1 : 0;
      hi[d] = shift[d] > 0 ? 3 : kSide;
      to[d] = shift[d] * kSide + 1;
    }
    for (int z = lo[2]; z < hi[2]; ++z)
      for (int y = lo[1]; y < hi[1]; ++y) {
        double* out =
            tile + (((D == 3 ? (z + to[2]) * kTile : 0) + y + to[1]) * kTile + lo[0] + to[0]) * kStride;
        const double* in = field + (static_cast<std::size_t>(n < 0 ? 0 : n) * Grid<D>::kCells +
                                    ((D == 3 ? z * kSide : 0) + y) * kSide + lo[0]) *
                                       kWidth;
        using Node = Reg<(kWidth < kStride ? kWidth : kStride)>;
        if (n < 0)
          for (int x = 0; x < hi[0] - lo[0]; ++x) Node::zero().store(out + x * kStride);
        else
          for (int x = 0; x < hi[0] - lo[0]; ++x) Node::load(in + x * kWidth).store(out + x * kStride);
      }
  }
}

// Work of the occupied blocks for parallel_for_work: particles, and what a tile costs in particles.
template <int D>
std::vector<long> work_of_blocks(const mpm::Transfer<D>& transfer) {
  constexpr long kTileWork = mpm::Transfer<D>::kTileNodes / 8;
  std::vector<long> before(transfer.grid->occupied_blocks() + 1, 0);
  for (int b = 0; b < transfer.grid->occupied_blocks(); ++b) {
    before[b + 1] = before[b] + kTileWork;
    for (const mpm::Body<D>& body : transfer.bodies) before[b + 1] += body.particles->ranges[b].count;
  }
  return before;
}

}  // namespace polder::POLDER_SIMD_NAMESPACE
