#include "coupling/step_limit.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "coupling/audit.hpp"
#include "coupling/body_shape.hpp"
#include "coupling/explicit_water.hpp"
#include "coupling/initial_state.hpp"
#include "coupling/point_water.hpp"
#include "coupling/two_layer.hpp"
#include "coupling/world.hpp"

namespace polder::coupling {
namespace {

constexpr int kSteps = 120;        // of one trial
constexpr double kGrowth = 1e3;    // of the energy between the first third and the end of an unstable trial
constexpr double kRunaway = 1e12;  // growth at any time, before displacements matter
constexpr double kBracket = 1.02;  // ratio of unstable and stable steps that ends the search
constexpr double kSpeed = 1e-10;   // of the initial velocities, as a share of the wave speed

// A patch of one soil: 5 cells along each axis (3 in 3D), a wall on the lower sides, free surfaces on the
// upper sides which cut their cells at different places.
template <int D>
Scene patch_of(const Scene& scene, const Body& body, bool wet) {
  Scene s = scene;
  const double h = scene.grid.cell;
  const BodyShape shape(body, scene.grid);
  s.grid.origin = {};
  if (scene.grid.space == Space::axisymmetric) s.grid.origin[0] = shape.lower()[0];
  // Surfaces where they hurt most under USL: where a node beyond the last points carries next to nothing.
  // With B-splines that is from 3/4 of a cell on, where the lattice gains a row; with GIMP, a particle
  // spacing above a node.
  const double whole = D == 2 ? 5 : 3;
  const double reach[3] = {whole + 0.75, whole + 1.0 / body.particles_per_axis, whole + 0.3};
  Body b = body;
  b.polygon.clear();
  b.extrude.reset();
  b.centre.reset();
  b.velocity = {};
  b.spin = 0;
  b.stress = {};
  b.random.clear();  // mean soil
  b.box = {{Vector3{}, Vector3{}}};
  for (int d = 0; d < D; ++d) {
    s.grid.size[d] = 8 * h;
    (*b.box)[0][d] = s.grid.origin[d];
    (*b.box)[1][d] = s.grid.origin[d] + reach[d] * h;
  }
  s.bodies = {b};
  s.water_bodies.clear();
  // No weight; the mobility of the water is that of the scene's gravity all the same.
  double gravity = 0;
  for (double g : scene.gravity) gravity += g * g;
  s.gravity = {};
  s.numerics.sleep = false;  // it is about motion
  mpm::MaterialParameters& m = s.materials[body.material];
  if (gravity > 0) m.hydraulic_conductivity *= kStandardGravity / std::sqrt(gravity);
  for (Material& soil : s.materials) soil.retention = {};  // air in the pores only softens the water
  s.boundaries.clear();
  s.water_boundaries.clear();
  s.water_lines.clear();
  s.water.phreatic.clear();
  s.water.outside_level.reset();
  s.water.initial = WaterSpec::Initial::zero;
  if (!wet) {
    s.formulation = "dry";
    // Soil above the phreatic line: its pore water is weight only.
    const double saturation =
        scene.unsaturated() ? scene.water.initial_saturation.value_or(1.0) : scene.water.saturation_above;
    const double water = m.porosity * saturation * scene.water.density;
    if (find_formulation(scene.formulation)->carrier != WaterCarrier::none)
      m.density_solid += water / (1 - m.porosity);
  }
  return s;
}

template <int D>
class Patch {
 public:
  explicit Patch(const Scene& scene) : world_(build_world<D>(scene)) {
    world_->skeleton.set_laws(world_->materials, false);
    wave_speed_ = world_->skeleton.wave_speed(world_->materials);
    if (world_->pore_water) update_water_cells(*world_, 0.0);
    audit_ = std::make_unique<Audit<D>>(*world_);
  }

  double wave_speed() const { return wave_speed_; }

  // By the formulas of a uniform grid: where to begin the search, and what it is about.
  MotionLimit expected() {
    const double h = world_->skeleton.grid().spacing();
    if (!world_->pore_water || !world_->pore_water->compressible) return {h / wave_speed_, "skeleton wave"};
    if (world_->pore_water->points) return point_water_limit(*world_);
    return combined_limit(explicit_limit(*world_, 0.0), h, wave_speed_);
  }

  bool stable(double dt) {
    disturb();
    double early = 0;
    StepInput in;
    in.dt = dt;
    const World<D>& w = *world_;
    if (w.pore_water && w.pore_water->compressible)
      blend_for_step(*world_, dt, w.scene.numerics.courant * w.skeleton.grid().spacing() / wave_speed_);
    for (int i = 0; i < kSteps; ++i) {
      if (!world_->pore_water)
        step_dry(*world_, in);
      else if (world_->pore_water->layer)
        step_two_layer(*world_, in, 1);
      else if (world_->pore_water->points)
        step_point_water(*world_, in, 1);
      else
        step_one_layer(*world_, in, 1);
      const Totals t = audit_->totals(*world_);
      const double energy = t.kinetic_energy + t.elastic_energy;
      if (!(energy < kRunaway * initial_)) return false;
      if (i < kSteps / 3)
        early = std::max(early, energy);
      else if (!(energy < kGrowth * early))
        return false;
    }
    return true;
  }

 private:
  // Random velocities, the same in every trial; no stress, no pressure.
  void disturb() {
    std::uint64_t state = 1;
    std::vector<ParticleSet<D>*> sets;
    for (auto& body : world_->skeleton.bodies()) sets.push_back(body.get());
    if (world_->pore_water && world_->pore_water->layer)
      sets.push_back(&world_->pore_water->layer->fluid.points());
    for (ParticleSet<D>* points : sets) {
      ParticleSet<D>& set = *points;
      for (int p = 0; p < set.slots(); ++p) {
        for (Reals& s : set.stress) s[p] = 0;
        if (set.id[p] < 0) continue;
        for (int d = 0; d < D; ++d) {
          state = state * 6364136223846793005ull + 1442695040888963407ull;
          set.velocity[d][p] = kSpeed * wave_speed_ * (static_cast<double>(state >> 11) * 0x1p-52 - 1);
        }
      }
      for (Reals& c : set.affine) std::fill(c.begin(), c.end(), 0.0);
      std::fill(set.pore_pressure.begin(), set.pore_pressure.end(), 0.0);
      // Against the grains: what drag does to the difference shows from the first step on.
      for (int d = 0; d < D; ++d)
        if (!set.water_velocity[d].empty())
          for (int p = 0; p < set.slots(); ++p) set.water_velocity[d][p] = -set.velocity[d][p];
    }
    if (world_->pore_water) {
      Reals& p = world_->pore_water->pressure.pressure();
      std::fill(p.begin(), p.end(), 0.0);
    }
    initial_ = audit_->totals(*world_).kinetic_energy;
  }

  std::unique_ptr<World<D>> world_;
  std::unique_ptr<Audit<D>> audit_;
  double wave_speed_, initial_ = 0;
};

template <int D>
StabilityLimit limit_of(const Scene& scene) {
  Patch<D> patch(scene);
  const MotionLimit expected = patch.expected();
  const double unit = expected.dt;
  double low = unit, high = unit;
  if (patch.stable(unit)) do
      low = high, high *= 1.5;
    while (high < 1e3 * unit && patch.stable(high));
  else
    do high = low, low /= 1.5;
    while (low > 1e-3 * unit && !patch.stable(low));
  while (high > kBracket * low) {
    const double middle = std::sqrt(low * high);
    (patch.stable(middle) ? low : high) = middle;
  }
  StabilityLimit limit;
  limit.dt = low;
  limit.mechanism = expected.reason;
  limit.courant_number = low * patch.wave_speed() / scene.grid.cell;
  return limit;
}

template <int D>
StabilityLimit find(const Scene& scene) {
  StabilityLimit limit;
  const bool water = find_formulation(scene.formulation)->carrier != WaterCarrier::none;
  std::vector<std::pair<int, int>> seen;  // soils and lattices that have had their turn
  for (const Body& body : scene.bodies) {
    const std::pair<int, int> soil{body.material, body.particles_per_axis};
    if (std::find(seen.begin(), seen.end(), soil) != seen.end()) continue;
    seen.push_back(soil);
    const mpm::MaterialParameters& m = scene.materials[body.material];
    const bool porous = water && m.porosity > 0;
    for (bool wet : {false, true}) {
      if (wet ? !porous : porous && scene.water.phreatic.empty() && !scene.unsaturated()) continue;
      StabilityLimit found = limit_of<D>(patch_of<D>(scene, body, wet));
      found.material = m.name, found.with_water = wet;
      if (limit.dt == 0 || found.dt < limit.dt) limit = std::move(found);
    }
  }
  return limit;
}

}  // namespace

StabilityLimit find_stability_limit(const Scene& scene) {
  return scene.dimension() == 2 ? find<2>(scene) : find<3>(scene);
}

}  // namespace polder::coupling
