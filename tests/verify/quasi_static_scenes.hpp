// A dry slope of one soil on a smooth base between smooth walls, and what its points say at the end of a run.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/threads.hpp"
#include "coupling/simulation.hpp"

namespace polder::verify {

using coupling::Scene;
using coupling::Simulation;
using coupling::Stage;

constexpr double kSlopeDensity = 2000, kSlopeGravity = 9.81;

// 4 m high at 1 : 1.5, on 2 m of the same soil. Angles in radians, SI units.
inline Scene slope_scene(double cell, double cohesion, double friction) {
  Scene s;
  s.grid.size = {16, 7, 0};
  s.grid.cell = cell;
  mpm::MaterialParameters m;
  m.name = "soil";
  m.model = mpm::MaterialModel::mohr_coulomb;
  m.density_solid = kSlopeDensity;
  m.young = 20e6;
  m.poisson = 0.3;
  m.cohesion.value = {cohesion};
  m.friction.value = {friction};
  s.materials = {m};
  coupling::Body body;
  body.name = "slope";
  body.polygon = {{0, 0, 0}, {16, 0, 0}, {16, 2, 0}, {11, 2, 0}, {5, 6, 0}, {0, 6, 0}};
  s.bodies = {body};
  coupling::Boundary base;
  base.name = "base";
  base.kind = coupling::Boundary::Kind::fixed;
  base.side = 2;
  s.boundaries = {base};
  Stage stage;
  stage.name = "gravity";
  stage.mode = Stage::Mode::equilibrium;
  stage.duration = 100;
  s.stages = {stage};
  return s;
}

inline void run_to_end(Simulation& simulation) {
  while (!simulation.finished()) simulation.step();
}

inline std::vector<double> field_of(const Simulation& simulation, const std::string& name) {
  return simulation.points({name}).fields.at(0).values;
}

// Root mean square of the difference over that of the reference.
inline double distance(const std::vector<double>& a, const std::vector<double>& reference) {
  double square = 0, scale = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    square += (a[i] - reference[i]) * (a[i] - reference[i]);
    scale += reference[i] * reference[i];
  }
  return std::sqrt(square / scale);
}

inline double largest(const std::vector<double>& values) {
  return values.empty() ? 0 : *std::max_element(values.begin(), values.end());
}

}  // namespace polder::verify
