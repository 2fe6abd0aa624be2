#include "coupling/drag_law.hpp"

#include <algorithm>
#include <cmath>

namespace polder::coupling {
namespace {

constexpr double kDense = 0.8;          // porosity up to which Gidaspow takes a bed for packed
constexpr double kNewtonian = 1000;     // Reynolds number from which the drag coefficient is constant
constexpr double kDilutest = 1 - 1e-6;  // one grain in a million of its volumes is as good as none

double ergun(const Material& m, const DragFluid& f, double n, double u) {
  const double d = m.grain_diameter;
  return 150 * f.viscosity * (1 - n) * (1 - n) / (n * d * d) + 1.75 * f.density * (1 - n) * u / d;
}

// Drag of a single grain over its superficial velocity n u, C rho u, from Re C(Re): finite at rest.
double of_grain(const Material& m, const DragFluid& f, double n, double reynolds_times_c) {
  return f.viscosity * reynolds_times_c / (n * m.grain_diameter);
}

double wen_yu(const Material& m, const DragFluid& f, double n, double u) {
  const double re = f.density * n * u * m.grain_diameter / f.viscosity;
  const double re_c = re < kNewtonian ? 24 * (1 + 0.15 * std::pow(re, 0.687)) : 0.44 * re;
  return 0.75 * n * (1 - n) * std::pow(n, -2.65) / m.grain_diameter * of_grain(m, f, n, re_c);
}

double di_felice(const Material& m, const DragFluid& f, double n, double u) {
  const double re = f.density * n * u * m.grain_diameter / f.viscosity;
  const double root = 0.63 * std::sqrt(re) + 4.8;
  double exponent = 3.7;
  if (re > 0) {
    const double away = 1.5 - std::log10(re);
    exponent -= 0.65 * std::exp(-0.5 * away * away);
  }
  return 0.75 * (1 - n) * std::pow(n, 2 - exponent) / m.grain_diameter * of_grain(m, f, n, root * root);
}

}  // namespace

double drag_coefficient(const Material& m, const DragFluid& f, double porosity, double speed) {
  const double n = std::min(porosity, kDilutest);
  switch (m.drag_law) {
    case DragLaw::darcy:
      break;
    case DragLaw::forchheimer:
      return n * n * f.unit_weight * (1 / m.hydraulic_conductivity + m.forchheimer * n * speed);
    case DragLaw::ergun:
      return ergun(m, f, n, speed);
    case DragLaw::gidaspow:
      return n < kDense ? ergun(m, f, n, speed) : wen_yu(m, f, n, speed);
    case DragLaw::di_felice:
      return di_felice(m, f, n, speed);
  }
  return n * n * f.unit_weight / m.hydraulic_conductivity;
}

double apparent_conductivity(const Material& m, const DragFluid& f, double porosity, double speed) {
  const double n = std::min(porosity, kDilutest);
  return n * n * f.unit_weight / drag_coefficient(m, f, n, speed);
}

}  // namespace polder::coupling
