// Relaxation against slow motion, and what it must not do to the soil on its way.
#include <doctest/doctest.h>

#include "core/error.hpp"
#include "coupling/memory_state.hpp"
#include "coupling/simulation.hpp"
#include "tests/verify/quasi_static_scenes.hpp"

using namespace polder;
using namespace polder::verify;

namespace {

constexpr double kDegree = 3.14159265358979323846 / 180;

double column(const Simulation& simulation, const std::string& name) {
  for (const coupling::Column& c : simulation.history())
    if (c.name == name) return c.value;
  throw std::out_of_range(name);
}

// Largest share of the Mohr-Coulomb strength used by any point, for a friction angle: cohesion that would
// just do.
double needed_cohesion(const Simulation& simulation, double friction) {
  const std::vector<double> stress = field_of(simulation, "effective_stress");
  const std::size_t n = static_cast<std::size_t>(simulation.particles()), width = stress.size() / n;
  double most = 0;
  for (std::size_t p = 0; p < n; ++p) {
    const double* s = &stress[p * width];
    const double centre = 0.5 * (s[0] + s[1]), radius = std::hypot(0.5 * (s[0] - s[1]), s[3]);
    const double high = std::max(centre + radius, s[2]), low = std::min(centre - radius, s[2]);
    most = std::max(most, (high - low + (high + low) * std::sin(friction)) / (2 * std::cos(friction)));
  }
  return most;
}

}  // namespace

TEST_CASE(
    "A yielding slope relaxes to the stress that a slow loading ends with, in a fiftieth of its steps") {
  set_threads(1);
  const Scene relaxed = slope_scene(0.5, 6e3, 20 * kDegree);
  Simulation quick(relaxed);
  run_to_end(quick);
  const std::vector<double> stress = field_of(quick, "effective_stress"),
                            strain = field_of(quick, "deviatoric_strain");
  const long yielding = std::count_if(strain.begin(), strain.end(), [](double k) { return k > 1e-6; });
  CHECK(yielding > 0.1 * static_cast<double>(quick.particles()));  // or the comparison would say nothing

  // Gravity grows over 250 periods of the slope; a light damping takes out what the start stirs up.
  Scene slow = relaxed;
  Stage& stage = slow.stages[0];
  stage.mode = Stage::Mode::dynamic;
  stage.damping = 0.1;
  stage.gravity_ramp = 25;
  stage.duration = 25.5;
  Simulation motion(slow);
  double inertia = 0;  // of the loading but its first moment, when there is no load to speak of
  while (!motion.finished()) {
    motion.step();
    if (motion.time() > 5 && motion.steps() % 50 == 0)
      inertia = std::max(inertia, column(motion, "unbalanced_force_ratio[-]"));
  }
  MESSAGE("relaxation " << quick.steps() << " steps, slow motion " << motion.steps() << " with inertia "
                        << inertia << " of the weight; stress differs by "
                        << distance(stress, field_of(motion, "effective_stress")));
  CHECK(inertia < 1e-3);
  CHECK(distance(stress, field_of(motion, "effective_stress")) < 0.01);
  CHECK(motion.steps() > 50 * quick.steps());
}

TEST_CASE("Gravity turned on over a slope that stays elastic leaves no plastic strain") {
  set_threads(1);
  const double friction = 30 * kDegree;
  Scene scene = slope_scene(0.5, 0, friction);
  scene.stages[0].plastic = false;
  scene.stages[0].force_tolerance = 1e-6;
  Simulation elastic(scene);
  run_to_end(elastic);
  const double just_enough = needed_cohesion(elastic, friction);

  // Nothing yields at rest with a little more strength; with less some points must.
  scene.stages[0].plastic = true;
  for (const double share : {1.05, 0.8}) {
    scene.materials[0].cohesion.value = {share * just_enough};
    Simulation simulation(scene);
    run_to_end(simulation);
    const std::vector<double> strain = field_of(simulation, "deviatoric_strain");
    const double most = largest(strain);
    MESSAGE("cohesion " << share << " of what the elastic state needs, " << just_enough
                        << " Pa: largest plastic strain " << most);
    if (share > 1) {
      CHECK(most == 0);
      CHECK(distance(field_of(simulation, "effective_stress"), field_of(elastic, "effective_stress")) < 1e-4);
    } else {
      CHECK(most > 1e-6);
    }
  }
}

TEST_CASE("A relaxed state is at rest for the dynamic scheme") {
  set_threads(1);
  Scene scene = slope_scene(0.5, 8e3, 25 * kDegree);
  Stage wait;
  wait.name = "wait";
  wait.duration = 0.5;
  scene.stages.push_back(wait);
  Simulation simulation(scene);
  while (simulation.stage() == 0) simulation.step();
  const std::vector<double> before = field_of(simulation, "effective_stress");
  run_to_end(simulation);
  CHECK(distance(field_of(simulation, "effective_stress"), before) < 2e-3);
}

TEST_CASE("A slope that cannot stand does not come to rest") {
  set_threads(1);
  Scene scene = slope_scene(0.5, 1e3, 15 * kDegree);
  scene.stages[0].duration = 5;
  Simulation simulation(scene);
  CHECK_THROWS_AS(run_to_end(simulation), NumericalError);
}

TEST_CASE("A relaxation that goes on from a checkpoint gives the same bits") {
  set_threads(1);
  const Scene scene = slope_scene(0.5, 6e3, 20 * kDegree);
  Simulation whole(scene), first(scene), second(scene);
  run_to_end(whole);
  for (int i = 0; i < 73; ++i) first.step();
  coupling::MemoryState state;
  state.save(first);
  state.load(second);
  run_to_end(second);
  CHECK(second.steps() == whole.steps());
  CHECK(field_of(second, "effective_stress") == field_of(whole, "effective_stress"));
}
