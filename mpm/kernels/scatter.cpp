// Particles to nodes and cells.
//
// With the stencil's weights N_i = w0 w1 (w2), node i gets
//   m_i += N m,   p_i += N m (v + C (x_i - x_p)),   f_i += N f_ext - V sigma grad N,   V_i += N V.
// The tensor product is summed axis by axis. What multiplies a slope (or, of C, a distance) along one axis
// and plain weights along the others is one register for that axis and its node; the last axis takes what
// multiplies plain weights along. So a node costs two fused multiply-adds of a whole register.
#include <algorithm>

#include "core/threads.hpp"
#include "mpm/kernels/tile.hpp"

namespace polder::POLDER_SIMD_NAMESPACE {
namespace {

using mpm::AffineKind;

// What one pack gives to the nodes: one register for each particle.
template <int D, bool kAffine>
struct ScatterFields {
  Reg<8> value[kLanes];                    // m, m v, f_ext, V
  Reg<8> stress[D][kLanes];                // -V sigma e_d in the force lanes
  Reg<8> affine[kAffine ? D : 1][kLanes];  // m C e_d in the momentum lanes
};

// plain: what goes with weights alone. stress: -V sigma, in the order of particle stress. The transposes are
// shared: stress rides in lanes that mass, momentum and volume leave free.
template <int D, bool kAffine>
POLDER_INLINE void transpose_fields(Pack (&plain)[8], bool has_force, const Pack* stress,
                                    ScatterFields<D, kAffine>& out) {
  Reg<8> shared[kLanes], other[D == 3 ? kLanes : 1], force[kLanes];
  if (has_force) {
    Pack f[8] = {};
    for (int d = 0; d < D; ++d) f[1 + D + d] = plain[1 + D + d];
    to_nodes<8>(f, force);
  }
  if constexpr (D == 2) {
    plain[3] = stress[0], plain[4] = plain[6] = stress[3], plain[7] = stress[1];
  } else {
    plain[4] = stress[0], plain[5] = stress[3], plain[6] = stress[5];
    Pack f[8] = {stress[3], stress[1], stress[4], Pack{}, stress[5], stress[4], stress[2], Pack{}};
    to_nodes<8>(f, other);
  }
  to_nodes<8>(plain, shared);
  for (int l = 0; l < kLanes; ++l) {
    if constexpr (D == 2) {
      out.value[l] = shared[l].template pick<0, 1, 2, -1, -1, 5, -1, -1>();
      out.stress[0][l] = shared[l].template pick<-1, -1, -1, 3, 4, -1, -1, -1>();
      out.stress[1][l] = shared[l].template pick<-1, -1, -1, 6, 7, -1, -1, -1>();
    } else {
      out.value[l] = shared[l].template pick<0, 1, 2, 3, -1, -1, -1, 7>();
      out.stress[0][l] = shared[l].template pick<-1, -1, -1, -1, 4, 5, 6, -1>();
      out.stress[1][l] = other[l].template pick<-1, -1, -1, -1, 0, 1, 2, -1>();
      out.stress[2][l] = other[l].template pick<-1, -1, -1, -1, 4, 5, 6, -1>();
    }
    if (has_force) out.value[l] += force[l];
  }
}

template <int D, bool kAffine>
POLDER_INLINE void load_fields(const mpm::Transfer<D>& transfer, const ParticleSet<D>& set, int p,
                               ScatterFields<D, kAffine>& out) {
  constexpr int kForce = 1 + D;  // first force lane
  const Pack solid = load(&set.mass[p]);
  const Mask real = solid > 0;
  const Pack volume = select(real, load(&set.volume[p]), Pack{});
  Pack mass = solid;
  if (!set.pore_water.empty()) mass += load(&set.pore_water[p]) * (volume - solid * (1 / set.density_solid));
  if (!set.retained_water.empty()) mass += load(&set.retained_water[p]);
  Pack sigma[ParticleSet<D>::kStress];
  for (int k = 0; k < ParticleSet<D>::kStress; ++k) sigma[k] = select(real, load(&set.stress[k][p]), Pack{});
  if (!set.suction_stress.empty()) {
    const Pack s = select(real, load(&set.suction_stress[p]), Pack{});
    for (int k = 0; k < 3; ++k) sigma[k] += s;
  }

  Pack f[8] = {};
  f[0] = mass;
  for (int d = 0; d < D; ++d) {
    f[1 + d] = mass * load(&set.velocity[d][p]);
    if (!set.body_acceleration[d].empty()) f[kForce + d] = mass * load(&set.body_acceleration[d][p]);
  }
  if (D == 2 && transfer.space == Space::axisymmetric) {  // hoop stress pulls towards the axis
    const Pack radius = load(&set.position[0][p]);
    f[kForce] -= volume * sigma[2] / radius;
  }
  if (!set.nodal_weight.empty())
    f[mpm::Transfer<D>::kVolume] = volume * load(&set.nodal_weight[p]);
  else if (!set.wet.empty())
    f[mpm::Transfer<D>::kVolume] = volume * load(&set.wet[p]);
  Pack push[ParticleSet<D>::kStress];
  for (int k = 0; k < ParticleSet<D>::kStress; ++k) push[k] = -volume * sigma[k];
  const bool has_force = !set.body_acceleration[0].empty() || transfer.space == Space::axisymmetric;
  transpose_fields<D, kAffine>(f, has_force, push, out);
  if constexpr (kAffine)
    for (int d = 0; d < D; ++d) {
      Pack c[8] = {};
      for (int i = 0; i < D; ++i) c[1 + i] = mass * load(&set.affine[i * D + d][p]);
      to_nodes<8>(c, out.affine[d]);
    }
}

// The same fields of the water in saturated pores: its mass and momentum, -V sigma with sigma = -p, and
// volume over conductivity in place of the volume.
template <int D>
POLDER_INLINE void load_pore_water(const mpm::Transfer<D>& transfer, double density, bool kozeny_carman,
                                   const ParticleSet<D>& set, int p, ScatterFields<D, false>& out) {
  constexpr int kForce = 1 + D;
  const Pack solid = load(&set.mass[p]), wet = load(&set.wet[p]);
  const Pack volume = select(solid > 0, wet * load(&set.volume[p]), Pack{});
  const Pack push = volume * load(&set.pore_pressure[p]);
  Pack f[8] = {};
  f[0] = density * (volume - wet * solid * (1 / set.density_solid));
  if (!set.water_velocity[0].empty())
    for (int d = 0; d < D; ++d) f[1 + d] = f[0] * load(&set.water_velocity[d][p]);
  if (D == 2 && transfer.space == Space::axisymmetric) f[kForce] = push / load(&set.position[0][p]);
  Pack conductivity = load(&set.conductivity[p]);
  if (kozeny_carman) {
    const Pack grains = solid * (1 / set.density_solid) / select(volume > 0, volume, broadcast(1.0));
    conductivity *= (1.0 - grains) * (1.0 - grains) * (1.0 - grains) / (grains * grains);
  }
  f[mpm::Transfer<D>::kVolume] = select(conductivity > 0, volume / conductivity, Pack{});
  Pack stress[ParticleSet<D>::kStress] = {push, push, push};
  transpose_fields<D, false>(f, D == 2 && transfer.space == Space::axisymmetric, stress, out);
}

// Weights of a pack by axis and node of the stencil, for lanes to be taken out one by one.
template <int D, bool kAffine>
struct LaneWeights {
  alignas(64) double plain[D][3][kLanes];
  alignas(64) double slope[D][3][kLanes];                 // dN/dx [1/m]
  alignas(64) double offset[kAffine ? D : 1][3][kLanes];  // N (x_node - x_p) [m]
  alignas(64) double product[D == 3 ? 9 : 1][kLanes];     // w1 w2 of node (j, k)

  POLDER_INLINE LaneWeights(const BlockFrame<D>& frame, const TileStencil<D>& s, const Pack* position,
                            double h) {
    for (int d = 0; d < D; ++d)
      for (int a = 0; a < 3; ++a) {
        store(plain[d][a], s.axis[d].weight[a]);
        store(slope[d][a], s.axis[d].slope[a] * frame.inverse_h);
        if constexpr (kAffine)
          store(offset[d][a], s.axis[d].weight[a] * s.distance(frame, d, a, position[d], h));
      }
    if constexpr (D == 3)
      for (int k = 0; k < 3; ++k)
        for (int j = 0; j < 3; ++j) store(product[k * 3 + j], s.axis[1].weight[j] * s.axis[2].weight[k]);
  }
};

template <int D, bool kAffine>
POLDER_INLINE void scatter_pack(const TileStencil<D>& s, const LaneWeights<D, kAffine>& weights,
                                const ScatterFields<D, kAffine>& f, double* tile) {
  constexpr int kTile = mpm::Transfer<D>::kTileSide;
  const auto& w = weights.plain;
  const auto& g = weights.slope;
  const auto& r = weights.offset;
#pragma GCC unroll 1
  for (int l = 0; l < kLanes; ++l) {
    double* first = tile + s.start[l] * 8;
    // What belongs to node a along an axis and not to the last one.
    const auto across = [&](int d, int a) __attribute__((always_inline)) {
      Reg<8> sum = f.stress[d][l] * g[d][a][l];
      if constexpr (kAffine) sum += f.affine[d][l] * r[d][a][l];
      return sum;
    };
    const auto last_axis = [&](int a) __attribute__((always_inline)) {
      Reg<8> sum = f.value[l] * w[D - 1][a][l];
      sum += f.stress[D - 1][l] * g[D - 1][a][l];
      if constexpr (kAffine) sum += f.affine[D - 1][l] * r[D - 1][a][l];
      return sum;
    };
    const auto add_row = [&](double* to, const Reg<8>& plain, const Reg<8>(&x)[3], double others)
        __attribute__((always_inline)) {
      for (int i = 0; i < 3; ++i) {
        Reg<8> node = Reg<8>::load(to + i * 8);
        node += plain * w[0][i][l];
        node += x[i] * others;
        node.store(to + i * 8);
      }
    };
    const Reg<8> x[3] = {across(0, 0), across(0, 1), across(0, 2)};
    if constexpr (D == 2) {
      for (int j = 0; j < 3; ++j) add_row(first + j * kTile * 8, last_axis(j), x, w[1][j][l]);
    } else {
      const Reg<8> y[3] = {across(1, 0), across(1, 1), across(1, 2)};
      for (int k = 0; k < 3; ++k) {
        const Reg<8> z = last_axis(k);
        for (int j = 0; j < 3; ++j) {
          Reg<8> plain = z * w[1][j][l];
          plain += y[j] * w[2][k][l];
          add_row(first + (k * kTile + j) * kTile * 8, plain, x, weights.product[k * 3 + j][l]);
        }
      }
    }
  }
}

// load(set, p, fields): what goes to the nodes; has(set): whether a body has any of it.
template <int D, bool kAffine, class Load, class Has>
void scatter_blocks(mpm::Transfer<D>& transfer, const Load& load_of, const Has& has) {
  constexpr int kTileNodes = mpm::Transfer<D>::kTileNodes;
  const Grid<D>& grid = *transfer.grid;
  const double h = grid.spacing();
  parallel_for_work(work_of_blocks(transfer), [&](int block) {
    double* tile = transfer.tiles.data() + static_cast<std::size_t>(block) * kTileNodes * 8;
    std::memset(tile, 0, sizeof(double) * kTileNodes * 8);
    const BlockFrame<D> frame(grid, block);
    for (const mpm::Body<D>& body : transfer.bodies) {
      const ParticleSet<D>& set = *body.particles;
      if (!has(set)) continue;
      const auto range = set.ranges[block];
      for (int p = range.first; p < range.first + range.count; p += kLanes) {
        fetch_ahead(p, set.position, set.half_size, set.velocity, set.mass, set.volume, set.stress, set.wet,
                    set.affine);
        Pack x[D], l[D];
        for (int d = 0; d < D; ++d) x[d] = load(&set.position[d][p]), l[d] = load(&set.half_size[d][p]);
        TileStencil<D> s;
        s.set(frame, transfer.shape, x, l);
        const LaneWeights<D, kAffine> weights(frame, s, x, h);
        ScatterFields<D, kAffine> f;
        load_of(set, p, f);
        scatter_pack<D, kAffine>(s, weights, f, tile);
      }
    }
  });
}

template <int D, bool kAffine>
void scatter_skeleton(mpm::Transfer<D>& transfer) {
  scatter_blocks<D, kAffine>(
      transfer,
      [&](const ParticleSet<D>& set, int p, ScatterFields<D, kAffine>& f)
          __attribute__((always_inline)) { load_fields<D, kAffine>(transfer, set, p, f); },
      [](const ParticleSet<D>&) { return true; });
}

template <int D>
void scatter_water(mpm::Transfer<D>& transfer, double density, bool kozeny_carman) {
  scatter_blocks<D, false>(
      transfer,
      [&](const ParticleSet<D>& set, int p, ScatterFields<D, false>& f)
          __attribute__((always_inline)) { load_pore_water<D>(transfer, density, kozeny_carman, set, p, f); },
      [](const ParticleSet<D>& set) { return !set.pore_pressure.empty(); });
}

// Overlap of the particle's box with cells along one axis: the lower cell and the share of the box inside it.
POLDER_INLINE void overlap(Pack x, Pack l, Mask& cell, Pack& lower) {
  cell = floor_to_int(x - l);
  lower = clamp((to_real(cell) + 1.0 - (x - l)) / (2.0 * l), 0.0, 1.0);
}

template <int D>
void scatter_cells_of(mpm::Transfer<D>& transfer) {
  constexpr int kTileNodes = mpm::Transfer<D>::kTileNodes, kTile = mpm::Transfer<D>::kTileSide;
  const Grid<D>& grid = *transfer.grid;
  parallel_for_work(work_of_blocks(transfer), [&](int block) {
    double* tile = transfer.tiles.data() + static_cast<std::size_t>(block) * kTileNodes * 4;
    std::memset(tile, 0, sizeof(double) * kTileNodes * 4);
    const BlockFrame<D> frame(grid, block);
    for (const mpm::Body<D>& body : transfer.bodies) {
      const ParticleSet<D>& set = *body.particles;
      if (set.wet.empty()) continue;  // a body without pores
      const auto range = set.ranges[block];
      for (int p = range.first; p < range.first + range.count; p += kLanes) {
        const Pack solid = load(&set.mass[p]), volume = select(solid > 0, load(&set.volume[p]), Pack{});
        const Pack wet = load(&set.wet[p]) * volume;
        const Pack grains = solid * (1 / set.density_solid);
        Pack fields[4] = {wet, load(&set.wet[p]) * grains};
        if (!set.conductivity.empty()) fields[2] = wet * load(&set.conductivity[p]);
        if (!set.retained_water.empty())
          fields[3] = load(&set.retained_water[p]);
        else if (!set.pore_water.empty())
          fields[3] = load(&set.pore_water[p]) * (volume - grains);
        Reg<4> node[kLanes];
        to_nodes<4>(fields, node);
        Mask start = Mask{};
        alignas(64) double share[D][2][kLanes];
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
          start = start * kTile + (cell - frame.first_node[d]);
        }
        for (int l = 0; l < kLanes; ++l) {
          double* first = tile + start[l] * 4;
          for (int k = 0; k < (D == 3 ? 2 : 1); ++k)
            for (int j = 0; j < 2; ++j)
              for (int i = 0; i < 2; ++i) {
                double f = share[0][i][l] * share[1][j][l];
                if constexpr (D == 3) f *= share[2][k][l];
                double* to = first + (((D == 3 ? k * kTile : 0) + j) * kTile + i) * 4;
                (Reg<4>::load(to) + node[l] * f).store(to);
              }
        }
      }
    }
  });
}

}  // namespace

void scatter_state(mpm::Transfer<2>& t, AffineKind a) {
  if (a == AffineKind::none)
    scatter_skeleton<2, false>(t);
  else
    scatter_skeleton<2, true>(t);
}
void scatter_state(mpm::Transfer<3>& t, AffineKind a) {
  if (a == AffineKind::none)
    scatter_skeleton<3, false>(t);
  else
    scatter_skeleton<3, true>(t);
}
void scatter_pore_water(mpm::Transfer<2>& t, double density, bool kozeny_carman) {
  scatter_water<2>(t, density, kozeny_carman);
}
void scatter_pore_water(mpm::Transfer<3>& t, double density, bool kozeny_carman) {
  scatter_water<3>(t, density, kozeny_carman);
}
void scatter_cells(mpm::Transfer<2>& t) {
  scatter_cells_of(t);
}
void scatter_cells(mpm::Transfer<3>& t) {
  scatter_cells_of(t);
}

}  // namespace polder::POLDER_SIMD_NAMESPACE
