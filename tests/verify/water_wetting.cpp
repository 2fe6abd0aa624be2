#include "tests/verify/water_wetting.hpp"

#include <algorithm>
#include <cmath>

namespace polder::verify {

using coupling::InitialStress;
using coupling::WaterBoundary;

namespace {

constexpr double kPorosity = 0.4, kDensitySolid = 2650, kDensityWater = 1000, kHeight = 1;
constexpr double kHead = 1.5, kLine = 0.25;  // level outside, phreatic line at the start

Scene soil_over(const Choice& c, double line, double retained, double duration, WaterBoundary base) {
  const double width = 4 * c.cell;
  Scene s = wet_scene(c, width, kHeight + 4 * c.cell, duration);
  s.materials = {elastic_soil(1e7, 0.2, kPorosity, c.conductivity, kDensitySolid)};
  s.bodies = {box(0, 0, width, kHeight, c)};
  s.bodies[0].stress.kind = InitialStress::Kind::k0;
  s.bodies[0].stress.k0 = {0.25};  // of the elastic column
  s.water.phreatic = {{0, line}, {width, line}};
  s.water.saturation_above = retained;
  base.name = "base";
  base.side = 2;
  s.water_boundaries = {base};
  return s;
}

// Where the water ends that stands in the soil: by the first moment of its points' volume, in a zone of
// porosity n up to the line at the start and n (1 - S) above.
double front_of(const Simulation& sim, const Choice& c, double line, double retained) {
  const coupling::PointFrame water = sim.water_points();
  double moment = 0;
  for (std::size_t p = 0; p < water.count(); ++p)
    moment += water.fields[2].values[p] * water.positions[3 * p + 1] / (4 * c.cell);
  const double below = 0.5 * kPorosity * line * line;
  if (moment < below) return std::sqrt(2 * moment / kPorosity);
  return std::sqrt(line * line + 2 * (moment - below) / (kPorosity * (1 - retained)));
}

// Time after which the front is at z.
double rise_time(const Choice& c, double head, double line, double retained, double z) {
  return kPorosity * (1 - retained) / c.conductivity *
         (head * std::log((head - line) / (head - z)) - (z - line));
}

double rise(const Choice& c, double head, double line, double retained, double time) {
  double low = line, high = kHeight;
  for (int i = 0; i < 60; ++i) {
    const double z = 0.5 * (low + high);
    (rise_time(c, head, line, retained, z) < time ? low : high) = z;
  }
  return 0.5 * (low + high);
}

// Vertical effective stress at a height, compression positive, mean over the row of points around it.
double stress_at(const Simulation& sim, double y) {
  const coupling::PointFrame soil = sim.points({"effective_stress"});
  const std::size_t components = static_cast<std::size_t>(soil.fields[0].components);
  double sum = 0, weight = 0;
  for (std::size_t p = 0; p < soil.count(); ++p)
    if (std::abs(soil.positions[3 * p + 1] - y) < 0.051)
      sum -= soil.fields[0].values[components * p + 1], ++weight;
  return weight > 0 ? sum / weight : 0;
}

}  // namespace

Scene rising_front_scene(const Choice& c, double retained, double duration) {
  WaterBoundary base;
  base.kind = WaterBoundary::Kind::head;
  base.value.value = {kHead};
  return soil_over(c, kLine, retained, duration, base);
}

Wetting rising_front(const Choice& c, double retained) {
  constexpr double kAt = 0.55, kEnd = 0.9;
  const double end = rise_time(c, kHead, kLine, retained, kEnd), width = 4 * c.cell;
  Simulation sim(rising_front_scene(c, retained, end));
  const double grains = (1 - kPorosity) * kDensitySolid * kGravity;
  const double kept = kPorosity * retained * kDensityWater * kGravity;
  // Error of the effective stress over the weight above.
  const auto stress_error = [&](double z) {
    const double mobile = kPorosity * (1 - retained) * kUnitWeight * std::max(0.0, z - kAt);
    const double pressure = z > kAt ? kUnitWeight * kHead * (1 - kAt / z) : 0.0;
    const double weight = (grains + kept) * (kHeight - kAt) + mobile;
    return (stress_at(sim, kAt) - (weight - pressure)) / weight;
  };
  Wetting r;
  double before = 0, after = 0;
  long count_before = 0, count_after = 0;
  while (!sim.finished()) {
    sim.step();
    const double z = rise(c, kHead, kLine, retained, sim.time());
    if (sim.steps() % 16 != 0) continue;
    const double seen = front_of(sim, c, kLine, retained);
    r.front_error = std::max(r.front_error, std::abs(seen - z) / c.cell);
    if (z > kAt - 0.15 && z < kAt - 0.1) before += stress_error(seen), ++count_before;
    if (z > kEnd - 0.05) after += stress_error(seen), ++count_after;
  }
  r.stress_before = before / static_cast<double>(count_before);
  r.stress_after = after / static_cast<double>(count_after);
  r.front = front_of(sim, c, kLine, retained);
  r.inflow_error =
      -column_of(sim, "water_outflow[m3]") / (width * kPorosity * (1 - retained) * (kEnd - kLine)) - 1;
  r.water_error = column_of(sim, "water_mass_error[-]");
  return r;
}

Draining falling_front(const Choice& c, double retained) {
  constexpr double kTurn = 0.85, kEnd = 0.45;
  // Rises as above, then drains: a free outlet takes i = 1.
  WaterBoundary base;
  base.kind = WaterBoundary::Kind::pressure;
  const double turn = rise_time(c, kHead, kLine, retained, kTurn);
  const double fall = kPorosity * (1 - retained) * (kTurn - kEnd) / c.conductivity;
  base.value.time = {0, turn, turn * (1 + 1e-6), 2 * (turn + fall)};
  base.value.value = {kUnitWeight * kHead, kUnitWeight * kHead, 0, 0};
  Simulation sim(soil_over(c, kLine, retained, turn + fall, base));
  Draining r;
  double from = 0;
  while (!sim.finished()) {
    sim.step();
    if (sim.time() <= turn) {
      from = front_of(sim, c, kLine, retained);
      continue;
    }
    const double fallen = c.conductivity * (sim.time() - turn) / (kPorosity * (1 - retained));
    if (sim.steps() % 16 != 0) continue;
    const double seen = front_of(sim, c, kLine, retained);
    r.level_error = std::max(r.level_error, std::abs(from - seen - fallen) / c.cell);
  }
  r.water_error = column_of(sim, "water_mass_error[-]");
  return r;
}

}  // namespace polder::verify
