#include "tests/verify/mpm_collapse.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>

#include "core/error.hpp"

namespace polder::verify {

CollapseResult collapse(const CollapseOptions& o) {
  constexpr double kGravity = 9.81;
  const double height = o.aspect * o.width, h = o.width / o.cells_across;
  SkeletonOptions options;
  options.shape = o.shape, options.musl = o.musl, options.affine = o.affine,
  options.cell_average = o.cell_average;
  options.flip = o.flip;
  const double length = o.width * (1.5 + 2.5 * o.aspect);
  const Grid<2> grid(
      {0, 0},
      {static_cast<int>(std::lround(length / h)), static_cast<int>(std::lround(1.3 * height / h)) + 3}, h);
  auto sides = all_sides<2>(BoundaryKind::roller);
  sides[2].kind = o.base < 0 ? BoundaryKind::fixed : BoundaryKind::friction;
  sides[2].coefficient = std::max(0.0, o.base);
  Scene<2> scene(grid, options, sides);
  MaterialParameters m = mohr_coulomb(2650, o.young, 0.3, o.friction * std::numbers::pi / 180, o.cohesion, 0);
  m.porosity = 0.4;
  ParticleSet<2>& set = scene.add(m, {0, 0}, {o.width, height});
  scene.gravity = {0, -kGravity};
  // Weight in place at the start: K0 = nu / (1 - nu).
  for (int p = 0; p < set.slots(); ++p) {
    const double vertical = -m.dry_density() * kGravity * (height - set.position[1][p]);
    set.stress[1][p] = vertical, set.stress[0][p] = set.stress[2][p] = vertical * 0.3 / 0.7;
  }
  double volume = 0;
  for (int p = 0; p < set.slots(); ++p) volume += set.volume[p];

  CollapseResult r;
  const auto start = std::chrono::steady_clock::now();
  const double dt = scene.wave_step(o.courant), end = o.duration * std::sqrt(height / kGravity);
  const double fall = std::sqrt(2 * kGravity * height);
  try {
    while (scene.time < end) {
      scene.step(dt);
      r.fastest = std::max(r.fastest, scene.last.largest_speed / fall);
    }
  } catch (const NumericalError&) {  // a runaway point
    r.lost = set.count();
  }
  r.wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  r.steps = scene.steps;
  std::vector<double> reach;
  double left = 0;
  scene.each([&](const ParticleSet<2>& s, int p) {
    const double x = s.position[0][p] + s.half_size[0][p], y = s.position[1][p] + s.half_size[1][p];
    if (!(x > 0 && y > 0 && x < grid.upper()[0] && y < grid.upper()[1])) ++r.lost;
    reach.push_back(x);
    if (s.position[0][p] < h) r.height = std::max(r.height, y / o.width);
    left += s.volume[p];
  });
  std::sort(reach.begin(), reach.end());
  r.front = reach.back() / o.width - 1;
  r.runout = reach[static_cast<std::size_t>(0.99 * reach.size())] / o.width - 1;
  r.volume_change = left / volume - 1;
  r.kinetic = scene.kinetic_energy() / (0.5 * m.dry_density() * kGravity * height * height * o.width);
  return r;
}

}  // namespace polder::verify
