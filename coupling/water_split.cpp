// Points of water that have come into pores too small for them. Soil that retains water leaves n (1 - S) for
// the rest, and a point of n h^2 / 4 drawn out along its way there would leave cells without any.
#include <algorithm>
#include <cmath>

#include "coupling/two_layer.hpp"

namespace polder::coupling {
namespace {

constexpr double kTooLarge = 1.5;  // volume over that of a whole point in the pores around

}  // namespace

// A point that is too large becomes two of half its volume with its velocity, a quarter of the points'
// spacing before and behind it on its way through the soil.
template <int D>
void split_points(World<D>& world) {
  if (!world.scene.retains_water()) return;
  const PoreWater<D>& w = *world.pore_water;
  WaterLayer<D>& layer = *world.pore_water->layer;
  ParticleSet<D>& set = layer.fluid.points();
  const Grid<D>& grid = world.skeleton.grid();
  const double lanes = std::round(grid.spacing() / layer.spacing);
  const double room = std::pow(grid.spacing() / lanes, D);
  std::vector<int> large;
  for (int p = 0; p < set.slots(); ++p) {
    if (set.id[p] < 0) continue;
    const int slot = grid.slot(set.cell_of(grid, p));
    if (slot >= 0 && layer.soil_fill[slot] > 0 && set.volume[p] > kTooLarge * w.porosity[slot] * room)
      large.push_back(p);
  }
  if (large.empty()) return;
  const int first = set.slots();
  set.append(static_cast<int>(large.size()));
  for (const ParticleField& f : set.fields())
    for (std::size_t k = 0; k < large.size(); ++k)
      (*f.values)[static_cast<std::size_t>(first) + k] = (*f.values)[large[k]];
  for (std::size_t k = 0; k < large.size(); ++k) {
    const int p = large[k], q = first + static_cast<int>(k);
    int along = 0;
    for (int d = 1; d < D; ++d)
      if (std::abs(set.velocity[d][p]) > std::abs(set.velocity[along][p])) along = d;
    const double low = grid.origin()[along], high = low + grid.cells()[along] * grid.spacing();
    const double step = std::min(
        {0.25 * layer.spacing, 0.5 * (set.position[along][p] - low), 0.5 * (high - set.position[along][p])});
    set.position[along][p] -= step, set.position[along][q] += step;
    set.volume[p] = set.volume[q] = 0.5 * set.volume[p];
    set.mass[p] = set.mass[q] = set.volume[p] * world.scene.water.density;
  }
  world.skeleton.add_travel(1);  // the next step sorts them in
}

template void split_points<2>(World<2>&);
template void split_points<3>(World<3>&);

}  // namespace polder::coupling
