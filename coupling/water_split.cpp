// Points of water on their way into pores too small for them: one of h^2 / 4 from open water would be drawn
// out to 1 / n of its length in soil of porosity n, longer than a cell, and leave cells by turns with too
// much water and too little (in a falling head by up to a tenth of the cell). Soil that retains water leaves
// n (1 - S) for the rest.
#include <algorithm>
#include <cmath>

#include "coupling/two_layer.hpp"

namespace polder::coupling {
namespace {

constexpr double kTooLarge = 1.5;  // volume over that of a whole point in the pores around
constexpr double kStill = 1e-6;    // speed over that of a fall by the points' spacing; slower ones go nowhere

// The axis along which a point moves fastest.
template <int D>
int main_direction(const ParticleSet<D>& set, int p) {
  int along = 0;
  for (int d = 1; d < D; ++d)
    if (std::abs(set.velocity[d][p]) > std::abs(set.velocity[along][p])) along = d;
  return along;
}

// Block that the last sort put a point into.
template <int D>
int block_of(const ParticleSet<D>& set, int p) {
  const auto after = std::upper_bound(set.ranges.begin(), set.ranges.end(), p,
                                      [](int slot, const auto& range) { return slot < range.first; });
  return static_cast<int>(after - set.ranges.begin()) - 1;
}

// How far a place lies outside a block along an axis [cells]; what points may do is bounded by how far all of
// them may have travelled.
template <int D>
double outside(const Grid<D>& grid, int block, double x, int axis) {
  const double at = (x - grid.origin()[axis]) / grid.spacing() - grid.block_origin(block)[axis];
  return std::max({0.0, -at, at - Grid<D>::kSide});
}

}  // namespace

// A point that is too large for where it is, or for where it will be a spacing further on, becomes two of
// half its volume with its velocity, a quarter of the points' spacing before and behind it on its way.
template <int D>
void split_points(World<D>& world) {
  const PoreWater<D>& w = *world.pore_water;
  WaterLayer<D>& layer = *world.pore_water->layer;
  ParticleSet<D>& set = layer.fluid.points();
  const Grid<D>& grid = world.skeleton.grid();
  const double lanes = std::round(grid.spacing() / layer.spacing);
  const double room = std::pow(grid.spacing() / lanes, D);
  double gravity = 0;
  for (double g : world.gravity) gravity += g * g;
  const double still = kStill * std::sqrt(std::sqrt(gravity) * layer.spacing);
  const auto too_large = [&](const Index<D>& cell, double volume) {
    const int slot = grid.slot(cell);
    return slot >= 0 && layer.soil_fill[slot] > 0 && volume > kTooLarge * w.porosity[slot] * room;
  };
  std::vector<int> large;
  for (int p = 0; p < set.slots(); ++p) {
    if (set.id[p] < 0) continue;
    Index<D> cell = set.cell_of(grid, p);
    bool split = too_large(cell, set.volume[p]);
    const int along = main_direction(set, p);
    if (!split && std::abs(set.velocity[along][p]) > still) {
      const double ahead = set.position[along][p] + std::copysign(layer.spacing, set.velocity[along][p]);
      cell[along] = std::clamp(static_cast<int>(std::floor((ahead - grid.origin()[along]) / grid.spacing())),
                               0, grid.cells()[along] - 1);
      split = too_large(cell, set.volume[p]);
    }
    if (split) large.push_back(p);
  }
  if (large.empty()) return;
  for (const int p : large) {
    const int along = main_direction(set, p);
    const double low = grid.origin()[along], high = low + grid.cells()[along] * grid.spacing();
    const double step = std::min(
        {0.25 * layer.spacing, 0.5 * (set.position[along][p] - low), 0.5 * (high - set.position[along][p])});
    const int block = block_of(set, p);
    set.position[along][p] += step;
    const int slot = grid.slot(set.cell_of(grid, p));
    int q = slot < 0 ? -1 : set.insert(slot / Grid<D>::kCells);
    if (q < 0) {
      q = set.slots();
      set.append(1);
      world.skeleton.add_travel(1);  // the next step sorts it in
    }
    for (const ParticleField& f : set.fields()) (*f.values)[q] = (*f.values)[p];
    set.position[along][p] -= 2 * step;
    world.skeleton.add_travel(
        std::max(0.0, outside(grid, block, set.position[along][p], along) - world.skeleton.travelled()));
    set.volume[p] = set.volume[q] = 0.5 * set.volume[p];
    set.mass[p] = set.mass[q] = set.volume[p] * world.scene.water.density;
  }
}

template void split_points<2>(World<2>&);
template void split_points<3>(World<3>&);

}  // namespace polder::coupling
