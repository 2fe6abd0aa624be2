#include "tests/verify/higo_scenes.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "tests/verify/one_layer_rest.hpp"

namespace polder::verify {
namespace {

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

constexpr double kAlpha = 2, kResidual = 0.1, kSuctionHead = 1;  // n = 2

double saturation(double pressure) {
  const double h = std::max(0.0, -pressure / kUnitWeight);
  return kResidual + (1 - kResidual) / std::sqrt(1 + kAlpha * kAlpha * h * h);
}

}  // namespace

double analysed_limit(const Choice& c, double porosity, double density) {
  constexpr int kModes = 200;
  const double stiffness = c.bulk_modulus / porosity;
  const double wave = stiffness / (density * c.cell * c.cell);                            // 1 / dt_w^2
  const double darcy = 2 * c.conductivity / kUnitWeight * stiffness / (c.cell * c.cell);  // 1 / dt_k
  double longest = 1e9;
  for (int i = 0; i <= kModes; ++i)
    for (int j = 0; j <= kModes; ++j) {
      const double a = i / static_cast<double>(kModes), b = j / static_cast<double>(kModes);  // sin^2
      // Of a velocity that the points have carried, over that of the nodes.
      const double smoothing = (1 - 0.75 * a) * (1 - 0.75 * b);
      const double w =
          wave * (c.musl ? smoothing : 2 - smoothing) *
          (a + b - 2 * a * b + 2 * c.rhie_chow * 2 * a * b / (c.musl ? smoothing : 2 - smoothing));
      const double d = darcy * (a + b);
      if (w + d > 0) longest = std::min(longest, 2 / (d + std::sqrt(d * d + 4 * w)));
    }
  return longest;
}

Scene rain_scene(const Choice& c, double duration) {
  const double h = c.cell;
  Scene s = wet_scene(c, 2 * h, 1 + 2 * h, duration);
  coupling::Material soil(elastic_soil(1e6, 0.2, 0.4, c.conductivity));
  soil.retention.model = fdm::Retention::Model::van_genuchten;
  soil.retention.alpha = kAlpha, soil.retention.n = 2, soil.retention.residual = kResidual;
  s.materials = {soil};
  s.bodies = {box(0, 0, 2 * h, 1, c)};
  s.water.initial_saturation = saturation(-kUnitWeight * kSuctionHead);
  coupling::WaterBoundary rain;
  rain.name = "rain";
  rain.kind = coupling::WaterBoundary::Kind::rain;
  rain.side = coupling::WaterBoundary::kOnSurface;
  rain.value.value = {5e-4};
  s.water_boundaries = {rain};
  coupling::Stage rest = s.stages[0];
  rest.name = "rest";
  rest.mode = coupling::Stage::Mode::equilibrium;
  rest.duration = 10;
  rest.water_flows = false;
  rest.reset_displacement = true;
  s.stages[0].damping = 0.02;
  s.stages.insert(s.stages.begin(), rest);
  return s;
}

Rain rain(const Choice& c, double duration) {
  const auto start = std::chrono::steady_clock::now();
  Simulation sim(rain_scene(c, duration));
  while (sim.stage() == 0) sim.step();
  const double height = top_of(sim);
  const long before = sim.steps();
  while (!sim.finished()) sim.step();
  Rain r;
  r.settlement = height - top_of(sim);
  r.steps = sim.steps() - before;
  r.seconds = seconds_since(start);
  r.water_error = column_of(sim, "water_mass_error[-]");
  r.largest_speed = column_of(sim, "max_speed[m/s]");
  // Linear between the two cells' centres around each depth.
  for (int i = 0; i < 3; ++i) {
    const double y = 0.9 - 0.2 * i, below = (std::floor(y / c.cell - 0.5) + 0.5) * c.cell;
    const double share = (y - below) / c.cell;
    const auto at = [&](double height_of) {
      return saturation(sim.cell_quantity({0.5 * c.cell, height_of, 0}, "pore_pressure"));
    };
    r.saturation[i] = share < 1e-9 ? at(below) : (1 - share) * at(below) + share * at(below + c.cell);
  }
  return r;
}

Slumped slump_in_time(const Choice& c, const std::vector<double>& times) {
  const auto start = std::chrono::steady_clock::now();
  Scene s = slump_scene(c, times.back());
  const coupling::Stage whole = s.stages[0];
  s.stages.clear();
  double before = 0;
  for (double t : times) {
    s.stages.push_back(whole);
    s.stages.back().name = "until " + std::to_string(t);
    s.stages.back().duration = t - before;
    before = t;
  }
  Simulation sim(s);
  Slumped r;
  for (int i = 0; i < static_cast<int>(times.size()); ++i) {
    while (sim.stage() == i) sim.step();
    r.height.push_back(column_of(sim, "height[m]"));
    r.runout.push_back(column_of(sim, "runout[m]"));
  }
  r.steps = sim.steps();
  r.seconds = seconds_since(start);
  return r;
}

}  // namespace polder::verify
