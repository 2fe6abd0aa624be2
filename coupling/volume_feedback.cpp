#include "coupling/volume_feedback.hpp"

#include <numeric>

#include "coupling/cell_overlap.hpp"

namespace polder::coupling {
namespace {

constexpr double kMostWithdrawn = 0.5;  // of the water that a cell can give, in one step

// f(body, slot of the point, its overlap) for every point of porous soil, in their order.
template <int D, class F>
void each_porous_point(const World<D>& world, const F& f) {
  const auto& bodies = world.skeleton.bodies();
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const ParticleSet<D>& set = *bodies[b];
    if (set.pore_water.empty()) continue;
    for (int p = 0; p < set.slots(); ++p)
      if (set.id[p] >= 0) f(b, p, overlap_of(world.skeleton.grid(), set, p));
  }
}

// Compliance of the soil in each cell, the mean over its points.
template <int D>
void find_compressibility(World<D>& world) {
  const std::size_t slots = static_cast<std::size_t>(world.skeleton.grid().slots());
  Reals& mean = world.pore_water->feedback.compressibility;
  Reals weight(slots, 0.0);
  mean.assign(slots, 0.0);
  each_porous_point(world, [&](std::size_t b, int p, const Overlap<D>& o) {
    const ParticleSet<D>& set = *world.skeleton.bodies()[b];
    const mpm::MaterialParameters& m = world.materials[set.material];
    const double compliance = 1 / (m.lame_lambda() + m.shear_modulus());
    for (int k = 0; k < ipow(2, D); ++k) {
      if (o.slot[k] < 0) continue;
      weight[o.slot[k]] += o.share[k] * set.volume[p];
      mean[o.slot[k]] += o.share[k] * set.volume[p] * compliance;
    }
  });
  for (std::size_t i = 0; i < slots; ++i)
    if (weight[i] > 0) mean[i] /= weight[i];
}

// Gives what is asked of inactive cells to the active ones beside them in equal parts, across faces or, where
// there are none, across edges and corners. Returns what finds none.
template <int D>
double hand_over_slivers(const World<D>& world, Reals& asked) {
  const PoreWater<D>& w = *world.pore_water;
  const Grid<D>& grid = world.skeleton.grid();
  double nowhere = 0;
  for (int i = 0; i < grid.slots(); ++i) {
    if (w.cells.active(i) || asked[i] == 0) continue;
    const Index<D> index = grid.index(i);
    int faces[2 * D], others[ipow(3, D)], n_faces = 0, n_others = 0;
    for (int k = 0; k < ipow(3, D); ++k) {
      Index<D> beside = index;
      int apart = 0;
      for (int d = 0, j = k; d < D; ++d, j /= 3) beside[d] += j % 3 - 1, apart += j % 3 != 1;
      const int slot = apart > 0 && grid.is_cell(beside) ? grid.slot(beside) : -1;
      if (slot < 0 || !w.cells.active(slot)) continue;
      if (apart == 1)
        faces[n_faces++] = slot;
      else
        others[n_others++] = slot;
    }
    const int* to = n_faces > 0 ? faces : others;
    const int n = n_faces > 0 ? n_faces : n_others;
    for (int k = 0; k < n; ++k) asked[to[k]] += asked[i] / n;
    if (n == 0) nowhere += asked[i];
    asked[i] = 0;
  }
  return nowhere;
}

double sum_of(const Reals& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

}  // namespace

template <int D>
std::vector<Reals> point_volumes(const World<D>& world) {
  std::vector<Reals> volumes;
  for (const auto& body : world.skeleton.bodies()) {
    Reals v(static_cast<std::size_t>(body->count()), 0.0);
    for (int p = 0; p < body->slots(); ++p)
      if (body->id[p] >= 0) v[static_cast<std::size_t>(body->id[p])] = body->volume[p];
    volumes.push_back(std::move(v));
  }
  return volumes;
}

template <int D>
void begin_feedback(World<D>& world) {
  VolumeFeedback& f = world.pore_water->feedback;
  if (!f.owed.empty()) return;  // one such stage after another
  const std::size_t slots = static_cast<std::size_t>(world.skeleton.grid().slots());
  f.foreseen.assign(slots, 0.0), f.owed.assign(slots, 0.0);
  find_compressibility(world);
}

template <int D>
double end_feedback(World<D>& world) {
  PoreWater<D>& w = *world.pore_water;
  const double left = sum_of(w.feedback.owed);
  w.storage += left;
  w.feedback = {};
  return left;
}

template <int D>
double charge_volume(World<D>& world, const std::vector<Reals>& before) {
  PoreWater<D>& w = *world.pore_water;
  VolumeFeedback& f = w.feedback;
  double opened = 0;
  each_porous_point(world, [&](std::size_t b, int p, const Overlap<D>& o) {
    const ParticleSet<D>& set = *world.skeleton.bodies()[b];
    const double saturation = w.unsaturated ? set.pore_water[p] / world.scene.water.density : set.wet[p];
    const double water = saturation * (set.volume[p] - before[b][static_cast<std::size_t>(set.id[p])]);
    opened += water;
    for (int k = 0; k < ipow(2, D); ++k)
      if (o.slot[k] >= 0) f.owed[o.slot[k]] += o.share[k] * water;
  });
  for (std::size_t i = 0; i < f.owed.size(); ++i) f.owed[i] -= f.foreseen[i], f.foreseen[i] = 0;
  const double nowhere = hand_over_slivers(world, f.owed);
  w.storage += nowhere - opened;
  find_compressibility(world);
  return nowhere;
}

template <int D>
const Reals& withdrawal(World<D>& world, double dt) {
  PoreWater<D>& w = *world.pore_water;
  VolumeFeedback& f = w.feedback;
  f.rate.assign(static_cast<std::size_t>(w.cells.count()), 0.0);
  for (int c = 0; c < w.cells.count(); ++c) {
    const fdm::ActiveCell<D>& cell = w.cells.cells()[c];
    const int i = cell.slot;
    double taken = f.owed[i];
    if (w.unsaturated && taken > 0) {
      const UnsaturatedWater<D>& u = *w.unsaturated;
      const fdm::RetentionCurve& curve = u.field.curve(u.soil[i]);
      if (!curve.always_saturated()) {
        const double pores = w.porosity[i] * u.volume_fraction[i] * cell.volume;
        const double room = std::max(0.0, u.field.saturation()[i] - curve.parameters().residual);
        taken = std::min(taken, kMostWithdrawn * pores * room);
      }
    }
    f.rate[static_cast<std::size_t>(c)] = taken / dt;
  }
  return f.rate;
}

template <int D>
void settle_withdrawal(World<D>& world, double dt, const Reals& before) {
  PoreWater<D>& w = *world.pore_water;
  VolumeFeedback& f = w.feedback;
  const Reals& pressure = w.pore_pressure();
  for (int c = 0; c < w.cells.count(); ++c) {
    const fdm::ActiveCell<D>& cell = w.cells.cells()[c];
    const int i = cell.slot;
    const double taken = dt * f.rate[static_cast<std::size_t>(c)];
    f.owed[i] -= taken, w.storage += taken;
    const double share =
        w.unsaturated ? w.unsaturated->volume_fraction[i] * w.unsaturated->field.saturation()[i] : 1.0;
    f.foreseen[i] += share * cell.volume * f.compressibility[i] * (pressure[i] - before[i]);
  }
}

#define POLDER_INSTANTIATE(D)                                             \
  template std::vector<Reals> point_volumes<D>(const World<D>&);          \
  template void begin_feedback<D>(World<D>&);                             \
  template double end_feedback<D>(World<D>&);                             \
  template double charge_volume<D>(World<D>&, const std::vector<Reals>&); \
  template const Reals& withdrawal<D>(World<D>&, double);                 \
  template void settle_withdrawal<D>(World<D>&, double, const Reals&);
POLDER_INSTANTIATE(2)
POLDER_INSTANTIATE(3)

}  // namespace polder::coupling
