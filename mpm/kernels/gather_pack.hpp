// Two vector fields of the nodes at the points: values, gradient, affine moment. Pieces that the kernels from
// nodes to particles share.
#pragma once

#include "mpm/kernels/tile.hpp"

namespace polder::POLDER_SIMD_NAMESPACE {

// A tile holds two vector fields a and b: 2D {ax, ay, bx, by}, 3D {ax, ay, az, -, bx, by, bz, -}.
template <int D>
inline constexpr int kPair = D == 2 ? 4 : 8;
template <int D>
inline constexpr int kSecond = D == 2 ? 2 : 4;

template <int D>
struct Gathered {
  Pack a[D], b[D];       // sum N a, sum N b
  Pack gradient[D * D];  // db_i/dx_j [1/s]
  Pack moment[D * D];    // sum N b_i (x_node - x_p)_j / sum N (x_node - x_p)_j^2 [1/s], affine only
};

template <int D>
void load_pair(const Grid<D>& grid, int block, const Reals& a, const Reals& b, double* tile) {
  constexpr int kVector = mpm::Transfer<D>::kVector;
  if constexpr (D == 2) {
    // Interleave by loading each field with a stride of four and half the width.
    alignas(64) double other[mpm::Transfer<D>::kTileNodes * 4];
    load_tile<D, kVector, kPair<D>>(grid, block, a.data(), tile);
    if (&a != &b) load_tile<D, kVector, kPair<D>>(grid, block, b.data(), other);
    const double* second = &a != &b ? other : tile;
    for (int i = 0; i < mpm::Transfer<D>::kTileNodes; ++i)
      tile[i * 4 + 2] = second[i * 4], tile[i * 4 + 3] = second[i * 4 + 1];
  } else {
    load_tile<D, kVector, kPair<D>>(grid, block, a.data(), tile);
    load_tile<D, kVector, kPair<D>>(grid, block, b.data(), tile + 4);
  }
}

enum class Want { values, gradient, moment };

template <int D, Want kWant>
POLDER_INLINE void gather_pack(const double* tile, const BlockFrame<D>& frame, const TileStencil<D>& s,
                               const Pack* position, double h, Gathered<D>& out) {
  constexpr int kTile = mpm::Transfer<D>::kTileSide, kW = kPair<D>;
  constexpr bool kGradient = kWant != Want::values, kMoment = kWant == Want::moment;
  alignas(64) double w[D][3][kLanes], g[D][3][kLanes], r[D][3][kLanes];
  for (int d = 0; d < D; ++d)
    for (int a = 0; a < 3; ++a) {
      store(w[d][a], s.axis[d].weight[a]);
      if constexpr (kGradient) store(g[d][a], s.axis[d].slope[a] * frame.inverse_h);
      if constexpr (kMoment) store(r[d][a], s.axis[d].weight[a] * s.distance(frame, d, a, position[d], h));
    }
  Reg<kW> value[kLanes], slope[kGradient ? D : 1][kLanes], moment[kMoment ? D : 1][kLanes];
  const auto lane = [&](int l) __attribute__((always_inline)) {
    const double* first = tile + s.start[l] * kW;
    Reg<kW> v{}, dx{}, dy{}, dz{}, mx{}, my{}, mz{};
    for (int k = 0; k < (D == 3 ? 3 : 1); ++k) {
      Reg<kW> pv{}, px{}, py{}, qx{}, qy{};  // of this plane
      for (int j = 0; j < 3; ++j) {
        const double* row = first + ((D == 3 ? k * kTile : 0) + j) * kTile * kW;
        Reg<kW> rv{}, rx{}, sx{};
        for (int i = 0; i < 3; ++i) {
          const Reg<kW> n = Reg<kW>::load(row + i * kW);
          rv += n * w[0][i][l];
          if constexpr (kGradient) rx += n * g[0][i][l];
          if constexpr (kMoment) sx += n * r[0][i][l];
        }
        pv += rv * w[1][j][l];
        if constexpr (kGradient) px += rx * w[1][j][l], py += rv * g[1][j][l];
        if constexpr (kMoment) qx += sx * w[1][j][l], qy += rv * r[1][j][l];
      }
      if constexpr (D == 2) {
        v = pv, dx = px, dy = py, mx = qx, my = qy;
      } else {
        const double wk = w[2][k][l];
        v += pv * wk;
        if constexpr (kGradient) dx += px * wk, dy += py * wk, dz += pv * g[2][k][l];
        if constexpr (kMoment) mx += qx * wk, my += qy * wk, mz += pv * r[2][k][l];
      }
    }
    value[l] = v;
    if constexpr (kGradient) {
      slope[0][l] = dx, slope[1][l] = dy;
      if constexpr (D == 3) slope[2][l] = dz;
    }
    if constexpr (kMoment) {
      moment[0][l] = mx, moment[1][l] = my;
      if constexpr (D == 3) moment[2][l] = mz;
    }
  };
  // In the plane what a lane gathers fits in registers, if the lanes are known at compile time. Through
  // memory a pack would be read from pieces that have just been written, which stalls.
  if constexpr (D == 2) {
#pragma GCC unroll 8
    for (int l = 0; l < kLanes; ++l) lane(l);
  } else {
    for (int l = 0; l < kLanes; ++l) lane(l);
  }
  Pack f[kW];
  to_packs<kW>(value, f);
  for (int d = 0; d < D; ++d) out.a[d] = f[d], out.b[d] = f[kSecond<D> + d];
  if constexpr (kGradient)
    for (int j = 0; j < D; ++j) {
      to_packs<kW>(slope[j], f);
      for (int i = 0; i < D; ++i) out.gradient[i * D + j] = f[kSecond<D> + i];
    }
  if constexpr (kMoment)
    for (int j = 0; j < D; ++j) {
      // The second moment of the weights is diagonal (tensor product, linear completeness); 0 on an
      // interpolating node.
      Pack second = Pack{};
      for (int a = 0; a < 3; ++a) {
        const Pack x = s.distance(frame, j, a, position[j], h);
        second += s.axis[j].weight[a] * x * x;
      }
      const Pack inverse = select(second > 1e-10 * h * h, 1.0 / max(second, 1e-10 * h * h), Pack{});
      to_packs<kW>(moment[j], f);
      for (int i = 0; i < D; ++i) out.moment[i * D + j] = f[kSecond<D> + i] * inverse;
    }
}

}  // namespace polder::POLDER_SIMD_NAMESPACE
