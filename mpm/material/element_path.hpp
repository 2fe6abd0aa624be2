// One material point along the loading paths of the laboratory: what a constitutive law answers, without a
// grid.
//
// Small strains in three dimensions, no rotation: strains are sums of increments, tension positive,
// components as in mpm/material/law.hpp {xx, yy, zz, xy, yz, zx} with shear as tensor components. The axis of
// all tests is y. Components of stress that a test holds constant are met by Newton's method on the strain
// increment of every step, to 1e-12 of the stress; the law itself is the one the particle kernels use.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "mpm/material/array_law.hpp"
#include "mpm/material/material.hpp"

namespace polder::mpm {

using Components = std::array<double, 6>;

// A point that takes increments of strain, of stress, or a mixture.
class ElementPoint {
 public:
  explicit ElementPoint(const MaterialParameters& material, bool plastic = true, double height = 0);

  struct Control {
    bool stress =
        false;  // value is the stress at the end of the step [Pa]; otherwise the strain increment [-]
    double value = 0;
    int same_as = -1;  // if set: the strain increment equals that of this component, and value is not used
  };

  void apply_strain(const Components& increment);
  // Throws NumericalError where no strain increment gives the stress asked for (failure under stress
  // control).
  void apply(const std::array<Control, 6>& control);

  Components stress{};        // effective [Pa]; may be set before the first step
  Components strain{};        // accumulated
  std::vector<double> state;  // see state_layout(material, 3)

 private:
  std::unique_ptr<ArrayLaw> law_;
  double young_;
};

enum class ElementTest {
  triaxial_drained,        // axial strain; lateral stresses constant (extension: positive axial strain)
  triaxial_undrained,      // axial strain at constant volume
  biaxial_drained,         // axial strain; sigma_xx constant, eps_zz = 0
  biaxial_undrained,       // axial strain at constant volume, eps_zz = 0
  oedometer,               // axial strain; no lateral strain
  isotropic,               // three equal strains; the control is one of them
  simple_shear_drained,    // engineering shear strain gamma_xy; sigma_yy constant, eps_xx = eps_zz = 0
  simple_shear_undrained,  // gamma_xy at constant volume: no other strain
  pure_shear               // gamma_xy with all normal stresses constant
};

struct ElementPath {
  ElementTest test = ElementTest::triaxial_drained;
  Components initial_stress{};  // effective [Pa]
  std::vector<double> targets;  // controlled strain to be reached one after the other [-]
  int steps = 1;                // equal increments to each target
  bool plastic = true;
  double height = 0;  // for strength that grows with depth [m]
};

struct ElementRow {
  double control = 0;  // controlled strain
  Components strain{}, stress{};
  std::vector<double> state;
  // Undrained tests: excess pore pressure, compression positive, for a constant total stress on the free side
  // (lateral in triaxial and biaxial tests, vertical in simple shear) [Pa]; 0 in drained tests.
  double excess_pore_pressure = 0;
};

// The initial state and one row for each target.
std::vector<ElementRow> run_element(const MaterialParameters& material, const ElementPath& path);

}  // namespace polder::mpm
