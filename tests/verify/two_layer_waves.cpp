#include "tests/verify/two_layer_waves.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "io/csv.hpp"

namespace polder::verify {

using coupling::WaterSpec;
using Complex = std::complex<double>;

namespace {

constexpr double kDensityWater = 1000;

// Column 1 m high on a closed base, 2 cells wide, without weight, loaded on its drained top.
Scene column(const Choice& c, const mpm::MaterialParameters& soil, double duration) {
  const double h = c.cell;
  Scene s = wet_scene(c, 2 * h, 1 + 2 * h, duration);
  s.gravity = {};
  s.materials = {soil};
  s.bodies = {box(0, 0, 2 * h, 1, c)};
  s.water.initial = WaterSpec::Initial::zero;
  return s;
}

}  // namespace

// ---- harmonic loading

// With lengths over L, stresses over q and z down from the top, the columns satisfy S X'' + R X = 0 for
// X = (u, w), w the displacement of water relative to the grains times n, and
// X = sum of c_j V_j sinh(l_j (1 - z)) / (l_j cosh l_j) over the two eigenvalues l^2 of -S^-1 R.
Complex harmonic_pressure(ColumnEquations equations, const HarmonicGroups& g, double depth) {
  const Complex i(0, 1);
  const double kappa = g.kappa;
  std::array<std::array<Complex, 2>, 2> r{};
  r[1][1] = -i / g.pi1;
  switch (equations) {
    case ColumnEquations::uw:
      r[0][1] = g.beta * g.pi2, r[1][1] += g.beta / g.porosity * g.pi2;
      [[fallthrough]];
    case ColumnEquations::up:
      r[1][0] = g.beta * g.pi2;
      [[fallthrough]];
    case ColumnEquations::darcy:
      r[0][0] = g.pi2;
      break;
    case ColumnEquations::consolidation:
      break;
  }
  // A = -S^-1 R with S = {{1, kappa}, {kappa, kappa}}.
  const double det = kappa - kappa * kappa;
  std::array<std::array<Complex, 2>, 2> a{};
  for (int c = 0; c < 2; ++c) {
    a[0][c] = -(kappa * r[0][c] - kappa * r[1][c]) / det;
    a[1][c] = -(-kappa * r[0][c] + r[1][c]) / det;
  }
  const Complex half = 0.5 * (a[0][0] + a[1][1]);
  const Complex root = std::sqrt(half * half - (a[0][0] * a[1][1] - a[0][1] * a[1][0]));
  std::array<std::array<Complex, 2>, 2> v{};  // v[j]: eigenvector j
  std::array<Complex, 2> l{};
  for (int j = 0; j < 2; ++j) {
    const Complex square = half + (j == 0 ? root : -root);
    l[j] = std::sqrt(square);
    v[j] = std::abs(a[0][1]) > std::abs(square - a[1][1]) ? std::array<Complex, 2>{a[0][1], square - a[0][0]}
                                                          : std::array<Complex, 2>{square - a[1][1], a[1][0]};
  }
  // At the top: no pressure, u' + w' = 0, and total stress u' + kappa w' = -1.
  const Complex b00 = v[0][0] + v[0][1], b01 = v[1][0] + v[1][1];
  const Complex b10 = v[0][0] + kappa * v[0][1], b11 = v[1][0] + kappa * v[1][1];
  const Complex whole = b00 * b11 - b01 * b10;
  const Complex factor[] = {-b01 / whole, b00 / whole};
  Complex p = 0;
  for (int j = 0; j < 2; ++j) {
    const Complex s = l[j].real() >= 0 ? l[j] : -l[j];
    const Complex cosh = (std::exp(-s * depth) + std::exp(-s * (2 - depth))) / (1.0 + std::exp(-2.0 * s));
    p += kappa * factor[j] * (v[j][0] + v[j][1]) * cosh;
  }
  return p;
}

double harmonic_difference(ColumnEquations a, ColumnEquations b, const HarmonicGroups& g) {
  double difference = 0, largest = 0;
  for (int i = 0; i <= 100; ++i) {
    const Complex exact = harmonic_pressure(b, g, i / 100.0);
    difference = std::max(difference, std::abs(harmonic_pressure(a, g, i / 100.0) - exact));
    largest = std::max(largest, std::abs(exact));
  }
  return difference / largest;
}

double Harmonic::error(ColumnEquations equations, const HarmonicGroups& groups) const {
  double difference = 0, largest = 0;
  for (std::size_t i = 0; i < depth.size(); ++i) {
    const Complex exact = harmonic_pressure(equations, groups, depth[i]);
    difference = std::max(difference, std::abs(amplitude[i] - exact));
    largest = std::max(largest, std::abs(exact));
  }
  return difference / largest;
}

double analysed_mixture_limit(const Choice& c, double n, double density_solid) {
  const double modulus = elastic_soil(1e7, 0.2, n, c.conductivity).wave_modulus(), q = c.bulk_modulus / n;
  const double grains = (1 - n) * density_solid, water = n * kDensityWater;
  const double beta = n * n * kUnitWeight / c.conductivity;
  // The determinant of 4 M + 2 (2 - s) dt C - dt^2 K D for a = sin^2(theta / 2), D = diag(s or 2 - s, 2 - s).
  const auto stable = [&](double dt, double a) {
    const double s = 1 - 0.75 * a, d = 2 - s, of_grains = c.musl ? s : d;
    const double x = 4 * a * dt * dt / (c.cell * c.cell), drag = 2 * d * dt * beta;
    const double k00 = modulus + (1 - n) * (1 - n) * q, k01 = n * (1 - n) * q, k11 = n * n * q;
    return (4 * grains + drag - x * k00 * of_grains) * (4 * water + drag - x * k11 * d) >
           (drag + x * k01 * d) * (drag + x * k01 * of_grains);
  };
  constexpr int kModes = 50;
  constexpr double kRatio = 1.002;
  const double shortest = 0.3 * c.cell * std::sqrt(kDensityWater / (modulus + q));
  double limit = std::numeric_limits<double>::infinity();
  for (int i = 1; i <= kModes; ++i) {
    double dt = shortest;
    while (dt < limit && stable(dt, i / static_cast<double>(kModes))) dt *= kRatio;
    limit = std::min(limit, dt);
  }
  return limit;
}

Harmonic harmonic_column(const Choice& choice, const HarmonicGroups& g, int steps, int periods) {
  constexpr double kModulus = 1e7, kPoisson = 0.2, kLoad = 100;
  const double factor = (1 + kPoisson) * (1 - 2 * kPoisson) / (1 - kPoisson);
  const double rho = kDensityWater / g.beta;
  const double grains = (rho - g.porosity * kDensityWater) / (1 - g.porosity);
  const double square = kModulus / (1 - g.kappa) / rho;  // V_c^2
  const double omega = std::sqrt(g.pi2 * square), period = 2 * std::numbers::pi / omega;
  Choice c = choice;
  c.bulk_modulus = g.porosity * g.kappa / (1 - g.kappa) * kModulus;
  c.conductivity = g.pi1 * kGravity * g.beta * omega / square;
  const mpm::MaterialParameters soil =
      elastic_soil(factor * kModulus, kPoisson, g.porosity, c.conductivity, grains);
  Scene s = column(c, soil, periods * period);
  const double dt = period / steps, h = c.cell;
  s.numerics.time_step = dt;
  s.boundaries = {load(2 * h, 0, 1, 0)};
  coupling::TimeTable& table = s.boundaries[0].pressure;
  table = {{}, {}};
  for (int i = 0; i <= periods * steps; ++i) {
    const double t = i * dt, growth = t < 2 * period ? std::pow(std::sin(omega * t / 8), 2) : 1.0;
    table.time.push_back(t), table.value.push_back(kLoad * growth * std::sin(omega * t));
  }
  Simulation sim(s);
  Harmonic r;
  const int cells = static_cast<int>(std::lround(1 / h));
  std::vector<Complex> before(cells);
  r.amplitude.resize(cells);
  for (int i = 0; i < cells; ++i) r.depth.push_back(1 - (i + 0.5) * h);
  for (int n = 1; n <= periods * steps; ++n) {
    sim.step();
    if (n <= (periods - 2) * steps) continue;
    std::vector<Complex>& sum = n <= (periods - 1) * steps ? before : r.amplitude;
    // sin(omega t) is the imaginary part of the load's exp(i omega t).
    const double phase = 2 * std::numbers::pi * n / steps;
    const Complex wave = Complex(0, 2.0 / (steps * kLoad)) * std::exp(Complex(0, -phase));
    for (int i = 0; i < cells; ++i)
      sum[i] += wave * sim.cell_quantity({0.5 * h, (i + 0.5) * h, 0}, "pore_pressure");
  }
  double largest = 0;
  for (int i = 0; i < cells; ++i) {
    r.change = std::max(r.change, std::abs(r.amplitude[i] - before[i]));
    largest = std::max(largest, std::abs(r.amplitude[i]));
  }
  r.change /= largest;
  r.steps = sim.steps();
  return r;
}

// ---- two waves

namespace {

CsvTable biot_column(bool up, const char* quantity) {
  const std::string name =
      std::string("biot_column_permeable") + (up ? "_up" : "") + "_smooth_" + quantity + ".csv";
  return CsvTable(std::filesystem::path(POLDER_SOURCE_DIR) / "tests" / "reference" / name);
}

// "... name=1.5; ..." of the first comment line.
double parameter(const CsvTable& table, const std::string& name) {
  const std::string& line = table.comments().at(0);
  const std::size_t at = line.find(" " + name + "=");
  if (at == std::string::npos) throw std::runtime_error("the reference has no " + name);
  return std::stod(line.substr(at + name.size() + 2));
}

constexpr double kHeights[] = {0.25, 0.5, 0.75};
constexpr std::size_t kColumns[] = {2, 3, 4};  // of these heights in the tables

struct Series {
  std::vector<double> time;
  std::array<std::vector<double>, 3> value;  // at the heights
  // Linear between steps.
  double at(int height, double t) const {
    const auto next = std::lower_bound(time.begin(), time.end(), t);
    if (next == time.begin()) return value[height].front();
    if (next == time.end()) return value[height].back();
    const std::size_t i = static_cast<std::size_t>(next - time.begin());
    const double share = (t - time[i - 1]) / (time[i] - time[i - 1]);
    return value[height][i - 1] + share * (value[height][i] - value[height][i - 1]);
  }
};

// Second wave in the effective stress: when it is half way up at a height, between what it is at two times.
double passage(const Series& s, int height, double from, double to) {
  const double middle = 0.5 * (s.at(height, from) + s.at(height, to));
  for (std::size_t i = 1; i < s.time.size(); ++i) {
    const double a = s.value[height][i - 1] - middle, b = s.value[height][i] - middle;
    if (s.time[i] > from && a * b <= 0 && a != b)
      return s.time[i - 1] + (s.time[i] - s.time[i - 1]) * a / (a - b);
  }
  return std::nan("");
}

Series series_of(const CsvTable& table, double end) {
  Series s;
  const auto time = table.column(std::size_t{0});
  for (std::size_t i = 0; i < time.size() && time[i] <= end; ++i) s.time.push_back(time[i]);
  for (int k = 0; k < 3; ++k) {
    const auto column = table.column(kColumns[k]);
    s.value[k].assign(column.begin(), column.begin() + static_cast<std::ptrdiff_t>(s.time.size()));
  }
  return s;
}

double distance(const Series& computed, const Series& reference) {
  double difference = 0, whole = 0;
  for (int k = 0; k < 3; ++k)
    for (std::size_t i = 0; i < reference.time.size(); ++i) {
      difference += std::pow(computed.at(k, reference.time[i]) - reference.value[k][i], 2);
      whole += std::pow(reference.value[k][i], 2);
    }
  return std::sqrt(difference / whole);
}

}  // namespace

TwoWaves two_waves(const Choice& choice, ColumnEquations equations) {
  const bool up = equations == ColumnEquations::up;
  constexpr double kEnd = 1.5e-3, kRise = 2e-4, kPoisson = 0.2;
  const CsvTable table = biot_column(up, "sig");
  Choice c = choice;
  c.bulk_modulus = parameter(table, "Kw_Pa");
  c.conductivity = parameter(table, "k_m_s");
  const double h = c.cell, q = parameter(table, "q_Pa"), modulus = parameter(table, "M_Pa");
  const double factor = (1 + kPoisson) * (1 - 2 * kPoisson) / (1 - kPoisson);
  Scene s = column(c,
                   elastic_soil(factor * modulus, kPoisson, parameter(table, "n"), c.conductivity,
                                parameter(table, "rho_s")),
                   kEnd);
  s.boundaries = {load(2 * h, 0, 1, 0)};
  coupling::TimeTable& load_table = s.boundaries[0].pressure;
  load_table = {{}, {}};
  constexpr int kPieces = 200;
  for (int i = 0; i <= kPieces; ++i) {
    const double share = static_cast<double>(i) / kPieces;
    load_table.time.push_back(share * kRise);
    load_table.value.push_back(q * std::pow(std::sin(0.5 * std::numbers::pi * share), 2));
  }
  Simulation sim(s);
  // Two points of each layer, above and below a height that lies between two cells.
  const double spacing = h / c.per_axis;
  std::array<std::array<int, 2>, 3> soil{}, water{};
  const coupling::PointFrame start = sim.water_points();
  for (int k = 0; k < 3; ++k)
    for (int side = 0; side < 2; ++side) {
      const double x = 0.5 * spacing, y = kHeights[k] + (side - 0.5) * spacing;
      soil[k][side] = sim.probe_particle({x, y, 0});
      double nearest = 1e300;
      for (std::size_t p = 0; p < start.count(); ++p) {
        const double r = std::hypot(start.positions[3 * p] - x, start.positions[3 * p + 1] - y);
        if (r < nearest) nearest = r, water[k][side] = static_cast<int>(p);
      }
    }
  Series pressure, stress, grains, flow;
  for (Series* series : {&pressure, &stress, &grains, &flow}) {
    series->time.push_back(0);
    for (auto& v : series->value) v.push_back(0);
  }
  const bool layered = start.count() > 0;
  const bool kept = coupling::find_formulation(c.formulation)->inertia == coupling::RelativeInertia::kept;
  std::clock_t spent = 0;
  while (!sim.finished()) {
    const std::clock_t before = std::clock();
    sim.step();
    spent += std::clock() - before;
    for (Series* series : {&pressure, &stress, &grains, &flow}) series->time.push_back(sim.time());
    const coupling::PointFrame fluid = layered ? sim.water_points() : coupling::PointFrame{};
    for (int k = 0; k < 3; ++k) {
      double sum[4] = {};
      for (int side = 0; side < 2; ++side) {
        sum[0] += sim.cell_quantity({0.5 * h, kHeights[k] + (side - 0.5) * h, 0}, "pore_pressure");
        sum[1] += sim.particle_quantity(soil[k][side], "stress_yy");
        sum[2] += sim.particle_quantity(soil[k][side], "velocity_y");
        if (kept && !layered) sum[3] += sim.particle_quantity(soil[k][side], "water_velocity_y");
        if (layered) sum[3] += fluid.fields[0].values[3 * static_cast<std::size_t>(water[k][side]) + 1];
      }
      pressure.value[k].push_back(0.5 * sum[0]), stress.value[k].push_back(0.5 * sum[1]);
      grains.value[k].push_back(0.5 * sum[2]), flow.value[k].push_back(0.5 * sum[3]);
    }
  }
  TwoWaves r;
  const Series exact = series_of(table, kEnd);
  r.pressure = distance(pressure, series_of(biot_column(up, "p"), kEnd));
  r.stress = distance(stress, exact);
  r.grains = distance(grains, series_of(biot_column(up, "v"), kEnd));
  r.water = kept ? distance(flow, series_of(biot_column(up, "w"), kEnd)) : std::nan("");
  // Between the plateaus behind the first and the second wave.
  constexpr double kFrom[] = {0, 8.5e-4, 4e-4}, kTo[] = {0, 1.1e-3, 7e-4};
  const auto delay = [&](const Series& series) {
    return passage(series, 1, kFrom[1], kTo[1]) - passage(series, 2, kFrom[2], kTo[2]);
  };
  const auto jump = [&](const Series& series) { return series.at(2, kTo[2]) - series.at(2, kFrom[2]); };
  r.speed = delay(exact) / delay(stress);
  r.amplitude = jump(stress) / jump(exact);
  r.steps = sim.steps();
  r.seconds = static_cast<double>(spent) / CLOCKS_PER_SEC;
  return r;
}

}  // namespace polder::verify
