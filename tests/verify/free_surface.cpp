#include "tests/verify/free_surface.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>

#include "fdm/phreatic_exit.hpp"
#include "tests/verify/seepage_scene.hpp"

namespace polder::verify {
namespace {

using Boundary = fdm::WaterBoundary<2>;

constexpr double kConductivity = 1e-4;  // [m/s]
constexpr double kLength = 10;          // of the block whose level changes [m]
constexpr double kDrainable = 0.2;      // its drainable porosity

fdm::Soil<2> gardner(double alpha, double residual) {
  fdm::Soil<2> soil;
  soil.retention.model = fdm::Retention::Model::gardner;
  soil.retention.alpha = alpha;
  soil.retention.residual = residual;
  return soil;
}

Boundary head(const char* name, int side, double level, bool seepage_above) {
  Boundary b;
  b.name = name;
  b.kind = Boundary::Kind::head;
  b.side = side;
  b.value = level;
  b.seepage_above = seepage_above;
  return b;
}

// Finds the steady state; both boundaries of the scene in the order upstream, downstream.
FreeSurface steady_flow(SeepageScene& s, double alpha, const Fringe& fringe) {
  s.field.set_averages(fringe.averages);
  const auto start = std::chrono::steady_clock::now();
  const fdm::StepReport report = s.field.steady(s.unsaturated(1000 / alpha));
  FreeSurface found{
      .converged = report.converged,
      .iterations = report.iterations,
      .linear_iterations = report.linear_iterations,
      .seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(),
      .inflow = -s.field.discharge().boundary[0],
      .outflow = s.field.discharge().boundary[1],
      .exit = std::nan("")};
  for (const fdm::PhreaticExit& e : fdm::phreatic_exits(s.cells, s.field.pressure()))
    if (e.boundary == 1 && e.found) found.exit = e.place[1];
  return found;
}

}  // namespace

double charny_discharge(double length, double h1, double h2) {
  return kConductivity * (h1 * h1 - h2 * h2) / (2 * length);
}

FreeSurface rectangular_dam(double length, double h1, double h2, int cells, Fringe fringe) {
  const double h = h1 / cells, alpha = fringe.steepness / h1;
  const int columns = static_cast<int>(std::lround(length / h));
  SeepageScene s({0, 0}, {columns, cells}, h, {gardner(alpha, 0.1)});
  s.set_conductivity(kConductivity);
  s.conditions.boundaries = {head("upstream", 0, h1, false), head("downstream", 1, h2, true)};
  s.update();
  s.set_head([&](const Point<2>& x) {  // Dupuit
    return std::sqrt(h1 * h1 - (h1 * h1 - h2 * h2) * x[0] / length) - x[1];
  });
  return steady_flow(s, alpha, fringe);
}

FreeSurface trapezoidal_levee(double base, double upstream, double downstream, double h1, double h2,
                              double cell, Fringe fringe) {
  const double top = base / (upstream + downstream), apex = upstream * top, alpha = fringe.steepness / h1;
  const Index<2> size{static_cast<int>(std::lround(base / cell)),
                      static_cast<int>(std::ceil(top / cell - 1e-9)) + 1};
  // Share of a cell below both slopes, by columns of its width.
  const auto fill = [&](const Point<2>& centre) {
    constexpr int kStrips = 16;
    double sum = 0;
    for (int i = 0; i < kStrips; ++i) {
      const double x = centre[0] + cell * ((i + 0.5) / kStrips - 0.5);
      const double surface = std::min(x / upstream, (base - x) / downstream);
      sum += std::clamp((surface - centre[1]) / cell + 0.5, 0.0, 1.0);
    }
    return sum / kStrips;
  };
  SeepageScene s({0, 0}, size, cell, {gardner(alpha, 0.1)});
  s.set_conductivity(kConductivity);
  s.fill_cells(fill);
  Boundary water = head("upstream", fdm::kFreeSurface, h1, false);
  water.to[0] = apex;
  Boundary air = head("downstream", fdm::kFreeSurface, h2, true);
  air.from[0] = apex;
  s.conditions.boundaries = {water, air};
  s.update();
  s.set_head([&](const Point<2>& x) {
    const double part = std::clamp((x[0] - upstream * h1) / (base - upstream * h1), 0.0, 1.0);
    return h1 + (h2 - h1) * part - x[1];
  });
  return steady_flow(s, alpha, fringe);
}

LevelChange level_change(double h0, double hb, double cell, double alpha, const std::vector<double>& times) {
  const double height = std::max(h0, hb) + 10 / alpha;  // room for the fringe
  const Index<2> size{static_cast<int>(std::lround(kLength / cell)),
                      static_cast<int>(std::ceil(height / cell))};
  SeepageScene s({0, 0}, size, cell, {gardner(alpha, 0.5)});
  std::fill(s.porosity.begin(), s.porosity.end(), 2 * kDrainable);
  s.set_conductivity(kConductivity);
  s.conditions.boundaries = {head("side", 0, hb, true)};
  s.update();
  s.set_head([&](const Point<2>& x) { return h0 - x[1]; });
  LevelChange result;
  double dt = times[0] / 50;
  for (const double t : times) {
    s.run(t, dt, t / 20);
    result.time.push_back(t);
    result.volume.push_back(s.out[0]);
  }
  result.defect = s.defect / s.out[0];
  result.steps = s.steps;
  return result;
}

double linearised_volume(double h0, double hb, double fringe, double time) {
  // h - hb = (h0 - hb) sum 4 / (m pi) sin(m pi x / 2L) exp(-D (m pi / 2L)^2 t), m odd.
  const double diffusivity = kConductivity * (0.5 * (h0 + hb) + fringe) / kDrainable;
  double left = 0;  // mean of (h - hb) / (h0 - hb)
  for (int m = 1; m < 4001; m += 2) {
    const double rate = std::pow(m * std::numbers::pi / (2 * kLength), 2) * diffusivity;
    left += 8 / std::pow(m * std::numbers::pi, 2) * std::exp(-rate * time);
  }
  return kDrainable * kLength * (h0 - hb) * (1 - left);
}

}  // namespace polder::verify
