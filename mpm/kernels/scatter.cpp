// Particles to nodes and cells.
//
// With the stencil's weights N_i = w0 w1 (w2), node i gets
//   m_i += N m            p_i += N m (v + C (x_i - x_p))            f_i += N f_ext - V sigma grad N V_i += N
//   V
// The tensor product is summed axis by axis: what multiplies a plain weight and what multiplies a slope along
// the last axis are carried in two registers, so a node costs two or three fused multiply-adds of a whole
// register.
#include <algorithm>

#include "core/threads.hpp"
#include "mpm/kernels/tile.hpp"

namespace polder::POLDER_SIMD_NAMESPACE {
namespace {

using mpm::AffineKind;

// Fields of one pack that go to the nodes, transposed: one register for each particle.
template <int D, bool kAffine>
struct ScatterFields {
  Reg<8> value[kLanes];                    // m, m v, f_ext, V
  Reg<8> stress[D][kLanes];                // -V sigma e_d in the force lanes
  Reg<8> affine[kAffine ? D : 1][kLanes];  // m C e_d in the momentum lanes
};

template <int D, bool kAffine>
POLDER_INLINE void load_fields(const mpm::Transfer<D>& transfer, const ParticleSet<D>& set, int p,
                               ScatterFields<D, kAffine>& out) {
  constexpr int kForce = 1 + D;  // first force lane
  const Pack solid = load(&set.mass[p]);
  const Mask real = solid > 0;
  const Pack volume = select(real, load(&set.volume[p]), Pack{});
  Pack mass = solid;
  if (!set.pore_water.empty()) mass += load(&set.pore_water[p]) * (volume - solid * (1 / set.density_solid));
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
  to_nodes<8>(f, out.value);

  constexpr int xy = 3, yz = D == 3 ? 4 : 0, zx = D == 3 ? 5 : 0;
  const int row[3][3] = {{0, xy, zx}, {xy, 1, yz}, {zx, yz, 2}};
  for (int d = 0; d < D; ++d) {
    Pack s[8] = {};
    for (int i = 0; i < D; ++i) s[kForce + i] = -volume * sigma[row[d][i]];
    to_nodes<8>(s, out.stress[d]);
  }
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
  to_nodes<8>(f, out.value);
  for (int d = 0; d < D; ++d) {
    Pack s[8] = {};
    s[kForce + d] = push;
    to_nodes<8>(s, out.stress[d]);
  }
}

POLDER_INLINE void add(double* node, const Reg<8>& value) {
  (Reg<8>::load(node) + value).store(node);
}

template <int D, bool kAffine>
POLDER_INLINE void scatter_pack(const TileStencil<D>& s, const double (&w)[D][3][kLanes],
                                const double (&g)[D][3][kLanes], const double (&r)[D][3][kLanes],
                                const ScatterFields<D, kAffine>& f, double* tile) {
  constexpr int kTile = mpm::Transfer<D>::kTileSide;
  for (int l = 0; l < kLanes; ++l) {
    double* first = tile + s.start[l] * 8;
    if constexpr (D == 2) {
      Reg<8> plain[3], slope[3], offset[3];
      for (int i = 0; i < 3; ++i) {
        plain[i] = f.value[l] * w[0][i][l] + f.stress[0][l] * g[0][i][l];
        slope[i] = f.stress[1][l] * w[0][i][l];
        if constexpr (kAffine) {
          plain[i] += f.affine[0][l] * r[0][i][l];
          offset[i] = f.affine[1][l] * w[0][i][l];
        }
      }
      for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 3; ++i) {
          Reg<8> n = plain[i] * w[1][j][l] + slope[i] * g[1][j][l];
          if constexpr (kAffine) n += offset[i] * r[1][j][l];
          add(first + (j * kTile + i) * 8, n);
        }
    } else {
      for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 3; ++i) {
          const double ww = w[0][i][l] * w[1][j][l];
          Reg<8> plain = f.value[l] * ww + f.stress[0][l] * (g[0][i][l] * w[1][j][l]) +
                         f.stress[1][l] * (w[0][i][l] * g[1][j][l]);
          Reg<8> slope = f.stress[2][l] * ww, offset{};
          if constexpr (kAffine) {
            plain += f.affine[0][l] * (r[0][i][l] * w[1][j][l]) + f.affine[1][l] * (w[0][i][l] * r[1][j][l]);
            offset = f.affine[2][l] * ww;
          }
          for (int k = 0; k < 3; ++k) {
            Reg<8> n = plain * w[2][k][l] + slope * g[2][k][l];
            if constexpr (kAffine) n += offset * r[2][k][l];
            add(first + ((k * kTile + j) * kTile + i) * 8, n);
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
        Pack x[D], l[D];
        for (int d = 0; d < D; ++d) x[d] = load(&set.position[d][p]), l[d] = load(&set.half_size[d][p]);
        TileStencil<D> s;
        s.set(frame, transfer.shape, x, l);
        alignas(64) double w[D][3][kLanes], g[D][3][kLanes], r[D][3][kLanes];
        for (int d = 0; d < D; ++d)
          for (int a = 0; a < 3; ++a) {
            store(w[d][a], s.axis[d].weight[a]);
            store(g[d][a], s.axis[d].slope[a] * frame.inverse_h);
            if constexpr (kAffine) store(r[d][a], s.axis[d].weight[a] * s.distance(frame, d, a, x[d], h));
          }
        ScatterFields<D, kAffine> f;
        load_of(set, p, f);
        scatter_pack<D, kAffine>(s, w, g, r, f, tile);
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
        if (!set.pore_water.empty()) fields[3] = load(&set.pore_water[p]) * (volume - grains);
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
