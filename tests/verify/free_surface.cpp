#include "tests/verify/free_surface.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

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

// Takes the state of a softer fringe: pressures below zero shrink with the fringe, so that k_r stays.
void start_from(const SeepageScene& softer, double ratio, SeepageScene& s) {
  for (const auto& c : s.cells.cells()) {
    const double p = softer.field.pressure()[c.slot];
    s.field.pressure()[c.slot] = p > 0 ? p : p / ratio;
  }
}

// Where the pressure in a column of cells passes zero, the highest such place [m].
double zero_height(const SeepageScene& s, int column) {
  const std::vector<double> pressure(s.field.pressure().begin(), s.field.pressure().end());
  const std::vector<double> p = s.line(1, column, pressure);
  double z = 0;
  for (std::size_t j = 0; j + 1 < p.size(); ++j)
    if (p[j] > 0 && p[j + 1] <= 0)
      z = s.grid.origin()[1] + s.grid.spacing() * (static_cast<double>(j) + 0.5 + p[j] / (p[j] - p[j + 1]));
  return z;
}

void estimate_limit(FreeSurfaceLimit& limit) {
  const std::size_t n = limit.found.size();
  if (n < 2) return;
  const FreeSurface &coarse = limit.found[n - 2], &fine = limit.found[n - 1];
  const double share = std::exp2(-2.0 / 3);  // of the distance that is left after doubling alpha
  limit.discharge = 2 * fine.outflow - coarse.outflow;
  limit.exit = (fine.exit - share * coarse.exit) / (1 - share);
}

}  // namespace

double charny_discharge(double length, double h1, double h2) {
  return kConductivity * (h1 * h1 - h2 * h2) / (2 * length);
}

FreeSurfaceLimit rectangular_dam(double length, double h1, double h2, int cells, double steepest) {
  const double h = h1 / cells;
  const int columns = static_cast<int>(std::lround(length / h));
  FreeSurfaceLimit limit;
  std::unique_ptr<SeepageScene> softer;
  for (double alpha = 20 / h1; alpha <= 1.001 * steepest / h1; alpha *= 2) {
    auto s = std::make_unique<SeepageScene>(Point<2>{0, 0}, Index<2>{columns, cells}, h,
                                            std::vector<fdm::Soil<2>>{gardner(alpha, 0.1)});
    s->set_conductivity(kConductivity);
    s->conditions.boundaries = {head("upstream", 0, h1, false), head("downstream", 1, h2, true)};
    s->update();
    s->set_head([&](const Point<2>& x) {  // Dupuit
      return std::sqrt(h1 * h1 - (h1 * h1 - h2 * h2) * x[0] / length) - x[1];
    });
    if (softer) start_from(*softer, 2, *s);
    const fdm::StepReport report = s->field.steady(s->unsaturated(1000 / alpha));
    const fdm::Discharge& q = s->field.discharge();
    limit.alpha.push_back(alpha);
    limit.found.push_back({.converged = report.converged,
                           .iterations = report.iterations,
                           .inflow = -q.boundary[0],
                           .outflow = q.boundary[1],
                           .exit = zero_height(*s, columns - 1)});
    softer = std::move(s);
  }
  estimate_limit(limit);
  return limit;
}

FreeSurfaceLimit trapezoidal_levee(double base, double upstream, double downstream, double h1, double h2,
                                   double cell, double steepest) {
  const double top = base / (upstream + downstream), apex = upstream * top;
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
  FreeSurfaceLimit limit;
  std::unique_ptr<SeepageScene> softer;
  for (double alpha = 20 / h1; alpha <= 1.001 * steepest / h1; alpha *= 2) {
    auto s = std::make_unique<SeepageScene>(Point<2>{0, 0}, size, cell,
                                            std::vector<fdm::Soil<2>>{gardner(alpha, 0.1)});
    s->set_conductivity(kConductivity);
    s->fill_cells(fill);
    Boundary water = head("upstream", fdm::kFreeSurface, h1, false);
    water.to[0] = apex;
    Boundary air = head("downstream", fdm::kFreeSurface, h2, true);
    air.from[0] = apex;
    s->conditions.boundaries = {water, air};
    s->update();
    s->set_head([&](const Point<2>& x) {
      const double part = std::clamp((x[0] - upstream * h1) / (base - upstream * h1), 0.0, 1.0);
      return h1 + (h2 - h1) * part - x[1];
    });
    if (softer) start_from(*softer, 2, *s);
    const fdm::StepReport report = s->field.steady(s->unsaturated(1000 / alpha));
    const fdm::Discharge& q = s->field.discharge();
    double exit = h2;  // the highest face of the downstream slope that lets water out
    for (const auto& f : s->cells.boundary_faces()) {
      const auto& c = s->cells.cells()[f.cell];
      const double z = s->cells.centre(c.index)[1], rise = f.axis == 1 ? f.distance : 0;
      if (f.boundary == 1 && s->field.pressure()[c.slot] > kGamma * rise) exit = std::max(exit, z + rise);
    }
    limit.alpha.push_back(alpha);
    limit.found.push_back({.converged = report.converged,
                           .iterations = report.iterations,
                           .inflow = -q.boundary[0],
                           .outflow = q.boundary[1],
                           .exit = exit});
    softer = std::move(s);
  }
  estimate_limit(limit);
  return limit;
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
