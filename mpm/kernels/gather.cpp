// Nodes to particles: velocities, velocity gradients, stress, motion.
#include <algorithm>

#include "core/threads.hpp"
#include "mpm/kernels/tile.hpp"
#include "mpm/material/law.hpp"
#include "mpm/material/rotation.hpp"

namespace polder::POLDER_SIMD_NAMESPACE {
namespace {

using mpm::AffineKind;
using mpm::MoveOptions;
using mpm::MoveResult;

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

template <int D>
void update_velocities_of(mpm::Transfer<D>& t, double flip, const Reals& v_old, const Reals& v_new,
                          bool map) {
  constexpr int kTileNodes = mpm::Transfer<D>::kTileNodes, kTile = mpm::Transfer<D>::kTileSide;
  const Grid<D>& grid = *t.grid;
  parallel_for_work(work_of_blocks(t), [&](int block) {
    alignas(64) double in[kTileNodes * kPair<D>];
    load_pair<D>(grid, block, v_old, v_new, in);
    double* out = t.tiles.data() + static_cast<std::size_t>(block) * kTileNodes * 4;
    if (map) std::memset(out, 0, sizeof(double) * kTileNodes * 4);
    const BlockFrame<D> frame(grid, block);
    for (const mpm::Body<D>& body : t.bodies) {
      ParticleSet<D>& set = *body.particles;
      const auto range = set.ranges[block];
      for (int p = range.first; p < range.first + range.count; p += kLanes) {
        Pack x[D], l[D];
        for (int d = 0; d < D; ++d) x[d] = load(&set.position[d][p]), l[d] = load(&set.half_size[d][p]);
        TileStencil<D> s;
        s.set(frame, t.shape, x, l);
        Gathered<D> q;
        gather_pack<D, Want::values>(in, frame, s, x, grid.spacing(), q);
        Pack v[D];
        for (int d = 0; d < D; ++d) {
          v[d] = flip * (load(&set.velocity[d][p]) + (q.b[d] - q.a[d])) + (1 - flip) * q.b[d];
          store(&set.velocity[d][p], v[d]);
        }
        if (!map) continue;
        const Pack solid = load(&set.mass[p]);
        Pack mass = solid;
        if (!set.pore_water.empty())
          mass += load(&set.pore_water[p]) *
                  (select(solid > 0, load(&set.volume[p]), Pack{}) - solid * (1 / set.density_solid));
        Pack f[4] = {};
        for (int d = 0; d < D; ++d) f[d] = mass * v[d];
        Reg<4> momentum[kLanes];
        to_nodes<4>(f, momentum);
        alignas(64) double w[D][3][kLanes];
        for (int d = 0; d < D; ++d)
          for (int a = 0; a < 3; ++a) store(w[d][a], s.axis[d].weight[a]);
        for (int lane = 0; lane < kLanes; ++lane)
          for (int k = 0; k < (D == 3 ? 3 : 1); ++k)
            for (int j = 0; j < 3; ++j) {
              double* to = out + (s.start[lane] + ((D == 3 ? k * kTile : 0) + j) * kTile) * 4;
              const double wj = w[1][j][lane] * (D == 3 ? w[D - 1][k][lane] : 1.0);
              const Reg<4> row = momentum[lane] * wj;
              for (int i = 0; i < 3; ++i) (Reg<4>::load(to + i * 4) + row * w[0][i][lane]).store(to + i * 4);
            }
      }
    }
  });
}

struct BlockResult {
  double far = 0, fast = 0;  // largest displacement along an axis [cells], largest squared speed
  int body = -1, slot = -1;
  bool finite = true;
};

// Ratio of volumes over the step, det(I + G) (1 + hoop strain), minus one.
template <int D>
POLDER_INLINE Pack dilatation(const Pack* g, Pack hoop_strain) {
  if constexpr (D == 2) {
    const Pack plane = g[0] + g[3] + (g[0] * g[3] - g[1] * g[2]);
    return plane + hoop_strain * (1.0 + plane);
  } else {
    const Pack minors = g[0] * g[4] - g[1] * g[3] + g[0] * g[8] - g[2] * g[6] + g[4] * g[8] - g[5] * g[7];
    const Pack det = g[0] * (g[4] * g[8] - g[5] * g[7]) - g[1] * (g[3] * g[8] - g[5] * g[6]) +
                     g[2] * (g[3] * g[7] - g[4] * g[6]);
    return g[0] + g[4] + g[8] + minors + det;
  }
}

// Strain increments of a pack from its gradient at the midpoint of the step.
template <int D>
POLDER_INLINE void strain_of(const Pack* mid, Pack hoop_strain, Pack* strain) {
  strain[0] = mid[0];
  strain[1] = mid[D + 1];
  strain[2] = D == 3 ? mid[D * D - 1] : hoop_strain / (1.0 + 0.5 * hoop_strain);
  strain[3] = 0.5 * (mid[1] + mid[D]);
  if constexpr (D == 3) {
    strain[4] = 0.5 * (mid[5] + mid[7]);
    strain[5] = 0.5 * (mid[2] + mid[6]);
  }
}

// Motion and domain of a pack. gradient: dt dv_i/dx_j.
template <int D>
POLDER_INLINE void move_pack(ParticleSet<D>& set, int p, Mask real, const Pack* x, const Pack* half_size,
                             const Pack* carried, const Pack* gradient, bool stretches, double dt, double h,
                             int body, BlockResult& result) {
  Pack fast = Pack{}, far = Pack{};
  for (int d = 0; d < D; ++d) {
    const Pack step = select(real, dt * carried[d], Pack{});
    store(&set.position[d][p], x[d] + step);
    if (stretches)
      store(&set.half_size[d][p],
            clamp(half_size[d] * (1.0 + gradient[d * D + d]), 0.5 * set.reference_half_size,
                  std::min(1.5 * set.reference_half_size, 0.5 * h)));
    far = max(far, abs(step) * (1 / h));
    fast += carried[d] * carried[d];
  }
  fast = select(real, fast, Pack{});
  if (all(fast <= broadcast(result.fast)) && all(far <= broadcast(result.far)))
    return;  // nothing new: the rule
  for (int lane = 0; lane < kLanes; ++lane) {
    if (!real[lane]) continue;
    if (!(fast[lane] < 1e12)) result.finite = false;
    if (fast[lane] > result.fast || !(fast[lane] < 1e12))
      result.fast = fast[lane], result.body = body, result.slot = p + lane;
    result.far = std::max(result.far, far[lane]);
  }
}

// What one block of one body needs in move_block.
template <int D>
struct MoveFrame {
  mpm::Transfer<D>& transfer;
  const MoveOptions& options;
  const BlockFrame<D>& block;
  const double* velocities;  // tile of pairs
  bool hoop, usl;
  double h;
};

// Motion of a pack between the gather from the nodes and the law.
template <int D>
struct Motion {
  Pack gradient[D * D];  // dt dv_i/dx_j
  Pack hoop;             // strain across the plane: of hoops, and what the locking cure puts there

  POLDER_INLINE Pack trace() const {
    Pack sum = hoop;
    for (int d = 0; d < D; ++d) sum += gradient[d * D + d];
    return sum;
  }
  // Replace the volumetric strain, a third along each direction: also across the plane, where it is zero in
  // the mean of the cell. So a slice in space does what plane strain does.
  POLDER_INLINE void set_trace(Pack wanted) {
    const Pack correction = (wanted - trace()) * (1.0 / 3);
    for (int d = 0; d < D; ++d) gradient[d * D + d] += correction;
    if constexpr (D == 2) hoop += correction;
  }
};

// Mean volumetric strain over the points of a body that the last sort found in one cell, weighted by volume.
// The mean over the points that carry the stress is the adjoint of their internal force, wherever they have
// moved: a rate taken from the cell's corners is not, and feeds energy into pressure waves once points are
// off their first places.
template <int D>
struct CellMeans {
  double volume[Grid<D>::kCells] = {};
  double strain[Grid<D>::kCells] = {};

  POLDER_INLINE void add(const double* home, const double* volumes, Pack trace) {
    for (int l = 0; l < kLanes; ++l) {
      const int cell = static_cast<int>(home[l]);
      volume[cell] += volumes[l], strain[cell] += volumes[l] * trace[l];
    }
  }
  void divide() {
    for (int c = 0; c < Grid<D>::kCells; ++c) strain[c] = volume[c] > 0 ? strain[c] / volume[c] : 0;
  }
  POLDER_INLINE Pack of(const double* home) const {
    Pack mean;
    for (int l = 0; l < kLanes; ++l) mean[l] = strain[static_cast<int>(home[l])];
    return mean;
  }
};

template <class Stress>
POLDER_INLINE Pack mean_of(const Stress& s) {
  return (s[0] + s[1] + s[2]) * (1.0 / 3);
}

// What the change of volume needs from before the law.
struct BeforeLaw {
  Pack dilatation, mean;
};

// Grains that lose contact fly apart without stress, and push as soon as they approach again. If the volume
// followed such openings it would grow with every bump, and with it every later force V sigma. So where no
// compression is left, the volume of dry soil follows its elastic strain only. The pores of wet soil stay
// full: there it follows the motion.
template <int D>
POLDER_INLINE void update_volume(ParticleSet<D>& set, int p, double bulk_modulus, const BeforeLaw& before,
                                 Pack mean) {
  Pack change = before.dilatation;
  if (bulk_modulus > 0) {
    Mask open = mean >= -1e-9 * bulk_modulus;
    if (!set.wet.empty()) open &= load(&set.wet[p]) == 0;
    change = select(open, (mean - before.mean) * (1 / bulk_modulus), change);
  }
  store(&set.volume[p], load(&set.volume[p]) * (1.0 + change));
}

// First half of a pack's step: velocities, displacement gradient, motion.
template <int D, Want kWant>
POLDER_INLINE void gather_motion(const MoveFrame<D>& m, ParticleSet<D>& set, int p, int body,
                                 Motion<D>& motion, BlockResult& result) {
  const MoveOptions& o = m.options;
  const double dt = o.dt;
  const Mask real = load(&set.mass[p]) > 0;
  Pack x[D], l[D];
  for (int d = 0; d < D; ++d) x[d] = load(&set.position[d][p]), l[d] = load(&set.half_size[d][p]);
  TileStencil<D> s;
  s.set(m.block, m.transfer.shape, x, l);
  Gathered<D> q;
  gather_pack<D, kWant>(m.velocities, m.block, s, x, m.h, q);

  // Velocities: USL blends here; affine takes the grid's; MUSL has done it before the second mapping.
  Pack carried[D];
  for (int d = 0; d < D; ++d) {
    carried[d] = m.usl ? q.b[d] : q.a[d];
    if (m.usl)
      store(&set.velocity[d][p],
            o.flip * (load(&set.velocity[d][p]) + (q.b[d] - q.a[d])) + (1 - o.flip) * q.b[d]);
    else if (o.affine != AffineKind::none)
      store(&set.velocity[d][p], carried[d]);
  }
  if (o.affine != AffineKind::none)
    for (int k = 0; k < D * D; ++k)
      store(&set.affine[k][p], select(real, kWant == Want::moment ? q.moment[k] : q.gradient[k], Pack{}));

  // Padding points feel nothing, so that their state stays harmless.
  for (int k = 0; k < D * D; ++k) motion.gradient[k] = select(real, dt * q.gradient[k], Pack{});
  motion.hoop = m.hoop ? select(real, dt * q.b[0] / x[0], Pack{}) : Pack{};
  move_pack<D>(set, p, real, x, l, carried, motion.gradient, m.transfer.bodies[body].law != nullptr, dt, m.h,
               body, result);
}

// Second half: strain and rotated stress for the law. They refer to the midpoint of the step: a rigid
// rotation, and any path there and back, strains nothing.
template <int D>
POLDER_INLINE void prepare_law(ParticleSet<D>& set, int p, int u, const Motion<D>& motion,
                               StressBatch<D>& batch, BeforeLaw& before) {
  for (int k = 0; k < D * D; ++k) batch.gradient[u][k] = motion.gradient[k];
  Pack mid[D * D];
  for (int k = 0; k < D * D; ++k) mid[k] = motion.gradient[k];
  midpoint_gradient(mid);
  strain_of<D>(mid, motion.hoop, batch.strain[u]);
  for (int k = 0; k < StressBatch<D>::kStress; ++k) batch.stress[u][k] = load(&set.stress[k][p]);
  for (std::size_t k = 0; k < set.state.size(); ++k) batch.state[u][k] = load(&set.state[k][p]);
  rotate_stress(mid, batch.stress[u]);
  before.dilatation = dilatation<D>(motion.gradient, motion.hoop);
  before.mean = mean_of(batch.stress[u]);
}

// The law for the packs [first, first + packs), whose motions stand in `motion`.
template <int D>
POLDER_INLINE void apply_law(const MoveFrame<D>& m, ParticleSet<D>& set, int body, int first, int packs,
                             const Motion<D>* motion) {
  const auto* law = static_cast<const Law<D>*>(m.transfer.bodies[body].law);
  if (law == nullptr) return;
  StressBatch<D> batch;
  batch.packs = packs;
  BeforeLaw before[kBatchPacks];
  for (int u = 0; u < packs; ++u) prepare_law<D>(set, first + u * kLanes, u, motion[u], batch, before[u]);
  law->update(batch);
  for (int u = 0; u < packs; ++u) {
    const int p = first + u * kLanes;
    update_volume<D>(set, p, m.transfer.bodies[body].bulk_modulus, before[u], mean_of(batch.stress[u]));
    for (int k = 0; k < StressBatch<D>::kStress; ++k) store(&set.stress[k][p], batch.stress[u][k]);
    for (std::size_t k = 0; k < set.state.size(); ++k) store(&set.state[k][p], batch.state[u][k]);
  }
}

// Without the locking cure, batch after batch; with it, all motions of the block first, then their cells'
// means.
template <int D, Want kWant>
void move_body(const MoveFrame<D>& m, int block, int body, std::vector<Motion<D>>& motions,
               BlockResult& result) {
  ParticleSet<D>& set = *m.transfer.bodies[body].particles;
  const auto range = set.ranges[block];
  const int packs = range.count / kLanes;
  if (!m.options.cell_average) {
    Motion<D> motion[kBatchPacks];
    for (int u = 0; u < packs; u += kBatchPacks) {
      const int n = std::min(kBatchPacks, packs - u), first = range.first + u * kLanes;
      for (int i = 0; i < n; ++i)
        gather_motion<D, kWant>(m, set, first + i * kLanes, body, motion[i], result);
      apply_law<D>(m, set, body, first, n, motion);
    }
    return;
  }
  if (static_cast<int>(motions.size()) < packs) motions.resize(packs);
  CellMeans<D> means;
  for (int u = 0; u < packs; ++u) {
    const int p = range.first + u * kLanes;
    gather_motion<D, kWant>(m, set, p, body, motions[u], result);
    means.add(&set.home_cell[p], &set.volume[p], motions[u].trace());
  }
  means.divide();
  for (int u = 0; u < packs; ++u) {
    const int p = range.first + u * kLanes;
    const Pack mean = select(load(&set.mass[p]) > 0, means.of(&set.home_cell[p]), Pack{});
    motions[u].set_trace(mean);
  }
  for (int u = 0; u < packs; u += kBatchPacks)
    apply_law<D>(m, set, body, range.first + u * kLanes, std::min(kBatchPacks, packs - u), &motions[u]);
}

template <int D, Want kWant>
BlockResult move_block(mpm::Transfer<D>& t, const MoveOptions& o, const Reals* v_old, const Reals& v_move,
                       const Reals& v_gradient, int block) {
  constexpr int kTileNodes = mpm::Transfer<D>::kTileNodes;
  alignas(64) double velocities[kTileNodes * kPair<D>];
  const bool usl = o.update_velocity && kWant == Want::gradient;
  load_pair<D>(*t.grid, block, usl ? *v_old : v_move, v_gradient, velocities);
  const BlockFrame<D> frame(*t.grid, block);
  const MoveFrame<D> m{t, o, frame, velocities, t.space == Space::axisymmetric, usl, t.grid->spacing()};
  BlockResult result;
  thread_local std::vector<Motion<D>> motions;
  for (std::size_t body = 0; body < t.bodies.size(); ++body)
    move_body<D, kWant>(m, block, static_cast<int>(body), motions, result);
  return result;
}

template <int D, Want kWant>
MoveResult move_of(mpm::Transfer<D>& t, const MoveOptions& o, const Reals* v_old, const Reals& v_move,
                   const Reals& v_gradient) {
  std::vector<BlockResult> results(t.grid->occupied_blocks());
  parallel_for_work(work_of_blocks(t), [&](int block) {
    results[block] = move_block<D, kWant>(t, o, v_old, v_move, v_gradient, block);
  });
  MoveResult total;
  for (const BlockResult& r : results) {
    total.finite &= r.finite;
    total.largest_displacement = std::max(total.largest_displacement, r.far);
    if (r.fast > total.largest_speed || !r.finite)
      total.largest_speed = r.fast, total.fastest_body = r.body, total.fastest_slot = r.slot;
  }
  total.largest_speed = std::sqrt(total.largest_speed);
  return total;
}

template <int D>
MoveResult move_any(mpm::Transfer<D>& t, const MoveOptions& o, const Reals* v_old, const Reals& v_move,
                    const Reals& v_gradient) {
  if (o.affine == AffineKind::apic) return move_of<D, Want::moment>(t, o, v_old, v_move, v_gradient);
  return move_of<D, Want::gradient>(t, o, v_old, v_move, v_gradient);
}

}  // namespace

void update_velocities(mpm::Transfer<2>& t, double f, const Reals& a, const Reals& b, bool m) {
  update_velocities_of(t, f, a, b, m);
}
void update_velocities(mpm::Transfer<3>& t, double f, const Reals& a, const Reals& b, bool m) {
  update_velocities_of(t, f, a, b, m);
}
MoveResult update_stress_and_move(mpm::Transfer<2>& t, const MoveOptions& o, const Reals* a, const Reals& b,
                                  const Reals& c) {
  return move_any(t, o, a, b, c);
}
MoveResult update_stress_and_move(mpm::Transfer<3>& t, const MoveOptions& o, const Reals* a, const Reals& b,
                                  const Reals& c) {
  return move_any(t, o, a, b, c);
}

}  // namespace polder::POLDER_SIMD_NAMESPACE
