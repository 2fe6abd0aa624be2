// Soil that sleeps: it does so at rest, wakes by force, contact and pore pressure, errs by no more than its
// thresholds, and keeps the bits of restarts and threads.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "core/threads.hpp"
#include "coupling/sleep.hpp"
#include "tests/verify/cut_run.hpp"
#include "tests/verify/one_layer_scenes.hpp"

using namespace polder;
using namespace polder::verify;
using coupling::Body;
using coupling::Boundary;
using coupling::TimeTable;
using coupling::WaterBoundary;

namespace {

constexpr double kCell = 0.1, kSide = 2;

// Soil 2 m wide and 2 m high at rest between rollers, under its own weight from the start; cells of 0.1 m.
coupling::Scene bed(const std::string& formulation, double duration) {
  Choice c;
  c.formulation = formulation, c.cell = kCell, c.courant = 0.5;
  coupling::Scene s = wet_scene(c, kSide, 2 * kSide, duration);
  mpm::MaterialParameters m = elastic_soil(1e7, 0.3, 0.4, 1e-3, 2650);
  m.model = mpm::MaterialModel::mohr_coulomb;
  m.friction.value = {0.6};
  m.cohesion.value = {1000};
  s.materials = {m};
  Body soil = box(0, 0, kSide, kSide, c, 0);
  soil.stress.kind = coupling::InitialStress::Kind::k0;
  soil.stress.k0 = {0.3 / 0.7};
  s.bodies = {soil};
  for (int side : {0, 1, 2}) {
    Boundary b;
    b.name = "side-" + std::to_string(side);
    b.side = side;
    s.boundaries.push_back(b);
  }
  s.water.initial = coupling::WaterSpec::Initial::hydrostatic;
  s.numerics.sleep = true;
  s.numerics.sleep_force = 0.02;
  s.numerics.sleep_delay = 0.5;
  return s;
}

coupling::Scene awake(coupling::Scene s) {
  s.numerics.sleep = false;
  return s;
}

long asleep_after(const coupling::Scene& scene, double time) {
  Simulation s(scene);
  while (!s.finished() && s.time() < time) s.step();
  return s.savings().sleeping_points;
}

// Mean of a quantity over the first body, step by step until the end, at the times of `every`.
std::vector<double> history_of(const coupling::Scene& scene, const std::string& quantity, double every,
                               coupling::Savings* report = nullptr) {
  Simulation s(scene);
  std::vector<double> values;
  while (!s.finished()) {
    s.step();
    if (s.time() >= every * static_cast<double>(values.size() + 1))
      values.push_back(s.body_quantity(scene.bodies[0].name, quantity));
  }
  if (report != nullptr) *report = s.savings();
  return values;
}

// Largest difference, and that at the end, over the range of the expected values. Blocks wake one after the
// other, some hundredths of a second late each, so on the way the former tells of a lag.
struct Difference {
  double largest = 0, last = 0;
};
Difference difference(const std::vector<double>& a, const std::vector<double>& expected) {
  REQUIRE(a.size() == expected.size());
  REQUIRE(!a.empty());
  const auto [low, high] = std::minmax_element(expected.begin(), expected.end());
  Difference d;
  for (std::size_t i = 0; i < a.size(); ++i)
    d.largest = std::max(d.largest, std::abs(a[i] - expected[i]) / (*high - *low));
  d.last = std::abs(a.back() - expected.back()) / (*high - *low);
  MESSAGE("difference over the range: largest " << d.largest << ", at the end " << d.last);
  return d;
}

double range_of(const std::vector<double>& a) {
  const auto [low, high] = std::minmax_element(a.begin(), a.end());
  return *high - *low;
}

}  // namespace

TEST_CASE("soil at rest falls asleep and stays where it is, and the walls carry its weight") {
  for (const char* formulation : {"dry", "one-layer"}) {
    CAPTURE(formulation);
    coupling::Scene scene = bed(formulation, 2.0);
    Simulation s(scene);
    while (!s.finished() && s.time() < 1.5) s.step();
    CHECK(s.savings().sleeping_points == s.particles());
    CHECK(s.savings().blocks_woken == 0);
    const std::int64_t skipped = s.savings().skipped_particle_steps;
    const long before = s.steps();
    const double place = s.body_quantity("soil-0", "position_y");
    while (!s.finished()) s.step();
    CHECK(s.savings().skipped_particle_steps - skipped == (s.steps() - before) * s.particles());
    CHECK(s.body_quantity("soil-0", "position_y") == place);
    CHECK(column_of(s, "kinetic_energy[J]") == 0);
    // Reaction of the base: weight of the soil and, wet, of the water, less what pore pressure carries there.
    const double density = 0.6 * 2650 + (scene.formulation == "dry" ? 0 : 0.4 * 1000 - 1000);
    CHECK(std::abs(s.body_quantity("soil-0", "displacement")) < 1e-4);
    Simulation other(awake(scene));
    while (!other.finished()) other.step();
    const double weight = density * 9.81 * kSide * kSide;
    CHECK(other.body_quantity("soil-0", "stress_yy") ==
          doctest::Approx(s.body_quantity("soil-0", "stress_yy")).epsilon(0.01));
    CHECK(s.body_quantity("soil-0", "stress_yy") == doctest::Approx(-0.5 * weight / kSide).epsilon(0.02));
  }
}

TEST_CASE("sleeping soil is woken by a load") {
  coupling::Scene scene = bed("dry", 4.0);
  Boundary b = load(kSide, 0, kSide, 0);  // the soil to its left, seen along it
  b.pressure.time = {0, 2.0, 2.4, 4.0};
  b.pressure.value = {0, 0, 20e3, 20e3};
  scene.boundaries.push_back(b);
  CHECK(asleep_after(scene, 1.9) == 1600);
  coupling::Savings report;
  const std::vector<double> sleeping = history_of(scene, "displacement", 0.02, &report);
  const std::vector<double> expected = history_of(awake(scene), "displacement", 0.02);
  CHECK(report.blocks_woken > 0);
  CHECK(report.skipped_particle_steps > 0);
  CHECK(range_of(expected) > 5e-4);  // the settlement
  const Difference d = difference(sleeping, expected);
  CHECK(d.largest < 0.15);
  CHECK(d.last < 0.05);
}

TEST_CASE("sleeping soil is woken by what falls on it") {
  coupling::Scene scene = bed("dry", 3.0);
  Body falling = scene.bodies[0];
  falling.name = "block";
  falling.stress = {};
  // It takes 1.9 s to come back, while the bed has fallen asleep.
  falling.box = {{coupling::Vector3{0.7, 2.6, 0}, coupling::Vector3{1.3, 3.0, 0}}};
  falling.velocity = {0, 9, 0};
  scene.grid.size[1] = 8;
  scene.bodies.push_back(falling);
  scene.stages[0].damping = 0.1;  // the bed starts with the block's weight on it, and swings
  CHECK(asleep_after(scene, 1.7) == 1600);
  coupling::Savings report;
  const std::vector<double> sleeping = history_of(scene, "displacement", 0.02, &report);
  const std::vector<double> expected = history_of(awake(scene), "displacement", 0.02);
  CHECK(report.blocks_woken > 0);
  CHECK(range_of(expected) > 1e-3);
  const Difference d = difference(sleeping, expected);
  CHECK(d.largest < 0.15);
  CHECK(d.last < 0.05);
}

TEST_CASE("sleeping soil is woken by a rise of the pore pressure") {
  coupling::Scene scene = bed("one-layer", 4.0);
  WaterBoundary head;
  head.name = "below";
  head.side = 2;
  head.value.time = {0, 2.0, 2.5, 4.0};
  head.value.value = {2.0, 2.0, 3.2, 3.2};  // nearly the critical gradient
  scene.water_boundaries = {head};
  CHECK(asleep_after(scene, 1.9) == 1600);
  coupling::Savings report;
  const std::vector<double> sleeping = history_of(scene, "displacement", 0.02, &report);
  const std::vector<double> expected = history_of(awake(scene), "displacement", 0.02);
  CHECK(report.blocks_woken > 0);
  CHECK(range_of(expected) > 5e-4);  // the heave
  const Difference d = difference(sleeping, expected);
  CHECK(d.largest < 0.15);
  CHECK(d.last < 0.05);
}

TEST_CASE("sleep keeps the bits of a cut run and of any number of threads") {
  for (const char* formulation : {"dry", "one-layer"}) {
    CAPTURE(formulation);
    // A load that comes and goes: cut in sleep, and where blocks wake and fall asleep again.
    coupling::Scene scene = bed(formulation, 3.2);
    Boundary b = load(1.0, 0, kSide, 0);
    b.pressure.time = {0, 1.4, 1.5, 3.2};
    b.pressure.value = {0, 0, 10e3, 10e3};
    scene.boundaries.push_back(b);
    scene.numerics.sleep_force = 0.1;
    set_threads(1);
    const WholeRun whole = run_whole(scene);
    CHECK(whole.state.counts.at("times_woken") > 0);
    CHECK(whole.state.counts.at("times_asleep") > 9);  // blocks of the bed: some sleep again
    for (double share : {0.4, 0.55})
      check_cut_run(scene, static_cast<long>(share * whole.steps), whole.state, whole.steps);
    for (int n : {2, 4}) {
      set_threads(n);
      check_same_bits(run_whole(scene).state, whole.state);
    }
    set_threads(1);
  }
}

TEST_CASE("where soil cannot sleep") {
  CHECK(coupling::keeps_awake(bed("dry", 1)) == nullptr);
  CHECK(coupling::keeps_awake(bed("one-layer", 1)) == nullptr);
  for (const char* formulation : {"two-layer", "u-p", "higo"}) {
    CAPTURE(formulation);
    CHECK(coupling::keeps_awake(bed(formulation, 1)) != nullptr);
    CHECK_THROWS_AS(Simulation(bed(formulation, 1)), InputError);
  }
  coupling::Scene weightless = bed("dry", 1);
  weightless.gravity = {};
  CHECK(coupling::keeps_awake(weightless) != nullptr);
}
