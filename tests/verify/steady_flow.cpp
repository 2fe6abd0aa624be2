#include "tests/verify/steady_flow.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "tests/verify/seepage_scene.hpp"

namespace polder::verify {
namespace {

using Boundary = fdm::WaterBoundary<2>;

fdm::Soil<2> soil_of(const SteadyScene& scene) {
  fdm::Soil<2> soil;
  soil.retention.model = scene.n > 0 ? fdm::Retention::Model::van_genuchten : fdm::Retention::Model::gardner;
  soil.retention.alpha = scene.alpha, soil.retention.n = scene.n, soil.retention.residual = scene.residual;
  return soil;
}

Boundary head(int side, double level, bool seepage_above) {
  Boundary b;
  b.name = side == 0 ? "upstream" : "downstream";
  b.kind = Boundary::Kind::head;
  b.side = side;
  b.value = level;
  b.seepage_above = seepage_above;
  return b;
}

double suction_start(SteadyStart start, double near, double level, double dry, double z) {
  return start == SteadyStart::near ? near - z : start == SteadyStart::still ? level - z : -dry;
}

SteadyFlow find(SeepageScene& s, bool averages) {
  s.field.set_averages(averages);
  const auto begin = std::chrono::steady_clock::now();
  const fdm::StepReport r = s.field.steady(s.unsaturated(1000));
  const fdm::Discharge& q = s.field.discharge();
  SteadyFlow found{.converged = r.converged,
                   .iterations = r.iterations,
                   .linear_iterations = r.linear_iterations,
                   .seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(),
                   .inflow = -q.boundary[0]};
  found.outflow = q.total() + found.inflow;
  return found;
}

}  // namespace

std::vector<SteadyScene> steady_scenes() {
  std::vector<SteadyScene> scenes{
      {.name = "Gardner, alpha = 80/m", .conductivity = 1e-4, .alpha = 80, .residual = 0.1}};
  const SteadyScene soils[] = {
      {.name = "loamy sand of cases/levee-story",
       .conductivity = 4.5e-5,
       .alpha = 2.73,
       .n = 2.28,
       .residual = 0.139},
      {.name = "sand", .conductivity = 8.25e-5, .alpha = 14.5, .n = 2.68, .residual = 0.1},
      {.name = "clay loam", .conductivity = 7.2e-7, .alpha = 1.9, .n = 1.31, .residual = 0.23},
      {.name = "silty clay", .conductivity = 5.5e-8, .alpha = 0.5, .n = 1.09, .residual = 0.19}};
  for (const SteadyScene& s : soils) scenes.push_back(s);
  for (const bool drain : {false, true})
    for (SteadyScene s : soils) {
      s.levee = true, s.drain = drain;
      scenes.push_back(s);
    }
  return scenes;
}

SteadyFlow steady_flow(const SteadyScene& scene, SteadyStart start, bool averages) {
  if (!scene.levee) {
    SeepageScene s({0, 0}, {40, 40}, 0.025, {soil_of(scene)});
    s.set_conductivity(scene.conductivity);
    s.conditions.boundaries = {head(0, 1, false), head(1, 0.2, true)};
    s.update();
    s.set_head(
        [&](const Point<2>& x) { return suction_start(start, std::sqrt(1 - 0.96 * x[0]), 0.2, 3, x[1]); });
    return find(s, averages);
  }
  constexpr double kCell = 0.1, kLevel = 2.375, kBase = 9;
  SeepageScene s({0, 0}, {90, 30}, kCell, {soil_of(scene)});
  s.set_conductivity(scene.conductivity);
  s.fill_cells([](const Point<2>& centre) {
    constexpr int kStrips = 16;
    double sum = 0;
    for (int i = 0; i < kStrips; ++i) {
      const double x = centre[0] + kCell * ((i + 0.5) / kStrips - 0.5);
      sum += std::clamp((std::min(3.0, (kBase - x) / 2) - centre[1]) / kCell + 0.5, 0.0, 1.0);
    }
    return sum / kStrips;
  });
  s.conditions.boundaries = {head(0, kLevel, false)};
  if (scene.drain) s.conditions.drains = {{"toe", {{6.5, 0.15}, {8.5, 0.15}}, 0}};
  s.update();
  s.set_head(
      [&](const Point<2>& x) { return suction_start(start, kLevel * (1 - x[0] / kBase), 0, 2, x[1]); });
  return find(s, averages);
}

}  // namespace polder::verify
