// Vector fields of the nodes at the points: values, gradient, affine moment. Pieces that the kernels from
// nodes to particles share.
#pragma once

#include "mpm/kernels/tile.hpp"

namespace polder::POLDER_SIMD_NAMESPACE {

// Numbers of one vector in a tile node (padded in space).
template <int D>
inline constexpr int kVectorLanes = D == 2 ? 2 : 4;

// What a tile's vector fields are at a pack of points. `value` and the derivatives belong to the last field.
template <int D>
struct Gathered {
  Pack before[D];        // sum N a of the first of two fields
  Pack value[D];         // sum N b
  Pack gradient[D * D];  // db_i/dx_j [1/s]
  Pack moment[D * D];    // sum N b_i (x_node - x_p)_j / sum N (x_node - x_p)_j^2 [1/s], affine only
};

enum class Want { values, gradient, moment };

// tile: kFields vectors a node, as load_tile() leaves them.
//
// A node is multiplied by its weight and by its slope along x at once: in a register of twice its width that
// holds it twice, {b | b} {N, N | dN/dx, dN/dx}. The sums along the other axes then cost what those of the
// value cost.
template <int D, int kFields, Want kWant>
POLDER_INLINE void gather_pack(const double* tile, const BlockFrame<D>& frame, const TileStencil<D>& s,
                               const Pack* position, double h, Gathered<D>& out) {
  constexpr int kTile = mpm::Transfer<D>::kTileSide, kHalf = kVectorLanes<D>, kW = kHalf * kFields;
  constexpr int kLast = kW - kHalf;  // first lane of the last field
  constexpr bool kGradient = kWant != Want::values, kMoment = kWant == Want::moment;
  constexpr int kWide = kGradient ? 2 * kW : kW, kNarrow = kW < 4 ? 4 : kW;
  static_assert(kWide >= 4);
  using Wide = Reg<kWide>;      // {value | slope along x}
  using Narrow = Reg<kNarrow>;  // its lower lanes
  alignas(64) double w[D][3][kLanes], g[D][3][kLanes], r[D][3][kLanes];
  for (int d = 0; d < D; ++d)
    for (int a = 0; a < 3; ++a) {
      store(w[d][a], s.axis[d].weight[a]);
      if constexpr (kGradient) store(g[d][a], s.axis[d].slope[a] * frame.inverse_h);
      if constexpr (kMoment) store(r[d][a], s.axis[d].weight[a] * s.distance(frame, d, a, position[d], h));
    }
  Wide along_x[kLanes];
  Narrow slope[kGradient ? D : 1][kLanes], moment[kMoment ? D : 1][kLanes];
  // Not unrolled: with the lane known the compiler would take the weights out of registers, lane by lane, and
  // not from memory, where broadcasting them costs nothing.
#pragma GCC unroll 1
  for (int l = 0; l < kLanes; ++l) {
    const double* first = tile + s.start[l] * kW;
    Wide wx[3];
    for (int i = 0; i < 3; ++i)
      wx[i] = kGradient ? Wide::halves(w[0][i][l], g[0][i][l]) : Wide::all(w[0][i][l]);
    Wide v{};
    Narrow dy{}, dz{}, mx{}, my{}, mz{};
    for (int k = 0; k < (D == 3 ? 3 : 1); ++k) {
      Wide pv{};  // of this plane
      Narrow py{}, qx{}, qy{};
      for (int j = 0; j < 3; ++j) {
        const double* row = first + ((D == 3 ? k * kTile : 0) + j) * kTile * kW;
        Wide rv{};
        Narrow sx{};
        for (int i = 0; i < 3; ++i) {
          const Wide n = kGradient ? Wide::twice(row + i * kW) : Wide::load(row + i * kW);
          rv += n * wx[i];
          if constexpr (kMoment) sx += n.template low<kNarrow>() * r[0][i][l];
        }
        pv += rv * w[1][j][l];
        if constexpr (kGradient) py += rv.template low<kNarrow>() * g[1][j][l];
        if constexpr (kMoment) qx += sx * w[1][j][l], qy += rv.template low<kNarrow>() * r[1][j][l];
      }
      if constexpr (D == 2) {
        v = pv, dy = py, mx = qx, my = qy;
      } else {
        const double wk = w[2][k][l];
        v += pv * wk;
        if constexpr (kGradient) dy += py * wk, dz += pv.template low<kNarrow>() * g[2][k][l];
        if constexpr (kMoment) mx += qx * wk, my += qy * wk, mz += pv.template low<kNarrow>() * r[2][k][l];
      }
    }
    along_x[l] = v;
    if constexpr (kGradient) {
      slope[1][l] = dy;
      if constexpr (D == 3) slope[2][l] = dz;
    }
    if constexpr (kMoment) {
      moment[0][l] = mx, moment[1][l] = my;
      if constexpr (D == 3) moment[2][l] = mz;
    }
  }
  Pack wide[kWide], narrow[kNarrow];
  to_packs<kWide>(along_x, wide);
  for (int i = 0; i < D; ++i) {
    if constexpr (kFields == 2) out.before[i] = wide[i];
    out.value[i] = wide[kLast + i];
    if constexpr (kGradient) out.gradient[i * D] = wide[kW + kLast + i];
  }
  if constexpr (kGradient)
    for (int j = 1; j < D; ++j) {
      to_packs<kNarrow>(slope[j], narrow);
      for (int i = 0; i < D; ++i) out.gradient[i * D + j] = narrow[kLast + i];
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
      to_packs<kNarrow>(moment[j], narrow);
      for (int i = 0; i < D; ++i) out.moment[i * D + j] = narrow[kLast + i] * inverse;
    }
}

}  // namespace polder::POLDER_SIMD_NAMESPACE
