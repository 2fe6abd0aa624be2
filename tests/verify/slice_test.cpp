// A slice of a levee in space, between smooth walls, against the same levee in plane strain: equilibrium,
// seepage and failure.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "core/threads.hpp"
#include "coupling/simulation.hpp"

using namespace polder;
using namespace polder::coupling;

namespace {

constexpr double kCell = 0.1;

struct Slice {
  bool walls, wet;
  mpm::ShapeKind shape;
  LockingCure locking;
  double cohesion;  // [Pa]
};

// A levee with water in it to its left, loaded on its crest; in space `walls` from y = 0.1 to 0.3 m hold the
// slice inside a deeper grid, or the grid's own front and back do. With a cohesion of 100 Pa it fails, with 1
// kPa it yields and stands.
coupling::Scene levee(bool space, const Slice& slice) {
  const bool walls = space && slice.walls, wet = slice.wet;
  coupling::Scene s;
  s.formulation = wet ? "one-layer" : "dry";
  s.gravity = space ? Vector3{0, 0, -9.81} : Vector3{0, -9.81, 0};
  s.grid.space = space ? Space::three_d : Space::plane_strain;
  s.grid.size = space ? Vector3{2.8, walls ? 0.4 : 0.2, 1.0} : Vector3{2.8, 1.0, 0};
  s.grid.cell = kCell;
  s.grid.shape = slice.shape;
  s.numerics.locking = slice.locking;
  mpm::MaterialParameters m;
  m.name = "sand";
  m.model = mpm::MaterialModel::mohr_coulomb;
  m.density_solid = 2650, m.porosity = 0.4, m.young = 5e6, m.poisson = 0.3;
  m.friction.value = {0.4};
  m.cohesion.value = {slice.cohesion};
  m.hydraulic_conductivity = 1e-3;
  s.materials = {m};
  Body b;
  b.name = "levee";
  b.polygon = {{0, 0, 0}, {1.8, 0, 0}, {0.7, 0.8, 0}, {0, 0.8, 0}};
  if (walls) b.extrude = {0.1, 0.3};
  s.bodies = {b};
  Boundary base;
  base.name = "base";
  base.side = space ? 4 : 2;
  base.kind = Boundary::Kind::friction;
  base.coefficient = 0.4;
  s.boundaries = {base};
  // A footing on the crest.
  Boundary load;
  load.name = "footing";
  load.kind = Boundary::Kind::pressure;
  load.pressure = {{0, 0.1}, {0, 4e3}};
  const double y0 = walls ? 0.1 : 0, y1 = walls ? 0.3 : 0.2;
  if (space)
    load.polygon = {{0, y0, 0.8}, {0, y1, 0.8}, {0.4, y1, 0.8}, {0.4, y0, 0.8}};
  else
    load.segment = {{Vector3{0.4, 0.8, 0}, Vector3{0, 0.8, 0}}};
  s.boundaries.push_back(load);
  if (walls)
    for (const bool back : {false, true}) {
      Boundary wall;
      wall.name = back ? "back" : "front";
      // Held both ways, as by a side of the grid; a roller inside the grid lets the soil go.
      wall.kind = Boundary::Kind::velocity;
      wall.velocity[1] = TimeTable{};
      const double y = back ? 0.3 : 0.1;
      wall.polygon = {{0, y, 0}, {2.8, y, 0}, {2.8, y, 1}, {0, y, 1}};
      if (!back) std::reverse(wall.polygon.begin(), wall.polygon.end());
      s.boundaries.push_back(wall);
    }
  if (wet) {
    s.water.phreatic = {{0, 0.6, 0}, {2.8, 0, 0}};
    s.water.saturation_above = 0.5;
  }
  Stage rest;
  rest.name = "rest";
  rest.mode = Stage::Mode::dynamic;
  rest.duration = 0.2;
  rest.damping = 0.5;
  rest.sticking = true;
  Stage slide;
  slide.name = "slide";
  slide.mode = Stage::Mode::dynamic;
  slide.duration = 0.2;
  s.stages = {rest, slide};
  return s;
}

struct Difference {
  double position = 0;  // largest, as a share of the largest displacement
  double stress = 0;    // RMS, as a share of the RMS of the stresses
  double pressure = 0;  // of pore water, likewise
  double largest = 0;   // displacement in the plane [m]
};

Difference compare(const Slice& slice) {
  const bool wet = slice.wet;
  Simulation plane(levee(false, slice)), space(levee(true, slice));
  // The same steps, so that rounding is all that differs.
  while (!plane.finished()) plane.step();
  while (!space.finished()) space.step();
  REQUIRE(plane.steps() == space.steps());
  const std::vector<std::string> fields{"displacement", "effective_stress", "pore_pressure"};
  const PointFrame a = plane.points(fields), b = space.points(fields);
  REQUIRE(b.count() == 4 * a.count());
  const auto place = [](double x, double up) {
    return std::pair{std::lround(x / kCell * 100), std::lround(up / kCell * 100)};
  };
  std::map<std::pair<long, long>, std::size_t> at;  // by the initial position in the plane
  for (std::size_t i = 0; i < a.count(); ++i)
    at[place(a.positions[3 * i] - a.fields[0].values[3 * i],
             a.positions[3 * i + 1] - a.fields[0].values[3 * i + 1])] = i;
  REQUIRE(at.size() == a.count());
  Difference d;
  double stress = 0, scale = 0, pressure = 0, pressure_scale = 0;
  for (std::size_t j = 0; j < b.count(); ++j) {
    const auto& u = b.fields[0].values;
    const std::size_t i = at.at(place(b.positions[3 * j] - u[3 * j], b.positions[3 * j + 2] - u[3 * j + 2]));
    const double dx = b.positions[3 * j] - a.positions[3 * i];
    const double dz = b.positions[3 * j + 2] - a.positions[3 * i + 1];
    d.position = std::max(d.position, std::hypot(dx, dz));
    d.largest = std::max(d.largest, std::hypot(a.fields[0].values[3 * i], a.fields[0].values[3 * i + 1]));
    constexpr std::size_t kInSpace[] = {0, 2, 1, 5};  // xx, yy, zz, xy of the plane
    for (std::size_t k = 0; k < 4; ++k) {
      const double s = a.fields[1].values[6 * i + k];
      stress += std::pow(b.fields[1].values[6 * j + kInSpace[k]] - s, 2), scale += s * s;
    }
    if (wet) {
      const double p = a.fields[2].values[i];
      pressure += std::pow(b.fields[2].values[j] - p, 2), pressure_scale += p * p;
    }
  }
  d.position /= d.largest;
  d.stress = std::sqrt(stress / scale);
  d.pressure = wet ? std::sqrt(pressure / pressure_scale) : 0;
  MESSAGE("slice" << (wet ? ", wet" : ", dry") << ": positions " << d.position << ", stresses " << d.stress
                  << ", pore pressure " << d.pressure << " after " << d.largest << " m, " << space.steps()
                  << " steps");
  return d;
}

}  // namespace

TEST_CASE("a slice of a levee between the sides of the grid is the levee in plane strain") {
  set_threads(1);
  for (const bool wet : {false, true})
    for (const mpm::ShapeKind shape : {mpm::ShapeKind::gimp, mpm::ShapeKind::quadratic_bspline}) {
      CAPTURE(wet);
      CAPTURE(static_cast<int>(shape));
      const Difference d = compare({false, wet, shape, LockingCure::none, 100});
      CHECK(d.largest > 0.01);
      CHECK(d.position < 1e-5);
      CHECK(d.stress < 1e-5);
      CHECK(d.pressure < 1e-5);
    }
}

TEST_CASE("frames hold the recovered stress, with the mean of the points' own") {
  set_threads(1);
  for (const bool space : {false, true}) {
    Simulation s(levee(space, {false, true, mpm::ShapeKind::gimp, LockingCure::none, 1000}));
    for (int i = 0; i < 50; ++i) s.step();
    const PointFrame f = s.points({"recovered_stress", "effective_stress", "volume"});
    double changed = 0;
    for (std::size_t k = 0; k < 6; ++k) {
      double own = 0, recovered = 0, scale = 0;
      for (std::size_t i = 0; i < f.count(); ++i) {
        const double v = f.fields[2].values[i], a = f.fields[1].values[6 * i + k];
        const double b = f.fields[0].values[6 * i + k];
        own += v * a, recovered += v * b, scale += v * std::abs(a);
        changed = std::max(changed, std::abs(a - b));
      }
      CHECK(std::abs(own - recovered) <= 1e-12 * scale);
    }
    CHECK(changed > 10);
  }
}

TEST_CASE("a slice between walls inside the grid, with the locking cure") {
  set_threads(1);
  const Difference walls = compare({true, false, mpm::ShapeKind::gimp, LockingCure::none, 1000});
  CHECK(walls.position < 1e-3);
  CHECK(walls.stress < 1e-3);
  const Difference cure = compare({false, true, mpm::ShapeKind::gimp, LockingCure::cell_average, 1000});
  CHECK(cure.largest > 0.01);
  CHECK(cure.position < 1e-5);
  CHECK(cure.stress < 1e-5);
  CHECK(cure.pressure < 1e-5);
}
