// What a material is, in SI units: the plain numbers of the case file, shared by every vector level of the
// kernels. Stress is positive in tension everywhere in Polder; strengths (cohesion, shear strength, tension
// cut-off) are positive.
#pragma once

#include <limits>
#include <string>
#include <vector>

namespace polder::mpm {

enum class MaterialModel {
  linear_elastic,  // rate form, Hughes-Winget rotation
  neo_hookean,     // P = lambda ln J F^-T + mu (F - F^-T), follows the deformation gradient
  mohr_coulomb,    // non-associated, tension cut-off, strength mobilised by plastic deviatoric strain
  von_mises,       // undrained strength, linear softening, growing with depth
  tresca           // the same with Tresca's yield surface
};

// A parameter mobilised by the accumulated plastic deviatoric strain kappa = sum sqrt(2/3 de_p : de_p) [-]:
// constant outside the knots of a piecewise linear curve, or residual + (peak - residual) exp(-rate kappa).
struct Mobilised {
  enum class Kind { constant, piecewise_linear, exponential };
  Kind kind = Kind::constant;
  std::vector<double> strain{0.0};  // knots, ascending (constant and piecewise_linear; constant has one)
  std::vector<double> value{0.0};   // values at the knots
  double peak = 0, residual = 0, rate = 0;  // exponential
  bool operator==(const Mobilised&) const = default;
};

struct MaterialParameters {
  std::string name;
  MaterialModel model = MaterialModel::linear_elastic;

  double density_solid = 0;  // density of the grains [kg/m3]; of the bulk material where porosity is 0
  double porosity = 0;       // [-], initial
  double young = 0;          // [Pa]
  double poisson = 0;        // [-]

  // Mohr-Coulomb. Angles in radians.
  Mobilised cohesion;            // [Pa]
  Mobilised friction;            // [rad]
  Mobilised dilation;            // [rad]
  Mobilised capillary_cohesion;  // [Pa], added to the cohesion where a particle is unsaturated
  double tension_cutoff =
      std::numeric_limits<double>::infinity();  // largest tensile principal stress [Pa], limited by the apex

  // Whether particles carry factors of their own on the cohesion and on the tangent of the friction angle
  // (random fields), and between which bounds the latter lie.
  struct Scatter {
    bool cohesion = false, friction = false;
    double lowest_friction = 1, highest_friction = 1;
    bool operator==(const Scatter&) const = default;
  };
  Scatter scatter;

  // von Mises and Tresca: peak undrained shear strength at depth z below `strength_datum`, su =
  // shear_strength + strength_gradient z, falling by softening_modulus (<= 0) with plastic deviatoric strain
  // to residual_strength. von Mises: sqrt(J2) = su. Tresca: (sigma_1 - sigma_3)/2 = su.
  double shear_strength = 0;     // [Pa]
  double strength_gradient = 0;  // [Pa/m]
  double strength_datum = 0;     // height of zero depth, along the last axis [m]
  double residual_strength = 0;  // [Pa]
  double softening_modulus = 0;  // d su / d kappa [Pa], <= 0

  // Pore water.
  double hydraulic_conductivity = 0;  // saturated [m/s]

  double bulk_modulus() const { return young / (3 * (1 - 2 * poisson)); }
  double shear_modulus() const { return young / (2 * (1 + poisson)); }
  double lame_lambda() const { return young * poisson / ((1 + poisson) * (1 - 2 * poisson)); }
  double wave_modulus() const { return lame_lambda() + 2 * shear_modulus(); }  // lambda + 2 G
  double dry_density() const { return (1 - porosity) * density_solid; }
  bool operator==(const MaterialParameters&) const = default;
};

}  // namespace polder::mpm
