// Helpers of the particle kernels: stencils in tile coordinates, tiles of node fields.
#pragma once

#include <array>
#include <cstring>
#include <type_traits>

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

// What a tile holds of a node or cell: kWidth numbers, or a single one.
template <int kWidth>
using TileValue = std::conditional_t<kWidth == 1, double, Reg<kWidth == 1 ? 2 : kWidth>>;

template <int kWidth>
POLDER_INLINE TileValue<kWidth> load_value(const double* p) {
  if constexpr (kWidth == 1)
    return *p;
  else
    return Reg<kWidth>::load(p);
}
template <int kWidth>
POLDER_INLINE void store_value(double* p, const TileValue<kWidth>& value) {
  if constexpr (kWidth == 1)
    *p = value;
  else
    value.store(p);
}

// Fields of particles are many streams, more than processors foresee: what comes kAhead packs later is asked
// for by hand, a cache line a field.
inline constexpr int kAhead = 8;

POLDER_INLINE void fetch_ahead(int p, const Reals& field) {
  if (!field.empty()) __builtin_prefetch(field.data() + p + kAhead * kLanes);
}
template <class Fields>
POLDER_INLINE void fetch_ahead(int p, const Fields& fields) {
  for (const Reals& field : fields) fetch_ahead(p, field);
}
template <class... Fields>
POLDER_INLINE void fetch_ahead(int p, const Fields&... fields) {
  (fetch_ahead(p, fields), ...);
}

// Copies nodal velocities (mpm::Transfer::kVector numbers a node) into a tile, side by side where there are
// two: {ax, ay, bx, by} or {ax, ay, az, -, bx, by, bz, -} a node. Nodes that are not stored read as zero.
template <int D, int kFields>
void load_tile(const Grid<D>& grid, int block, const std::array<const double*, kFields>& fields,
               double* tile) {
  constexpr int kSide = Grid<D>::kSide, kTile = mpm::Transfer<D>::kTileSide;
  constexpr int kIn = mpm::Transfer<D>::kVector, kLanesOut = D == 2 ? 2 : 4, kOut = kLanesOut * kFields;
  using Node = Reg<kLanesOut>;
  const auto& neighbours = grid.neighbours(block);
  // A row of the tile: the last node of the block before, this block's, three of the one behind.
  const auto copy = [&](int neighbour, int first, int count, double* out) __attribute__((always_inline)) {
    if (neighbour < 0) {
      for (int x = 0; x < count * kFields; ++x) Node::zero().store(out + x * kLanesOut);
      return;
    }
    const std::size_t in = (static_cast<std::size_t>(neighbour) * Grid<D>::kCells + first) * kIn;
    for (int x = 0; x < count; ++x)
      for (int f = 0; f < kFields; ++f)
        Node::load(fields[f] + in + x * kIn).store(out + x * kOut + f * kLanesOut);
  };
  for (int z = D == 3 ? -1 : 0; z < (D == 3 ? kSide + 3 : 1); ++z)
    for (int y = -1; y < kSide + 3; ++y) {
      const int by = y < 0 ? 0 : y < kSide ? 1 : 2, bz = z < 0 ? 0 : z < kSide ? 1 : 2;
      const int* of_row = &neighbours[(D == 3 ? bz * 9 : 0) + by * 3];
      const int first = ((D == 3 ? (z + kSide) % kSide * kSide : 0) + (y + kSide) % kSide) * kSide;
      double* out = tile + ((D == 3 ? (z + 1) * kTile : 0) + y + 1) * kTile * kOut;
      copy(of_row[0], first + kSide - 1, 1, out);
      copy(of_row[1], first, kSide, out + kOut);
      copy(of_row[2], first, 3, out + (kSide + 1) * kOut);
    }
}

// Copies what a sleeping block gives to its tile; false where it is awake, or has not been computed yet.
inline bool take_kept(const Reals& kept, double* tile) {
  if (kept.empty()) return false;
  std::memcpy(tile, kept.data(), sizeof(double) * kept.size());
  return true;
}

// Work of the occupied blocks for parallel_for_work: particles, and what a tile costs in particles.
// Work space of the calling thread: good until it asks again.
template <int D>
const std::vector<long>& work_of_blocks(const mpm::Transfer<D>& transfer) {
  constexpr long kTileWork = mpm::Transfer<D>::kTileNodes / 8;
  thread_local std::vector<long> before;
  before.assign(transfer.grid->occupied_blocks() + 1, 0);
  for (int b = 0; b < transfer.grid->occupied_blocks(); ++b) {
    before[b + 1] = before[b] + kTileWork;
    if (transfer.asleep(b)) continue;
    for (const mpm::Body<D>& body : transfer.bodies) before[b + 1] += body.particles->ranges[b].count;
  }
  return before;
}

}  // namespace polder::POLDER_SIMD_NAMESPACE
