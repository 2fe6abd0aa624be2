#include "tests/verify/water_lift.hpp"

#include <algorithm>
#include <cmath>

#include "coupling/drag_law.hpp"

namespace polder::verify {

using coupling::PointFrame;
using coupling::WaterBoundary;

namespace {

constexpr double kDensitySolid = 2650, kDensityWater = 1000, kYoung = 1e6;

}  // namespace

coupling::Material loose_sand(double porosity, double grain_diameter, double fluidisation_porosity) {
  coupling::Material m = elastic_soil(kYoung, 0.3, porosity, 0, kDensitySolid);
  m.model = mpm::MaterialModel::mohr_coulomb;
  m.friction.value = {0.6};
  m.tension_cutoff = 0;
  m.drag_law = coupling::DragLaw::gidaspow;
  m.grain_diameter = grain_diameter;
  m.fluidisation_porosity = fluidisation_porosity;
  return m;
}

Lifting lifting(const Choice& c, const coupling::Material& soil, double most) {
  constexpr double kHeight = 1, kRamp = 8, kStay = 0.5, kFall = 0.5, kRest = 12, kLeft = 0.05;
  const double h = c.cell, width = 4 * h;
  const double critical = (1 - soil.porosity) * (kDensitySolid / kDensityWater - 1);
  Scene s = wet_scene(c, width, 2 * kHeight, kRamp + kStay + kFall + kRest);
  s.materials = {soil};
  s.bodies = {box(0, 0, width, kHeight, c)};
  s.bodies[0].stress.kind = coupling::InitialStress::Kind::k0;
  s.bodies[0].stress.k0 = {0.5};
  WaterBoundary base;
  base.name = "base";
  base.kind = WaterBoundary::Kind::pressure;
  base.side = 2;
  const auto pressure = [&](double gradient) { return kUnitWeight * kHeight * (1 + gradient); };
  base.value.time = {0, kRamp, kRamp + kStay, kRamp + kStay + kFall};
  base.value.value = {pressure(0), pressure(most * critical), pressure(most * critical), pressure(0)};
  s.water_boundaries = {base};
  Simulation sim(s);
  Lifting r;
  const auto compression = [&] { return -sim.body_quantity("soil-0", "vertical_stress"); };
  const double at_rest = compression();
  while (!sim.finished()) {
    sim.step();
    // Water that has come in stands on the soil.
    const double pond = -column_of(sim, "water_outflow[m3]") / width;
    const double gradient = (base.value.at(sim.time()) / kUnitWeight - kHeight - pond) / kHeight;
    if (r.critical == 0 && compression() < kLeft * at_rest) r.critical = gradient / ((1 - kLeft) * critical);
    r.fluidised = std::max(r.fluidised, column_of(sim, "fluidised[-]"));
    r.height = std::max(r.height, top_of(sim));
  }
  r.settled_share = column_of(sim, "fluidised[-]");
  r.settled_height = top_of(sim);
  r.settled_compression = compression();
  r.settled_stress = r.settled_compression / at_rest;
  r.solid_error = column_of(sim, "solid_mass_error[-]");
  r.water_error = column_of(sim, "water_mass_error[-]");
  r.steps = sim.steps();
  return r;
}

Settling settling(const Choice& c, const coupling::Material& soil, double height) {
  const double h = c.cell, width = 4 * h;
  const coupling::DragFluid water{kDensityWater, 1e-3, kUnitWeight};
  // The speed at which grains sink with relative velocity u against drag beta u.
  const auto sinking = [&](double n) {
    double low = 0, high = 10;
    for (int i = 0; i < 200; ++i) {
      const double u = 0.5 * (low + high);
      const double weight = n * (1 - n) * (kDensitySolid - kDensityWater) * kGravity;
      (coupling::drag_coefficient(soil, water, n, u) * u < weight ? low : high) = u;
    }
    return n * low;
  };
  Settling r;
  r.exact = sinking(soil.porosity);
  const double single = sinking(1 - 1e-6), re = kDensityWater * single * soil.grain_diameter / 1e-3;
  const double power = re < 0.2   ? 4.65
                       : re < 1   ? 4.35 * std::pow(re, -0.03)
                       : re < 500 ? 4.45 * std::pow(re, -0.1)
                                  : 2.39;
  r.richardson_zaki = single * std::pow(soil.porosity, power);
  // Before the surface meets the sediment, which grows from below to the fluidisation porosity.
  const double meet =
      height / r.exact / (1 + (1 - soil.porosity) / (soil.porosity - soil.fluidisation_porosity));
  const double duration = 0.4 * meet;
  Scene s = wet_scene(c, width, height + 2 * h, duration);
  s.materials = {soil};
  s.bodies = {box(0, 0, width, height, c)};
  Simulation sim(s);
  // From where the grains have reached their speed, a few relaxation times.
  double from = 0, at = 0;
  while (!sim.finished()) {
    sim.step();
    if (at == 0 && sim.time() > 0.1 * duration) at = sim.time(), from = top_of(sim);
  }
  const double surface = top_of(sim);
  r.velocity = (from - surface) / (sim.time() - at);
  const PointFrame f = sim.points({"porosity", "velocity"});
  int middle = 0, low = 0;
  for (std::size_t p = 0; p < f.count(); ++p) {
    const double y = f.positions[3 * p + 1], n = f.fields[0].values[p];
    if (std::abs(y - 0.65 * surface) < 0.15 * surface)
      r.grains -= f.fields[1].values[3 * p + 1], r.porosity += n, ++middle;
    if (y < 0.05 * height * (1 - soil.porosity)) r.sediment += n, ++low;
  }
  r.grains /= middle, r.porosity /= middle, r.sediment /= low;
  r.steps = sim.steps();
  return r;
}

}  // namespace polder::verify
