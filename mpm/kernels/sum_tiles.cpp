// Nodes: sum of the private tiles that reach them, in fixed order; and while a row's sums are in registers
// the velocities.
#include "core/threads.hpp"
#include "mpm/kernels/tile.hpp"

namespace polder::POLDER_SIMD_NAMESPACE {
namespace {

// A row of a block's nodes from the tiles of the three blocks side by side whose row `of_row` (in their own
// nodes, from the tile's first) lies there; -1 or a block of the halo has no tile.
template <int D, int kWidth>
POLDER_INLINE void add_row(const mpm::Transfer<D>& transfer, const int* blocks, int of_row,
                           TileValue<kWidth> (&row)[Grid<D>::kSide]) {
  constexpr int kSide = Grid<D>::kSide, kTile = mpm::Transfer<D>::kTileSide;
  const auto tile_row = [&](int block) -> const double* {
    if (block < 0 || block >= transfer.grid->occupied_blocks()) return nullptr;
    return transfer.tiles.data() +
           (static_cast<std::size_t>(block) * mpm::Transfer<D>::kTileNodes + of_row * kTile) * kWidth;
  };
  // A tile covers nodes [-1, kSide + 3) of its block.
  if (const double* before = tile_row(blocks[0]))
    for (int x = 0; x < 3; ++x) row[x] += load_value<kWidth>(before + (x + 1 + kSide) * kWidth);
  if (const double* own = tile_row(blocks[1]))
    for (int x = 0; x < kSide; ++x) row[x] += load_value<kWidth>(own + (x + 1) * kWidth);
  if (const double* behind = tile_row(blocks[2])) row[kSide - 1] += load_value<kWidth>(behind);
}

// put(slot, row): what becomes of the sums of a row of nodes, the first of them `slot`.
template <int D, int kWidth, class Put>
void sum_width(const mpm::Transfer<D>& transfer, const Put& put) {
  constexpr int kSide = Grid<D>::kSide, kTile = mpm::Transfer<D>::kTileSide;
  const Grid<D>& grid = *transfer.grid;
  // The tile of a neighbour before (0), beside (1) or behind (2) along an axis covers this node of the block.
  const auto covers = [](int neighbour, int node) {
    return neighbour == 1 || (neighbour == 0 ? node < 3 : node == kSide - 1);
  };
  parallel_for(grid.blocks(), [&](int block) {
    const std::size_t slot = static_cast<std::size_t>(block) * Grid<D>::kCells;
    const int* neighbours = grid.neighbours(block).data();
    for (int z = 0; z < (D == 3 ? kSide : 1); ++z)
      for (int y = 0; y < kSide; ++y) {
        TileValue<kWidth> row[kSide] = {};
        for (int bz = D == 3 ? 0 : 1; bz < (D == 3 ? 3 : 2); ++bz) {
          if (!covers(bz, z)) continue;
          for (int by = 0; by < 3; ++by) {
            if (!covers(by, y)) continue;
            const int row_z = D == 3 ? z + 1 + (1 - bz) * kSide : 0, row_y = y + 1 + (1 - by) * kSide;
            add_row<D, kWidth>(transfer, neighbours + (D == 3 ? bz * 9 : 0) + by * 3, row_z * kTile + row_y,
                               row);
          }
        }
        put(slot + static_cast<std::size_t>((z * kSide + y) * kSide), row);
      }
  });
}

double inverse_of(double mass) {
  return mass > 0 ? 1 / mass : 0;
}

// Sum of a node with its mass in lane 0 and its momentum behind: sums and velocity.
template <int D>
POLDER_INLINE void put_state(const Reg<8>& sum, double* sums, double* velocity) {
  sum.store(sums);
  const double inverse = inverse_of(sums[0]);
  Reg<8> momentum;
  if constexpr (D == 2)
    momentum = sum.template pick<1, 2, -1, -1, -1, -1, -1, -1>();
  else
    momentum = sum.template pick<1, 2, 3, -1, -1, -1, -1, -1>();
  (momentum.template low<4>() * inverse).store(velocity);
}

// A fluid in the plane: mass, momentum and weight.
POLDER_INLINE void put_fluid(const Reg<4>& sum, double* sums, double* velocity) {
  static_assert(mpm::Transfer<2>::kVolume == 5);
  sum.pick<0, 1, 2, -1>().store(sums);
  sum.pick<-1, 3, -1, -1>().store(sums + 4);
  (sum.pick<1, 2, -1, -1>() * inverse_of(sums[0])).store(velocity);
}

template <int D>
void sum_state_of(mpm::Transfer<D>& transfer, Reals& sums, Reals& velocity) {
  sum_width<D, 8>(transfer, [&](std::size_t slot, const auto& row) {
    for (int x = 0; x < Grid<D>::kSide; ++x)
      put_state<D>(row[x], sums.data() + (slot + x) * 8, velocity.data() + (slot + x) * 4);
  });
}

template <int D>
void sum_momentum_of(mpm::Transfer<D>& transfer, const Reals& sums, Reals& velocity) {
  sum_width<D, 4>(transfer, [&](std::size_t slot, const auto& row) {
    for (int x = 0; x < Grid<D>::kSide; ++x)
      (row[x] * inverse_of(sums[(slot + x) * mpm::Transfer<D>::kSum]))
          .store(velocity.data() + (slot + x) * 4);
  });
}

template <int D>
void sum_cells_of(mpm::Transfer<D>& transfer, Reals& cells) {
  sum_width<D, 4>(transfer, [&](std::size_t slot, const auto& row) {
    for (int x = 0; x < Grid<D>::kSide; ++x) row[x].store(cells.data() + (slot + x) * 4);
  });
}

template <int D>
void sum_volume_of(mpm::Transfer<D>& transfer, Reals& cells) {
  sum_width<D, 1>(transfer, [&](std::size_t slot, const auto& row) {
    for (int x = 0; x < Grid<D>::kSide; ++x) cells[slot + x] = row[x];
  });
}

}  // namespace

void sum_state(mpm::Transfer<2>& transfer, Reals& sums, Reals& velocity) {
  sum_state_of(transfer, sums, velocity);
}
void sum_state(mpm::Transfer<3>& transfer, Reals& sums, Reals& velocity) {
  sum_state_of(transfer, sums, velocity);
}
void sum_fluid(mpm::Transfer<2>& transfer, Reals& sums, Reals& velocity) {
  sum_width<2, 4>(transfer, [&](std::size_t slot, const auto& row) {
    for (int x = 0; x < Grid<2>::kSide; ++x)
      put_fluid(row[x], sums.data() + (slot + x) * 8, velocity.data() + (slot + x) * 4);
  });
}
void sum_fluid(mpm::Transfer<3>& transfer, Reals& sums, Reals& velocity) {
  sum_state_of(transfer, sums, velocity);
}
void sum_momentum(mpm::Transfer<2>& transfer, const Reals& sums, Reals& velocity) {
  sum_momentum_of(transfer, sums, velocity);
}
void sum_momentum(mpm::Transfer<3>& transfer, const Reals& sums, Reals& velocity) {
  sum_momentum_of(transfer, sums, velocity);
}
void sum_cells(mpm::Transfer<2>& transfer, Reals& cells) {
  sum_cells_of(transfer, cells);
}
void sum_cells(mpm::Transfer<3>& transfer, Reals& cells) {
  sum_cells_of(transfer, cells);
}
void sum_volume(mpm::Transfer<2>& transfer, Reals& cells) {
  sum_volume_of(transfer, cells);
}
void sum_volume(mpm::Transfer<3>& transfer, Reals& cells) {
  sum_volume_of(transfer, cells);
}

}  // namespace polder::POLDER_SIMD_NAMESPACE
