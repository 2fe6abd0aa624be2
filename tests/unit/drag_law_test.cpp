// Drag laws against the forms in which their authors gave them, written anew, and against each other where
// they must meet.
#include "coupling/drag_law.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace polder::coupling;

namespace {

constexpr DragFluid kWater{1000, 1e-3, 9810};

Material grains(DragLaw law, double diameter) {
  Material m;
  m.drag_law = law;
  m.grain_diameter = diameter;
  return m;
}

// Pressure lost on a metre of bed at a specific discharge [Pa/m]: n |grad p| = beta u.
double lost(const Material& m, double porosity, double discharge) {
  const double u = discharge / porosity;
  return drag_coefficient(m, kWater, porosity, u) * u / porosity;
}

// Velocity at which a single grain sinks: weight under water against the drag on its volume.
double terminal_velocity(const Material& m, double density) {
  constexpr double n = 1 - 1e-6;
  double low = 0, high = 100;
  for (int i = 0; i < 200; ++i) {
    const double u = 0.5 * (low + high);
    const double drag = drag_coefficient(m, kWater, n, u) * u / (1 - n);
    (drag < (density - kWater.density) * 9.81 ? low : high) = u;
  }
  return low;
}

}  // namespace

TEST_CASE("Darcy's drag loses head as q / k, Forchheimer's as q / k + b q^2") {
  Material m;
  m.hydraulic_conductivity = 3e-3;
  for (const double n : {0.3, 0.45})
    for (const double q : {1e-6, 1e-3, 0.1}) {
      CHECK(lost(m, n, q) == doctest::Approx(9810 * q / 3e-3).epsilon(1e-12));
      Material f = m;
      f.drag_law = DragLaw::forchheimer;
      f.forchheimer = 470;
      CHECK(lost(f, n, q) == doctest::Approx(9810 * (q / 3e-3 + 470 * q * q)).epsilon(1e-12));
      CHECK(apparent_conductivity(f, kWater, n, q / n) ==
            doctest::Approx(1 / (1 / 3e-3 + 470 * q)).epsilon(1e-12));
    }
}

TEST_CASE("Ergun's friction factor is 150 / Re_m + 1.75") {
  for (const double d : {2e-4, 5e-3})
    for (const double n : {0.35, 0.5, 0.7})
      for (const double q : {1e-5, 1e-2, 1.0}) {
        const double re = 1000 * q * d / (1e-3 * (1 - n));
        const double factor =
            lost(grains(DragLaw::ergun, d), n, q) * d / (1000 * q * q) * n * n * n / (1 - n);
        CHECK(factor == doctest::Approx(150 / re + 1.75).epsilon(1e-10));
        CHECK(lost(grains(DragLaw::gidaspow, d), n, q) == lost(grains(DragLaw::ergun, d), n, q));
      }
}

TEST_CASE("slow flow through a bed has the permeability of Kozeny and Carman") {
  // d^2 n^3 / (150 (1 - n)^2), the power of the porosity that kozeny_carman gives to Darcy's law.
  for (const double n : {0.3, 0.4, 0.5}) {
    const double k = apparent_conductivity(grains(DragLaw::ergun, 1e-3), kWater, n, 0);
    CHECK(k == doctest::Approx(9810 / 1e-3 * 1e-6 / 150 * kozeny_carman(n)).epsilon(1e-12));
  }
}

TEST_CASE("laws of suspensions become the drag of single grains") {
  // Stokes: w = (rho_s - rho) g d^2 / (18 mu); Di Felice's 4.8^2 stands for 24.
  const double d = 2e-5, stokes = 1650 * 9.81 * d * d / 18e-3;
  CHECK(terminal_velocity(grains(DragLaw::gidaspow, d), 2650) == doctest::Approx(stokes).epsilon(0.01));
  CHECK(terminal_velocity(grains(DragLaw::di_felice, d), 2650) ==
        doctest::Approx(stokes * 24 / 23.04).epsilon(0.03));
  // Quartz in water: 0.16 m/s at 1 mm (C = 0.84, Re = 160) by Schiller and Naumann's curve.
  for (const DragLaw law : {DragLaw::gidaspow, DragLaw::di_felice}) {
    const double w = terminal_velocity(grains(law, 1e-3), 2650);
    const double re = 1000 * w * 1e-3 / 1e-3, c = 4.0 / 3 * 1650 * 9.81 * 1e-3 / (1000 * w * w);
    CHECK(c == doctest::Approx(law == DragLaw::gidaspow ? 24 / re * (1 + 0.15 * std::pow(re, 0.687))
                                                        : std::pow(0.63 + 4.8 / std::sqrt(re), 2))
                   .epsilon(1e-4));
    CHECK(w == doctest::Approx(0.155).epsilon(0.06));
  }
  // Newton: C = 0.44.
  const double w = terminal_velocity(grains(DragLaw::gidaspow, 0.02), 2650);
  CHECK(w == doctest::Approx(std::sqrt(4.0 / 3 * 1650 * 9.81 * 0.02 / (1000 * 0.44))).epsilon(1e-4));
}

TEST_CASE("drag vanishes with the grains, is finite at rest and grows with velocity") {
  for (const DragLaw law : {DragLaw::ergun, DragLaw::gidaspow, DragLaw::di_felice}) {
    const Material m = grains(law, 1e-3);
    double before = drag_coefficient(m, kWater, 0.3, 0.1);
    for (const double n : {0.5, 0.79, 0.9, 0.99, 0.9999, 1.0}) {
      const double beta = drag_coefficient(m, kWater, n, 0.1);
      CHECK(beta > 0);
      CHECK(beta < before);
      CHECK(std::isfinite(drag_coefficient(m, kWater, n, 0)));
      CHECK(drag_coefficient(m, kWater, n, 0) > 0);
      CHECK(drag_coefficient(m, kWater, n, 0.2) > beta);
      CHECK(drag_coefficient(m, kWater, n, 1e-9) ==
            doctest::Approx(drag_coefficient(m, kWater, n, 0)).epsilon(1e-2));
      before = beta;
    }
    CHECK(before < 1e-3 * drag_coefficient(m, kWater, 0.99, 0.1));
  }
}

TEST_CASE("beds: Di Felice stays within a factor of Ergun over the Reynolds number") {
  // Both fit the same measurements at porosities near 0.4; Di Felice (1994) claims 40 %.
  for (const double q : {1e-6, 1e-4, 1e-2, 0.3}) {
    const double ratio =
        lost(grains(DragLaw::di_felice, 1e-3), 0.42, q) / lost(grains(DragLaw::ergun, 1e-3), 0.42, q);
    CAPTURE(q);
    CHECK(ratio > 0.6);
    CHECK(ratio < 1.5);
  }
}
