// Particles to nodes.
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

// Lanes of a tile node: those of a sum (mpm/transfer.hpp); a fluid in the plane, without force, does with {m,
// px, py, V}.
template <int D, bool kStress>
inline constexpr int kNodeLanes = D == 2 && !kStress ? 4 : 8;

// What one pack gives to the nodes: one register for each particle.
template <int D, bool kAffine, bool kStress>
struct ScatterFields {
  using Node = Reg<kNodeLanes<D, kStress>>;
  Node value[kLanes];                    // m, m v, f_ext, V
  Node stress[kStress ? D : 1][kLanes];  // -V sigma e_d in the force lanes
  Node affine[kAffine ? D : 1][kLanes];  // m C e_d in the momentum lanes
};

// Values of the cells around the points of a block, for mpm::CellWeight.
template <int D>
struct CellValues {
  static constexpr int kTile = mpm::Transfer<D>::kTileSide;
  alignas(64) double tile[mpm::Transfer<D>::kTileNodes];

  void load(const Grid<D>& grid, int block, const double* of_cell) {
    constexpr int kSide = Grid<D>::kSide;
    const auto& neighbours = grid.neighbours(block);
    const auto copy = [&](int neighbour, int first, int count, double* out) {
      const double* in = of_cell + static_cast<std::ptrdiff_t>(neighbour) * Grid<D>::kCells + first;
      for (int x = 0; x < count; ++x) out[x] = neighbour < 0 ? 0.0 : in[x];
    };
    for (int z = D == 3 ? -1 : 0; z < (D == 3 ? kSide + 1 : 1); ++z)
      for (int y = -1; y < kSide + 1; ++y) {
        const int by = y < 0 ? 0 : y < kSide ? 1 : 2, bz = z < 0 ? 0 : z < kSide ? 1 : 2;
        const int* of_row = &neighbours[(D == 3 ? bz * 9 : 0) + by * 3];
        const int first = ((D == 3 ? (z + kSide) % kSide * kSide : 0) + (y + kSide) % kSide) * kSide;
        double* out = tile + ((D == 3 ? (z + 1) * kTile : 0) + y + 1) * kTile;
        copy(of_row[0], first + kSide - 1, 1, out);
        copy(of_row[1], first, kSide, out + 1);
        copy(of_row[2], first, 1, out + kSide + 1);
      }
  }
  POLDER_INLINE Pack at(const BlockFrame<D>& frame, const Pack* position) const {
    Mask index = Mask{};
    for (int d = D - 1; d >= 0; --d) {
      Mask cell = to_int((position[d] - frame.origin[d]) * frame.inverse_h);
      cell = cell > frame.last_node[d] - 1 ? Mask{} + (frame.last_node[d] - 1) : cell;
      index = index * kTile + (cell - frame.first_node[d]);
    }
    Pack value;
    for (int l = 0; l < kLanes; ++l) value[l] = tile[index[l]];
    return value;
  }
};

// plain: what goes with weights alone. stress: -V sigma, in the order of particle stress. The transposes are
// shared: stress rides in lanes that mass, momentum and volume leave free.
template <int D, bool kAffine>
POLDER_INLINE void transpose_fields(Pack (&plain)[8], bool has_force, const Pack* stress,
                                    ScatterFields<D, kAffine, true>& out) {
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

template <class Fields, int D>
POLDER_INLINE void load_affine(const ParticleSet<D>& set, int p, Pack mass, Fields& out) {
  for (int d = 0; d < D; ++d) {
    constexpr int kLanesOfNode = sizeof(typename Fields::Node) / sizeof(double);
    Pack c[kLanesOfNode] = {};
    for (int i = 0; i < D; ++i) c[1 + i] = mass * load(&set.affine[i * D + d][p]);
    to_nodes<kLanesOfNode>(c, out.affine[d]);
  }
}

// The volume that the pressure of the pore water acts on.
template <int D>
POLDER_INLINE Pack pushed_volume(const mpm::CellWeight& weight, const CellValues<D>& cells,
                                 const BlockFrame<D>& frame, const ParticleSet<D>& set, int p,
                                 const Pack* position, Pack solid, Pack volume) {
  if (weight.of_cell == nullptr) return volume * load(&set.wet[p]);
  Pack part = volume;
  if (weight.grains_only) {
    Pack grains = solid * (1 / set.density_solid);
    if (!set.retained_water.empty()) grains += load(&set.retained_water[p]) * (1 / weight.retained_density);
    part = min(part, grains);
  }
  return cells.at(frame, position) * part;
}

template <int D, bool kAffine>
POLDER_INLINE void load_fields(const mpm::Transfer<D>& transfer, const BlockFrame<D>& frame,
                               const CellValues<D>& cells, const ParticleSet<D>& set, int p,
                               const Pack* position, ScatterFields<D, kAffine, true>& out) {
  constexpr int kForce = 1 + D;  // first force lane
  fetch_ahead(p, set.velocity, set.mass, set.volume, set.stress, set.wet, set.affine);
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
    f[kForce] -= volume * sigma[2] / position[0];
  }
  if (!set.wet.empty())
    f[mpm::Transfer<D>::kVolume] =
        pushed_volume(transfer.weight, cells, frame, set, p, position, solid, volume);
  Pack push[ParticleSet<D>::kStress];
  for (int k = 0; k < ParticleSet<D>::kStress; ++k) push[k] = -volume * sigma[k];
  const bool has_force = !set.body_acceleration[0].empty() || transfer.space == Space::axisymmetric;
  transpose_fields<D, kAffine>(f, has_force, push, out);
  if constexpr (kAffine) load_affine(set, p, mass, out);
}

// Of a fluid.
template <int D, bool kAffine>
POLDER_INLINE void load_fluid(const BlockFrame<D>& frame, const CellValues<D>& cells,
                              const ParticleSet<D>& set, int p, const Pack* position,
                              ScatterFields<D, kAffine, false>& out) {
  constexpr int kLanesOfNode = kNodeLanes<D, false>;
  fetch_ahead(p, set.velocity, set.mass, set.volume, set.affine);
  const Pack mass = load(&set.mass[p]);
  Pack f[kLanesOfNode] = {};
  f[0] = mass;
  for (int d = 0; d < D; ++d) f[1 + d] = mass * load(&set.velocity[d][p]);
  f[kLanesOfNode - 1] = select(mass > 0, load(&set.volume[p]), Pack{}) * cells.at(frame, position);
  to_nodes<kLanesOfNode>(f, out.value);
  if constexpr (kAffine) load_affine(set, p, mass, out);
}

// The same fields of the water in saturated pores: its mass and momentum, -V sigma with sigma = -p, and
// volume over conductivity in place of the volume.
template <int D>
POLDER_INLINE void load_pore_water(const mpm::Transfer<D>& transfer, double density, bool kozeny_carman,
                                   const ParticleSet<D>& set, int p, ScatterFields<D, false, true>& out) {
  constexpr int kForce = 1 + D;
  fetch_ahead(p, set.mass, set.volume, set.wet, set.pore_pressure, set.conductivity, set.water_velocity);
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
template <int D, bool kAffine, bool kStress>
struct LaneWeights {
  alignas(64) double plain[D][3][kLanes];
  alignas(64) double slope[kStress ? D : 1][3][kLanes];   // dN/dx [1/m]
  alignas(64) double offset[kAffine ? D : 1][3][kLanes];  // N (x_node - x_p) [m]
  alignas(64) double product[D == 3 ? 9 : 1][kLanes];     // w1 w2 of node (j, k)

  POLDER_INLINE LaneWeights(const BlockFrame<D>& frame, const TileStencil<D>& s, const Pack* position,
                            double h) {
    for (int d = 0; d < D; ++d)
      for (int a = 0; a < 3; ++a) {
        store(plain[d][a], s.axis[d].weight[a]);
        if constexpr (kStress) store(slope[d][a], s.axis[d].slope[a] * frame.inverse_h);
        if constexpr (kAffine)
          store(offset[d][a], s.axis[d].weight[a] * s.distance(frame, d, a, position[d], h));
      }
    if constexpr (D == 3)
      for (int k = 0; k < 3; ++k)
        for (int j = 0; j < 3; ++j) store(product[k * 3 + j], s.axis[1].weight[j] * s.axis[2].weight[k]);
  }
};

template <int D, bool kAffine, bool kStress>
POLDER_INLINE void scatter_pack(const TileStencil<D>& s, const LaneWeights<D, kAffine, kStress>& weights,
                                const ScatterFields<D, kAffine, kStress>& f, double* tile) {
  constexpr int kTile = mpm::Transfer<D>::kTileSide, kW = kNodeLanes<D, kStress>;
  constexpr bool kAcross = kStress || kAffine;  // something that weights along the other axes multiply
  using Node = Reg<kW>;
  const auto& w = weights.plain;
  const auto& g = weights.slope;
  const auto& r = weights.offset;
#pragma GCC unroll 1
  for (int l = 0; l < kLanes; ++l) {
    double* first = tile + s.start[l] * kW;
    const auto add_across = [&](Node & sum, int d, int a) __attribute__((always_inline)) {
      if constexpr (kStress) sum += f.stress[d][l] * g[d][a][l];
      if constexpr (kAffine) sum += f.affine[d][l] * r[d][a][l];
    };
    // What belongs to node a along an axis and not to the last one.
    const auto across = [&](int d, int a) __attribute__((always_inline)) {
      Node sum{};
      add_across(sum, d, a);
      return sum;
    };
    const auto last_axis = [&](int a) __attribute__((always_inline)) {
      Node sum = f.value[l] * w[D - 1][a][l];
      add_across(sum, D - 1, a);
      return sum;
    };
    const auto add_row = [&](double* to, const Node& plain, const Node(&x)[3], double others)
        __attribute__((always_inline)) {
      for (int i = 0; i < 3; ++i) {
        Node node = Node::load(to + i * kW);
        node += plain * w[0][i][l];
        if constexpr (kAcross) node += x[i] * others;
        node.store(to + i * kW);
      }
    };
    const Node x[3] = {across(0, 0), across(0, 1), across(0, 2)};
    if constexpr (D == 2) {
      for (int j = 0; j < 3; ++j) add_row(first + j * kTile * kW, last_axis(j), x, w[1][j][l]);
    } else {
      const Node y[3] = {across(1, 0), across(1, 1), across(1, 2)};
      for (int k = 0; k < 3; ++k) {
        const Node z = last_axis(k);
        for (int j = 0; j < 3; ++j) {
          Node plain = z * w[1][j][l];
          if constexpr (kAcross) plain += y[j] * w[2][k][l];
          add_row(first + (k * kTile + j) * kTile * kW, plain, x, weights.product[k * 3 + j][l]);
        }
      }
    }
  }
}

// load_of(frame, cells, set, p, position, fields): what goes to the nodes; has(set): whether a body has any
// of it.
template <int D, bool kAffine, bool kStress, class Load, class Has>
void scatter_blocks(mpm::Transfer<D>& transfer, const Load& load_of, const Has& has) {
  constexpr std::size_t kTile = mpm::Transfer<D>::kTileNodes * kNodeLanes<D, kStress>;
  const Grid<D>& grid = *transfer.grid;
  const double h = grid.spacing();
  parallel_for_work(work_of_blocks(transfer), [&](int block) {
    double* tile = transfer.tiles.data() + block * kTile;
    if constexpr (kStress)
      if (transfer.asleep(block) && take_kept(transfer.sleepers[block].state, tile)) return;
    std::memset(tile, 0, sizeof(double) * kTile);
    const BlockFrame<D> frame(grid, block);
    CellValues<D> cells;
    if (transfer.weight.of_cell != nullptr) cells.load(grid, block, transfer.weight.of_cell->data());
    for (const mpm::Body<D>& body : transfer.bodies) {
      const ParticleSet<D>& set = *body.particles;
      if (!has(set)) continue;
      const auto range = set.ranges[block];
      for (int p = range.first; p < range.first + range.count; p += kLanes) {
        fetch_ahead(p, set.position, set.half_size);
        Pack x[D], l[D];
        for (int d = 0; d < D; ++d) x[d] = load(&set.position[d][p]), l[d] = load(&set.half_size[d][p]);
        TileStencil<D> s;
        s.set(frame, transfer.shape, x, l);
        const LaneWeights<D, kAffine, kStress> weights(frame, s, x, h);
        ScatterFields<D, kAffine, kStress> f;
        load_of(frame, cells, set, p, x, f);
        scatter_pack<D, kAffine, kStress>(s, weights, f, tile);
      }
    }
  });
}

template <int D, bool kAffine>
void scatter_skeleton(mpm::Transfer<D>& transfer) {
  scatter_blocks<D, kAffine, true>(
      transfer,
      [&](const BlockFrame<D>& frame, const CellValues<D>& cells, const ParticleSet<D>& set, int p,
          const Pack* x, ScatterFields<D, kAffine, true>& f)
          __attribute__((always_inline)) { load_fields<D, kAffine>(transfer, frame, cells, set, p, x, f); },
      [](const ParticleSet<D>&) { return true; });
}

template <int D, bool kAffine>
void scatter_fluid_of(mpm::Transfer<D>& transfer) {
  scatter_blocks<D, kAffine, false>(
      transfer,
      [&](const BlockFrame<D>& frame, const CellValues<D>& cells, const ParticleSet<D>& set, int p,
          const Pack* x, ScatterFields<D, kAffine, false>& f)
          __attribute__((always_inline)) { load_fluid<D, kAffine>(frame, cells, set, p, x, f); },
      [](const ParticleSet<D>&) { return true; });
}

template <int D>
void scatter_water(mpm::Transfer<D>& transfer, double density, bool kozeny_carman) {
  scatter_blocks<D, false, true>(
      transfer,
      [&](const BlockFrame<D>&, const CellValues<D>&, const ParticleSet<D>& set, int p, const Pack*,
          ScatterFields<D, false, true>& f)
          __attribute__((always_inline)) { load_pore_water<D>(transfer, density, kozeny_carman, set, p, f); },
      [](const ParticleSet<D>& set) { return !set.pore_pressure.empty(); });
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
void scatter_fluid(mpm::Transfer<2>& t, AffineKind a) {
  if (a == AffineKind::none)
    scatter_fluid_of<2, false>(t);
  else
    scatter_fluid_of<2, true>(t);
}
void scatter_fluid(mpm::Transfer<3>& t, AffineKind a) {
  if (a == AffineKind::none)
    scatter_fluid_of<3, false>(t);
  else
    scatter_fluid_of<3, true>(t);
}
void scatter_pore_water(mpm::Transfer<2>& t, double density, bool kozeny_carman) {
  scatter_water<2>(t, density, kozeny_carman);
}
void scatter_pore_water(mpm::Transfer<3>& t, double density, bool kozeny_carman) {
  scatter_water<3>(t, density, kozeny_carman);
}

}  // namespace polder::POLDER_SIMD_NAMESPACE
