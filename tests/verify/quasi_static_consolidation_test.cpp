// Consolidation by quasi-static stages: the soil's change of volume between two relaxations reaches the pore
// water. Terzaghi's column under a load that comes at once, against his series; the error falls with the
// change of pressure after which equilibrium is sought, and no water is lost.
#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

#include "core/threads.hpp"
#include "tests/verify/one_layer_consolidation.hpp"

using namespace polder;
using namespace polder::verify;
using coupling::Stage;

namespace {

constexpr double kLoad = 1e4, kHeight = 1, kCell = 0.1, kConductivity = 5e-4;

mpm::MaterialParameters sand() {
  return elastic_soil(1e7, 0.3, 0.46, kConductivity, 2700);
}

double wave_modulus() {
  return sand().wave_modulus();
}

// Quasi-static up to the time factors 0.2 and 0.5, with equilibrium sought after this change of pressure.
Scene column(double relax_change, bool retains) {
  const mpm::MaterialParameters soil = sand();
  Scene s = wet_scene({.cell = kCell}, 2 * kCell, kHeight + 2 * kCell, 0);
  s.gravity = {};
  coupling::Material material(soil);
  if (retains) {  // full all the time, but the equation is that of soil that need not be
    material.retention.model = fdm::Retention::Model::van_genuchten;
    material.retention.alpha = 2;
    material.retention.n = 2;
  }
  s.materials = {material};
  s.bodies = {box(0, 0, 2 * kCell, kHeight, {.cell = kCell})};
  s.boundaries = {load(2 * kCell, 0, kHeight, kLoad)};
  s.water.initial = coupling::WaterSpec::Initial::zero;
  s.stages.clear();
  const double unit =
      kHeight * kHeight * kUnitWeight / (kConductivity * wave_modulus());  // time factor 1 [s]
  double before = 0;
  for (const double factor : {0.2, 0.5}) {
    Stage stage;
    stage.name = "to " + std::to_string(factor);
    stage.mode = Stage::Mode::quasi_static;
    stage.duration = (factor - before) * unit;
    stage.largest_step = 0.0025 * unit;
    stage.relax_change = relax_change;
    stage.force_tolerance = 1e-4;
    s.stages.push_back(stage);
    before = factor;
  }
  return s;
}

struct Found {
  double error[2] = {0, 0};  // L2 of the pressure over the load at both times [-]
  double settlement = 0;     // over Terzaghi's at the second
  double relaxations = 0, water_error = 0, unaccounted = 0;
};

Found consolidate(double relax_change, bool retains) {
  Simulation simulation(column(relax_change, retains));
  Found f;
  for (int i = 0; i < 2; ++i) {
    while (simulation.stage() == i) simulation.step();
    const double factor = i == 0 ? 0.2 : 0.5;
    double sum = 0;
    int cells = 0;
    for (double y = 0.5 * kCell; y < kHeight; y += kCell, ++cells) {
      const double e = simulation.cell_quantity({0.5 * kCell, y, 0}, "pore_pressure") / kLoad -
                       terzaghi_pressure(factor, kHeight - y);
      sum += e * e;
    }
    f.error[i] = std::sqrt(sum / cells);
  }
  f.settlement = (kHeight - top_of(simulation)) / (terzaghi_degree(0.5) * kLoad * kHeight / wave_modulus());
  f.relaxations = column_of(simulation, "relaxations");
  f.water_error = column_of(simulation, "water_mass_error[-]");
  f.unaccounted = column_of(simulation, "relaxation_water[m3]");
  MESSAGE(std::string(retains ? "with a retention curve" : "saturated")
          << ", equilibrium after " << relax_change / kLoad << " of the load: error " << f.error[0] << ", "
          << f.error[1] << "; settlement " << f.settlement << " of Terzaghi's; " << f.relaxations
          << " relaxations; water " << f.water_error << ", " << f.unaccounted << " m3 without account");
  return f;
}

}  // namespace

TEST_CASE("Terzaghi's column by quasi-static stages") {
  set_threads(1);
  for (const bool retains : {false, true}) {
    CAPTURE(retains);
    std::vector<Found> runs;
    for (const double share : {0.1, 0.05, 0.025}) {
      const Found f = consolidate(share * kLoad, retains);
      // Every litre that pores gave up went through the cells, but for what the last relaxation asked for.
      CHECK(std::abs(f.water_error) < 1e-12);
      CHECK(std::abs(f.unaccounted) <
            0.5 * share * terzaghi_degree(0.5) * kLoad / wave_modulus() * 2 * kCell);
      for (const double error : f.error) CHECK(error < 0.2 * share + 0.003);
      CHECK(std::abs(f.settlement - 1) < 0.3 * share);
      if (!runs.empty())
        for (int i = 0; i < 2; ++i) CHECK(f.error[i] < 0.8 * runs.back().error[i]);
      runs.push_back(f);
    }
  }
}
