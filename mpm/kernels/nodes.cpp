// Node by node: the momentum balance of a step, and the impulse that a node has received.
#include <array>

#include "core/threads.hpp"
#include "mpm/kernels/tile.hpp"
#include "mpm/node_update.hpp"

namespace polder::POLDER_SIMD_NAMESPACE {
namespace {

constexpr int kSum = 8, kVector = 4;  // numbers a node, mpm::Transfer

// Components of a vector, zero in the lanes behind them.
template <int D>
POLDER_INLINE Reg<4> components(Reg<4> v) {
  if constexpr (D == 2)
    return v.template pick<0, 1, -1, -1>();
  else
    return v.template pick<0, 1, 2, -1>();
}

// f(slot) returns what a node adds to the sum over all nodes; blocks are summed in their order.
template <int D, class F>
double sum_over_nodes(const Grid<D>& grid, const F& f) {
  thread_local std::vector<double> store;
  std::vector<double>& parts = store;  // of this thread, for all
  parts.resize(grid.blocks());
  parallel_for(grid.blocks(), [&](int block) {
    double part = 0;
    for (int i = block * Grid<D>::kCells; i < (block + 1) * Grid<D>::kCells; ++i)
      part += f(static_cast<std::size_t>(i));
    parts[block] = part;
  });
  double sum = 0;
  for (double part : parts) sum += part;
  return sum;
}

template <int D>
double predict_of(const Grid<D>& grid, const mpm::NodePrediction<D>& p, const Reals& sums, const Reals& v_old,
                  Reals& v) {
  alignas(32) double g[4] = {};
  for (int d = 0; d < D; ++d) g[d] = p.gravity[d];
  const Reg<4> gravity = Reg<4>::load(g);
  return sum_over_nodes<D>(grid, [&](std::size_t i) {
    const double* s = &sums[i * kSum];
    const Reg<4> old = Reg<4>::load(&v_old[i * kVector]);
    double* out = &v[i * kVector];
    if (!(s[0] > p.mass_floor)) {
      old.store(out);
      return 0.0;
    }
    Reg<4> a = components<D>(Reg<4>::load_any(s + 1 + D)) / s[0] + gravity;
    if (p.acceleration != nullptr) a += components<D>(Reg<4>::load(&(*p.acceleration)[i * kVector]));
    if (p.damping > 0) {
      alignas(32) double f[4];
      a.store(f);
      // Damping of a held component would only falsify its reaction.
      for (int d = 0; d < D; ++d)
        if (const double power = f[d] * v_old[i * kVector + d]; !((*p.held)[i] >> d & 1))
          f[d] *= power > 0 ? 1 - p.damping : power < 0 ? 1 + p.damping : 1.0;
      a = Reg<4>::load(f);
    }
    (old + a * p.dt).store(out);
    return s[0] * s[0];
  });
}

template <int D>
double squared_impulse_of(const Grid<D>& grid, const Reals& sums, const Reals& before, const Reals& after) {
  return sum_over_nodes<D>(grid, [&](std::size_t i) {
    const double mass = sums[i * kSum];
    double square = 0;
    for (int d = 0; d < D; ++d) {
      const double impulse = mass * (after[i * kVector + d] - before[i * kVector + d]);
      square += impulse * impulse;
    }
    return square;
  });
}

}  // namespace

double predict_velocities(const Grid<2>& grid, const mpm::NodePrediction<2>& p, const Reals& sums,
                          const Reals& v_old, Reals& v) {
  return predict_of(grid, p, sums, v_old, v);
}
double predict_velocities(const Grid<3>& grid, const mpm::NodePrediction<3>& p, const Reals& sums,
                          const Reals& v_old, Reals& v) {
  return predict_of(grid, p, sums, v_old, v);
}
double squared_impulse(const Grid<2>& grid, const Reals& sums, const Reals& before, const Reals& after) {
  return squared_impulse_of(grid, sums, before, after);
}
double squared_impulse(const Grid<3>& grid, const Reals& sums, const Reals& before, const Reals& after) {
  return squared_impulse_of(grid, sums, before, after);
}

}  // namespace polder::POLDER_SIMD_NAMESPACE
