#include "coupling/point_sides.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "coupling/points.hpp"
#include "mpm/point_stencil.hpp"

namespace polder::coupling {
namespace {

constexpr int kStride = 4;

template <int D>
constexpr int kForce = 1 + D;  // first force lane of a node's sums

// Nodes of a side of the grid between two corners (none: all of it), for f(slot).
template <int D, class F>
void each_node_of_side(const Grid<D>& grid, int side, const std::optional<std::array<Point<D>, 2>>& part,
                       const F& f) {
  const int axis = side / 2;
  const double slack = 1e-6 * grid.spacing();
  for (int i = 0; i < grid.slots(); ++i) {
    const Index<D> index = grid.index(i);
    if (index[axis] != (side % 2 ? grid.cells()[axis] : 0)) continue;
    const Point<D> x = grid.position(index);
    bool inside = true;
    for (int d = 0; d < D && part; ++d)
      inside &= d == axis || (x[d] >= std::min((*part)[0][d], (*part)[1][d]) - slack &&
                              x[d] <= std::max((*part)[0][d], (*part)[1][d]) + slack);
    if (inside) f(i);
  }
}

// Pressure that a boundary prescribes at a height [Pa]; NaN where it is closed.
double pressure_at(const WaterBoundary& b, double height, double time, double unit_weight) {
  constexpr double kClosed = std::numeric_limits<double>::quiet_NaN();
  switch (b.kind) {
    case WaterBoundary::Kind::head: {
      const double depth = b.value.at(time) - height;
      return depth > 0 ? unit_weight * depth : kClosed;
    }
    case WaterBoundary::Kind::pressure:
      return b.value.at(time);
    case WaterBoundary::Kind::surface:
      return 0;
    default:
      return kClosed;
  }
}

// Blocks whose points may reach a node: their cells lie less than two from it, their points half a cell more.
template <int D>
void add_blocks_around(const Grid<D>& grid, int slot, std::vector<int>& blocks) {
  const Index<D> node = grid.index(slot);
  for (int corner = 0; corner < ipow(2, D); ++corner) {
    Index<D> cell = node;
    for (int d = 0; d < D; ++d)
      cell[d] = std::clamp(cell[d] + (corner >> d & 1 ? 2 : -3), 0, grid.cells()[d] - 1);
    const int block = grid.stored_block(grid.block_number(cell));
    if (block >= 0 && block < grid.occupied_blocks()) blocks.push_back(block);
  }
}

// Heights of the nodes where a head is prescribed: of what their force of the points' pressure is made of,
// sum N V y / sum N V, so that a linear pressure at the side balances the same one in the points, at the ends
// of a side and where it is filled in part as well.
template <int D>
void find_heights(World<D>& world) {
  PointWater<D>& w = *world.pore_water->points;
  if (w.side_blocks.empty()) return;
  const mpm::Skeleton<D>& skeleton = world.skeleton;
  const Grid<D>& grid = skeleton.grid();
  const bool mixed = world.scene.numerics.point_pressure == PointPressure::mixed;
  w.height_sums.assign(grid.slots(), {});
  // One point after the other: in an order that no number of threads changes.
  for (const auto& body : skeleton.bodies()) {
    const ParticleSet<D>& set = *body;
    for (const int block : w.side_blocks) {
      const auto range = set.ranges[block];
      for (int p = range.first; p < range.first + range.count; ++p) {
        if (set.id[p] < 0) continue;
        Point<D> x, l;
        for (int d = 0; d < D; ++d) x[d] = set.position[d][p], l[d] = set.half_size[d][p];
        const int cell = grid.slot(set.cell_of(grid, p));
        if (mixed && w.full[cell]) {
          x = grid.position(grid.index(cell)), l = {};
          for (int d = 0; d < D; ++d) x[d] += 0.5 * grid.spacing();
        }
        const mpm::PointStencil<D> s = mpm::point_stencil<D>(
            grid, mixed && w.full[cell] ? mpm::ShapeKind::linear : skeleton.options().shape, x, l);
        for (int n = 0; n < s.count; ++n) {
          w.height_sums[s.slot[n]][0] += s.weight[n] * set.volume[p];
          w.height_sums[s.slot[n]][1] += s.weight[n] * set.volume[p] * x[D - 1];
        }
      }
    }
  }
  for (SideNode& n : w.sides) {
    const std::array<double, 2>& s = w.height_sums[n.slot];
    if (s[0] > 0) n.height = s[1] / s[0];
  }
}

// A wall bears the water that lies on it, F_p . n = - rho_w V g . n of water at rest before it, and so the
// grains press it with their effective stress, which friction follows. Soil full of water cannot leave it.
template <int D>
void lean_on_walls(World<D>& world) {
  PointWater<D>& w = *world.pore_water->points;
  if (w.frictional.empty()) return;
  const double density = world.scene.water.density;
  const double full = 0.5 * std::pow(world.skeleton.grid().spacing(), D);  // support of a node on a side
  std::vector<std::uint8_t> sealed(world.skeleton.grid().slots(), 0);
  for (const SideNode& n : w.frictional) {
    const double volume =
        world.skeleton.sums()[static_cast<std::size_t>(n.slot) * 8 + mpm::Transfer<D>::kVolume];
    w.sums[static_cast<std::size_t>(n.slot) * 8 + kForce<D> + n.axis] =
        -density * volume * w.gravity * world.gravity[n.axis];
    if (volume > 0.5 * full) sealed[n.slot] = 1;
  }
  world.skeleton.boundaries().set_sealed(std::move(sealed));
}

}  // namespace

template <int D>
void find_sides(World<D>& world) {
  PointWater<D>& w = *world.pore_water->points;
  const Grid<D>& grid = world.skeleton.grid();
  const auto at = [](int i, int axis) {
    return [i, axis](const SideNode& n) { return n.slot == i && n.axis == axis; };
  };
  const auto node = [&](int i, int side, int boundary) {
    return SideNode{i, side / 2, side % 2 ? 1 : -1, boundary, grid.position(grid.index(i))[D - 1]};
  };
  w.sides.clear(), w.side_blocks.clear(), w.frictional.clear();
  for (std::size_t b = 0; b < world.scene.water_boundaries.size(); ++b) {
    const WaterBoundary& boundary = world.scene.water_boundaries[b];
    if (boundary.side < 0) continue;
    std::optional<std::array<Point<D>, 2>> part;
    if (boundary.from && boundary.to) part = {point<D>(*boundary.from), point<D>(*boundary.to)};
    each_node_of_side<D>(grid, boundary.side, part, [&](int i) {
      std::erase_if(w.sides, at(i, boundary.side / 2));
      w.sides.push_back(node(i, boundary.side, static_cast<int>(b)));
    });
  }
  for (const SideNode& n : w.sides)
    if (world.scene.water_boundaries[n.boundary].kind == WaterBoundary::Kind::head)
      add_blocks_around(grid, n.slot, w.side_blocks);
  std::sort(w.side_blocks.begin(), w.side_blocks.end());
  w.side_blocks.erase(std::unique(w.side_blocks.begin(), w.side_blocks.end()), w.side_blocks.end());
  for (const mpm::BoundarySpec<D>& spec : world.skeleton.boundaries().specs()) {
    if (spec.kind != mpm::BoundaryKind::friction || spec.side < 0) continue;
    std::optional<std::array<Point<D>, 2>> part;
    if (spec.has_segment) part = {spec.from, spec.to};
    each_node_of_side<D>(grid, spec.side, part, [&](int i) {
      if (std::none_of(w.sides.begin(), w.sides.end(), at(i, spec.side / 2)))
        w.frictional.push_back(node(i, spec.side, -1));
    });
  }
}

template <int D>
void push_at_sides(World<D>& world) {
  PointWater<D>& w = *world.pore_water->points;
  find_heights(world);
  for (const SideNode& n : w.sides) {
    const double p =
        pressure_at(world.scene.water_boundaries[n.boundary], n.height, w.time, world.unit_weight());
    if (!std::isnan(p))
      w.sums[static_cast<std::size_t>(n.slot) * 8 + kForce<D> + n.axis] -=
          n.outward * p * area_of_side(world, n.slot);
  }
  lean_on_walls(world);
}

template <int D>
void close_sides(World<D>& world) {
  PointWater<D>& w = *world.pore_water->points;
  for (const SideNode& n : w.sides)
    if (std::isnan(
            pressure_at(world.scene.water_boundaries[n.boundary], n.height, w.time, world.unit_weight())))
      w.flow[static_cast<std::size_t>(n.slot) * kStride + n.axis] = 0;
}

#define POLDER_INSTANTIATE(D)                \
  template void find_sides<D>(World<D>&);    \
  template void push_at_sides<D>(World<D>&); \
  template void close_sides<D>(World<D>&);
POLDER_INSTANTIATE(2)
POLDER_INSTANTIATE(3)

}  // namespace polder::coupling
