// Nodes to nodes: what the particles would make of a change of nodal velocity, from the masses of cells.
#include "core/threads.hpp"
#include "mpm/kernels/tile.hpp"

namespace polder::POLDER_SIMD_NAMESPACE {
namespace {

// Consistent over lumped mass of one cell along one axis, {1/2 - a, a; a, 1/2 - a}. Linear and GIMP shapes
// over n particles in regular rows: a = mean of x (1 - x). The B-spline reaches further; a = 1/4 has its
// second moment.
double neighbour_weight(mpm::ShapeKind shape, int particles_per_axis) {
  if (shape == mpm::ShapeKind::quadratic_bspline) return 0.25;
  return 1.0 / 6 + 1.0 / (12.0 * particles_per_axis * particles_per_axis);
}

template <int D>
void map_by_cells_of(const mpm::Transfer<D>& t, const Reals& cells, int particles_per_axis, double flip,
                     const Reals& v_old, const Reals& v_new, Reals& mapped) {
  using Node = Reg<4>;
  constexpr int kTileNodes = mpm::Transfer<D>::kTileNodes, kTile = mpm::Transfer<D>::kTileSide;
  constexpr int kSide = Grid<D>::kSide, kCorners = ipow(2, D), kMass = mpm::Transfer<D>::kCellMass;
  const Grid<D>& grid = *t.grid;
  const double beside = neighbour_weight(t.shape, particles_per_axis), here = 0.5 - beside;
  int corner_offset[kCorners];
  for (int k = 0; k < kCorners; ++k)
    corner_offset[k] = (k & 1) + (k >> 1 & 1) * kTile + (D == 3 ? (k >> 2) * kTile * kTile : 0);
  parallel_for(grid.blocks(), [&](int block) {
    alignas(64) double old[kTileNodes * 4], change[kTileNodes * 4], cell[kTileNodes * 4];
    alignas(64) double sum[kTileNodes * 4] = {}, mass[kTileNodes] = {};
    load_tile<D, 4, 4>(grid, block, cells.data(), cell);
    load_tile<D, 4, 4>(grid, block, v_old.data(), old);
    load_tile<D, 4, 4>(grid, block, v_new.data(), change);
    for (int i = 0; i < kTileNodes * 4; ++i) change[i] -= flip * old[i];
    // Cells [-1, kSide) of the block reach all of its nodes.
    for (int z = 0; z < (D == 3 ? kSide + 1 : 1); ++z)
      for (int y = 0; y <= kSide; ++y)
        for (int x = 0; x <= kSide; ++x) {
          const int first = ((D == 3 ? z * kTile : 0) + y) * kTile + x;
          const double m = cell[first * 4 + kMass];
          if (!(m > 0)) continue;
          Node u[kCorners];
          for (int k = 0; k < kCorners; ++k) u[k] = Node::load(change + (first + corner_offset[k]) * 4);
          for (int d = 0; d < D; ++d)
            for (int k = 0; k < kCorners; ++k) {
              if (k >> d & 1) continue;
              const Node low = u[k], high = u[k | 1 << d];
              u[k] = low * here + high * beside;
              u[k | 1 << d] = low * beside + high * here;
            }
          for (int k = 0; k < kCorners; ++k) {
            const int node = first + corner_offset[k];
            (Node::load(sum + node * 4) + u[k] * m).store(sum + node * 4);
            mass[node] += m / kCorners;
          }
        }
    for (int i = 0; i < Grid<D>::kCells; ++i) {
      const int x = i % kSide, y = i / kSide % kSide, z = i / (kSide * kSide);
      const int node = ((D == 3 ? (z + 1) * kTile : 0) + y + 1) * kTile + x + 1;
      const Node u =
          mass[node] > 0 ? Node::load(sum + node * 4) * (1 / mass[node]) : Node::load(change + node * 4);
      (Node::load(old + node * 4) * flip + u)
          .store(mapped.data() + (static_cast<std::size_t>(block) * Grid<D>::kCells + i) * 4);
    }
  });
}

}  // namespace

void map_by_cells(const mpm::Transfer<2>& t, const Reals& cells, int n, double flip, const Reals& v_old,
                  const Reals& v_new, Reals& mapped) {
  map_by_cells_of(t, cells, n, flip, v_old, v_new, mapped);
}
void map_by_cells(const mpm::Transfer<3>& t, const Reals& cells, int n, double flip, const Reals& v_old,
                  const Reals& v_new, Reals& mapped) {
  map_by_cells_of(t, cells, n, flip, v_old, v_new, mapped);
}

}  // namespace polder::POLDER_SIMD_NAMESPACE
