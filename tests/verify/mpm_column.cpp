#include "tests/verify/mpm_column.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "mpm/stress_recovery.hpp"

namespace polder::verify {
namespace {

constexpr double kDensity = 2000, kGravity = 9.81;

template <int D>
ColumnResult settle(const ColumnOptions& o) {
  constexpr int up = D - 1;
  const double h = o.spacing;
  Index<D> cells;
  cells.fill(4);
  cells[up] = static_cast<int>(std::lround(o.height / h)) + 4;
  SkeletonOptions options;
  options.shape = o.shape, options.cell_average = o.cell_average, options.space = o.space;
  Scene<D> scene(Grid<D>(Point<D>{}, cells, h), options, all_sides<D>(BoundaryKind::roller));
  Point<D> upper;
  upper.fill(4 * h);
  upper[up] = o.height;
  ParticleSet<D>& set = scene.add(elastic(kDensity, o.young, 0), Point<D>{}, upper);
  scene.gravity[up] = -kGravity;
  if (o.from_exact_stress)
    for (int p = 0; p < set.slots(); ++p)
      set.stress[up][p] = -kDensity * kGravity * (o.height - set.position[up][p]);
  scene.damping = 0.7;

  ColumnResult r;
  scene.relax(scene.wave_step(0.5), 1e-6, static_cast<long>(150 * o.height / h));
  r.unbalanced = scene.skeleton.unbalanced_force() / scene.skeleton.load_norm();
  r.steps = scene.steps;
  const double scale = kDensity * kGravity * o.height;
  struct Mean {
    double error = 0;
    int count = 0;
  };
  std::map<int, Mean> rows;
  const auto recovered = recover_stress<D>(scene.skeleton.grid(), set);
  double top = 0, square = 0, mass = 0, recovered_square = 0;
  for (int p = 0; p < set.slots(); ++p) {
    if (set.id[p] < 0) continue;
    const double y = set.initial_position[up][p];
    const double error = (set.stress[up][p] + kDensity * kGravity * (o.height - y)) / scale;
    square += error * error;
    const double after = (recovered[up][p] + kDensity * kGravity * (o.height - y)) / scale;
    recovered_square += after * after;
    if (y < h) r.recovered_bottom = std::max(r.recovered_bottom, std::abs(after));
    mass += set.mass[p];
    if (std::abs(error) > std::abs(r.worst)) r.worst = error, r.where = y;
    if (y < h) r.bottom = std::max(r.bottom, std::abs(error));
    Mean& row = rows[static_cast<int>(y / h)];
    row.error += error, ++row.count;
    top = std::max(top, y);
  }
  r.rms = std::sqrt(square / set.count());
  r.recovered_rms = std::sqrt(recovered_square / set.count());
  double cell_square = 0;
  for (const auto& [row, mean] : rows) cell_square += std::pow(mean.error / mean.count, 2);
  r.cell_rms = std::sqrt(cell_square / rows.size());
  r.reaction_error = scene.skeleton.boundaries().reaction(2 * up)[up] / (mass * kGravity) - 1;

  // Height of the highest point: integral of the stretch from the base.
  const double k = kDensity * kGravity / o.young;
  const double exact =
      o.from_exact_stress ? top : (std::exp(-k * (o.height - top)) - std::exp(-k * o.height)) / k;
  double lowest = 0;
  int n = 0;
  for (int p = 0; p < set.slots(); ++p)
    if (set.id[p] >= 0 && set.initial_position[up][p] > top - 1e-9) lowest += set.position[up][p], ++n;
  r.settlement_error = (lowest / n - exact) / (o.from_exact_stress ? o.height : top - exact);
  return r;
}

}  // namespace

ColumnResult settle_column(const ColumnOptions& o) {
  return o.three_d ? settle<3>(o) : settle<2>(o);
}

}  // namespace polder::verify
