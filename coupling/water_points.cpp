// Points of water: where they start, and how they come and go through open sides of the grid.
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.hpp"
#include "coupling/body_shape.hpp"
#include "coupling/mean_share.hpp"
#include "coupling/points.hpp"
#include "coupling/two_layer.hpp"
#include "fdm/mixture_flow.hpp"
#include "mpm/seed_particles.hpp"

namespace polder::coupling {
namespace {

constexpr double kLeastShare = 0.02;  // of a point's domain with water in it
constexpr int kWaterSeed = 7919;      // points of water are scattered otherwise than those of the soil

// Points of one body; share(x): of the space at x that water takes, 0: none there.
template <int D, class Share>
void add_points(World<D>& world, const Body& body, const BodyShape& shape, const Share& share,
                const Vector3& velocity) {
  ParticleSet<D>& set = world.pore_water->layer->fluid.points();
  const Space space = world.scene.grid.space;
  std::array<bool, D> flat;
  for (int d = 0; d < D; ++d) flat[d] = shape.is_flat(d);
  const auto region = mpm::seed_region<D>(world.skeleton.grid(), body.particles_per_axis,
                                          point<D>(shape.lower()), point<D>(shape.upper()), flat);
  const auto inside = [&](const Vector3& x) { return shape.inside(x) ? share(x) : 0.0; };
  std::vector<double> shares;
  const auto holds_water = [&](const Point<D>& x) {
    return mean_share<D>(x, region.spacing, inside) > kLeastShare;
  };
  ParticleSet<D> part;
  mpm::seed_particles<D>(part, region, space, 1.0, 0.0, body.seed, holds_water);
  for (int p = 0; p < part.slots(); ++p) {
    Point<D> x;
    for (int d = 0; d < D; ++d) x[d] = part.position[d][p];
    shares.push_back(mean_share<D>(x, region.spacing, inside));
  }
  if (body.jitter > 0) {
    part = {};
    mpm::seed_particles<D>(part, region, space, 1.0, body.jitter, body.seed + kWaterSeed, holds_water);
  }
  const int first = set.slots();
  set.append(part.slots());
  set.wet.resize(set.slots(), 1.0);
  set.reference_half_size = std::max(set.reference_half_size, part.reference_half_size);
  for (int p = 0; p < part.slots(); ++p) {
    const int q = first + p;
    for (int d = 0; d < D; ++d) {
      set.position[d][q] = set.initial_position[d][q] = part.position[d][p];
      set.half_size[d][q] = part.half_size[d][p];
      set.velocity[d][q] = velocity[d];
    }
    set.wet[q] = 1;  // where append() has put zeros
    set.volume[q] = part.volume[p] * shares[p];
    set.mass[q] = set.volume[q] * world.scene.water.density;
  }
}

// The side's part that a boundary of the water opens, or none.
bool opens(const WaterBoundary& b) {
  using Kind = WaterBoundary::Kind;
  return b.side >= 0 && (b.kind == Kind::head || b.kind == Kind::pressure || b.kind == Kind::surface);
}

}  // namespace

template <int D>
mpm::BoundarySet<D> water_walls(const Scene& scene, const mpm::BoundarySet<D>& soil) {
  using mpm::BoundaryKind;
  std::vector<mpm::BoundarySpec<D>> specs;
  // Those of the soil: the sides of the grid, then the scene's boundaries but for the loads.
  std::vector<bool> sticky(2 * D, false);
  for (const Boundary& b : scene.boundaries)
    if (!b.loads()) sticky.push_back(b.is_wall() && b.water == Boundary::WaterContact::no_slip);
  for (mpm::BoundarySpec<D> s : soil.specs()) {
    const bool wall =
        s.kind == BoundaryKind::fixed || s.kind == BoundaryKind::friction || s.kind == BoundaryKind::roller;
    const bool sticks = sticky[specs.size()];
    if (wall) s.kind = sticks ? BoundaryKind::fixed : BoundaryKind::roller;
    if (s.kind == BoundaryKind::velocity)  // a wall that moves: all of it, or only across itself
      for (int d = 0; d < D; ++d) {
        if (sticks && !s.prescribed[d]) s.prescribed[d] = true, s.velocity[d] = [](double) { return 0.0; };
        if (!sticks && s.side >= 0 && d != s.side / 2) s.prescribed[d] = false;
      }
    specs.push_back(std::move(s));
  }
  for (const WaterBoundary& b : scene.water_boundaries) {
    if (!opens(b)) continue;
    mpm::BoundarySpec<D> s;
    s.name = b.name;
    s.kind = BoundaryKind::free;
    s.side = b.side;
    if (b.from || b.to) {
      s.has_segment = true;
      for (int d = 0; d < D; ++d) {
        constexpr double kFar = std::numeric_limits<double>::infinity();
        const double from = b.from ? (*b.from)[d] : -kFar, to = b.to ? (*b.to)[d] : kFar;
        s.from[d] = std::min(from, to), s.to[d] = std::max(from, to);
      }
    }
    specs.push_back(std::move(s));
  }
  return mpm::BoundarySet<D>(std::move(specs));
}

template <int D>
void seed_water(World<D>& world) {
  const Scene& scene = world.scene;
  WaterLayer<D>& layer = *world.pore_water->layer;
  ParticleSet<D>& set = layer.fluid.points();
  set.name = "water";
  set.density_solid = scene.water.density;
  std::vector<BodyShape> shapes;
  for (const Body& b : scene.bodies) shapes.emplace_back(b, scene.grid);
  const auto in_soil = [&](const Vector3& x) {
    return std::any_of(shapes.begin(), shapes.end(), [&](const BodyShape& s) { return s.inside(x); });
  };
  int finest = 1;
  for (const std::vector<Body>* list : {&scene.bodies, &scene.water_bodies})
    for (const Body& b : *list) finest = std::max(finest, b.particles_per_axis);
  layer.spacing = scene.grid.cell / finest;
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const double porosity = scene.materials[scene.bodies[b].material].porosity;
    if (porosity <= 0) continue;
    add_points(
        world, scene.bodies[b], shapes[b],
        [&](const Vector3& x) {
          const bool above =
              !scene.water.phreatic.empty() && x[D - 1] > height_at(scene.water.phreatic, x[0]);
          return above ? 0.0 : porosity;
        },
        scene.bodies[b].velocity);
  }
  for (const Body& b : scene.water_bodies)
    add_points(
        world, b, BodyShape(b, scene.grid), [&](const Vector3& x) { return in_soil(x) ? 0.0 : 1.0; },
        b.velocity);
  if (layer.fluid.affine() != mpm::AffineKind::none)
    for (Reals& c : set.affine) c.assign(set.slots(), 0.0);
  if (set.count() == 0)
    throw InputError(
        "there is no water: no porous soil below the phreatic line and no body of water with a point in it");
}

namespace {

constexpr double kInside = 1e-6;     // distance to a side that points keep [cells]
constexpr double kNothing = 1e-9;    // volume of a point that is as good as gone, over that of a whole one
constexpr double kBeginning = 0.02;  // and of one that begins

// Whether water passes a side of the grid at a cell.
template <int D>
bool passes(const fdm::WaterCells<D>& cells, int slot) {
  const auto faces = cells.boundary_faces();
  return std::any_of(faces.begin(), faces.end(), [&](const fdm::BoundaryFace<D>& f) {
    return f.boundary >= 0 && !f.free_surface && f.open && cells.cells()[f.cell].slot == slot;
  });
}

// Points stay inside the grid. One that has gone out where a boundary is open in name but takes no pressure,
// above the level of a head, is gone: it has dripped off.
template <int D>
void hold_inside(World<D>& world) {
  PoreWater<D>& w = *world.pore_water;
  ParticleSet<D>& set = w.layer->fluid.points();
  const Grid<D>& grid = world.skeleton.grid();
  const double h = grid.spacing();
  const auto hold = [&](int p) {
    int side = -1;
    Index<D> cell;
    for (int d = 0; d < D; ++d) {
      const double x = (set.position[d][p] - grid.origin()[d]) / h;
      if (x < 0) side = 2 * d;
      if (x > grid.cells()[d]) side = 2 * d + 1;
      const double inside = std::clamp(x, kInside, grid.cells()[d] - kInside);
      if (inside != x) set.position[d][p] = grid.origin()[d] + inside * h;
      cell[d] = std::clamp(static_cast<int>(inside), 0, grid.cells()[d] - 1);
    }
    if (side < 0) return;
    const int slot = grid.slot(cell);
    const bool wall =
        slot < 0 || (w.layer->fluid.held_components()[slot] >> (side / 2) & 1) || passes(w.cells, slot);
    if (wall) return;
    w.layer->removed += set.volume[p], w.outflow += set.volume[p];
    set.remove(p);
  };
  // Points leave the blocks they were sorted into by less than a cell.
  for (int block = 0; block < grid.occupied_blocks(); ++block) {
    const Index<D> first = grid.block_origin(block);
    const auto range = set.ranges[block];
    for (int d = 0; d < D; ++d) {
      const bool lower = first[d] == 0, upper = first[d] + Grid<D>::kSide >= grid.cells()[d];
      if (!lower && !upper) continue;
      const double low = grid.origin()[d] + 2 * kInside * h,
                   high = grid.origin()[d] + (grid.cells()[d] - 2 * kInside) * h;
      for (int p = range.first; p < range.first + range.count; ++p)
        if ((set.position[d][p] < low || set.position[d][p] > high) && set.id[p] >= 0) hold(p);
    }
  }
}

// Points of the water in a cell, the nearest to its open side first.
template <int D>
std::vector<int> nearest_points(const World<D>& world, const fdm::BoundaryFace<D>& face) {
  const Grid<D>& grid = world.skeleton.grid();
  const ParticleSet<D>& set = world.pore_water->layer->fluid.points();
  const fdm::ActiveCell<D>& cell = world.pore_water->cells.cells()[face.cell];
  std::vector<int> found;
  const int block = cell.slot / Grid<D>::kCells;
  if (block >= grid.occupied_blocks()) return found;
  const auto range = set.ranges[block];
  const Point<D> low = grid.position(cell.index);
  const double h = grid.spacing();
  for (int p = range.first; p < range.first + range.count; ++p) {
    bool inside = true;
    for (int d = 0; d < D && inside; ++d)
      inside = set.position[d][p] >= low[d] && set.position[d][p] < low[d] + h;
    if (inside && set.id[p] >= 0) found.push_back(p);
  }
  std::sort(found.begin(), found.end(), [&](int a, int b) {
    const double x = face.outward * set.position[face.axis][a], y = face.outward * set.position[face.axis][b];
    return x != y ? x > y : set.id[a] < set.id[b];
  });
  return found;
}

template <int D>
struct Arrival {
  int slot;  // of its cell
  Point<D> position{}, velocity{};
  double volume = 0;
};

// Where the next point comes in: at the side, in the lane along it that is farthest from all points.
template <int D>
Arrival<D> arrive(const World<D>& world, const fdm::BoundaryFace<D>& face, const std::vector<int>& points) {
  const Grid<D>& grid = world.skeleton.grid();
  const WaterLayer<D>& layer = *world.pore_water->layer;
  const ParticleSet<D>& set = layer.fluid.points();
  const fdm::ActiveCell<D>& cell = world.pore_water->cells.cells()[face.cell];
  const int lanes = static_cast<int>(std::lround(grid.spacing() / layer.spacing));
  Arrival<D> made{.slot = cell.slot};
  double emptiest = -1;
  for (int lane = 0; lane < ipow(lanes, D - 1); ++lane) {
    Point<D> x;
    int rest = lane;
    for (int d = 0; d < D; ++d) {
      double at = face.outward > 0 ? 1 - kInside : kInside;
      if (d != face.axis) at = (rest % lanes + 0.5) / lanes, rest /= lanes;
      x[d] = grid.origin()[d] + (cell.index[d] + at) * grid.spacing();
    }
    double nearest = std::numeric_limits<double>::infinity();
    for (int p : points) {
      double r = 0;
      for (int d = 0; d < D; ++d) r += (set.position[d][p] - x[d]) * (set.position[d][p] - x[d]);
      nearest = std::min(nearest, r);
    }
    if (nearest > emptiest) emptiest = nearest, made.position = x;
  }
  for (int d = 0; d < D; ++d)
    for (int node : face.nodes)
      made.velocity[d] += layer.fluid.velocity()[static_cast<std::size_t>(node) * 4 + d] /
                          static_cast<double>(face.nodes.size());
  return made;
}

template <int D>
void append(World<D>& world, const std::vector<Arrival<D>>& arrivals) {
  WaterLayer<D>& layer = *world.pore_water->layer;
  ParticleSet<D>& set = layer.fluid.points();
  for (const Arrival<D>& arrival : arrivals) {
    int p = set.insert(arrival.slot / Grid<D>::kCells);
    if (p < 0) {
      p = set.slots();
      set.append(1);
      world.skeleton.add_travel(1);  // the next step sorts it in
    }
    for (int d = 0; d < D; ++d) {
      set.position[d][p] = set.initial_position[d][p] = arrival.position[d];
      set.velocity[d][p] = arrival.velocity[d];
      set.half_size[d][p] = 0.5 * layer.spacing;
    }
    set.wet[p] = 1;
    set.volume[p] = arrival.volume;
    set.mass[p] = arrival.volume * world.scene.water.density;
  }
}

}  // namespace

// What flows out is taken from the points nearest to the side, what flows in goes to them until they are
// whole, and then to new ones: the volume of all points changes by exactly what passes the side, and the cell
// there stays as full as the flow makes it. (Taking whole points as they cross empties and fills it by
// turns.)
template <int D>
void pass_open_sides(World<D>& world, double dt) {
  const Scene& scene = world.scene;
  PoreWater<D>& w = *world.pore_water;
  WaterLayer<D>& layer = *w.layer;
  ParticleSet<D>& set = layer.fluid.points();
  const Grid<D>& grid = world.skeleton.grid();
  const bool open = std::any_of(scene.water_boundaries.begin(), scene.water_boundaries.end(), opens);
  hold_inside(world);
  if (!open) return;

  layer.owed.resize(grid.slots(), 0.0);
  const fdm::MixtureMotion motion{world.skeleton.v_new(), layer.fluid.velocity(), layer.grains_response,
                                  layer.water_response, w.porosity};
  const int lanes = static_cast<int>(std::lround(grid.spacing() / layer.spacing));
  const double density = scene.water.density;
  std::vector<Arrival<D>> arrivals;
  for (const fdm::BoundaryFace<D>& f : w.cells.boundary_faces()) {
    if (f.boundary < 0 || f.free_surface || !f.open) continue;
    const fdm::ActiveCell<D>& cell = w.cells.cells()[f.cell];
    double& owed = layer.owed[cell.slot];  // to the points in the cell
    owed -= dt * fdm::mixture_outflow(w.cells, motion, f);
    if (owed == 0) continue;
    const double whole = w.porosity[cell.slot] * cell.volume / ipow(lanes, D);
    const std::vector<int> points = nearest_points(world, f);
    for (int p : points) {
      if (owed == 0) break;
      const double change =
          owed > 0 ? std::clamp(whole - set.volume[p], 0.0, owed) : std::max(owed, -set.volume[p]);
      owed -= change;
      (change > 0 ? layer.added : layer.removed) += std::abs(change);
      w.outflow -= change;
      set.volume[p] += change;
      set.mass[p] = set.volume[p] * density;
      if (set.volume[p] > kNothing * whole) continue;
      owed += set.volume[p];  // the last of it is owed back
      layer.removed += set.volume[p], w.outflow += set.volume[p];
      set.remove(p);
    }
    if (!(owed > kBeginning * whole)) continue;
    Arrival<D> made = arrive(world, f, points);
    made.volume = std::min(owed, whole);
    owed -= made.volume;
    layer.added += made.volume, w.outflow -= made.volume;
    arrivals.push_back(made);
  }
  if (!arrivals.empty()) append(world, arrivals);
}

#define POLDER_INSTANTIATE(D)                                                            \
  template mpm::BoundarySet<D> water_walls<D>(const Scene&, const mpm::BoundarySet<D>&); \
  template void seed_water<D>(World<D>&);                                                \
  template void pass_open_sides<D>(World<D>&, double);
POLDER_INSTANTIATE(2)
POLDER_INSTANTIATE(3)

}  // namespace polder::coupling
