#include "mpm/material/material.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace polder::mpm {
namespace {

bool is_undrained(MaterialModel model) {
  return model == MaterialModel::von_mises || model == MaterialModel::tresca;
}

// Undrained shear strength of a particle [Pa]; see von_mises.hpp for the residual of weak particles.
double undrained_strength(const MaterialParameters& m, double peak, double kappa) {
  return std::max(peak + m.softening_modulus * kappa, std::min(peak, m.residual_strength));
}

double second_invariant(std::span<const double> s) {
  const double p = (s[0] + s[1] + s[2]) / 3;
  double shear = 0;
  for (std::size_t i = 3; i < s.size(); ++i) shear += s[i] * s[i];
  return 0.5 * ((s[0] - p) * (s[0] - p) + (s[1] - p) * (s[1] - p) + (s[2] - p) * (s[2] - p)) + shear;
}

}  // namespace

StateLayout state_layout(const MaterialParameters& m, int dimension) {
  StateLayout layout;
  const auto add = [&](const char* name, const char* unit, double initial) {
    layout.variables.push_back({name, unit, initial});
    return layout.count() - 1;
  };
  if (m.model == MaterialModel::mohr_coulomb) {
    layout.plastic_strain = add("plastic_deviatoric_strain", "-", 0);
    // soil counts as unsaturated until water is said to be there
    if (range_of(m.capillary_cohesion).highest > 0) layout.capillary_factor = add("capillary_factor", "-", 1);
    if (m.scatter.cohesion) layout.cohesion_factor = add("cohesion_factor", "-", 1);
    if (m.scatter.friction) layout.friction_factor = add("friction_factor", "-", 1);
  } else if (is_undrained(m.model)) {
    layout.plastic_strain = add("plastic_deviatoric_strain", "-", 0);
    layout.peak_strength = add("peak_shear_strength", "Pa", m.shear_strength);
  } else if (m.model == MaterialModel::neo_hookean) {
    layout.deformation_gradient = 0;
    if (dimension == 2) {
      for (const char* ij : {"xx", "xy", "yx", "yy", "zz"})
        add((std::string("deformation_gradient_") + ij).c_str(), "-", ij[0] == ij[1] ? 1 : 0);
    } else {
      for (const char* ij : {"xx", "xy", "xz", "yx", "yy", "yz", "zx", "zy", "zz"})
        add((std::string("deformation_gradient_") + ij).c_str(), "-", ij[0] == ij[1] ? 1 : 0);
    }
  }
  return layout;
}

double peak_strength_at(const MaterialParameters& m, double height) {
  return m.shear_strength + m.strength_gradient * std::max(0.0, m.strength_datum - height);
}

void set_initial_state(const MaterialParameters& m, int dimension, double height, std::span<double> state) {
  const StateLayout layout = state_layout(m, dimension);
  for (int i = 0; i < layout.count(); ++i) state[i] = layout.variables[i].initial;
  if (layout.peak_strength >= 0) state[layout.peak_strength] = peak_strength_at(m, height);
}

Strength strength_of(const MaterialParameters& m, const StateLayout& layout, std::span<const double> state) {
  if (layout.plastic_strain < 0) return {std::numeric_limits<double>::infinity(), 0, 0};
  const double kappa = state[layout.plastic_strain];
  if (is_undrained(m.model)) return {undrained_strength(m, state[layout.peak_strength], kappa), 0, 0};
  double cohesion = value_at(m.cohesion, kappa), friction = value_at(m.friction, kappa),
         dilation = value_at(m.dilation, kappa);
  if (layout.cohesion_factor >= 0) cohesion *= state[layout.cohesion_factor];
  if (layout.friction_factor >= 0) {
    friction = std::atan(std::tan(friction) * state[layout.friction_factor]);
    dilation = std::min(dilation, friction);
  }
  if (layout.capillary_factor >= 0)
    cohesion += state[layout.capillary_factor] * value_at(m.capillary_cohesion, kappa);
  return {cohesion, friction, dilation};
}

// Cyclic Jacobi rotations: keeps small differences of principal values, unlike the trigonometric formula.
Principal principal_stresses(std::span<const double> s) {
  std::array<double, 3> d{s[0], s[1], s[2]};
  if (s.size() == 4) {
    const double mean = 0.5 * (s[0] + s[1]), radius = std::hypot(0.5 * (s[0] - s[1]), s[3]);
    d = {mean + radius, mean - radius, s[2]};
  } else {
    double a[3][3] = {{s[0], s[3], s[5]}, {s[3], s[1], s[4]}, {s[5], s[4], s[2]}};
    for (int sweep = 0; sweep < 6; ++sweep)
      for (const auto& [p, q] : {std::pair{0, 1}, std::pair{0, 2}, std::pair{1, 2}}) {
        if (a[p][q] == 0) continue;
        const double theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
        const double t = (theta < 0 ? -1 : 1) / (std::abs(theta) + std::hypot(1.0, theta));
        const double c = 1 / std::hypot(1.0, t), sn = t * c, off = a[p][q];
        const int r = 3 - p - q;
        a[p][p] -= t * off, a[q][q] += t * off, a[p][q] = a[q][p] = 0;
        const double rp = a[r][p], rq = a[r][q];
        a[r][p] = a[p][r] = c * rp - sn * rq;
        a[r][q] = a[q][r] = sn * rp + c * rq;
      }
    d = {a[0][0], a[1][1], a[2][2]};
  }
  std::sort(d.begin(), d.end(), std::greater<>());
  return {d[0], d[1], d[2]};
}

double mobilised_friction_angle(std::span<const double> stress) {
  const Principal s = principal_stresses(stress);
  const double shear = s.first - s.third, confinement = -(s.first + s.third);
  if (shear <= 0) return 0;
  return shear >= confinement ? std::numbers::pi / 2 : std::asin(shear / confinement);
}

double strength_utilisation(const MaterialParameters& m, const StateLayout& layout,
                            std::span<const double> stress, std::span<const double> state) {
  if (layout.plastic_strain < 0) return 0;
  const Strength strength = strength_of(m, layout, state);
  double demand, capacity;
  if (m.model == MaterialModel::von_mises) {
    demand = std::sqrt(second_invariant(stress));
    capacity = strength.cohesion;
  } else {
    const Principal s = principal_stresses(stress);
    demand = s.first - s.third;
    capacity = 2 * strength.cohesion * std::cos(strength.friction) -
               (s.first + s.third) * std::sin(strength.friction);
  }
  if (capacity > 0) return demand / capacity;
  return demand > 0 ? std::numeric_limits<double>::infinity() : 0;
}

bool carries_initial_stress(MaterialModel model) {
  return model != MaterialModel::neo_hookean;
}

}  // namespace polder::mpm
