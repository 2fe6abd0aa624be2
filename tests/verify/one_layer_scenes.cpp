#include "tests/verify/one_layer_scenes.hpp"

#include <cmath>
#include <limits>

namespace polder::verify {

using coupling::Body;
using coupling::Boundary;
using coupling::Stage;
using coupling::Vector3;

mpm::MaterialParameters elastic_soil(double young, double poisson, double porosity, double conductivity,
                                     double density_solid) {
  mpm::MaterialParameters m;
  m.name = "soil";
  m.density_solid = density_solid;
  m.porosity = porosity;
  m.young = young;
  m.poisson = poisson;
  m.hydraulic_conductivity = conductivity;
  return m;
}

Scene wet_scene(const Choice& c, double width, double height, double duration) {
  Scene s;
  s.formulation = c.formulation;
  s.grid.cell = c.cell;
  s.grid.size = {c.cell * std::ceil(width / c.cell - 1e-9), c.cell * std::ceil(height / c.cell - 1e-9), 0};
  s.grid.shape = c.shape;
  s.numerics.order = c.musl ? coupling::StressOrder::musl : coupling::StressOrder::usl;
  s.numerics.courant = c.courant;
  s.numerics.locking = c.locking;
  s.numerics.rhie_chow = c.rhie_chow;
  s.numerics.pressure = c.pressure;
  s.numerics.drag = c.drag;
  s.numerics.point_pressure = c.point_pressure;
  s.numerics.smooth_rates = c.smooth_rates;
  s.water.bulk_modulus = c.bulk_modulus;
  Stage stage;
  stage.name = "run";
  stage.duration = duration;
  s.stages = {stage};
  return s;
}

double column_of(const Simulation& simulation, const std::string& name) {
  for (const coupling::Column& c : simulation.history())
    if (c.name == name) return c.value;
  return std::numeric_limits<double>::quiet_NaN();
}

Body box(double x0, double y0, double x1, double y1, const Choice& c, int material) {
  Body b;
  b.name = "soil-" + std::to_string(material);
  b.material = material;
  b.box = {{Vector3{x0, y0, 0}, Vector3{x1, y1, 0}}};
  b.particles_per_axis = c.per_axis;
  return b;
}

Boundary load(double from_x, double to_x, double height, double pressure) {
  Boundary b;
  b.name = "load";
  b.kind = Boundary::Kind::pressure;
  b.segment = {{Vector3{from_x, height, 0}, Vector3{to_x, height, 0}}};
  b.pressure.value = {pressure};
  return b;
}

double top_of(const Simulation& s) {
  return column_of(s, "height[m]");
}

}  // namespace polder::verify
