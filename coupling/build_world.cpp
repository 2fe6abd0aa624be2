// From a scene to its arrays.
#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "coupling/body_shape.hpp"
#include "coupling/drag_exchange.hpp"
#include "coupling/fluidisation.hpp"
#include "coupling/initial_state.hpp"
#include "coupling/point_water.hpp"
#include "coupling/points.hpp"
#include "coupling/random_field.hpp"
#include "coupling/sleep.hpp"
#include "coupling/two_layer.hpp"
#include "coupling/world.hpp"
#include "mpm/seed_particles.hpp"

namespace polder::coupling {
namespace {

template <int D>
Grid<D> make_grid(const GridSpec& spec) {
  Index<D> cells;
  for (int d = 0; d < D; ++d) cells[d] = static_cast<int>(std::lround(spec.size[d] / spec.cell));
  return Grid<D>(point<D>(spec.origin), cells, spec.cell);
}

mpm::SkeletonOptions make_options(const Scene& scene) {
  const NumericsSpec& n = scene.numerics;
  mpm::SkeletonOptions o;
  o.space = scene.grid.space;
  o.shape = scene.grid.shape;
  o.musl = n.order == StressOrder::musl && n.transfer == Transfer::flip;
  o.affine = n.transfer == Transfer::apic   ? mpm::AffineKind::apic
             : n.transfer == Transfer::tpic ? mpm::AffineKind::tpic
                                            : mpm::AffineKind::none;
  o.flip = n.flip;
  // The cell's divergence comes from nodal values; the quadratic B-spline's own strain does not agree with it
  // at the cell's scale, and needs no cure (docs/theory: volumetric locking).
  o.cell_average = n.locking == LockingCure::cell_average ||
                   (n.locking == LockingCure::automatic && o.shape != mpm::ShapeKind::quadratic_bspline);
  return o;
}

std::function<double(double)> in_time(const TimeTable& table) {
  return [table](double t) { return table.at(t); };
}

template <int D>
mpm::BoundarySet<D> make_boundaries(const Scene& scene) {
  std::vector<mpm::BoundarySpec<D>> specs;
  for (int side = 0; side < 2 * D;
       ++side) {  // the grid is a closed smooth box unless the case says otherwise
    mpm::BoundarySpec<D> s;
    s.name = "side-" + std::to_string(side);
    s.side = side;
    specs.push_back(s);
  }
  for (const Boundary& b : scene.boundaries) {
    if (b.kind == Boundary::Kind::traction || b.kind == Boundary::Kind::pressure) continue;
    mpm::BoundarySpec<D> s;
    s.name = b.name;
    s.side = b.side.value_or(-1);
    if (b.segment) s.has_segment = true, s.from = point<D>((*b.segment)[0]), s.to = point<D>((*b.segment)[1]);
    s.patch = b.polygon;
    s.coefficient = b.coefficient;
    switch (b.kind) {
      case Boundary::Kind::fixed:
        s.kind = mpm::BoundaryKind::fixed;
        break;
      case Boundary::Kind::roller:
        s.kind = mpm::BoundaryKind::roller;
        break;
      case Boundary::Kind::friction:
        s.kind = mpm::BoundaryKind::friction;
        break;
      case Boundary::Kind::velocity:
        s.kind = mpm::BoundaryKind::velocity;
        break;
      case Boundary::Kind::tied:
        if (s.side < 0 || s.has_segment || s.side / 2 == D - 1 ||
            (scene.grid.space == Space::axisymmetric && s.side / 2 == 0))
          throw InputError("boundary '" + b.name + "': only whole sides across from each other can be tied");
        s.kind = mpm::BoundaryKind::tied;
        break;
      default:
        s.kind = mpm::BoundaryKind::free;
        break;
    }
    for (int d = 0; d < D; ++d)
      if (b.velocity[d]) s.prescribed[d] = true, s.velocity[d] = in_time(*b.velocity[d]);
    specs.push_back(std::move(s));
  }
  return mpm::BoundarySet<D>(std::move(specs));
}

template <int D>
mpm::SurfaceLoad<D> make_load(const Scene& scene, const Boundary& b, double piece) {
  if constexpr (D == 2) {
    if (!b.segment) throw InputError("boundary '" + b.name + "': a load in 2D acts on a segment");
    return mpm::line_load(b.name, point<2>((*b.segment)[0]), point<2>((*b.segment)[1]), piece,
                          scene.grid.space);
  } else {
    if (b.polygon.empty()) throw InputError("boundary '" + b.name + "': a load in 3D acts on a polygon");
    return mpm::patch_load(b.name, b.polygon, piece);
  }
}

template <int D>
void add_loads(const Scene& scene, mpm::Skeleton<D>& skeleton) {
  int per_axis = 1;
  for (const Body& body : scene.bodies) per_axis = std::max(per_axis, body.particles_per_axis);
  for (const Boundary& b : scene.boundaries) {
    if (b.kind != Boundary::Kind::traction && b.kind != Boundary::Kind::pressure) continue;
    mpm::SurfaceLoad<D> load = make_load<D>(scene, b, scene.grid.cell / per_axis);
    if (b.kind == Boundary::Kind::pressure)
      load.pressure = in_time(b.pressure);
    else
      for (int d = 0; d < D; ++d) load.traction[d] = in_time(b.traction[d]);
    skeleton.loads().push_back(std::move(load));
  }
}

// A lattice with the points' spacing, and one of its points for each of them.
template <int D>
Lattice lattice_of(const mpm::SeedRegion<D>& region) {
  Lattice lattice;
  for (int d = 0; d < D; ++d) {
    lattice.lower[d] = region.lower[d] + 0.5 * region.spacing[d];
    lattice.spacing[d] = region.spacing[d];
    lattice.count[d] = region.count[d];
  }
  return lattice;
}

// What scatters in a body, at its points.
template <int D>
void set_random_state(const Body& body, const mpm::MaterialParameters& material,
                      const mpm::SeedRegion<D>& region, const mpm::StateLayout& layout, ParticleSet<D>& set) {
  for (const RandomProperty& random : body.random) {
    const FactorField field = make_factors(random, lattice_of<D>(region), D);
    const auto factor = [&](int p) {
      Vector3 x{};
      for (int d = 0; d < D; ++d) x[d] = set.position[d][p];
      return field.at(x);
    };
    using Property = RandomProperty::Property;
    if (random.property == Property::conductivity) {
      set.conductivity.resize(set.slots());
      for (int p = 0; p < set.slots(); ++p) set.conductivity[p] = material.hydraulic_conductivity * factor(p);
      continue;
    }
    Reals& state = set.state[random.property == Property::cohesion   ? layout.cohesion_factor
                             : random.property == Property::friction ? layout.friction_factor
                                                                     : layout.peak_strength];
    for (int p = 0; p < set.slots(); ++p) state[p] *= factor(p);
  }
}

// Materials learn which of their strengths scatter in one of the bodies, and within which bounds.
void mark_scatter(Scene& scene) {
  for (const Body& body : scene.bodies)
    for (const RandomProperty& random : body.random) {
      mpm::MaterialParameters::Scatter& s = scene.materials[body.material].scatter;
      const FactorRange range = factor_range(random);
      if (random.property == RandomProperty::Property::cohesion) s.cohesion = true;
      if (random.property != RandomProperty::Property::friction) continue;
      s.friction = true;
      s.lowest_friction = std::min(s.lowest_friction, range.lowest);
      s.highest_friction = std::max(s.highest_friction, range.highest);
    }
}

template <int D>
void add_body(const Scene& scene, const Body& body, World<D>& world) {
  const mpm::MaterialParameters& material = scene.materials[body.material];
  const mpm::StateLayout& layout = world.layouts[body.material];
  const BodyShape shape(body, scene.grid);
  ParticleSet<D>& set = world.skeleton.add_body();
  set.name = body.name;
  set.material = body.material;
  set.density_solid = material.density_solid;
  set.state.resize(layout.count());
  std::array<bool, D> flat;
  for (int d = 0; d < D; ++d) flat[d] = shape.is_flat(d);
  const auto region = mpm::seed_region<D>(world.skeleton.grid(), body.particles_per_axis,
                                          point<D>(shape.lower()), point<D>(shape.upper()), flat);
  mpm::seed_particles<D>(set, region, scene.grid.space, material.dry_density(), body.jitter, body.seed,
                         [&](const Point<D>& x) { return shape.inside(vector3<D>(x)); });
  if (set.count() == 0)
    throw InputError("body '" + body.name + "' is smaller than the spacing of its particles: it has none");
  set.state_padding.resize(layout.count());
  mpm::set_initial_state(material, D, 0.0, set.state_padding);
  std::vector<double> state(layout.count());
  const Vector3 centre = shape.centroid();
  for (int p = 0; p < set.slots(); ++p) {
    mpm::set_initial_state(material, D, set.position[D - 1][p], state);
    for (int k = 0; k < layout.count(); ++k) set.state[k][p] = state[k];
    for (int d = 0; d < D; ++d) set.velocity[d][p] = body.velocity[d];
    if (D == 2 && body.spin != 0) {
      set.velocity[0][p] -= body.spin * (set.position[1][p] - centre[1]);
      set.velocity[1][p] += body.spin * (set.position[0][p] - centre[0]);
    }
  }
  set_random_state<D>(body, material, region, layout, set);
  if (world.skeleton.options().affine != mpm::AffineKind::none) {
    for (Reals& c : set.affine) c.assign(set.slots(), 0.0);
    if (D == 2 && body.spin != 0) {  // the points' own share of the turning: the gradient of the velocity
      set.affine[1].assign(set.slots(), -body.spin);
      set.affine[2].assign(set.slots(), body.spin);
    }
  }
}

template <int D>
std::vector<fdm::Soil<D>> soils_of(const Scene& scene) {
  std::vector<fdm::Soil<D>> soils;
  for (const Material& m : scene.materials) {
    fdm::Soil<D> s;
    s.retention = m.retention;
    for (int d = 0; d < D; ++d)
      if (d < static_cast<int>(m.anisotropy.size())) s.anisotropy[d] = m.anisotropy[d];
    soils.push_back(std::move(s));
  }
  return soils;
}

template <int D>
void add_water_layer(World<D>& world) {
  PoreWater<D>& water = *world.pore_water;
  const Scene& scene = world.scene;
  water.layer = std::make_unique<WaterLayer<D>>(world.skeleton.grid(), scene,
                                                water_walls<D>(scene, world.skeleton.boundaries()),
                                                water.cells, water.pressure);
  water.cells.set_inclined_surfaces(true);
  seed_water(world);
  world.skeleton.attach(water.layer->fluid.points());
}

}  // namespace

template <int D>
World<D>::World(Scene s, Grid<D> grid, const mpm::SkeletonOptions& options, mpm::BoundarySet<D> boundaries)
    : scene(std::move(s)), skeleton(std::move(grid), options, std::move(boundaries)) {
  mark_scatter(scene);
  for (int d = 0; d < D; ++d) gravity[d] = scene.gravity[d];
  for (Material& m : scene.materials)
    if (m.drag_of_grains() && m.porosity > 0)
      m.hydraulic_conductivity = apparent_conductivity(m, drag_fluid(*this), m.porosity, 0);
  materials = scene.skeleton_materials();
  for (const mpm::MaterialParameters& m : materials) layouts.push_back(mpm::state_layout(m, D));
}

template <int D>
double World<D>::unit_weight() const {
  double g = 0;
  for (double x : gravity) g += x * x;
  return scene.water.density * (g > 0 ? std::sqrt(g) : kStandardGravity);
}

template <int D>
std::unique_ptr<World<D>> build_world(const Scene& scene) {
  auto world = std::make_unique<World<D>>(scene, make_grid<D>(scene.grid), make_options(scene),
                                          make_boundaries<D>(scene));
  for (const Body& body : scene.bodies) add_body<D>(world->scene, body, *world);
  add_loads<D>(scene, world->skeleton);
  const Formulation* formulation = find_formulation(scene.formulation);
  if (formulation != nullptr && formulation->carrier != WaterCarrier::none) {
    fdm::WaterProperties<D> water;
    water.density = scene.water.density;
    water.bulk_modulus = scene.water.bulk_modulus;
    water.gravity = world->gravity;
    world->pore_water = std::make_unique<PoreWater<D>>(world->skeleton.grid(), scene.grid.space, water);
    if (scene.unsaturated()) {
      world->pore_water->unsaturated =
          std::make_unique<UnsaturatedWater<D>>(world->pore_water->cells, water, soils_of<D>(scene));
      world->pore_water->unsaturated->field.set_averages(scene.numerics.cell_means);
    }
    world->pore_water->pressure.set_tolerance(scene.numerics.solver_tolerance);
    world->pore_water->compressible = scene.compressible();
    if (scene.layered()) add_water_layer(*world);
    set_saturation(*world);
    if (scene.on_points()) add_point_water(*world);
  }
  if (!scene.unsaturated()) set_initial_stress(*world);  // else when the suction is known
  if (scene.layered()) fluidise(*world);
  world->skeleton.set_laws(world->materials, true);
  if (scene.numerics.sleep) {
    if (const char* why = keeps_awake(scene)) throw InputError(std::string("numerics.sleep: ") + why);
    world->skeleton.allow_sleep(sleep_options(scene));
  }
  world->skeleton.sort(true);
  if (world->pore_water && world->pore_water->layer) world->pore_water->layer->fluid.follow_grid();
  return world;
}

template struct World<2>;
template struct World<3>;
template std::unique_ptr<World<2>> build_world<2>(const Scene&);
template std::unique_ptr<World<3>> build_world<3>(const Scene&);

}  // namespace polder::coupling
