#include "coupling/quantities.hpp"

namespace polder::coupling {

const std::vector<Quantity>& particle_quantities() {
  static const std::vector<Quantity> list{
      {"displacement", "m"},       {"displacement_x", "m"},
      {"displacement_y", "m"},     {"displacement_z", "m"},
      {"position_x", "m"},         {"position_y", "m"},
      {"position_z", "m"},         {"velocity", "m/s"},
      {"velocity_x", "m/s"},       {"velocity_y", "m/s"},
      {"velocity_z", "m/s"},       {"pore_pressure", "Pa"},
      {"stress_xx", "Pa"},         {"stress_yy", "Pa"},
      {"stress_zz", "Pa"},         {"stress_xy", "Pa"},
      {"stress_yz", "Pa"},         {"stress_zx", "Pa"},
      {"vertical_stress", "Pa"},   {"mean_effective_stress", "Pa"},
      {"deviatoric_stress", "Pa"}, {"deviatoric_strain", "-"},
      {"porosity", "-"},           {"saturation", "-"},
  };
  return list;
}

const std::vector<Quantity>& cell_quantities() {
  static const std::vector<Quantity> list{{"pore_pressure", "Pa"}, {"head", "m"}};
  return list;
}

const std::vector<Quantity>& frame_quantities() {
  static const std::vector<Quantity> list{
      {"displacement", "m"},
      {"velocity", "m/s"},
      {"effective_stress", "Pa"},
      {"pore_pressure", "Pa"},
      {"deviatoric_strain", "-"},
      {"mean_effective_stress", "Pa"},
      {"deviatoric_stress", "Pa"},
      {"porosity", "-"},
      {"saturation", "-"},
      {"volume", "m3"},
      {"body", "-"},
      {"material", "-"},
      {"id", "-"},
  };
  return list;
}

}  // namespace polder::coupling
