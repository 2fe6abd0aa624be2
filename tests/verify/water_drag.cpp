#include "tests/verify/water_drag.hpp"

#include <algorithm>
#include <cmath>

#include "coupling/drag_law.hpp"
#include "tests/verify/two_layer_scenes.hpp"

namespace polder::verify {

using coupling::WaterBoundary;
using coupling::WaterSpec;

namespace {

coupling::Material stiff_soil(const coupling::Material& like) {
  coupling::Material m = elastic_soil(1e8, 0.2, like.porosity, like.hydraulic_conductivity);
  m.drag_law = like.drag_law;
  m.forchheimer = like.forchheimer;
  m.grain_diameter = like.grain_diameter;
  return m;
}

}  // namespace

Permeameter permeameter(const Choice& c, const coupling::Material& material, double gradient) {
  const double h = c.cell, width = 4 * h, height = 1;
  Scene s = wet_scene(c, width, height, 1e9);
  s.gravity = {};
  s.materials = {stiff_soil(material)};
  const coupling::Material& m = s.materials[0];
  s.bodies = {box(0, 0, width, height, c)};
  s.water.initial = WaterSpec::Initial::zero;
  coupling::Boundary base;
  base.name = "base";
  base.kind = coupling::Boundary::Kind::fixed;
  base.side = 2;
  s.boundaries = {base};
  const auto side = [](const char* name, int side, double pressure) {
    WaterBoundary b;
    b.name = name;
    b.kind = WaterBoundary::Kind::pressure;
    b.side = side;
    b.value.value = {pressure};
    return b;
  };
  s.water_boundaries = {side("inlet", 2, kUnitWeight * gradient * height), side("outlet", 3, 0)};
  Simulation sim(s);
  Permeameter r;
  // Mean over `kWindow` steps: points that come whole make single steps differ.
  constexpr int kWindow = 50, kMost = 2000;
  double before = 0, in = 0;
  for (int window = 0; window < kMost; ++window) {
    double out = 0, time = 0;
    in = 0;
    for (int i = 0; i < kWindow; ++i) {
      sim.step();
      time += sim.last_step();
      out += sim.last_step() * column_of(sim, "discharge:outlet[m3/s]");
      in -= sim.last_step() * column_of(sim, "discharge:inlet[m3/s]");
    }
    r.discharge = out / time / width, in /= time * width;
    if (std::abs(r.discharge - before) < 1e-5 * std::abs(r.discharge)) break;
    before = r.discharge;
  }
  r.difference = std::abs(in - r.discharge) / r.discharge;
  r.steps = sim.steps();
  const coupling::DragFluid water{s.water.density, s.water.viscosity, kUnitWeight};
  double low = 0, high = 100;
  for (int i = 0; i < 200; ++i) {
    const double q = 0.5 * (low + high), u = q / m.porosity;
    const double lost = coupling::drag_coefficient(m, water, m.porosity, u) * u / m.porosity;
    (lost < kUnitWeight * gradient ? low : high) = q;
  }
  r.exact = low;
  r.reynolds = s.water.density * r.discharge * m.grain_diameter / s.water.viscosity;
  return r;
}

Slowing slowing(const Choice& c, const coupling::Material& material, int steps) {
  constexpr double kSpeed = 0.5;
  const double h = c.cell;
  Scene s = wet_scene(c, 16 * h, 16 * h, 1e9);
  s.gravity = {};
  s.materials = {stiff_soil(material)};
  s.bodies = {box(6 * h, 6 * h, 10 * h, 10 * h, c)};
  s.water.initial = WaterSpec::Initial::zero;
  s.water.bulk_modulus = 1e-12;
  Simulation sim(s);
  give_water_speed(sim, kSpeed);
  const double first = column_of(sim, "momentum_x[kg m/s]");
  const coupling::Material& m = s.materials[0];
  const coupling::DragFluid water{s.water.density, s.water.viscosity, kUnitWeight};
  const double n = m.porosity, masses = 1 / ((1 - n) * m.density_solid) + 1 / (n * s.water.density);
  Slowing r;
  double expected = kSpeed, seen = 0;  // the first step knows drag at rest only
  for (int i = 0; i < steps; ++i) {
    sim.step();
    const double rate = coupling::drag_coefficient(m, water, n, seen) * masses;
    expected /= 1 + rate * sim.last_step();
    seen = expected;
    r.decay_error = std::max(r.decay_error, std::abs(relative_speed(sim) - expected) / kSpeed);
    r.momentum_error =
        std::max({r.momentum_error, std::abs(column_of(sim, "momentum_x[kg m/s]") - first) / first,
                  std::abs(column_of(sim, "momentum_y[kg m/s]")) / first});
  }
  r.relative = relative_speed(sim) / kSpeed;
  return r;
}

}  // namespace polder::verify
