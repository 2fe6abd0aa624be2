#include "tests/verify/one_layer_rest.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "coupling/memory_state.hpp"

namespace polder::verify {

using coupling::Boundary;
using coupling::InitialStress;
using coupling::WaterSpec;

namespace {

constexpr double kBuoyantWeight = 0.6 * (2650 - 1000) * kGravity;  // of the column's soil [N/m3]

Scene column_at_rest(const Choice& c, double duration) {
  const double h = c.cell, height = (10 + c.offset) * h;
  Scene s = wet_scene(c, 4 * h, height + 3 * h, duration);
  s.materials = {elastic_soil(1e7, 0.2, 0.4, c.conductivity)};
  s.bodies = {box(0, 0, 4 * h, height, c)};
  s.bodies[0].stress.kind = InitialStress::Kind::k0;
  s.bodies[0].stress.k0 = {0.25};
  return s;
}

// Errors of pressure and vertical effective stress against straight lines that vanish at the present surface:
// water at `water` times gamma_w, soil at `soil` [N/m3] below it.
Rest compare_with_lines(const Simulation& sim, const Choice& c, double water, double soil) {
  const double h = c.cell, top = top_of(sim);
  Rest r;
  double sum = 0;
  int cells = 0;
  for (double x = 0.5 * h; x < 4 * h; x += h)
    for (double y = 0.5 * h; y < top + h; y += h) {
      const double p = sim.cell_quantity({x, y, 0}, "pore_pressure");
      if (std::isnan(p)) continue;
      const double e = p - water * kUnitWeight * (top - y);
      sum += e * e, ++cells;
    }
  r.pressure_error = std::sqrt(sum / cells) / (kUnitWeight * top);
  const coupling::PointFrame frame = sim.points({"effective_stress"});
  std::map<std::pair<int, int>, std::pair<double, int>> cell_sum;  // of the points' errors, by cell
  sum = 0;
  for (std::size_t p = 0; p < frame.count(); ++p) {
    const double x = frame.positions[3 * p], y = frame.positions[3 * p + 1];
    const double e = frame.fields[0].values[6 * p + 1] + soil * (top - y);
    sum += e * e;
    auto& [cell, points] = cell_sum[{static_cast<int>(x / h), static_cast<int>(y / h)}];
    cell += e, ++points;
  }
  r.point_stress_error = std::sqrt(sum / static_cast<double>(frame.count())) / (kBuoyantWeight * top);
  sum = 0;
  for (const auto& [index, cell] : cell_sum) sum += std::pow(cell.first / cell.second, 2);
  r.cell_stress_error = std::sqrt(sum / static_cast<double>(cell_sum.size())) / (soil * top);
  r.speed = column_of(sim, "max_speed[m/s]");
  return r;
}

}  // namespace

Rest hydrostatic(const Choice& c, double duration) {
  Simulation sim(column_at_rest(c, duration));
  constexpr double kLast = 0.1;
  while (sim.time() < duration - kLast) sim.step();
  const double from = sim.time();
  const coupling::PointFrame before = sim.points({});
  while (!sim.finished()) sim.step();
  const coupling::PointFrame after = sim.points({});
  Rest r = compare_with_lines(sim, c, 1, kBuoyantWeight);
  for (std::size_t i = 0; i < before.positions.size(); ++i)
    r.motion = std::max(r.motion, std::abs(after.positions[i] - before.positions[i]) / (sim.time() - from));
  return r;
}

Rest upward_seepage(const Choice& c, double share) {
  const double critical = 0.6 * 1.65, gradient = share * critical, height = (10 + c.offset) * c.cell;
  // Several times the column's consolidation time H^2 / c_v.
  const double modulus = elastic_soil(1e7, 0.2, 0.4, 1).wave_modulus();
  Scene s = column_at_rest(c, 4 * height * height * kUnitWeight / (c.conductivity * modulus));
  coupling::WaterBoundary base;
  base.name = "base";
  base.kind = coupling::WaterBoundary::Kind::pressure;
  base.side = 2;
  base.value.value = {kUnitWeight * height * (1 + gradient)};
  s.water_boundaries = {base};
  Simulation sim(s);
  while (!sim.finished()) sim.step();
  return compare_with_lines(sim, c, 1 + gradient, (critical - gradient) * kUnitWeight);
}

Scene strip_scene(const Choice& c, double duration, double jitter) {
  Scene s = wet_scene(c, 2, 1 + 3 * c.cell, duration);
  s.gravity = {};
  s.materials = {elastic_soil(1e7, 0.2, 0.4, c.conductivity)};
  s.bodies = {box(0, 0, 2, 1 + c.offset * c.cell, c)};
  s.bodies[0].jitter = jitter;
  Boundary strip = load(0.5, 0, 1 + c.offset * c.cell, 0);
  strip.pressure.time = {0, 0.1};
  strip.pressure.value = {0, 1e4};
  s.boundaries = {strip};
  s.water.initial = WaterSpec::Initial::zero;
  s.stages[0].damping = 0.05;
  return s;
}

Strip strip_load(const Choice& c, double duration, double jitter) {
  Simulation sim(strip_scene(c, duration, jitter));
  while (!sim.finished()) sim.step();
  Strip r;
  r.roughness = column_of(sim, "pressure_roughness[Pa]") / 1e4;
  r.largest_speed = column_of(sim, "max_speed[m/s]");
  r.middle = sim.cell_quantity({0.5 * c.cell, 0.5 + 0.5 * c.cell, 0}, "pore_pressure") / 1e4;
  r.pressure_cells = static_cast<double>(sim.pressure_cells());
  return r;
}

double checkerboard_left(const Choice& c, int steps) {
  const double h = c.cell;
  Scene s = wet_scene(c, 16 * h, 13 * h, 1e9);
  s.gravity = {};
  s.materials = {elastic_soil(1e7, 0.2, 0.4, c.conductivity)};
  s.bodies = {box(0, 0, 16 * h, 10 * h, c)};
  s.water.initial = WaterSpec::Initial::field;
  s.water.initial_pressure = 1;
  Simulation sim(s);
  coupling::MemoryState state;
  state.save(sim);
  // Slots of a block are numbered row by row in squares of an even side, so the parity of a cell is that of
  // its place in the block.
  const auto sign = [](std::size_t slot) {
    constexpr std::size_t kSide = Grid<2>::kSide;
    const std::size_t local = slot % (kSide * kSide);
    return (local % kSide + local / kSide) % 2 ? -1.0 : 1.0;
  };
  const auto amplitude = [&](const Reals& p) {
    double sum = 0, cells = 0;
    for (std::size_t i = 0; i < p.size(); ++i)
      if (p[i] != 0) sum += sign(i) * p[i], ++cells;
    return sum / cells;
  };
  Reals& p = state.arrays.at("pore_pressure");
  for (std::size_t i = 0; i < p.size(); ++i) p[i] *= sign(i);
  const double before = amplitude(p);
  state.load(sim);
  for (int i = 0; i < steps; ++i) sim.step();
  state.save(sim);
  return amplitude(state.arrays.at("pore_pressure")) / before;
}

Scene slump_scene(const Choice& c, double duration, double poisson) {
  Scene s = wet_scene(c, 4, 1.6, duration);
  s.numerics.flip = 0.98;
  s.materials = {elastic_soil(5e4, poisson, 0.4, c.conductivity)};
  s.bodies = {box(0, 0, 1, 1 + c.offset * c.cell, c)};
  s.water.initial = WaterSpec::Initial::zero;
  Boundary base;
  base.name = "base";
  base.kind = Boundary::Kind::fixed;
  base.side = 2;
  s.boundaries = {base};
  s.stages[0].damping = 0.02;
  return s;
}

Slump slump(const Choice& c, double duration, double poisson) {
  Simulation sim(slump_scene(c, duration, poisson));
  Slump r;
  const auto volume = [](const Simulation& x) {
    double sum = 0;
    const coupling::PointFrame frame = x.points({"volume"});
    for (double v : frame.fields[0].values) sum += v;
    return sum;
  };
  const double initial = volume(sim);
  while (!sim.finished()) {
    sim.step();
    if (sim.steps() % 20 == 0) r.largest_speed = std::max(r.largest_speed, column_of(sim, "max_speed[m/s]"));
  }
  r.runout = column_of(sim, "runout[m]");
  r.volume = volume(sim) / initial;
  const coupling::PointFrame frame = sim.points({});
  for (std::size_t p = 0; p < frame.count(); ++p) r.height = std::max(r.height, frame.positions[3 * p + 1]);
  r.energy = column_of(sim, "kinetic_energy[J]") + column_of(sim, "elastic_energy[J]");
  r.released = column_of(sim, "work_gravity[J]");
  r.roughness = column_of(sim, "pressure_roughness[Pa]") / kUnitWeight;
  r.water_error = column_of(sim, "water_mass_error[-]");
  r.steps = sim.steps();
  return r;
}

}  // namespace polder::verify
