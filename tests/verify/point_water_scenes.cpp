#include "tests/verify/point_water_scenes.hpp"

#include <algorithm>
#include <cmath>

namespace polder::verify {

namespace {

double wave_modulus(double young, double poisson) {
  return young * (1 - poisson) / (1 + poisson) / (1 - 2 * poisson);
}

}  // namespace

FormulaLimits formula_limits(const Choice& c, double n, double density) {
  const double q = c.bulk_modulus / n, rho = (1 - n) * density + n * 1000;
  const double rate = n * n * kUnitWeight / c.conductivity * (1 / ((1 - n) * density) + 1 / (n * 1000));
  return {2 / rate, c.cell / std::sqrt((wave_modulus(1e7, 0.2) + q) / rho),
          c.cell * c.cell * kUnitWeight / (2 * c.conductivity * q)};
}

// A wave with a = sin^2(theta/2) along an axis whose nodal velocities come back from the points times
// s = 1 - 3/4 a. Where it changes sign from step to step and is neither damped nor excited,
//   explicit drag  s (dt^2 K + 2 dt C) = 4 M,   implicit  s dt^2 K = 4 M + (4 - 2 s) dt C,
// K = 4 a / h^2 {{..}}; and in u-p, with X = a dt^2 / h^2 and Y = 2 a kappa Q dt / h^2,
//   s (M + Q) X + Y (rho - rho_w) - s M X Y = rho.
double analysed_point_limit(const Choice& c, double n, double density) {
  const double modulus = wave_modulus(1e7, 0.2), q = c.bulk_modulus / n, h = c.cell;
  const double grains = (1 - n) * density, water = n * 1000, rho = grains + water;
  const double beta = n * n * kUnitWeight / c.conductivity;
  const bool kept = c.formulation == "v-w", implicit_drag = c.drag == coupling::DragStep::implicit;
  const auto stable = [&](double a, double dt) {
    const double s = 1 - 0.75 * a, x = a * dt * dt / (h * h);
    if (!kept) {
      const double y = 2 * a * c.conductivity / kUnitWeight * q * dt / (h * h);
      return s * (modulus + q) * x + y * (rho - 1000) - s * modulus * x * y < rho && y < 2;
    }
    const double drag = implicit_drag ? (1 - 0.5 * s) * dt * beta : -0.5 * s * dt * beta;
    const double k00 = modulus + (1 - n) * (1 - n) * q, k01 = n * (1 - n) * q, k11 = n * n * q;
    const double m00 = grains + drag - s * x * k00, m11 = water + drag - s * x * k11;
    const double m01 = -drag - s * x * k01;
    return m00 > 0 && m11 > 0 && m00 * m11 > m01 * m01;
  };
  double least = 1e300;
  for (int i = 0; i <= 400; ++i) {
    const double a = i / 400.0;
    double low = 1e-12, high = 1;
    for (int j = 0; j < 80; ++j) {
      const double middle = std::sqrt(low * high);
      (stable(a, middle) ? low : high) = middle;
    }
    least = std::min(least, low);
  }
  return least;
}

Flow upward_flow(const Choice& c, double head) {
  const double h = c.cell, width = 2 * h;
  Scene s = wet_scene(c, width, 1 + 2 * h, 3);
  s.gravity = {};
  s.materials = {elastic_soil(1e7, 0.2, 0.4, c.conductivity)};
  s.bodies = {box(0, 0, width, 1, c)};
  s.water.initial = coupling::WaterSpec::Initial::zero;
  coupling::WaterBoundary base;
  base.name = "base";
  base.kind = coupling::WaterBoundary::Kind::pressure;
  base.side = 2;
  base.value.value = {head * kUnitWeight};
  s.water_boundaries = {base};
  s.stages[0].damping = 0.2;
  Simulation sim(s);
  while (!sim.finished()) sim.step();
  Flow r;
  r.discharge = -column_of(sim, "discharge:base[m3/s]") / width;
  r.exact = c.conductivity * head;
  double sum = 0;
  const int cells = static_cast<int>(std::lround(1 / h));
  for (int j = 0; j < cells; ++j) {
    const double y = (j + 0.5) * h;
    const double e = sim.cell_quantity({0.5 * h, y, 0}, "pore_pressure") / (head * kUnitWeight) - (1 - y);
    sum += e * e;
  }
  r.pressure_error = std::sqrt(sum / cells);
  r.water_error = column_of(sim, "water_mass_error[-]");
  return r;
}

double pressure_range(const Scene& scene) {
  Simulation sim(scene);
  while (!sim.finished()) sim.step();
  const coupling::PointFrame f = sim.points({"pore_pressure"});
  const auto [low, high] = std::minmax_element(f.fields[0].values.begin(), f.fields[0].values.end());
  return *high - *low;
}

}  // namespace polder::verify
