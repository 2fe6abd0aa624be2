// Nodes: sum of the private tiles that reach them, in fixed order.
#include "core/threads.hpp"
#include "mpm/kernels/tile.hpp"

namespace polder::POLDER_SIMD_NAMESPACE {
namespace {

template <int D, int kWidth>
void sum_width(mpm::Transfer<D>& transfer, Reals& out) {
  constexpr int kSide = Grid<D>::kSide, kTile = mpm::Transfer<D>::kTileSide;
  const Grid<D>& grid = *transfer.grid;
  parallel_for(grid.blocks(), [&](int block) {
    double* sum = out.data() + static_cast<std::size_t>(block) * Grid<D>::kCells * kWidth;
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
  });
}

template <int D>
void sum_any(mpm::Transfer<D>& transfer, int width, Reals& out) {
  if (width == 8)
    sum_width<D, 8>(transfer, out);
  else
    sum_width<D, 4>(transfer, out);
}

}  // namespace

void sum_tiles(mpm::Transfer<2>& transfer, int width, Reals& out) {
  sum_any(transfer, width, out);
}
void sum_tiles(mpm::Transfer<3>& transfer, int width, Reals& out) {
  sum_any(transfer, width, out);
}

}  // namespace polder::POLDER_SIMD_NAMESPACE
