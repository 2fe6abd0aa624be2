#include "tests/verify/one_layer_consolidation.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "io/csv.hpp"

namespace polder::verify {

using coupling::InitialStress;
using coupling::Stage;
using coupling::WaterSpec;

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

namespace {

// ---- reference tables

std::filesystem::path reference(const std::string& name) {
  return std::filesystem::path(POLDER_SOURCE_DIR) / "tests" / "reference" / name;
}

// "... name=1.5; ..." of the first comment line.
double parameter(const CsvTable& table, const std::string& name) {
  const std::string& line = table.comments().at(0);
  const std::size_t at = line.find(" " + name + "=");
  if (at == std::string::npos) throw std::runtime_error("the reference has no " + name);
  return std::stod(line.substr(at + name.size() + 2));
}

// Column names end in "@t=12.5s".
double time_of(const CsvTable& table, std::size_t column) {
  const std::string& name = table.columns().at(column);
  return std::stod(name.substr(name.find("@t=") + 3));
}

// Linear in the first column.
double value_at(const CsvTable& table, std::size_t column, double x) {
  const auto xs = table.column(std::size_t{0}), ys = table.column(column);
  std::size_t i = 1;
  while (i + 1 < xs.size() && xs[i] < x) ++i;
  return ys[i - 1] + (x - xs[i - 1]) / (xs[i] - xs[i - 1]) * (ys[i] - ys[i - 1]);
}

// ---- runs

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

Consolidation two_layer(const Choice& c, const std::string& name, double faster) {
  const CsvTable table(reference("two_layer_" + name + "_isochrones.csv"));
  const double thickness[] = {parameter(table, "H1_m"), parameter(table, "H2_m")};
  const double modulus[] = {parameter(table, "M1_Pa"), parameter(table, "M2_Pa")};
  const double conductivity[] = {parameter(table, "k1_m_s"), parameter(table, "k2_m_s")};
  const double scale = 1e-4, q = scale * parameter(table, "q_Pa"), t90 = parameter(table, "t90_s");
  const double h = c.cell, height = thickness[0] + thickness[1];
  Scene s = wet_scene(c, 2 * h, height + 2 * h, 0);
  s.gravity = {};
  s.water.bulk_modulus = std::numeric_limits<double>::infinity();
  const double poisson = 0.2, factor = (1 + poisson) * (1 - 2 * poisson) / (1 - poisson);
  for (int l = 0; l < 2; ++l) {
    s.materials.push_back(elastic_soil(factor * modulus[l], poisson, 0.4, faster * conductivity[l]));
    s.bodies.push_back(box(0, l == 0 ? thickness[1] : 0, 2 * h, l == 0 ? height : thickness[1], c, l));
  }
  s.boundaries = {load(2 * h, 0, height, q)};
  s.water.initial = WaterSpec::Initial::field;
  s.water.initial_pressure = q;
  const std::size_t columns[] = {3, 5, 7};
  double top = 0;
  const auto error = [&](const Simulation& sim, int i) {
    top = top_of(sim);
    double sum = 0;
    int cells = 0;
    for (double y = 0.5 * h; y < height; y += h) {
      const double e = sim.cell_quantity({0.5 * h, y, 0}, "pore_pressure") -
                       scale * value_at(table, columns[i], height - y);
      sum += e * e, ++cells;
    }
    return std::sqrt(sum / cells) / q;
  };
  std::vector<double> times;
  for (const std::size_t column : columns) times.push_back(time_of(table, column) / faster);
  Consolidation r = run_to(s, times, error);
  if (std::abs(times.back() * faster / t90 - 1) > 1e-6) throw std::runtime_error(name + ": no column at t90");
  r.settlement_ratio = (height - top) / (0.9 * q * (thickness[0] / modulus[0] + thickness[1] / modulus[1]));
  return r;
}

Consolidation large_strain(const Choice& c, double faster) {
  const CsvTable table(reference("large_strain_logcauchy_kconst_u.csv"));
  const CsvTable settlements(reference("large_strain_logcauchy_kconst_settlement.csv"));
  const double height = parameter(table, "H_m"), q = parameter(table, "q_Pa");
  const double buoyant = parameter(table, "buoyant_weight_N_m3"), porosity = parameter(table, "n0");
  const double h = c.cell;
  Scene s = wet_scene(c, 2 * h, height + 2 * h, 0);
  s.water.bulk_modulus = std::numeric_limits<double>::infinity();
  s.materials = {elastic_soil(parameter(table, "E_Pa"), parameter(table, "nu"), porosity,
                              faster * parameter(table, "k0_m_s"),
                              1000 + buoyant / kGravity / (1 - porosity))};
  s.bodies = {box(0, 0, 2 * h, height, c)};
  s.boundaries = {load(2 * h, 0, height, q)};
  s.water.initial = WaterSpec::Initial::field;  // the soil carries nothing yet
  s.water.initial_pressure = q;
  s.water.initial_gradient = -(kUnitWeight + buoyant);
  s.water.initial_datum = height;
  const std::size_t columns[] = {3, 5, 7};
  double top = 0;
  const auto error = [&](const Simulation& sim, int i) {
    top = top_of(sim);
    // Present and initial height of the points of one column of points: which initial depth a cell is at.
    const coupling::PointFrame frame = sim.points({"displacement"});
    std::vector<std::pair<double, double>> column{{0, 0}, {top, height}};
    for (std::size_t p = 0; p < frame.count(); ++p)
      if (frame.positions[3 * p] < 0.5 * h / c.per_axis * 1.5) {
        const double y = frame.positions[3 * p + 1];
        column.emplace_back(y, y - frame.fields[0].values[3 * p + 1]);
      }
    std::sort(column.begin(), column.end());
    double sum = 0;
    int cells = 0;
    for (double y = 0.5 * h; y < top; y += h) {
      const double p = sim.cell_quantity({0.5 * h, y, 0}, "pore_pressure");
      if (std::isnan(p)) continue;
      const auto above =
          std::find_if(column.begin(), column.end(), [&](const auto& x) { return x.first > y; });
      const auto below = above - 1;
      const double initial = below->second + (y - below->first) / (above->first - below->first) *
                                                 (above->second - below->second);
      const double e = p - kUnitWeight * (top - y) - value_at(table, columns[i], height - initial);
      sum += e * e, ++cells;
    }
    return std::sqrt(sum / cells) / q;
  };
  std::vector<double> times;
  for (const std::size_t column : columns) times.push_back(time_of(table, column) / faster);
  Consolidation r = run_to(s, times, error);
  r.settlement_ratio = (height - top) / value_at(settlements, 1, times.back() * faster);
  return r;
}

}  // namespace polder::verify
