#include "tests/verify/stability_scenes.hpp"

#include <cmath>

namespace polder::verify {

using coupling::Boundary;
using coupling::Scene;
using coupling::Stage;
using coupling::Vector3;

namespace {

constexpr double kDegree = 3.14159265358979323846 / 180, kGravity = 9.81;
// Of the published slopes [m], [N/m3].
constexpr double kHeight = 10, kRun = 20, kUnitWeight = 20e3;

Stage elastic_equilibrium() {
  Stage s;
  s.name = "initial";
  s.mode = Stage::Mode::equilibrium;
  s.duration = 1000;
  s.plastic = false;
  s.water_flows = false;
  return s;
}

Boundary on_side(int side, Boundary::Kind kind) {
  Boundary b;
  b.name = "side-" + std::to_string(side);
  b.kind = kind;
  b.side = side;
  return b;
}

mpm::MaterialParameters drained(const std::string& name, double cohesion, double friction) {
  mpm::MaterialParameters m;
  m.name = name;
  m.model = mpm::MaterialModel::mohr_coulomb;
  m.density_solid = kUnitWeight / kGravity;
  m.young = 100e6;
  m.poisson = 0.3;
  m.cohesion.value = {cohesion};
  m.friction.value = {friction};
  return m;
}

mpm::MaterialParameters clay(const std::string& name, double strength) {
  mpm::MaterialParameters m = drained(name, 0, 0);
  m.model = mpm::MaterialModel::tresca;
  m.cohesion = m.friction = {};
  m.shear_strength = m.residual_strength = strength;
  return m;
}

coupling::Body body(const std::string& name, int material, const std::vector<Vector3>& polygon) {
  coupling::Body b;
  b.name = name;
  b.material = material;
  b.polygon = polygon;
  return b;
}

}  // namespace

std::vector<PublishedSlope> published_slopes() {
  return {{"ACADS 1(a): H=10 m; 2:1; c=3 kPa; phi=19.6 deg; gamma=20", 5, 40, 60, 3e3, 19.6 * kDegree, false},
          {"Griffiths & Lane example 1: 2:1; phi=20; c/(gamma H)=0.05; D=1", 0, 44, 50, 10e3, 20 * kDegree,
           false},
          {"Griffiths & Lane example 2: as 1 with D=1.5", 5, 44, 64, 10e3, 20 * kDegree, false},
          {"Griffiths & Lane example 3/4 homogeneous: 2:1; phi=0; cu/(gamma H)=0.25; D=2", 10, 45, 70, 50e3,
           0, true},
          {"Griffiths & Lane example 4: cu2/cu1 -> large (strong foundation); cu1/(gamma H)=0.25", 0, 44, 50,
           50e3, 0, true}};
}

Scene scene_of(const PublishedSlope& slope, double cell) {
  Scene s;
  s.grid.size = {slope.width, slope.below + kHeight + 1, 0};
  s.grid.cell = cell;
  s.materials = {slope.undrained ? clay("soil", slope.cohesion)
                                 : drained("soil", slope.cohesion, slope.friction)};
  const double base = slope.below, top = slope.below + kHeight;
  std::vector<Vector3> ground{{0, 0, 0}};
  if (base > 0) {
    ground.push_back({slope.width, 0, 0});
    ground.push_back({slope.width, base, 0});
  }
  ground.push_back({slope.toe, base, 0});
  ground.push_back({slope.toe - kRun, top, 0});
  ground.push_back({0, top, 0});
  s.bodies = {body("slope", 0, ground)};
  s.boundaries = {on_side(2, Boundary::Kind::fixed)};
  s.stages = {elastic_equilibrium()};
  return s;
}

Scene weak_layer_scene(double ratio, double cell) {
  constexpr double kStrength = 50e3;
  Scene s;
  s.grid.size = {60, 21, 0};
  s.grid.cell = cell;
  s.materials = {clay("clay", kStrength), clay("weak", ratio * kStrength)};
  // Corners of the layer, along its upper and its lower side.
  const Vector3 u0{8, 20, 0}, u1{36, 6, 0}, u2{48, 6, 0}, u3{52, 10, 0};
  const Vector3 l0{6, 20, 0}, l1{38, 4, 0}, l2{48, 4, 0}, l3{54, 10, 0};
  s.bodies = {body("above", 0, {u0, {20, 20, 0}, {40, 10, 0}, u3, u2, u1}),
              body("layer", 1, {u0, u1, u2, u3, l3, l2, l1, l0}),
              body("below", 0, {{0, 20, 0}, {0, 0, 0}, {60, 0, 0}, {60, 10, 0}, l3, l2, l1, l0})};
  s.boundaries = {on_side(2, Boundary::Kind::fixed)};
  s.stages = {elastic_equilibrium()};
  return s;
}

Scene drawdown_scene(double drawdown, double cell) {
  constexpr double kPorosity = 0.4;
  PublishedSlope slope = published_slopes()[1];
  Scene s = scene_of(slope, cell);
  const double level = kHeight * (1 - drawdown);
  if (level <= 0) return s;
  s.formulation = "one-layer";
  coupling::Material& soil = s.materials.front();
  soil.porosity = kPorosity;
  soil.density_solid = (kUnitWeight / kGravity - kPorosity * s.water.density) / (1 - kPorosity);
  soil.hydraulic_conductivity = 1e-4;
  s.water.phreatic = {{0, level, 0}, {slope.width, level, 0}};
  s.water.saturation_above = 1;  // one unit weight above and below
  s.water.outside_level = coupling::TimeTable{{0.0}, {level}};
  return s;
}

Scene scene_of(const InfiniteSlope& slope, int cells) {
  constexpr double kPorosity = 0.4;
  const double thickness = slope.depth * std::cos(slope.angle), h = thickness / cells;
  const bool wet = slope.water > 0;
  Scene s;
  s.formulation = wet ? "one-layer" : "dry";
  s.gravity = {kGravity * std::sin(slope.angle), -kGravity * std::cos(slope.angle), 0};
  s.numerics.locking = coupling::LockingCure::none;
  s.grid.size = {2 * h, thickness + 2 * h, 0};
  s.grid.cell = h;
  mpm::MaterialParameters soil;
  soil.name = "soil";
  soil.model = mpm::MaterialModel::mohr_coulomb;
  soil.young = 50e6;
  soil.poisson = 0.3;
  soil.cohesion.value = {kSpareStrength * slope.cohesion};
  soil.friction.value = {std::atan(kSpareStrength * std::tan(slope.friction))};
  if (slope.dilates) soil.dilation = soil.friction;
  if (wet) {
    soil.porosity = kPorosity;
    soil.density_solid = (slope.saturated_weight / kGravity - kPorosity * s.water.density) / (1 - kPorosity);
    soil.hydraulic_conductivity = 1e-4;
    const double level = slope.water * thickness;
    s.water.initial = coupling::WaterSpec::Initial::field;
    // Across the slope: the weight of the water, or what lets its head fall along the level alone.
    s.water.initial_gradient =
        s.water.density * (slope.horizontal ? -kGravity / std::cos(slope.angle) : s.gravity[1]);
    s.water.initial_datum = level;
    s.water.saturation_above =
        1 - (slope.saturated_weight - slope.weight) / (kPorosity * s.water.density * kGravity);
    if (slope.water < 1) s.water.phreatic = {{0, level, 0}, {s.grid.size[0], level, 0}};
  } else {
    soil.density_solid = slope.weight / kGravity;
  }
  s.materials = {soil};
  coupling::Body column;
  column.name = "column";
  column.box = {{{0, 0, 0}, {2 * h, thickness, 0}}};
  s.bodies = {column};
  s.boundaries = {on_side(2, Boundary::Kind::fixed), on_side(0, Boundary::Kind::tied)};
  s.stages = {elastic_equilibrium()};
  return s;
}

}  // namespace polder::verify
