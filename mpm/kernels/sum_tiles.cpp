// Nodes: sum of the private tiles that reach them, in fixed order; while a block's sums are in the cache, its
// velocities.
#include "core/threads.hpp"
#include "mpm/kernels/tile.hpp"

namespace polder::POLDER_SIMD_NAMESPACE {
namespace {

// finish(slot, sum): what else happens to a block, first slot and first sum.
template <int D, int kWidth, class Finish>
void sum_width(mpm::Transfer<D>& transfer, Reals& out, const Finish& finish) {
  constexpr int kSide = Grid<D>::kSide, kTile = mpm::Transfer<D>::kTileSide;
  const Grid<D>& grid = *transfer.grid;
  parallel_for(grid.blocks(), [&](int block) {
    const std::size_t slot = static_cast<std::size_t>(block) * Grid<D>::kCells;
    double* sum = out.data() + slot * kWidth;
    std::memset(sum, 0, sizeof(double) * Grid<D>::kCells * kWidth);
    const auto& neighbours = grid.neighbours(block);
    for (int k = 0; k < Grid<D>::kNeighbours; ++k) {
      const int n = neighbours[k];
      if (n < 0 || n >= grid.occupied_blocks()) continue;
      const int shift[3] = {k % 3 - 1, k / 3 % 3 - 1, D == 3 ? k / 9 - 1 : 0};
      int lo[3] = {0, 0, 0}, hi[3] = {1, 1, 1}, from[3] = {0, 0, 0};
      for (int d = 0; d < D; ++d) {  // the neighbour's tile covers its nodes [-1, kSide + 3)
        lo[d] = shift[d] > 0 ? kSide - 1 : 0;
        hi[d] = shift[d] < 0 ? 3 : kSide;
        from[d] = 1 - shift[d] * kSide;
      }
      const double* tile =
          transfer.tiles.data() + static_cast<std::size_t>(n) * mpm::Transfer<D>::kTileNodes * kWidth;
      for (int z = lo[2]; z < hi[2]; ++z)
        for (int y = lo[1]; y < hi[1]; ++y) {
          const double* in =
              tile +
              (((D == 3 ? (z + from[2]) * kTile : 0) + y + from[1]) * kTile + lo[0] + from[0]) * kWidth;
          double* to = sum + (((D == 3 ? z * kSide : 0) + y) * kSide + lo[0]) * kWidth;
          for (int x = 0; x < hi[0] - lo[0]; ++x)
            (Reg<kWidth>::load(to + x * kWidth) + Reg<kWidth>::load(in + x * kWidth)).store(to + x * kWidth);
        }
    }
    finish(slot, sum);
  });
}

double inverse_of(double mass) {
  return mass > 0 ? 1 / mass : 0;
}

template <int D>
void sum_state_of(mpm::Transfer<D>& transfer, Reals& sums, Reals& velocity) {
  sum_width<D, 8>(transfer, sums, [&](std::size_t slot, const double* sum) {
    for (int i = 0; i < Grid<D>::kCells; ++i, sum += 8) {
      double* v = velocity.data() + (slot + i) * mpm::Transfer<D>::kVector;
      const double inverse = inverse_of(sum[0]);
      for (int d = 0; d < D; ++d) v[d] = sum[1 + d] * inverse;
    }
  });
}

template <int D>
void sum_momentum_of(mpm::Transfer<D>& transfer, const Reals& sums, Reals& velocity) {
  sum_width<D, 4>(transfer, velocity, [&](std::size_t slot, double* v) {
    for (int i = 0; i < Grid<D>::kCells; ++i, v += 4)
      (Reg<4>::load(v) * inverse_of(sums[(slot + i) * mpm::Transfer<D>::kSum])).store(v);
  });
}

template <int D>
void sum_cells_of(mpm::Transfer<D>& transfer, Reals& cells) {
  sum_width<D, 4>(transfer, cells, [](std::size_t, const double*) {});
}

}  // namespace

void sum_state(mpm::Transfer<2>& transfer, Reals& sums, Reals& velocity) {
  sum_state_of(transfer, sums, velocity);
}
void sum_state(mpm::Transfer<3>& transfer, Reals& sums, Reals& velocity) {
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

}  // namespace polder::POLDER_SIMD_NAMESPACE
