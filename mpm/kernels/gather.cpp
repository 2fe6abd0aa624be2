// Nodes to particles: velocity gradients, stress, motion.
#include <algorithm>

#include "core/threads.hpp"
#include "mpm/kernels/gather_pack.hpp"
#include "mpm/material/law.hpp"
#include "mpm/material/rotation.hpp"

namespace polder::POLDER_SIMD_NAMESPACE {
namespace {

using mpm::AffineKind;
using mpm::MoveOptions;
using mpm::MoveResult;

struct BlockResult {
  double far = 0, fast = 0;  // largest displacement along an axis [cells], largest squared speed
  int body = -1, slot = -1;
  bool finite = true;
};

constexpr double kRunaway = 1e12;  // squared speed beyond which a point counts as gone

// The same while the packs of a body go by, lane by lane.
struct Fastest {
  Pack far = Pack{}, fast = Pack{};
  Mask first = Mask{};  // of the pack with the lane's fastest point

  POLDER_INLINE void look(int p, Pack square, Pack displacement) {
    const Mask faster = (square > fast) | ~(square < kRunaway);  // not a number stays
    fast = select(faster, square, fast);
    first = faster ? Mask{} + p : first;
    far = max(far, displacement);
  }
  void add_to(BlockResult& result, int body) const {
    for (int l = 0; l < kLanes; ++l) {
      const bool gone = !(fast[l] < kRunaway);
      const int slot = static_cast<int>(first[l]) + l;
      const bool earlier = fast[l] == result.fast && body == result.body && slot < result.slot;
      if (gone) result.finite = false;
      if (gone || fast[l] > result.fast || earlier)
        result.fast = fast[l], result.body = body, result.slot = slot;
      result.far = std::max(result.far, far[l]);
    }
  }
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
                             Fastest& fastest) {
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
  fastest.look(p, select(real, fast, Pack{}), far);
}

// What one block of one body needs in move_block.
template <int D>
struct MoveFrame {
  mpm::Transfer<D>& transfer;
  const MoveOptions& options;
  const BlockFrame<D>& block;
  const double* velocities;  // tile of kFields vectors
  bool hoop;
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
template <int D, int kFields, Want kWant>
POLDER_INLINE void gather_motion(const MoveFrame<D>& m, ParticleSet<D>& set, int p, int body,
                                 Motion<D>& motion, Fastest& fastest) {
  const MoveOptions& o = m.options;
  const double dt = o.dt;
  const Mask real = load(&set.mass[p]) > 0;
  fetch_ahead(p, set.position, set.half_size, set.velocity, set.mass, set.volume, set.stress, set.state);
  Pack x[D], l[D];
  for (int d = 0; d < D; ++d) x[d] = load(&set.position[d][p]), l[d] = load(&set.half_size[d][p]);
  TileStencil<D> s;
  s.set(m.block, m.transfer.shape, x, l);
  Gathered<D> q;
  gather_pack<D, kFields, kWant>(m.velocities, m.block, s, x, m.h, q);

  // Velocities: USL blends here; affine takes the grid's; MUSL has done it before the second mapping.
  for (int d = 0; d < D; ++d) {
    if constexpr (kFields == 2)
      store(&set.velocity[d][p],
            o.flip * (load(&set.velocity[d][p]) + (q.value[d] - q.before[d])) + (1 - o.flip) * q.value[d]);
    else if (o.affine != AffineKind::none)
      store(&set.velocity[d][p], q.value[d]);
  }
  if constexpr (kWant == Want::values) {  // nothing that strains
    motion = Motion<D>{};
  } else {
    if (o.affine != AffineKind::none)
      for (int k = 0; k < D * D; ++k)
        store(&set.affine[k][p], select(real, kWant == Want::moment ? q.moment[k] : q.gradient[k], Pack{}));

    // Padding points feel nothing, so that their state stays harmless.
    for (int k = 0; k < D * D; ++k) motion.gradient[k] = select(real, dt * q.gradient[k], Pack{});
    motion.hoop = m.hoop ? select(real, dt * q.value[0] / x[0], Pack{}) : Pack{};
  }
  move_pack<D>(set, p, real, x, l, q.value, motion.gradient, m.transfer.bodies[body].law != nullptr, dt, m.h,
               fastest);
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
template <int D, int kFields, Want kWant>
void move_body(const MoveFrame<D>& m, int block, int body, std::vector<Motion<D>>& motions,
               Fastest& fastest) {
  ParticleSet<D>& set = *m.transfer.bodies[body].particles;
  const auto range = set.ranges[block];
  const int packs = range.count / kLanes;
  if (!m.options.cell_average) {
    Motion<D> motion[kBatchPacks];
    for (int u = 0; u < packs; u += kBatchPacks) {
      const int n = std::min(kBatchPacks, packs - u), first = range.first + u * kLanes;
      for (int i = 0; i < n; ++i)
        gather_motion<D, kFields, kWant>(m, set, first + i * kLanes, body, motion[i], fastest);
      apply_law<D>(m, set, body, first, n, motion);
    }
    return;
  }
  if (static_cast<int>(motions.size()) < packs) motions.resize(packs);
  CellMeans<D> means;
  for (int u = 0; u < packs; ++u) {
    const int p = range.first + u * kLanes;
    gather_motion<D, kFields, kWant>(m, set, p, body, motions[u], fastest);
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

// fields: v, or v_old and v.
template <int D, int kFields, Want kWant>
MoveResult move_of(mpm::Transfer<D>& t, const MoveOptions& o,
                   const std::array<const double*, kFields>& fields) {
  thread_local std::vector<BlockResult> store;  // work space of the calling thread, for all
  std::vector<BlockResult>& results = store;
  results.assign(t.grid->occupied_blocks(), BlockResult{});
  parallel_for_work(work_of_blocks(t), [&](int block) {
    if (t.asleep(block)) return;
    alignas(64) double velocities[mpm::Transfer<D>::kTileNodes * kVectorLanes<D> * kFields];
    load_tile<D, kFields>(*t.grid, block, fields, velocities);
    const BlockFrame<D> frame(*t.grid, block);
    const MoveFrame<D> m{t, o, frame, velocities, t.space == Space::axisymmetric, t.grid->spacing()};
    thread_local std::vector<Motion<D>> motions;
    for (std::size_t body = 0; body < t.bodies.size(); ++body) {
      Fastest fastest;
      move_body<D, kFields, kWant>(m, block, static_cast<int>(body), motions, fastest);
      fastest.add_to(results[block], static_cast<int>(body));
    }
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
MoveResult move_any(mpm::Transfer<D>& t, const MoveOptions& o, const Reals* v_old, const Reals& v) {
  if (o.affine == AffineKind::apic) return move_of<D, 1, Want::moment>(t, o, {v.data()});
  const bool strains = std::any_of(t.bodies.begin(), t.bodies.end(),
                                   [](const mpm::Body<D>& body) { return body.law != nullptr; });
  if (o.update_velocity && !strains && o.affine == AffineKind::none)
    return move_of<D, 2, Want::values>(t, o, {v_old->data(), v.data()});
  if (o.update_velocity) return move_of<D, 2, Want::gradient>(t, o, {v_old->data(), v.data()});
  return move_of<D, 1, Want::gradient>(t, o, {v.data()});
}

}  // namespace

MoveResult update_stress_and_move(mpm::Transfer<2>& t, const MoveOptions& o, const Reals* a, const Reals& b) {
  return move_any(t, o, a, b);
}
MoveResult update_stress_and_move(mpm::Transfer<3>& t, const MoveOptions& o, const Reals* a, const Reals& b) {
  return move_any(t, o, a, b);
}

}  // namespace polder::POLDER_SIMD_NAMESPACE
