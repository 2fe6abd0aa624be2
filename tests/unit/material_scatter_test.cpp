// Particles with factors of their own on cohesion and friction behave as particles of a material with that
// strength.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "mpm/material/element_path.hpp"

using namespace polder::mpm;

namespace {

MaterialParameters soil() {
  MaterialParameters m;
  m.name = "soil";
  m.model = MaterialModel::mohr_coulomb;
  m.young = 2e7;
  m.poisson = 0.3;
  m.cohesion.kind = Mobilised::Kind::exponential;
  m.cohesion.peak = 8e3, m.cohesion.residual = 1e3, m.cohesion.rate = 40;
  m.friction.value = {30 * std::numbers::pi / 180};
  m.dilation.value = {4 * std::numbers::pi / 180};
  m.capillary_cohesion.value = {2e3};
  return m;
}

// Largest deviator in triaxial compression from 20 kPa with the state's factors.
double strength(const MaterialParameters& m, double cohesion_factor, double friction_factor) {
  ElementPoint point(m);
  const StateLayout layout = state_layout(m, 3);
  if (layout.cohesion_factor >= 0) point.state[layout.cohesion_factor] = cohesion_factor;
  if (layout.friction_factor >= 0) point.state[layout.friction_factor] = friction_factor;
  point.stress = {-2e4, -2e4, -2e4, 0, 0, 0};
  std::array<ElementPoint::Control, 6> control{};
  control[0] = control[2] = {.stress = true, .value = -2e4};
  control[1] = {.stress = false, .value = -2e-4};
  double largest = 0;
  for (int i = 0; i < 100; ++i) {
    point.apply(control);
    largest = std::max(largest, point.stress[0] - point.stress[1]);
  }
  return largest;
}

}  // namespace

TEST_CASE("a factor on cohesion and friction is a material of that strength") {
  for (double c : {0.4, 1.0, 2.5})
    for (double f : {0.6, 1.0, 1.8}) {
      CAPTURE(c);
      CAPTURE(f);
      MaterialParameters scattered = soil(), plain = soil();
      scattered.scatter = {true, true, 0.6, 1.8};
      plain.cohesion.peak *= c;
      plain.cohesion.residual *= c;
      plain.friction.value[0] = std::atan(f * std::tan(plain.friction.value[0]));
      CHECK(strength(scattered, c, f) == doctest::Approx(strength(plain, 1, 1)).epsilon(1e-9));
      const StateLayout layout = state_layout(scattered, 3);
      std::vector<double> state(layout.count());
      set_initial_state(scattered, 3, 0, state);
      CHECK(state[layout.cohesion_factor] == 1);
      state[layout.cohesion_factor] = c;
      state[layout.friction_factor] = f;
      const Strength k = strength_of(scattered, layout, state);
      CHECK(k.cohesion == doctest::Approx(8e3 * c + 2e3));
      CHECK(k.friction == doctest::Approx(plain.friction.value[0]));
    }
}

TEST_CASE("scattered friction keeps dilation at or below itself") {
  MaterialParameters m = soil();
  m.dilation.value = {25 * std::numbers::pi / 180};
  m.scatter = {false, true, 0.2, 1};
  const StateLayout layout = state_layout(m, 3);
  CHECK(layout.cohesion_factor == -1);
  std::vector<double> state(layout.count());
  set_initial_state(m, 3, 0, state);
  state[layout.friction_factor] = 0.2;
  const Strength k = strength_of(m, layout, state);
  CHECK(k.dilation == doctest::Approx(k.friction));
}
