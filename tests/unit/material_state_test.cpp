// State variables, mobilised parameters and parameter checks.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "mpm/material/material.hpp"

using namespace polder::mpm;

namespace {
constexpr double kDegree = std::numbers::pi / 180;

MaterialParameters sand() {
  MaterialParameters m;
  m.model = MaterialModel::mohr_coulomb;
  m.young = 1e7;
  m.poisson = 0.3;
  m.friction.value = {30 * kDegree};
  return m;
}
}  // namespace

TEST_CASE("state variables: plastic strain first, capillary factor only where there is capillary cohesion") {
  MaterialParameters m = sand();
  CHECK(state_layout(m, 2).count() == 1);
  CHECK(state_layout(m, 2).plastic_strain == 0);
  CHECK(state_layout(m, 2).capillary_factor == -1);
  m.capillary_cohesion.value = {500.0};
  CHECK(state_layout(m, 3).capillary_factor == 1);
  m.model = MaterialModel::neo_hookean;
  CHECK(state_layout(m, 2).count() == 5);
  CHECK(state_layout(m, 3).count() == 9);
  double f[9];
  set_initial_state(m, 3, 0.0, f);
  for (int i = 0; i < 9; ++i) CHECK(f[i] == (i % 4 == 0 ? 1 : 0));
}

TEST_CASE("undrained strength grows with depth below its datum and softens to the residual") {
  MaterialParameters m;
  m.model = MaterialModel::von_mises;
  m.shear_strength = 15e3;
  m.strength_gradient = 2e3;
  m.strength_datum = 10.0;
  m.softening_modulus = -30e3;
  m.residual_strength = 5e3;
  const StateLayout layout = state_layout(m, 2);
  double state[2];
  set_initial_state(m, 2, 4.0, state);
  CHECK(state[layout.peak_strength] == doctest::Approx(27e3));
  CHECK(peak_strength_at(m, 12.0) == doctest::Approx(15e3));
  state[layout.plastic_strain] = 0.1;
  CHECK(strength_of(m, layout, state).cohesion == doctest::Approx(24e3));
  state[layout.plastic_strain] = 10;
  CHECK(strength_of(m, layout, state).cohesion == doctest::Approx(5e3));
}

TEST_CASE("mobilised parameters are constant outside their knots") {
  Mobilised c;
  c.kind = Mobilised::Kind::piecewise_linear;
  c.strain = {0.01, 0.2};
  c.value = {2.0, 1.0};
  CHECK(value_at(c, 0.0) == 2.0);
  CHECK(value_at(c, 0.105) == doctest::Approx(1.5));
  CHECK(value_at(c, 1.0) == 1.0);
  CHECK(range_of(c).lowest == 1.0);
  c.kind = Mobilised::Kind::exponential;
  c.peak = 3.0, c.residual = 1.0, c.rate = 100.0;
  CHECK(value_at(c, 0.01) == doctest::Approx(1 + 2 * std::exp(-1.0)));
}

TEST_CASE("principal stresses and the mobilised friction angle do not depend on the axes") {
  // principal values -1, -2, -6 turned by 40 degrees about z, then named as 3D components
  const double c = std::cos(40 * kDegree), s = std::sin(40 * kDegree);
  const double stress[] = {-1 * c * c - 6 * s * s, -1 * s * s - 6 * c * c, -2, 5 * s * c, 0, 0};
  const Principal p = principal_stresses(stress);
  CHECK(p.first == doctest::Approx(-1).epsilon(1e-14));
  CHECK(p.second == doctest::Approx(-2).epsilon(1e-14));
  CHECK(p.third == doctest::Approx(-6).epsilon(1e-14));
  CHECK(mobilised_friction_angle(stress) == doctest::Approx(std::asin(5.0 / 7.0)));
  const double shuffled[] = {-2, -1 * c * c - 6 * s * s, -1 * s * s - 6 * c * c, 0, 5 * s * c, 0};
  CHECK(principal_stresses(shuffled).third == doctest::Approx(-6).epsilon(1e-14));
  const double none[4] = {};
  CHECK(mobilised_friction_angle(none) == 0);
  const double tension[4] = {3, 1, 1, 0};
  CHECK(mobilised_friction_angle(tension) == doctest::Approx(90 * kDegree));
}

TEST_CASE("utilisation is 1 on the Mohr-Coulomb surface") {
  MaterialParameters m = sand();
  m.cohesion.value = {1000.0};
  const StateLayout layout = state_layout(m, 2);
  const double state[] = {0.0}, s3 = 20e3, n = 3.0;
  const double stress[] = {-s3, -(n * s3 + 2 * 1000 * std::sqrt(n)), -s3, 0};
  CHECK(strength_utilisation(m, layout, stress, state) == doctest::Approx(1).epsilon(1e-12));
}

TEST_CASE("parameters outside the range of a model are named") {
  MaterialParameters m = sand();
  CHECK(check_parameters(m).empty());
  m.poisson = 0.5;
  m.dilation.value = {35 * kDegree};
  m.cohesion.value = {-1.0};
  m.tension_cutoff = -2;
  const auto problems = check_parameters(m);
  REQUIRE(problems.size() == 4);
  CHECK(problems[0].key == "poisson");
  CHECK(problems[1].key == "cohesion");
  CHECK(problems[2].key == "dilation");
  CHECK(problems[3].key == "tension_cutoff");
  m = sand();
  m.friction.kind = Mobilised::Kind::piecewise_linear;
  m.friction.strain = {0.2, 0.1};
  m.friction.value = {0.5, 0.4};
  CHECK(check_parameters(m).size() == 1);
  m.friction.value = {0.5};
  CHECK(check_parameters(m).size() == 1);
  m = sand();
  m.model = MaterialModel::tresca;
  m.softening_modulus = 5;
  CHECK(check_parameters(m).size() == 2);  // no strength, and hardening
}
