// Nodes to particles: velocities of the skeleton and of the pore water that points carry, what of it flows
// out of them.
#include <algorithm>

#include "core/threads.hpp"
#include "mpm/kernels/gather_pack.hpp"

namespace polder::POLDER_SIMD_NAMESPACE {
namespace {

// Mass and velocity of the skeleton, with the water that its points count to it.
template <int D>
struct OfSkeleton {
  static std::array<Reals, D>& velocity(ParticleSet<D>& set) { return set.velocity; }
  static bool present(const ParticleSet<D>&) { return true; }
  POLDER_INLINE Pack mass(const ParticleSet<D>& set, int p) const {
    const Pack solid = load(&set.mass[p]);
    if (set.pore_water.empty()) return solid;
    const Pack retained = set.retained_water.empty() ? Pack{} : load(&set.retained_water[p]);
    return solid + retained +
           load(&set.pore_water[p]) *
               (select(solid > 0, load(&set.volume[p]), Pack{}) - solid * (1 / set.density_solid));
  }
};

// The same of the water in saturated pores, where it has a velocity of its own.
template <int D>
struct OfPoreWater {
  double density;
  static std::array<Reals, D>& velocity(ParticleSet<D>& set) { return set.water_velocity; }
  static bool present(const ParticleSet<D>& set) { return !set.water_velocity[0].empty(); }
  POLDER_INLINE Pack mass(const ParticleSet<D>& set, int p) const {
    const Pack solid = load(&set.mass[p]);
    return density * load(&set.wet[p]) *
           (select(solid > 0, load(&set.volume[p]), Pack{}) - solid * (1 / set.density_solid));
  }
};

template <int D, class Phase>
void update_velocities_of(mpm::Transfer<D>& t, const Phase& phase, double flip, const Reals& v_old,
                          const Reals& v_new, bool map) {
  constexpr int kTileNodes = mpm::Transfer<D>::kTileNodes, kTile = mpm::Transfer<D>::kTileSide;
  const Grid<D>& grid = *t.grid;
  parallel_for_work(work_of_blocks(t), [&](int block) {
    double* out = t.tiles.data() + static_cast<std::size_t>(block) * kTileNodes * 4;
    if (map) std::memset(out, 0, sizeof(double) * kTileNodes * 4);
    if (t.asleep(block)) return;
    alignas(64) double in[kTileNodes * 2 * kVectorLanes<D>];
    load_tile<D, 2>(grid, block, {v_old.data(), v_new.data()}, in);
    const BlockFrame<D> frame(grid, block);
    for (const mpm::Body<D>& body : t.bodies) {
      ParticleSet<D>& set = *body.particles;
      if (!Phase::present(set)) continue;
      std::array<Reals, D>& velocity = Phase::velocity(set);
      const auto range = set.ranges[block];
      for (int p = range.first; p < range.first + range.count; p += kLanes) {
        fetch_ahead(p, set.position, set.half_size, velocity, set.mass);
        Pack x[D], l[D];
        for (int d = 0; d < D; ++d) x[d] = load(&set.position[d][p]), l[d] = load(&set.half_size[d][p]);
        TileStencil<D> s;
        s.set(frame, t.shape, x, l);
        Gathered<D> q;
        gather_pack<D, 2, Want::values>(in, frame, s, x, grid.spacing(), q);
        Pack v[D];
        for (int d = 0; d < D; ++d) {
          v[d] = flip * (load(&velocity[d][p]) + (q.value[d] - q.before[d])) + (1 - flip) * q.value[d];
          store(&velocity[d][p], v[d]);
        }
        if (!map) continue;
        const Pack mass = phase.mass(set, p);
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

template <int D>
double shift_points_of(mpm::Transfer<D>& t, const Reals& displacement, double most) {
  const Grid<D>& grid = *t.grid;
  thread_local std::vector<double> work;  // space of the calling thread, for all
  std::vector<double>& far = work;
  far.assign(grid.occupied_blocks(), 0.0);
  parallel_for_work(work_of_blocks(t), [&](int block) {
    alignas(64) double in[mpm::Transfer<D>::kTileNodes * kVectorLanes<D>];
    load_tile<D, 1>(grid, block, {displacement.data()}, in);
    const BlockFrame<D> frame(grid, block);
    Pack largest = Pack{};
    for (const mpm::Body<D>& body : t.bodies) {
      ParticleSet<D>& set = *body.particles;
      const auto range = set.ranges[block];
      for (int p = range.first; p < range.first + range.count; p += kLanes) {
        const Mask real = load(&set.mass[p]) > 0;
        Pack x[D];
        for (int d = 0; d < D; ++d) x[d] = load(&set.position[d][p]);
        TileStencil<D> s;
        s.set(frame, mpm::ShapeKind::linear, x, x);  // hats know no half sizes
        Gathered<D> q;
        gather_pack<D, 1, Want::gradient>(in, frame, s, x, grid.spacing(), q);
        for (int d = 0; d < D; ++d) {
          const Pack move = select(real, clamp(q.value[d], -most, most), Pack{});
          store(&set.position[d][p], x[d] + move);
          largest = max(largest, abs(move));
        }
      }
    }
    for (int l = 0; l < kLanes; ++l) far[block] = std::max(far[block], largest[l]);
  });
  return far.empty() ? 0.0 : *std::max_element(far.begin(), far.end());
}

// Of the points of a body in one cell.
template <int D>
struct CellSums {
  double volume[Grid<D>::kCells] = {};
  double expelled[Grid<D>::kCells] = {};
  double mean(int cell) const { return volume[cell] > 0 ? expelled[cell] / volume[cell] : 0; }
};

// Divergence of a nodal velocity at the points of a block, times the step; mean: of the points of a body in a
// cell.
template <int D>
void gather_expelled_block(mpm::Transfer<D>& t, double dt, const Reals& flow, bool mean, int block) {
  alignas(64) double in[mpm::Transfer<D>::kTileNodes * kVectorLanes<D>];
  load_tile<D, 1>(*t.grid, block, {flow.data()}, in);
  const BlockFrame<D> frame(*t.grid, block);
  const bool radial = t.space == Space::axisymmetric;
  for (const mpm::Body<D>& body : t.bodies) {
    ParticleSet<D>& set = *body.particles;
    if (set.expelled.empty()) continue;
    const auto range = set.ranges[block];
    CellSums<D> cells;
    for (int p = range.first; p < range.first + range.count; p += kLanes) {
      Pack x[D], l[D];
      for (int d = 0; d < D; ++d) x[d] = load(&set.position[d][p]), l[d] = load(&set.half_size[d][p]);
      TileStencil<D> s;
      s.set(frame, t.shape, x, l);
      Gathered<D> q;
      gather_pack<D, 1, Want::gradient>(in, frame, s, x, t.grid->spacing(), q);
      Pack divergence = q.gradient[0];
      for (int d = 1; d < D; ++d) divergence += q.gradient[d * D + d];
      if (radial) divergence += q.value[0] / x[0];
      const Pack expelled = dt * load(&set.wet[p]) * divergence;
      store(&set.expelled[p], expelled);
      if (!mean) continue;
      for (int i = 0; i < kLanes; ++i) {
        const int cell = static_cast<int>(set.home_cell[p + i]);
        const double wet = set.wet[p + i] * set.volume[p + i];
        cells.volume[cell] += wet, cells.expelled[cell] += wet * expelled[i];
      }
    }
    if (!mean) continue;
    for (int p = range.first; p < range.first + range.count; ++p)
      set.expelled[p] = set.wet[p] * cells.mean(static_cast<int>(set.home_cell[p]));
  }
}

template <int D>
void gather_expelled_of(mpm::Transfer<D>& t, double dt, const Reals& flow, bool mean) {
  parallel_for_work(work_of_blocks(t),
                    [&](int block) { gather_expelled_block<D>(t, dt, flow, mean, block); });
}

}  // namespace

void update_velocities(mpm::Transfer<2>& t, double f, const Reals& a, const Reals& b, bool m) {
  update_velocities_of(t, OfSkeleton<2>{}, f, a, b, m);
}
void update_velocities(mpm::Transfer<3>& t, double f, const Reals& a, const Reals& b, bool m) {
  update_velocities_of(t, OfSkeleton<3>{}, f, a, b, m);
}
void update_pore_velocities(mpm::Transfer<2>& t, double w, double f, const Reals& a, const Reals& b, bool m) {
  update_velocities_of(t, OfPoreWater<2>{w}, f, a, b, m);
}
void update_pore_velocities(mpm::Transfer<3>& t, double w, double f, const Reals& a, const Reals& b, bool m) {
  update_velocities_of(t, OfPoreWater<3>{w}, f, a, b, m);
}
void gather_expelled(mpm::Transfer<2>& t, double dt, const Reals& flow, bool mean) {
  gather_expelled_of(t, dt, flow, mean);
}
void gather_expelled(mpm::Transfer<3>& t, double dt, const Reals& flow, bool mean) {
  gather_expelled_of(t, dt, flow, mean);
}

double shift_points(mpm::Transfer<2>& t, const Reals& u, double most) {
  return shift_points_of(t, u, most);
}
double shift_points(mpm::Transfer<3>& t, const Reals& u, double most) {
  return shift_points_of(t, u, most);
}

}  // namespace polder::POLDER_SIMD_NAMESPACE
