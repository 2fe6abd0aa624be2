// Random properties of a body: what its points carry, from the scene on.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "coupling/simulation.hpp"
#include "mpm/material/material.hpp"

using namespace polder;
using namespace polder::coupling;

namespace {

using Property = RandomProperty::Property;

Scene scene(mpm::MaterialModel model, std::vector<RandomProperty> random) {
  Scene s;
  s.formulation = "one-layer";
  s.grid.size = {8, 4, 0};
  s.grid.cell = 0.1;
  mpm::MaterialParameters m;
  m.name = "soil";
  m.model = model;
  m.density_solid = 2700;
  m.porosity = 0.4;
  m.young = 1e7;
  m.poisson = 0.3;
  m.hydraulic_conductivity = 1e-5;
  m.cohesion.value = {1e4};
  m.friction.value = {std::atan(0.5)};
  if (model == mpm::MaterialModel::tresca)
    m.shear_strength = 2e4, m.strength_gradient = 1e3, m.strength_datum = 4;
  s.materials = {m};
  Body b;
  b.name = "block";
  b.box = {{Vector3{0, 0, 0}, Vector3{8, 4, 0}}};
  b.random = std::move(random);
  s.bodies = {b};
  Stage stage;
  stage.name = "run";
  stage.duration = 1;
  s.stages = {stage};
  return s;
}

RandomProperty field(Property property, double v, int seed) {
  RandomProperty r;
  r.property = property;
  r.coefficient_of_variation = v;
  r.correlation_length = {0.5, 0.2, 0};
  r.seed = seed;
  return r;
}

struct Found {
  double mean = 0, variation = 0;
};

Found statistics(const std::vector<double>& values) {
  double sum = 0, squares = 0;
  for (double v : values) sum += v, squares += v * v;
  const double n = static_cast<double>(values.size()), mean = sum / n;
  return {mean, std::sqrt(squares / n - mean * mean) / mean};
}

}  // namespace

TEST_CASE("points carry the scattered strength and conductivity") {
  const Simulation simulation(scene(mpm::MaterialModel::mohr_coulomb,
                                    {field(Property::cohesion, 0.3, 1), field(Property::friction, 0.15, 2),
                                     field(Property::conductivity, 0.8, 3)}));
  const PointFrame frame = simulation.points({"cohesion", "friction_angle", "conductivity"});
  // About 8 / 1 x 4 / 0.4 independent patches: means to some per cent, variations to ten.
  const Found cohesion = statistics(frame.fields[0].values),
              conductivity = statistics(frame.fields[2].values);
  CHECK(cohesion.mean == doctest::Approx(1e4).epsilon(0.1));
  CHECK(cohesion.variation == doctest::Approx(0.3).epsilon(0.2));
  CHECK(conductivity.mean == doctest::Approx(1e-5).epsilon(0.25));
  CHECK(conductivity.variation == doctest::Approx(0.8).epsilon(0.35));
  std::vector<double> tangent;
  for (double angle : frame.fields[1].values) tangent.push_back(std::tan(angle * std::numbers::pi / 180));
  CHECK(statistics(tangent).mean == doctest::Approx(0.5).epsilon(0.05));
  CHECK(statistics(tangent).variation == doctest::Approx(0.15).epsilon(0.2));
}

TEST_CASE("undrained strength scatters about its profile in depth") {
  const Simulation simulation(scene(mpm::MaterialModel::tresca, {field(Property::shear_strength, 0.3, 4)}));
  const PointFrame frame = simulation.points({"cohesion"});
  std::vector<double> factor;
  for (std::size_t i = 0; i < frame.fields[0].values.size(); ++i)
    factor.push_back(frame.fields[0].values[i] / (2e4 + 1e3 * (4 - frame.positions[3 * i + 1])));
  CHECK(statistics(factor).mean == doctest::Approx(1).epsilon(0.1));
  CHECK(statistics(factor).variation == doctest::Approx(0.3).epsilon(0.2));
}

TEST_CASE("without random fields points carry nothing more, and all the same strength") {
  const Simulation simulation(scene(mpm::MaterialModel::mohr_coulomb, {}));
  const PointFrame frame = simulation.points({"cohesion", "friction_angle"});
  for (double c : frame.fields[0].values) CHECK(c == 1e4);
  const mpm::MaterialParameters& m = simulation.scene().materials[0];
  CHECK(mpm::state_layout(m, 2).count() == 1);
}
