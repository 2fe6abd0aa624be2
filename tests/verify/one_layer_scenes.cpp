#include "tests/verify/one_layer_scenes.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>

namespace polder::verify {

using coupling::Body;
using coupling::Boundary;
using coupling::InitialStress;
using coupling::Stage;
using coupling::Vector3;
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

Body box(double x0, double y0, double x1, double y1, const Choice& c, int material = 0) {
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
  s.formulation = "one-layer";
  s.grid.cell = c.cell;
  s.grid.size = {c.cell * std::ceil(width / c.cell - 1e-9), c.cell * std::ceil(height / c.cell - 1e-9), 0};
  s.grid.shape = c.shape;
  s.numerics.order = c.musl ? coupling::StressOrder::musl : coupling::StressOrder::usl;
  s.numerics.courant = c.courant;
  s.numerics.locking = c.locking;
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

// ---- consolidation
// ----------------------------------------------------------------------------------------------------

Consolidation terzaghi(const Choice& c, const std::vector<double>& time_factors) {
  const double h = c.cell, height = 1 + c.offset * h, q = 1e4;
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

// ---- rest
// -------------------------------------------------------------------------------------------------------------

namespace {

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
  sum = 0;
  for (std::size_t p = 0; p < frame.count(); ++p) {
    const double e = frame.fields[0].values[6 * p + 1] + soil * (top - frame.positions[3 * p + 1]);
    sum += e * e;
  }
  r.stress_error = std::sqrt(sum / static_cast<double>(frame.count())) / (soil * top);
  r.speed = column_of(sim, "max_speed[m/s]");
  return r;
}

}  // namespace

Rest hydrostatic(const Choice& c, double duration) {
  Simulation sim(column_at_rest(c, duration));
  while (!sim.finished()) sim.step();
  return compare_with_lines(sim, c, 1, 0.6 * (2650 - 1000) * kGravity);
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
  MemoryState state;
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

Scene slump_scene(const Choice& c, double duration) {
  Scene s = wet_scene(c, 4, 1.6, duration);
  s.numerics.flip = 0.98;
  s.materials = {elastic_soil(5e4, 0.3, 0.4, c.conductivity)};
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

Slump slump(const Choice& c, double duration) {
  Simulation sim(slump_scene(c, duration));
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
  r.height = top_of(sim);
  r.runout = column_of(sim, "runout[m]");
  r.volume = volume(sim) / initial;
  r.roughness = column_of(sim, "pressure_roughness[Pa]") / kUnitWeight;
  r.water_error = column_of(sim, "water_mass_error[-]");
  r.steps = static_cast<double>(sim.steps());
  return r;
}

// ---- state
// ------------------------------------------------------------------------------------------------------------

void MemoryState::reals(const std::string& name, Reals& values) {
  if (reading_)
    values = arrays.at(name);
  else
    arrays[name] = values;
}
void MemoryState::integers(const std::string& name, std::vector<int>& values) {
  if (reading_)
    values = lists.at(name);
  else
    lists[name] = values;
}
void MemoryState::number(const std::string& name, double& value) {
  if (reading_)
    value = numbers.at(name);
  else
    numbers[name] = value;
}
void MemoryState::count(const std::string& name, std::int64_t& value) {
  if (reading_)
    value = counts.at(name);
  else
    counts[name] = value;
}
void MemoryState::save(Simulation& simulation) {
  reading_ = false;
  simulation.visit(*this);
}
void MemoryState::load(Simulation& simulation) {
  reading_ = true;
  simulation.visit(*this);
  reading_ = false;
}

std::vector<std::string> MemoryState::differences(const MemoryState& other) const {
  std::vector<std::string> names;
  const auto compare = [&](const auto& mine, const auto& theirs, const auto& same) {
    if (mine.size() != theirs.size()) names.push_back("number of entries");
    for (const auto& [name, value] : mine) {
      const auto match = theirs.find(name);
      if (match == theirs.end() || !same(value, match->second)) names.push_back(name);
    }
  };
  compare(arrays, other.arrays, [](const Reals& a, const Reals& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
  });
  compare(lists, other.lists, [](const auto& a, const auto& b) { return a == b; });
  compare(numbers, other.numbers, [](double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; });
  compare(counts, other.counts, [](auto a, auto b) { return a == b; });
  return names;
}

}  // namespace polder::verify
