// Stages in which water sets the pace, and unsaturated soil in motion: a coarse levee from the rising of the
// water to the end of its slide, rest under suction, the same bits after a restart and with any number of
// threads.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "core/threads.hpp"
#include "tests/verify/cut_run.hpp"
#include "tests/verify/one_layer_scenes.hpp"

using namespace polder;
using namespace polder::verify;
using coupling::Stage;

namespace {

Stage stage(const char* name, Stage::Mode mode, double duration) {
  Stage s;
  s.name = name;
  s.mode = mode;
  s.duration = duration;
  return s;
}

coupling::Material silty_sand() {
  mpm::MaterialParameters m = elastic_soil(1e7, 0.3, 0.46, 4.5e-5, 2700);
  m.model = mpm::MaterialModel::mohr_coulomb;
  m.friction.value = {30.8 * 3.14159265358979 / 180};
  m.tension_cutoff = 0;
  coupling::Material soil(m);
  soil.retention.model = fdm::Retention::Model::van_genuchten;
  soil.retention.alpha = 2.73;
  soil.retention.n = 2.28;
  soil.retention.residual = 0.139;
  return soil;
}

// 3 m high, slope 1 : 2, its upstream face on the left side of the grid, where water rises in an hour.
Scene flooded_levee() {
  Scene s = wet_scene({.cell = 0.25, .courant = 0.8}, 14, 4, 1);
  s.materials = {silty_sand()};
  coupling::Body levee;
  levee.name = "levee";
  levee.polygon = {{0, 0, 0}, {9, 0, 0}, {3, 3, 0}, {0, 3, 0}};
  s.bodies = {levee};
  s.water = {};
  s.water.initial_saturation = 0.6;
  coupling::Boundary base;
  base.name = "base";
  base.kind = coupling::Boundary::Kind::friction;
  base.side = 2;
  base.coefficient = 0.3;
  s.boundaries = {base};
  coupling::WaterBoundary upstream;
  upstream.name = "upstream";
  upstream.side = 0;
  upstream.value = {{0, 3600}, {0, 2.375}};
  s.water_boundaries = {upstream};
  Stage rest = stage("rest", Stage::Mode::equilibrium, 20);
  rest.plastic = false, rest.sticking = true, rest.water_flows = false;
  rest.reset_displacement = true;
  Stage flood = stage("flood", Stage::Mode::quasi_static, 40 * 3600);
  flood.until = Stage::Until::failure;
  flood.relax_change = 1000;
  s.stages = {rest, flood, stage("slide", Stage::Mode::dynamic, 1)};
  return s;
}

struct Ended {
  coupling::MemoryState state;
  long steps = 0;
  long flood_steps = 0;
  double water_error_of_flood = 0, water_error = 0;
  double failure_time = 0;
};

Ended run(const Scene& scene) {
  Simulation s(scene);
  Ended e;
  while (!s.finished()) {
    s.step();
    if (s.stage() == 1)
      e.water_error_of_flood = column_of(s, "water_mass_error[-]"), e.flood_steps = s.steps();
  }
  e.state.save(s);
  e.steps = s.steps();
  e.water_error = column_of(s, "water_mass_error[-]");
  REQUIRE(s.stages()[1].ended_by == "failure");
  REQUIRE_FALSE(s.events().empty());
  CHECK(s.events().back().is_failure());
  e.failure_time = s.events().back().time;
  return e;
}

}  // namespace

TEST_CASE("a levee from the rising of the water to its slide") {
  set_threads(1);
  const Scene scene = flooded_levee();
  const Ended whole = run(scene);
  MESSAGE("failure after " << whole.failure_time / 3600 << " h; water error " << whole.water_error_of_flood
                           << " in the flood, " << whole.water_error << " with the slide; " << whole.steps
                           << " steps");
  // Water reaches the toe by Boussinesq's dry front (n_e = 0.46 * 0.4, level 2.4 m) after some 15 hours.
  CHECK(whole.failure_time > 8 * 3600);
  CHECK(whole.failure_time < 25 * 3600);
  // Cells that the soil overfills a little count as full: what they take up beyond is missing.
  CHECK(std::abs(whole.water_error_of_flood) < 5e-6);
  CHECK(std::abs(whole.water_error) < 2e-4);

  SUBCASE("cut and gone on with, the bits are the same") {
    for (const long at :
         {whole.flood_steps / 2, whole.flood_steps - 3, (whole.flood_steps + whole.steps) / 2}) {
      check_cut_run(scene, at, whole.state, whole.steps);
    }
  }
  SUBCASE("with four threads the bits are the same") {
    set_threads(4);
    const Ended other = run(scene);
    set_threads(1);
    check_same_bits(other.state, whole.state);
  }
}

// Suction that is hydrostatic stays so while water could seep, while the soil follows, and while it could
// move.
TEST_CASE("soil under hydrostatic suction rests in every stage") {
  set_threads(1);
  for (const double offset : {0.0, 0.3}) {
    CAPTURE(offset);
    const double height = 1 + 0.1 * offset;
    Scene s = wet_scene({}, 0.5, 1.5, 1);
    coupling::Material soil = silty_sand();
    soil.model = mpm::MaterialModel::linear_elastic;
    s.materials = {soil};
    coupling::Body column = box(0, 0, 0.5, height, {});
    column.stress.kind = coupling::InitialStress::Kind::k0;
    column.stress.k0 = {0.3 / 0.7};
    s.bodies = {column};
    s.water = {};
    s.water.phreatic = {{0, 0.42, 0}, {0.5, 0.42, 0}};
    Stage rest = stage("rest", Stage::Mode::equilibrium, 20);
    rest.water_flows = false;
    rest.force_tolerance = 1e-6, rest.energy_tolerance = 1e-3;
    rest.reset_velocity = true;
    Stage dynamic = stage("dynamic", Stage::Mode::dynamic, 0.2);
    Stage follows = stage("quasi-static", Stage::Mode::quasi_static, 3600);
    follows.force_tolerance = 1e-6;
    s.stages = {rest, stage("seepage", Stage::Mode::seepage, 3600), follows, dynamic};
    Simulation simulation(s);
    const double start = simulation.cell_quantity({0.25, 0.75, 0}, "pore_pressure");
    CHECK(start == doctest::Approx(kUnitWeight * (0.42 - 0.75)).epsilon(1e-9));
    double fastest = 0;
    while (!simulation.finished()) {
      const bool moving = simulation.stage() == 3;
      simulation.step();
      if (moving) fastest = std::max(fastest, column_of(simulation, "max_speed[m/s]"));
    }
    CHECK(simulation.cell_quantity({0.25, 0.75, 0}, "pore_pressure") == doctest::Approx(start).epsilon(1e-3));
    CHECK(std::abs(column_of(simulation, "water_mass_error[-]")) < 1e-7);
    CHECK(std::abs(column_of(simulation, "water_outflow[m3]")) < 1e-9);
    CHECK(fastest < 2e-5);
    MESSAGE("fastest " << fastest << " m/s, pressure "
                       << simulation.cell_quantity({0.25, 0.75, 0}, "pore_pressure") - start << " Pa off");
  }
}

// A pond on the soil, told as a head on its surface: the water starts hydrostatic below the pond, the soil
// under its own buoyant weight, and nothing moves.
TEST_CASE("soil under a pond rests in every stage") {
  set_threads(1);
  constexpr double kPond = 1.6, kGround = 1;
  for (const bool by_pressure : {false, true}) {
    CAPTURE(by_pressure);
    Scene s = wet_scene({}, 0.5, 1.5, 1);
    coupling::Material soil = silty_sand();
    soil.model = mpm::MaterialModel::linear_elastic;
    s.materials = {soil};
    coupling::Body column = box(0, 0, 0.5, kGround, {});
    column.stress.kind = coupling::InitialStress::Kind::k0;
    column.stress.k0 = {0.3 / 0.7};
    s.bodies = {column};
    s.water = {};
    coupling::WaterBoundary pond;
    pond.name = "pond";
    pond.side = coupling::WaterBoundary::kOnSurface;
    pond.kind = by_pressure ? coupling::WaterBoundary::Kind::pressure : coupling::WaterBoundary::Kind::head;
    pond.value = {{0}, {by_pressure ? (kPond - kGround) * kUnitWeight : kPond}};
    s.water_boundaries = {pond};
    Stage rest = stage("rest", Stage::Mode::equilibrium, 20);
    rest.water_flows = false;
    rest.force_tolerance = 1e-6, rest.energy_tolerance = 1e-3;
    rest.reset_velocity = true;
    Stage follows = stage("quasi-static", Stage::Mode::quasi_static, 3600);
    follows.force_tolerance = 1e-6;
    s.stages = {rest, stage("seepage", Stage::Mode::seepage, 3600), follows,
                stage("dynamic", Stage::Mode::dynamic, 0.2)};
    Simulation simulation(s);
    const coupling::Vector3 low{0.25, 0.25, 0};
    const double start = simulation.cell_quantity(low, "pore_pressure");
    CHECK(start == doctest::Approx(kUnitWeight * (kPond - 0.25)).epsilon(1e-9));
    const int point = simulation.probe_particle(low);
    const double height = simulation.particle_quantity(point, "position_y");
    const double buoyant = -(1 - 0.46) * (2700 - 1000) * kGravity * (kGround - height);
    CHECK(simulation.particle_quantity(point, "stress_yy") == doctest::Approx(buoyant).epsilon(0.01));
    double fastest = 0;
    while (!simulation.finished()) {
      const bool moving = simulation.stage() == 3;
      simulation.step();
      if (moving) fastest = std::max(fastest, column_of(simulation, "max_speed[m/s]"));
    }
    CHECK(simulation.cell_quantity(low, "pore_pressure") == doctest::Approx(start).epsilon(1e-4));
    CHECK(simulation.particle_quantity(point, "stress_yy") == doctest::Approx(buoyant).epsilon(0.01));
    CHECK(std::abs(column_of(simulation, "water_outflow[m3]")) < 1e-6);
    CHECK(fastest < 2e-5);
    MESSAGE("fastest " << fastest << " m/s, outflow " << column_of(simulation, "water_outflow[m3]") << " m3");
  }
}
