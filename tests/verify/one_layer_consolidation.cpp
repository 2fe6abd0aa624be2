#include "tests/verify/one_layer_consolidation.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>

namespace polder::verify {

using coupling::InitialStress;
using coupling::Stage;
using coupling::WaterSpec;

namespace {

// Degree of consolidation and isochrone of Terzaghi (1943) for a layer drained at depth 0, closed at depth 1.
double terzaghi_pressure(double time_factor, double depth) {
  double sum = 0;
  for (int m = 0; m < 400; ++m) {
    const double a = std::numbers::pi * (2 * m + 1) / 2;
    sum += 2 / a * std::sin(a * depth) * std::exp(-a * a * time_factor);
  }
  return sum;
}
double terzaghi_degree(double time_factor) {
  double sum = 0;
  for (int m = 0; m < 400; ++m) {
    const double a = std::numbers::pi * (2 * m + 1) / 2;
    sum += 2 / (a * a) * std::exp(-a * a * time_factor);
  }
  return 1 - sum;
}

// Runs to each of the times and calls look(i) there; steps end at the times, up to one step.
Consolidation run_to(const Scene& scene, const std::vector<double>& times,
                     const std::function<double(const Simulation&, int)>& error) {
  const auto start = std::chrono::steady_clock::now();
  Scene s = scene;
  s.stages.clear();
  double before = 0;
  for (double t : times) {  // a stage for each time, so that steps end exactly there
    Stage stage;
    stage.name = "until " + std::to_string(t);
    stage.duration = t - before;
    s.stages.push_back(stage);
    before = t;
  }
  Simulation simulation(s);
  Consolidation result;
  for (int i = 0; i < static_cast<int>(times.size()); ++i) {
    while (simulation.stage() == i) simulation.step();
    result.pressure_error.push_back(error(simulation, i));
  }
  result.steps = simulation.steps();
  result.step = simulation.largest_step();
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

}  // namespace

Consolidation terzaghi(const Choice& c, const std::vector<double>& time_factors, double q) {
  const double h = c.cell, height = 1 + c.offset * h;
  const mpm::MaterialParameters soil = elastic_soil(1e7, 0.2, 0.4, c.conductivity);
  const double modulus = soil.wave_modulus();
  const double share = 1 / (1 + soil.porosity * modulus / c.bulk_modulus);  // of the load on the water
  const double consolidation = c.conductivity / kUnitWeight / (1 / modulus + soil.porosity / c.bulk_modulus);
  Scene s = wet_scene(c, 2 * h, height + 2 * h, 0);
  s.gravity = {};
  s.materials = {soil};
  s.bodies = {box(0, 0, 2 * h, height, c)};
  s.boundaries = {load(2 * h, 0, height, q)};
  s.water.initial = WaterSpec::Initial::field;
  s.water.initial_pressure = share * q;
  InitialStress& stress = s.bodies[0].stress;
  stress.kind = InitialStress::Kind::field;
  const double vertical = -(1 - share) * q, lateral = vertical * soil.poisson / (1 - soil.poisson);
  stress.value = {lateral, vertical, lateral, 0, 0, 0};

  std::vector<double> times;
  for (double factor : time_factors) times.push_back(factor * height * height / consolidation);
  double top = 0;
  const auto error = [&](const Simulation& sim, int i) {
    top = top_of(sim);
    double sum = 0;
    int cells = 0;
    for (double y = 0.5 * h; y < height + h; y += h) {
      const double p = sim.cell_quantity({0.5 * h, y, 0}, "pore_pressure");
      if (std::isnan(p)) continue;
      const double e =
          p - share * q * terzaghi_pressure(time_factors[i], std::max(0.0, (height - y) / height));
      sum += e * e, ++cells;
    }
    return std::sqrt(sum / cells) / (share * q);
  };
  Consolidation r = run_to(s, times, error);
  r.settlement_ratio = (height - top) / (terzaghi_degree(time_factors.back()) * share * q * height / modulus);
  return r;
}

Consolidation two_layer(const Choice& c, const TwoLayer& soil, const std::vector<double>& times,
                        const std::function<double(int, double)>& pressure, double settlement,
                        double faster) {
  const double h = c.cell, height = soil.thickness[0] + soil.thickness[1];
  Scene s = wet_scene(c, 2 * h, height + 2 * h, 0);
  s.gravity = {};
  const double poisson = 0.2, factor = (1 + poisson) * (1 - 2 * poisson) / (1 - poisson);
  for (int l = 0; l < 2; ++l) {
    s.materials.push_back(
        elastic_soil(factor * soil.modulus[l], poisson, 0.4, faster * soil.conductivity[l]));
    s.bodies.push_back(
        box(0, l == 0 ? soil.thickness[1] : 0, 2 * h, l == 0 ? height : soil.thickness[1], c, l));
  }
  s.boundaries = {load(2 * h, 0, height, soil.load)};
  s.water.initial = WaterSpec::Initial::field;
  s.water.initial_pressure = soil.load;
  std::vector<double> scaled;
  for (double t : times) scaled.push_back(t / faster);
  double top = 0;
  const auto error = [&](const Simulation& sim, int i) {
    top = top_of(sim);
    double sum = 0;
    int cells = 0;
    for (double y = 0.5 * h; y < height; y += h) {
      const double e = sim.cell_quantity({0.5 * h, y, 0}, "pore_pressure") - pressure(i, height - y);
      sum += e * e, ++cells;
    }
    return std::sqrt(sum / cells) / soil.load;
  };
  Consolidation r = run_to(s, scaled, error);
  r.settlement_ratio = (height - top) / settlement;
  return r;
}

Consolidation large_strain(const Choice& c, const LargeStrain& soil, const std::vector<double>& times,
                           const std::function<double(int, double)>& excess, double settlement,
                           double faster) {
  const double h = c.cell;
  Scene s = wet_scene(c, 2 * h, soil.height + 2 * h, 0);
  const double grains = 1000 + soil.buoyant_weight / kGravity / (1 - soil.porosity);
  s.materials = {elastic_soil(soil.young, soil.poisson, soil.porosity, faster * soil.conductivity, grains)};
  s.bodies = {box(0, 0, 2 * h, soil.height, c)};
  s.boundaries = {load(2 * h, 0, soil.height, soil.load)};
  s.water.initial = WaterSpec::Initial::field;
  s.water.initial_pressure = soil.load;  // excess pressure q + g0 a on top of the hydrostatic one
  s.water.initial_gradient = -(kUnitWeight + soil.buoyant_weight);
  s.water.initial_datum = soil.height;
  std::vector<double> scaled;
  for (double t : times) scaled.push_back(t / faster);
  double top = 0;
  const auto error = [&](const Simulation& sim, int i) {
    top = top_of(sim);
    // Present against initial height of the points of the first column: which initial depth a cell is at.
    const coupling::PointFrame frame = sim.points({"displacement"});
    std::vector<std::pair<double, double>> column{{0, 0}};
    for (std::size_t p = 0; p < frame.count(); ++p)
      if (frame.positions[3 * p] < 0.5 * h) {
        const double y = frame.positions[3 * p + 1];
        column.emplace_back(y, y - frame.fields[0].values[3 * p + 1]);
      }
    column.emplace_back(top, soil.height);
    std::sort(column.begin(), column.end());
    double sum = 0;
    int cells = 0;
    for (double y = 0.5 * h; y < top; y += h) {
      const double p = sim.cell_quantity({0.5 * h, y, 0}, "pore_pressure");
      if (std::isnan(p)) continue;
      const auto after =
          std::find_if(column.begin(), column.end(), [&](const auto& x) { return x.first > y; });
      const auto before = after - 1;
      const double initial = before->second + (y - before->first) / (after->first - before->first) *
                                                  (after->second - before->second);
      const double e = p - kUnitWeight * (top - y) - excess(i, soil.height - initial);
      sum += e * e, ++cells;
    }
    return std::sqrt(sum / cells) / soil.load;
  };
  Consolidation r = run_to(s, scaled, error);
  r.settlement_ratio = (soil.height - top) / settlement;
  return r;
}

}  // namespace polder::verify
