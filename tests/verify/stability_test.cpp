// Factors of safety against published and exact ones.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "core/threads.hpp"
#include "coupling/memory_state.hpp"
#include "coupling/strength_reduction.hpp"
#include "io/csv.hpp"
#include "tests/verify/quasi_static_scenes.hpp"
#include "tests/verify/stability_scenes.hpp"

using namespace polder;
using namespace polder::verify;
using coupling::StabilityOptions;
using coupling::StabilityResult;
using coupling::StabilityTrial;

namespace {

constexpr double kDegree = 3.14159265358979323846 / 180;

CsvTable reference(const std::string& name, const std::vector<std::string>& text) {
  return CsvTable(std::string(POLDER_SOURCE_DIR) + "/tests/reference/" + name, text);
}

StabilityResult factor_of(const Scene& scene, double first = 1, double tolerance = 0.005) {
  Simulation simulation(scene);
  run_to_end(simulation);
  StabilityOptions options;
  options.first = first;
  options.tolerance = tolerance;
  return find_factor_of_safety(simulation, options, [](const StabilityTrial&) { return true; });
}

}  // namespace

TEST_CASE("published slopes, to three per cent") {
  set_threads(1);
  const CsvTable table = reference("slopes_literature.csv", {"case", "note", "source"});
  const std::vector<std::string>& names = table.text("case");
  for (const PublishedSlope& slope : published_slopes()) {
    const auto found = std::find(names.begin(), names.end(), slope.name);
    REQUIRE_MESSAGE(found != names.end(), slope.name);
    const double published = table.column("value[-]")[static_cast<std::size_t>(found - names.begin())];
    const StabilityResult r = factor_of(scene_of(slope, 1.0));
    long steps = 0;
    for (const StabilityTrial& t : r.trials) steps += t.steps;
    MESSAGE(slope.name << ": " << r.factor() << ", published " << published << ", " << r.trials.size()
                       << " trials, " << steps << " steps");
    CHECK(std::abs(r.factor() / published - 1) < 0.03);
    CHECK(r.fails - r.stands <= 0.005 * r.stands);
    for (const StabilityTrial& t : r.trials) CHECK(t.stands == (t.factor <= r.stands));
  }
}

TEST_CASE("slow drawdown, to three per cent") {
  set_threads(1);
  const CsvTable table = reference("slope_drawdown.csv", {});
  for (std::size_t i = 0; i < table.rows(); ++i) {
    const double drawdown = table.column("L_over_H[-]")[i];
    if (drawdown != 0 && drawdown != 0.4 && drawdown != 0.7) continue;  // the others: stability_long
    const double published = table.column("FS_published[-]")[i], bishop = table.column("FS_Bishop[-]")[i];
    const double found = factor_of(drawdown_scene(drawdown, 0.5), published).factor();
    MESSAGE("L/H " << drawdown << ": " << found << ", published " << published << ", Bishop " << bishop);
    CHECK(std::abs(found / published - 1) < 0.03);
    CHECK(std::abs(found / bishop - 1) < 0.03);
  }
}

TEST_CASE("a thin weak layer that does not govern, to three per cent") {
  set_threads(1);
  const CsvTable table = reference("slope_weak_layer.csv", {});
  for (std::size_t i = 0; i < table.rows(); ++i) {
    const double ratio = table.column("cu2_over_cu1[-]")[i];
    if (ratio != 0.8 && ratio != 0.6) continue;  // weaker ones take finer cells: stability_long
    const double published = table.column("FS_published[-]")[i];
    const double found = factor_of(weak_layer_scene(ratio, 1.0), published).factor();
    MESSAGE("cu2/cu1 " << ratio << ": " << found << ", published " << published);
    CHECK(std::abs(found / published - 1) < 0.03);
    CHECK(found < table.column("FS_three_blocks[-]")[i]);
  }
}

TEST_CASE("infinite slopes with seepage parallel to them and level, to one per cent") {
  set_threads(1);
  const CsvTable table = reference("infinite_slope.csv", {"seepage"});
  for (std::size_t i = 0; i < table.rows(); ++i) {
    const auto at = [&](const char* column) { return table.column(column)[i]; };
    InfiniteSlope slope{at("beta[deg]") * kDegree,
                        at("phi[deg]") * kDegree,
                        1e3 * at("c[kPa]"),
                        1e3 * at("gamma[kN/m3]"),
                        1e3 * at("gamma_sat[kN/m3]"),
                        at("z[m]"),
                        at("m[-]"),
                        table.text("seepage")[i] == "horizontal"};
    const double exact = at("FS[-]");
    double error[2];  // with 20 and 40 cells
    for (int i = 0; i < 2; ++i) {
      const double found = factor_of(scene_of(slope, 20 << i), 1, 0.0025).factor();
      error[i] = found / kSpareStrength / exact - 1;
    }
    MESSAGE("beta " << at("beta[deg]") << ", phi " << at("phi[deg]") << ", water to " << slope.water
                    << std::string(slope.horizontal ? ", level: exact " : ": exact ") << exact
                    << ", 20 cells " << 100 * error[0] << " %, 40 cells " << 100 * error[1] << " %");
    CHECK(std::abs(error[1]) < 0.01);
    CHECK(std::abs(error[1]) < std::abs(error[0]) + 0.001);
  }
}

TEST_CASE("an infinite slope that does not dilate slides with sin(phi) in place of tan(phi)") {
  // Davis (1968): tau = sin(phi_F) sigma' on the slip plane, tan(phi_F) = tan(phi) / F. Before it slides its
  // stress has to turn all over the depth, which looks like a failure for a while.
  set_threads(1);
  const double angle = 20 * kDegree, friction = 30 * kDegree;
  const double exact = std::tan(friction) / std::tan(std::asin(std::tan(angle)));
  const InfiniteSlope slope{angle, friction, 0, 18e3, 20e3, 2, 0, false, false};
  const double found = factor_of(scene_of(slope, 20), 1.4 * kSpareStrength, 0.0025).factor() / kSpareStrength;
  MESSAGE("exact " << exact << ", found " << found);
  CHECK(std::abs(found / exact - 1) < 0.01);
}

TEST_CASE("a search for the factor leaves the simulation as it was") {
  set_threads(1);
  Scene scene = scene_of(published_slopes()[1], 1.0);
  Stage after;
  after.name = "after";
  after.duration = 0.2;
  scene.stages.push_back(after);
  Simulation simulation(scene), untouched(scene);
  for (Simulation* s : {&simulation, &untouched})
    while (s->stage() == 0) s->step();
  coupling::MemoryState before, later;
  before.save(simulation);
  StabilityOptions options;
  options.tolerance = 0.3;
  find_factor_of_safety(simulation, options, [](const StabilityTrial&) { return true; });
  later.save(simulation);
  CHECK(before.differences(later).empty());
  run_to_end(simulation), run_to_end(untouched);
  CHECK(field_of(simulation, "effective_stress") == field_of(untouched, "effective_stress"));
}

TEST_CASE("factors far from one, and none at all") {
  set_threads(1);
  PublishedSlope slope = published_slopes()[1];
  slope.cohesion *= 0.1, slope.friction = std::atan(0.1 * std::tan(slope.friction));
  const StabilityResult weak = factor_of(scene_of(slope, 1.0), 1, 0.02);
  CHECK(std::abs(weak.factor() / 0.14 - 1) < 0.05);  // a tenth of the strength, a tenth of 1.4
  slope = published_slopes()[1];
  slope.cohesion *= 1000;
  const StabilityResult strong = factor_of(scene_of(slope, 1.0));
  CHECK(strong.stands == 20);
  CHECK(!std::isfinite(strong.fails));
}

TEST_CASE("reduction of every strength") {
  mpm::MaterialParameters m;
  m.model = mpm::MaterialModel::mohr_coulomb;
  m.cohesion.kind = mpm::Mobilised::Kind::exponential;
  m.cohesion.peak = 8e3, m.cohesion.residual = 2e3, m.cohesion.rate = 100;
  m.friction.value = {30 * kDegree};
  m.dilation.value = {25 * kDegree};
  m.capillary_cohesion.value = {500};
  m.tension_cutoff = 1000;
  m.shear_strength = 40e3, m.strength_gradient = 1e3, m.residual_strength = 20e3, m.softening_modulus = -1e4;
  const mpm::MaterialParameters r = coupling::with_reduced_strength(m, 2);
  CHECK(r.cohesion.peak == 4e3);
  CHECK(r.cohesion.residual == 1e3);
  CHECK(r.cohesion.rate == 100);
  CHECK(std::tan(r.friction.value[0]) == doctest::Approx(0.5 * std::tan(30 * kDegree)));
  CHECK(r.dilation.value[0] == doctest::Approx(r.friction.value[0]));  // 25 deg would be above it
  CHECK(r.capillary_cohesion.value[0] == 250);
  CHECK(r.tension_cutoff == 500);
  CHECK(r.shear_strength == 20e3);
  CHECK(r.strength_gradient == 500);
  CHECK(r.residual_strength == 10e3);
  CHECK(r.softening_modulus == -5e3);
  CHECK(r.young == m.young);
  m.dilation.value = {-1 * kDegree};
  CHECK(coupling::with_reduced_strength(m, 2).dilation.value[0] == m.dilation.value[0]);
}
