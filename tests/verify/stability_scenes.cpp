#include "tests/verify/stability_scenes.hpp"

#include <cmath>

namespace polder::verify {

using coupling::Boundary;
using coupling::Scene;
using coupling::Stage;

namespace {

constexpr double kDegree = 3.14159265358979323846 / 180, kGravity = 9.81;

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
  constexpr double kHeight = 10, kRun = 20, kUnitWeight = 20e3;
  Scene s;
  s.grid.size = {slope.width, slope.below + kHeight + 1, 0};
  s.grid.cell = cell;
  mpm::MaterialParameters m;
  m.name = "soil";
  m.density_solid = kUnitWeight / kGravity;
  m.young = 100e6;
  m.poisson = 0.3;
  if (slope.undrained) {
    m.model = mpm::MaterialModel::tresca;
    m.shear_strength = m.residual_strength = slope.cohesion;
  } else {
    m.model = mpm::MaterialModel::mohr_coulomb;
    m.cohesion.value = {slope.cohesion};
    m.friction.value = {slope.friction};
  }
  s.materials = {m};
  const double base = slope.below, top = slope.below + kHeight;
  coupling::Body body;
  body.name = "slope";
  if (base > 0)
    body.polygon = {{0, 0, 0},
                    {slope.width, 0, 0},
                    {slope.width, base, 0},
                    {slope.toe, base, 0},
                    {slope.toe - kRun, top, 0},
                    {0, top, 0}};
  else
    body.polygon = {{0, 0, 0}, {slope.toe, 0, 0}, {slope.toe - kRun, top, 0}, {0, top, 0}};
  s.bodies = {body};
  s.boundaries = {on_side(2, Boundary::Kind::fixed)};
  s.stages = {elastic_equilibrium()};
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
  soil.cohesion.value = {slope.cohesion};
  soil.friction.value = {slope.friction};
  soil.dilation.value = {slope.friction};
  if (wet) {
    soil.porosity = kPorosity;
    soil.density_solid = (slope.saturated_weight / kGravity - kPorosity * s.water.density) / (1 - kPorosity);
    soil.hydraulic_conductivity = 1e-4;
    const double level = slope.water * thickness;
    s.water.initial = coupling::WaterSpec::Initial::field;
    s.water.initial_gradient = s.water.density * s.gravity[1];
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
