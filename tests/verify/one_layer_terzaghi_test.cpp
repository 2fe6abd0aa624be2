// One-dimensional consolidation (Terzaghi 1943): a loaded column of 10 cells, drained at its top, water
// of 2.2 GPa.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "coupling/simulation.hpp"

using namespace polder::coupling;

namespace {

constexpr double kLoad = 1e4;                  // [Pa]
constexpr double kModulus = 1e7 * 0.8 / 0.72;  // E (1 - nu) / ((1 + nu)(1 - 2 nu))
constexpr double kWater = 2.2e9, kPorosity = 0.4;
constexpr double kStartPressure = kLoad / (1 + kPorosity * kModulus / kWater);

double consolidation_coefficient(double conductivity) {
  return conductivity / 9810 / (1 / kModulus + kPorosity / kWater);
}

// p / p0 at the height y above the closed base of a column of height 1.
double exact(double time_factor, double y) {
  double sum = 0;
  for (int m = 0; m < 200; ++m) {
    const double a = std::numbers::pi * (2 * m + 1) / 2;
    sum += 2 / a * std::sin(a * (1 - y)) * std::exp(-a * a * time_factor);
  }
  return sum;
}

// The column in its undrained state, loaded.
Scene column(double h, double conductivity) {
  Scene s;
  s.formulation = "one-layer";
  s.gravity = {0, 0, 0};
  s.grid.size = {2 * h, 1 + 3 * h, 0};
  s.grid.cell = h;
  polder::mpm::MaterialParameters m;
  m.name = "soil";
  m.density_solid = 2650, m.porosity = kPorosity, m.young = 1e7, m.poisson = 0.2;
  m.hydraulic_conductivity = conductivity;
  s.materials = {m};
  Body b;
  b.name = "column";
  b.box = {{Vector3{0, 0, 0}, Vector3{2 * h, 1, 0}}};
  const double vertical = -(kLoad - kStartPressure);
  b.stress.kind = InitialStress::Kind::field;
  b.stress.value = {0.25 * vertical, vertical, 0.25 * vertical, 0, 0, 0};
  s.bodies = {b};
  s.water.bulk_modulus = kWater;
  s.water.initial = WaterSpec::Initial::field;
  s.water.initial_pressure = kStartPressure;
  Boundary load;
  load.name = "load";
  load.kind = Boundary::Kind::pressure;
  load.segment = {{Vector3{2 * h, 1, 0}, Vector3{0, 1, 0}}};
  load.pressure.value = {kLoad};
  s.boundaries = {load};
  Stage stage;
  stage.name = "consolidation";
  stage.duration = 0.5 / consolidation_coefficient(conductivity);
  s.stages = {stage};
  return s;
}

double error(const Simulation& s, double h, double conductivity) {
  double sum = 0;
  const int cells = static_cast<int>(std::lround(1 / h));
  for (int j = 0; j < cells; ++j) {
    const double y = (j + 0.5) * h;
    const double p = s.cell_quantity({h / 2, y, 0}, "pore_pressure") / kStartPressure;
    const double e = p - exact(consolidation_coefficient(conductivity) * s.time(), y);
    sum += e * e;
  }
  return std::sqrt(sum / cells);
}

}  // namespace

TEST_CASE("Terzaghi: pore pressure of ten cells at three times, the same step for every conductivity") {
  const double bound[] = {0.008, 0.004, 0.002}, factor[] = {0.05, 0.2, 0.5};
  for (double conductivity : {1e-3, 1e-4}) {
    Simulation s(column(0.1, conductivity));
    int next = 0;
    while (!s.finished()) {
      s.step();
      while (next < 3 && consolidation_coefficient(conductivity) * s.time() >= factor[next] * (1 - 1e-9)) {
        const double e = error(s, 0.1, conductivity);
        MESSAGE("k " << conductivity << " T_v " << factor[next] << ": relative L2 error " << e);
        CHECK(e <= bound[next]);
        ++next;
      }
    }
    CHECK(next == 3);
    // The step is the skeleton wave's, whatever the conductivity and the stiffness of water.
    CHECK(s.largest_step() == doctest::Approx(0.5 * 0.1 / std::sqrt(kModulus / 1990)).epsilon(2e-3));
  }
}

TEST_CASE("Terzaghi: the error falls with at least first order from 5 to 20 cells") {
  double before = 0;
  for (double h : {0.2, 0.1, 0.05}) {
    Simulation s(column(h, 1e-3));
    while (consolidation_coefficient(1e-3) * s.time() < 0.2) s.step();
    const double e = error(s, h, 1e-3);
    MESSAGE("h " << h << ": relative L2 error " << e);
    if (before > 0) CHECK(std::log2(before / e) >= 1.0);
    if (h == 0.05) CHECK(e < 0.0015);
    before = e;
  }
}
