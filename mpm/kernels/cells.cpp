// Particles to cells, by the overlap of their domains.
#include <cstring>

#include "core/threads.hpp"
#include "mpm/kernels/tile.hpp"

namespace polder::POLDER_SIMD_NAMESPACE {
namespace {

// Overlap of the particle's box with cells along one axis: the lower cell and the share of the box inside it.
POLDER_INLINE void overlap(Pack x, Pack l, Mask& cell, Pack& lower) {
  cell = floor_to_int(x - l);
  lower = clamp((to_real(cell) + 1.0 - (x - l)) / (2.0 * l), 0.0, 1.0);
}

// Of a pack: tile index of the lowest cell and the shares inside the two cells along each axis.
template <int D>
struct CellShares {
  Mask start = Mask{};
  alignas(64) double share[D][2][kLanes];

  POLDER_INLINE CellShares(const BlockFrame<D>& frame, const ParticleSet<D>& set, int p) {
    for (int d = D - 1; d >= 0; --d) {
      Mask cell;
      Pack lower;
      const Pack x = (load(&set.position[d][p]) - frame.origin[d]) * frame.inverse_h;
      // A box never reaches beyond the grid's sides: what would stick out counts inside.
      const Pack l = min(load(&set.half_size[d][p]) * frame.inverse_h, 0.5);
      overlap(x, l, cell, lower);
      lower = select(cell < 0, Pack{}, select(cell > frame.last_node[d] - 2, broadcast(1.0), lower));
      store(share[d][0], lower);
      store(share[d][1], 1.0 - lower);
      start = start * mpm::Transfer<D>::kTileSide + (cell - frame.first_node[d]);
    }
  }
};

// fields_of(set, p, node): kWidth numbers of each particle of a pack; has(set): whether a body has any.
template <int D, int kWidth, class Fields, class Has>
void scatter_overlaps(mpm::Transfer<D>& transfer, const Fields& fields_of, const Has& has) {
  constexpr int kTile = mpm::Transfer<D>::kTileSide;
  constexpr std::size_t kTileSize = mpm::Transfer<D>::kTileNodes * kWidth;
  const Grid<D>& grid = *transfer.grid;
  parallel_for_work(work_of_blocks(transfer), [&](int block) {
    double* tile = transfer.tiles.data() + block * kTileSize;
    if constexpr (kWidth == mpm::Transfer<D>::kCellSum)
      if (transfer.asleep(block) && take_kept(transfer.sleepers[block].cells, tile)) return;
    std::memset(tile, 0, sizeof(double) * kTileSize);
    const BlockFrame<D> frame(grid, block);
    for (const mpm::Body<D>& body : transfer.bodies) {
      const ParticleSet<D>& set = *body.particles;
      if (!has(set)) continue;
      const auto range = set.ranges[block];
      for (int p = range.first; p < range.first + range.count; p += kLanes) {
        TileValue<kWidth> node[kLanes];
        fields_of(set, p, node);
        const CellShares<D> s(frame, set, p);
        for (int l = 0; l < kLanes; ++l) {
          double* first = tile + s.start[l] * kWidth;
          for (int k = 0; k < (D == 3 ? 2 : 1); ++k)
            for (int j = 0; j < 2; ++j)
              for (int i = 0; i < 2; ++i) {
                double f = s.share[0][i][l] * s.share[1][j][l];
                if constexpr (D == 3) f *= s.share[2][k][l];
                double* to = first + (((D == 3 ? k * kTile : 0) + j) * kTile + i) * kWidth;
                store_value<kWidth>(to, load_value<kWidth>(to) + node[l] * f);
              }
        }
      }
    }
  });
}

template <int D>
void scatter_cells_of(mpm::Transfer<D>& transfer) {
  scatter_overlaps<D, 4>(
      transfer, [](const ParticleSet<D>& set, int p, Reg<4>(&node)[kLanes]) __attribute__((always_inline)) {
        const Pack solid = load(&set.mass[p]), volume = select(solid > 0, load(&set.volume[p]), Pack{});
        const Pack wet = load(&set.wet[p]) * volume;
        const Pack grains = solid * (1 / set.density_solid);
        Pack fields[4] = {wet, load(&set.wet[p]) * grains};
        if (!set.conductivity.empty()) fields[2] = wet * load(&set.conductivity[p]);
        if (!set.retained_water.empty())
          fields[3] = load(&set.retained_water[p]);
        else if (!set.pore_water.empty())
          fields[3] = load(&set.pore_water[p]) * (volume - grains);
        to_nodes<4>(fields, node);
      },
      [](const ParticleSet<D>& set) { return !set.wet.empty(); });  // others have no pores
}

template <int D>
void scatter_volume_of(mpm::Transfer<D>& transfer) {
  scatter_overlaps<D, 1>(
      transfer, [](const ParticleSet<D>& set, int p, double(&node)[kLanes]) __attribute__((always_inline)) {
        const Pack volume = select(load(&set.mass[p]) > 0, load(&set.volume[p]), Pack{});
        for (int l = 0; l < kLanes; ++l) node[l] = volume[l];
      },
      [](const ParticleSet<D>&) { return true; });
}

}  // namespace

void scatter_cells(mpm::Transfer<2>& t) {
  scatter_cells_of(t);
}
void scatter_cells(mpm::Transfer<3>& t) {
  scatter_cells_of(t);
}
void scatter_volume(mpm::Transfer<2>& t) {
  scatter_volume_of(t);
}
void scatter_volume(mpm::Transfer<3>& t) {
  scatter_volume_of(t);
}

}  // namespace polder::POLDER_SIMD_NAMESPACE
