#include "tests/verify/two_layer_scenes.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "coupling/memory_state.hpp"
#include "tests/verify/one_layer_rest.hpp"

namespace polder::verify {

using coupling::Body;
using coupling::InitialStress;
using coupling::MemoryState;
using coupling::PointFrame;
using coupling::WaterBoundary;
using coupling::WaterSpec;

namespace {

constexpr double kPorosity = 0.4, kDensitySolid = 2650, kDensityWater = 1000;

// Soil 1 m high and 4 cells wide, free water above it up to `level`.
Scene column(const Choice& c, double level, double jitter, double duration) {
  const double h = c.cell;
  Scene s = wet_scene(c, 4 * h, level + 4 * h, duration);
  s.materials = {elastic_soil(1e7, 0.2, kPorosity, c.conductivity, kDensitySolid)};
  s.bodies = {box(0, 0, 4 * h, 1, c)};
  s.bodies[0].jitter = jitter;
  s.bodies[0].stress.kind = InitialStress::Kind::k0;
  s.bodies[0].stress.k0 = {0.5};
  if (level > 1) {
    Body pond = box(0, 1, 4 * h, level, c);
    pond.name = "pond";
    pond.jitter = jitter;
    s.water_bodies = {pond};
  }
  return s;
}

// Volume of grains and water in each cell over the cell's, from the boxes of the points.
class Fill {
 public:
  Fill(const Simulation& sim, const Choice& c) : h_(c.cell), half_(0.5 * c.cell / c.per_axis) {
    const PointFrame soil = sim.points({"volume", "porosity"}), water = sim.water_points();
    for (std::size_t p = 0; p < soil.count(); ++p)
      add(soil.positions[3 * p], soil.positions[3 * p + 1],
          soil.fields[0].values[p] * (1 - soil.fields[1].values[p]));
    for (std::size_t p = 0; p < water.count(); ++p)
      add(water.positions[3 * p], water.positions[3 * p + 1], water.fields[2].values[p]);
  }
  double at(int i, int j) const {
    const auto found = volume_.find({i, j});
    return found == volume_.end() ? 0.0 : found->second / (h_ * h_);
  }

 private:
  double overlap(double x, int i) const {
    return std::max(0.0, std::min(x + half_, (i + 1) * h_) - std::max(x - half_, i * h_)) / (2 * half_);
  }
  // What reaches beyond a wall counts to the cell at the wall.
  void add(double x, double y, double volume) {
    const int i0 = static_cast<int>(std::floor((x - half_) / h_)),
              j0 = static_cast<int>(std::floor((y - half_) / h_));
    for (int i = i0; i <= i0 + 2; ++i)
      for (int j = j0; j <= j0 + 2; ++j)
        volume_[{std::clamp(i, 0, 3), std::max(j, 0)}] += volume * overlap(x, i) * overlap(y, j);
  }

  double h_, half_;
  std::map<std::pair<int, int>, double> volume_;
};

WaterRest rest_errors(const Simulation& sim, const Choice& c, double level) {
  const double h = c.cell;
  WaterRest r;
  double sum = 0;
  int cells = 0;
  const Fill fill(sim, c);
  for (int i = 0; i < 4; ++i)
    for (int j = 0; (j + 0.5) * h < level; ++j) {
      const double y = (j + 0.5) * h;
      const double p = sim.cell_quantity({(i + 0.5) * h, y, 0}, "pore_pressure");
      const double e = (p - kUnitWeight * (level - y)) / (kUnitWeight * level);
      sum += e * e, ++cells;
      r.pressure_largest = std::max(r.pressure_largest, std::abs(e));
      if (y < level - 1.5 * h) r.drift = std::max(r.drift, std::abs(fill.at(i, j) - 1));
    }
  r.pressure_error = std::sqrt(sum / cells);
  r.speed = column_of(sim, "max_speed[m/s]");
  return r;
}

WaterRest run_to_rest(const Scene& s, const Choice& c, double level) {
  Simulation sim(s);
  while (!sim.finished()) sim.step();
  return rest_errors(sim, c, level);
}

}  // namespace

WaterRest jittered_column(const Choice& c, double jitter, double duration) {
  return run_to_rest(column(c, 1, jitter, duration), c, 1);
}

WaterRest pond_over_soil(const Choice& c, double jitter, double duration) {
  return run_to_rest(column(c, 1.4, jitter, duration), c, 1.4);
}

FallingHead falling_head(const Choice& c, double jitter, double duration) {
  constexpr double kLevel = 1.4;
  const double h = c.cell, width = 4 * h;
  Scene s = column(c, kLevel, jitter, duration);
  WaterBoundary base;
  base.name = "base";
  base.kind = WaterBoundary::Kind::pressure;
  base.side = 2;
  base.value.value = {0.0};
  s.water_boundaries = {base};
  Simulation sim(s);
  const auto out = [&] { return column_of(sim, "water_outflow[m3]") / width; };
  while (sim.time() < 0.3 * duration) sim.step();
  FallingHead r;
  const double from = sim.time(), before = out();
  // Fill of the cells now and then: points that cross from cell to cell change it all the time.
  double drift = 0, next = from;
  long full = 0;
  while (!sim.finished()) {
    sim.step();
    if (sim.time() < next) continue;
    next += 0.02 * duration;
    const Fill fill(sim, c);
    const double level = kLevel - out();
    for (int j = 1; (j + 0.5) * h <= level - 1.5 * h; ++j)
      for (int i = 0; i < 4; ++i) {
        const double excess = fill.at(i, j) - 1;
        drift += excess * excess, ++full;
        double& largest = std::abs((j + 0.5) * h - 1) < h ? r.drift_interface : r.drift_elsewhere;
        largest = std::max(largest, std::abs(excess));
      }
  }
  const auto head = [&](double t) { return kLevel * std::exp(-c.conductivity * t); };
  r.outflow_error = (out() - before) / (head(from) - head(sim.time())) - 1;
  r.water_error = column_of(sim, "water_mass_error[-]");
  r.steps = sim.steps();
  const double level = kLevel - out();
  double pressure = 0;
  int cells = 0;
  for (int j = 0; (j + 0.5) * h < level - h; ++j) {
    const double y = (j + 0.5) * h;
    const double exact = kUnitWeight * (y < 1 ? (level - 1) * y : level - y);
    for (int i = 0; i < 4; ++i) {
      const double p = sim.cell_quantity({(i + 0.5) * h, y, 0}, "pore_pressure");
      const double e = (p - exact) / (kUnitWeight * kLevel);
      pressure += e * e, ++cells;
      r.pressure_largest = std::max(r.pressure_largest, std::abs(e));
    }
  }
  r.pressure_error = std::sqrt(pressure / cells);
  r.drift_rms = std::sqrt(drift / full);
  return r;
}

LevelSeepage level_seepage(const Choice& c, double duration) {
  constexpr double kLength = 1, kHeight = 0.5, kUpstream = 0.8, kDownstream = 0.6;
  Scene s = wet_scene(c, kLength, kHeight, duration);
  // As stiff as lets it consolidate within a second.
  s.materials = {elastic_soil(1e4 / c.conductivity, 0.2, kPorosity, c.conductivity, kDensitySolid)};
  s.bodies = {box(0, 0, kLength, kHeight, c)};
  s.bodies[0].stress.kind = InitialStress::Kind::k0;
  s.bodies[0].stress.k0 = {0.5};
  coupling::Boundary base;
  base.name = "base";
  base.kind = coupling::Boundary::Kind::friction;
  base.side = 2;
  base.coefficient = 0.5;
  s.boundaries = {base};
  for (const int side : {0, 1}) {
    WaterBoundary b;
    b.name = side == 0 ? "upstream" : "downstream";
    b.side = side;
    b.value.value = {side == 0 ? kUpstream : kDownstream};
    s.water_boundaries.push_back(b);
  }
  Simulation sim(s);
  while (sim.time() < 0.5 * duration) sim.step();
  const double gradient = (kUpstream - kDownstream) / kLength;
  double flow = 0;
  long steps = 0;
  for (; !sim.finished(); ++steps) sim.step(), flow += column_of(sim, "discharge:downstream[m3/s]");
  LevelSeepage r;
  r.outflow_error = flow / static_cast<double>(steps) / (c.conductivity * gradient * kHeight) - 1;
  for (double x = 0.5 * c.cell; x < kLength; x += c.cell)
    for (double y = 0.5 * c.cell; y < kHeight; y += c.cell) {
      const double exact = kUnitWeight * (kUpstream - gradient * x - y);
      const double error = sim.cell_quantity({x, y, 0}, "pore_pressure") - exact;
      r.pressure_error =
          std::max(r.pressure_error, std::abs(error) / (kUnitWeight * (kUpstream - kDownstream)));
    }
  return r;
}

double drag_rate(double conductivity) {
  return kPorosity * kPorosity * kUnitWeight / conductivity *
         (1 / ((1 - kPorosity) * kDensitySolid) + 1 / (kPorosity * kDensityWater));
}

void give_water_speed(Simulation& sim, double speed) {
  MemoryState state;
  state.save(sim);
  Reals& velocity = state.arrays.at("water/velocity_x");
  const std::vector<int>& id = state.lists.at("water/id");
  for (std::size_t p = 0; p < velocity.size(); ++p)
    if (id[p] >= 0) velocity[p] = speed;
  state.load(sim);
}

double relative_speed(const Simulation& sim) {
  double grains = 0, water = 0;
  const PointFrame soil = sim.points({"velocity"}), fluid = sim.water_points();
  for (std::size_t p = 0; p < soil.count(); ++p)
    grains += soil.fields[0].values[3 * p] / static_cast<double>(soil.count());
  for (std::size_t p = 0; p < fluid.count(); ++p)
    water += fluid.fields[0].values[3 * p] / static_cast<double>(fluid.count());
  return water - grains;
}

Exchange exchange_of_momentum(const Choice& c, double speed, int steps) {
  const double h = c.cell;
  Scene s = wet_scene(c, 16 * h, 16 * h, 1e9);
  s.gravity = {};
  s.materials = {elastic_soil(1e7, 0.2, kPorosity, c.conductivity, kDensitySolid)};
  s.bodies = {box(6 * h, 6 * h, 10 * h, 10 * h, c)};
  s.water.initial = WaterSpec::Initial::zero;
  s.water.bulk_modulus = 1e-12;
  Simulation sim(s);
  give_water_speed(sim, speed);

  const auto momentum = [&](int axis) {
    return column_of(sim, axis == 0 ? "momentum_x[kg m/s]" : "momentum_y[kg m/s]");
  };
  const double first = momentum(0);
  const double rate = drag_rate(c.conductivity);
  Exchange r;
  double expected = speed;
  for (int i = 0; i < steps; ++i) {
    sim.step();
    expected /= 1 + rate * sim.last_step();
    r.momentum_error =
        std::max({r.momentum_error, std::abs(momentum(0) - first) / first, std::abs(momentum(1)) / first});
  }
  r.relative = relative_speed(sim) / speed;
  r.decay_error = relative_speed(sim) / expected - 1;
  r.explicit_ratio = sim.last_step() * rate / 2;
  return r;
}

// ---- free water

DamBreak dam_break(const Choice& c, double width, double height, double length, double duration,
                   double every) {
  Scene s = wet_scene(c, length, height + 4 * c.cell, duration);
  Body dam = box(0, 0, width, height, c);
  dam.name = "dam";
  s.water_bodies = {dam};
  s.numerics.water_transfer = coupling::Transfer::apic;
  Simulation sim(s);
  DamBreak r;
  const double h = c.cell;
  // Depth of the columns of cells; one counts to the body of water where it holds as much as a fifth of a
  // cell.
  const auto depths = [&] {
    std::vector<double> depth(static_cast<std::size_t>(std::ceil(length / h)) + 1, 0.0);
    const PointFrame f = sim.water_points();
    const double half = 0.5 * h / c.per_axis;
    for (std::size_t p = 0; p < f.count(); ++p) {
      const double x = f.positions[3 * p], v = f.fields[2].values[p] / h;
      const int left = std::max(0, static_cast<int>((x - half) / h));
      const double share = std::clamp(((left + 1) * h - (x - half)) / (2 * half), 0.0, 1.0);
      depth[left] += share * v, depth[std::min<std::size_t>(left + 1, depth.size() - 1)] += (1 - share) * v;
    }
    return depth;
  };
  const auto look = [&] {
    const std::vector<double> depth = depths();
    constexpr double kShare = 0.2;
    std::size_t last = 0;
    while (last + 1 < depth.size() && depth[last] > kShare * h) ++last;
    const double ahead = depth[last], behind = last > 0 ? depth[last - 1] : ahead;
    // Between the centres of the last column that counts and the next, where the depth passes the share.
    r.time.push_back(sim.time());
    r.front.push_back(
        last == 0 ? 0.0 : (last - 0.5 + std::clamp((behind - kShare * h) / (behind - ahead), 0.0, 1.0)) * h);
    r.height.push_back(depth[0]);
  };
  look();
  for (double next = every; !sim.finished();) {
    sim.step();
    r.largest_speed = std::max(r.largest_speed, column_of(sim, "max_speed[m/s]"));
    if (sim.time() < next - 1e-9 * every) continue;
    look(), next += every;
  }
  const std::vector<double> depth = depths();
  for (std::size_t i = 0; i < depth.size(); ++i) r.profile.push_back({(i + 0.5) * h - width, depth[i]});
  r.water_error = column_of(sim, "water_mass_error[-]");
  r.seconds = sim.timing().total;
  r.steps = sim.steps();
  return r;
}

Sloshing sloshing(const Choice& c, double amplitude, double duration) {
  constexpr double kLength = 1, kDepth = 0.5, kWave = std::numbers::pi / kLength;
  const double h = c.cell;
  Scene s = wet_scene(c, kLength, 2 * kDepth, duration);
  Body tank;
  tank.name = "tank";
  tank.particles_per_axis = c.per_axis;
  constexpr int kPieces = 40;
  for (int i = 0; i <= kPieces; ++i) {
    const double x = kLength * (1 - static_cast<double>(i) / kPieces);
    tank.polygon.push_back({x, kDepth + amplitude * std::cos(kWave * x), 0});
  }
  tank.polygon.push_back({0, 0, 0});
  tank.polygon.push_back({kLength, 0, 0});
  s.water_bodies = {tank};
  s.numerics.water_transfer = coupling::Transfer::apic;
  Simulation sim(s);
  // Difference of the pressures at mid-depth beside the two walls: zero twice a period.
  const auto difference = [&] {
    const double y = 0.5 * kDepth + 0.25 * h;
    return sim.cell_quantity({0.5 * h, y, 0}, "pore_pressure") -
           sim.cell_quantity({kLength - 0.5 * h, y, 0}, "pore_pressure");
  };
  Sloshing r;
  double before = difference(), time = 0, first = -1, last = 0, peak = 0, first_peak = 0, last_peak = 0;
  while (!sim.finished()) {
    sim.step();
    const double now = difference();
    if (before * now <= 0 && before != 0) {
      const double at = time + (sim.time() - time) * before / (before - now);
      if (first < 0)
        first = at;
      else
        ++r.half_swings, last_peak = peak, first_peak = first_peak > 0 ? first_peak : peak;
      last = at, peak = 0;
    }
    peak = std::max(peak, std::abs(now));
    before = now, time = sim.time();
  }
  r.period = 2 * (last - first) / r.half_swings;
  r.exact = 2 * std::numbers::pi / std::sqrt(kGravity * kWave * std::tanh(kWave * kDepth));
  r.amplitude = last_peak / first_peak;
  r.steps = sim.steps();
  return r;
}

// ---- a scene with everything

Scene open_sides_scene(const Choice& c, double duration) {
  Scene s = wet_scene(c, 1, 1.2, duration);
  s.numerics.flip = 0.98;
  s.materials = {elastic_soil(5e4, 0.3, kPorosity, c.conductivity, kDensitySolid)};
  Body soil;
  soil.name = "soil";
  soil.polygon = {{0, 0, 0}, {1, 0, 0}, {1, 0.4, 0}, {0.4, 0.9, 0}, {0, 0.9, 0}};
  soil.particles_per_axis = c.per_axis;
  soil.jitter = 0.2;
  s.bodies = {soil};
  Body pond = box(0.5, 0.3, 1, 0.6, c);
  pond.name = "pond";
  pond.jitter = 0.2;
  s.water_bodies = {pond};
  s.water.phreatic = {{0, 0.8, 0}, {1, 0.6, 0}};
  const auto level = [](const char* name, int side, double value) {
    WaterBoundary b;
    b.name = name;
    b.side = side;
    b.value.value = {value};
    return b;
  };
  s.water_boundaries = {level("upstream", 0, 0.8), level("downstream", 1, 0.35)};
  s.stages[0].damping = 0.02;
  return s;
}

Cost cost_of_a_step(const Choice& c, int pairs, double duration) {
  Cost r;
  r.one_layer = r.two_layer = 1e300;
  for (int i = 0; i < pairs; ++i)
    for (const bool two : {false, true}) {
      Choice choice = c;
      choice.formulation = two ? "two-layer" : "one-layer";
      Simulation sim(slump_scene(choice, duration));
      while (!sim.finished()) sim.step();
      const double steps = static_cast<double>(sim.steps());
      double& best = two ? r.two_layer : r.one_layer;
      if (sim.timing().total / steps < best) {
        best = sim.timing().total / steps;
        (two ? r.two_layer_water : r.one_layer_water) = sim.timing().water / steps;
      }
      (two ? r.particles_two : r.particles_one) = sim.particles();
    }
  return r;
}

}  // namespace polder::verify
