// What the rest of Polder may ask about a material without knowing how its law is computed: state variables,
// strength at a given state, mobilised friction, checks of the parameters. Scalar and independent of the
// vector level.
//
// SI units, angles in radians, stress positive in tension; components as in mpm/material/law.hpp.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "mpm/material/parameters.hpp"

namespace polder::mpm {

struct StateVariable {
  std::string name;
  std::string unit;    // "-" for dimensionless
  double initial = 0;  // at the particle's creation; strengths that grow with depth: at zero depth
};

// The state variables that a particle of this material carries, and where the well-known ones are (-1: not
// carried). The layout depends on the material and the dimension only, never on whether a stage is elastic.
struct StateLayout {
  std::vector<StateVariable> variables;
  int plastic_strain = -1;        // accumulated plastic deviatoric strain kappa = sum sqrt(2/3 de_p : de_p)
  int capillary_factor = -1;      // share of the capillary cohesion that acts: 1 unsaturated, 0 wet
  int cohesion_factor = -1;       // of this particle, on the cohesion without the capillary one
  int friction_factor = -1;       // of this particle, on the tangent of the friction angle
  int peak_strength = -1;         // peak undrained shear strength of this particle [Pa]
  int deformation_gradient = -1;  // first component; 2D: xx xy yx yy zz, 3D: row by row

  int count() const { return static_cast<int>(variables.size()); }
};

StateLayout state_layout(const MaterialParameters& material, int dimension);

// Initial state of a particle at the given height (coordinate along the last axis) [m]; state has
// layout.count() entries.
void set_initial_state(const MaterialParameters& material, int dimension, double height,
                       std::span<double> state);

// Peak undrained shear strength at a height [Pa]: shear_strength + strength_gradient * depth, depth counted
// from the datum and not negative.
double peak_strength_at(const MaterialParameters& material, double height);

// Value of a mobilised parameter at the plastic deviatoric strain kappa.
double value_at(const Mobilised& parameter, double kappa);

// Largest and smallest value over all kappa >= 0.
struct Range {
  double lowest, highest;
};
Range range_of(const Mobilised& parameter);

// Strength of a particle in its present state. von Mises and Tresca: cohesion = undrained shear strength,
// angles 0.
struct Strength {
  double cohesion = 0;  // with the capillary share [Pa]
  double friction = 0;  // [rad]
  double dilation = 0;  // [rad]
};
Strength strength_of(const MaterialParameters& material, const StateLayout& layout,
                     std::span<const double> state);

// Friction angle mobilised by an effective stress without cohesion: sin phi_m = (s1 - s3) / -(s1 + s3); 90
// degrees where the mean of the extreme principal stresses is tensile, 0 for zero stress. stress has 4 (2D)
// or 6 (3D) components.
double mobilised_friction_angle(std::span<const double> stress);

// Principal stresses in descending order (tension positive).
struct Principal {
  double first, second, third;
};
Principal principal_stresses(std::span<const double> stress);

// Distance to failure: shear strength on the most critical plane used, (s1 - s3) / (2 c cos phi - (s1 + s3)
// sin phi); 1 on the yield surface. For von Mises sqrt(J2) / su. Infinite beyond the apex.
double strength_utilisation(const MaterialParameters& material, const StateLayout& layout,
                            std::span<const double> stress, std::span<const double> state);

// Does the model start from a given initial stress? A neo-Hookean solid starts from its stress-free shape
// instead.
bool carries_initial_stress(MaterialModel model);

// Everything wrong with the parameters, one sentence each ("poisson = 0.5: must lie in (-1, 0.5)"); empty if
// sound.
struct ParameterProblem {
  std::string key;  // name of the member of MaterialParameters
  std::string problem;
  std::string allowed;
};
std::vector<ParameterProblem> check_parameters(const MaterialParameters& material);

}  // namespace polder::mpm
