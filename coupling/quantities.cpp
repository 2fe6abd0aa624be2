#include "coupling/quantities.hpp"

#include <algorithm>

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
      {"cohesion", "Pa"},          {"friction_angle", "deg"},
      {"conductivity", "m/s"},     {"water_velocity", "m/s"},
      {"water_velocity_x", "m/s"}, {"water_velocity_y", "m/s"},
      {"water_velocity_z", "m/s"},
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
      {"recovered_stress", "Pa"},
      {"pore_pressure", "Pa"},
      {"deviatoric_strain", "-"},
      {"mean_effective_stress", "Pa"},
      {"deviatoric_stress", "Pa"},
      {"porosity", "-"},
      {"saturation", "-"},
      {"cohesion", "Pa"},
      {"friction_angle", "deg"},
      {"conductivity", "m/s"},
      {"water_velocity", "m/s"},
      {"volume", "m3"},
      {"body", "-"},
      {"material", "-"},
      {"id", "-"},
  };
  return list;
}

bool has_quasi_static_stage(const Scene& scene) {
  return std::any_of(scene.stages.begin(), scene.stages.end(),
                     [](const Stage& s) { return s.mode == Stage::Mode::quasi_static; });
}

std::vector<Quantity> history_quantities(const Scene& scene) {
  const auto component = [](int d) { return std::string(1, "xyz"[d]); };
  std::vector<Quantity> list{{"time", "s"},
                             {"step", ""},
                             {"stage", ""},
                             {"dt", "s"},
                             {"kinetic_energy", "J"},
                             {"elastic_energy", "J"},
                             {"work_gravity", "J"},
                             {"work_stress", "J"},
                             {"work_water", "J"},
                             {"work_damping", "J"},
                             {"work_boundary", "J"},
                             {"transfer_loss", "J"},
                             {"unbalanced_force_ratio", "-"}};
  const int dimension = scene.dimension();
  for (int d = 0; d < dimension; ++d) list.push_back({"momentum_" + component(d), "kg m/s"});
  for (const char* name : {"momentum_error", "solid_mass_error"}) list.push_back({name, "-"});
  list.push_back({"max_speed", "m/s"});
  for (const char* name : {"runout", "height"}) list.push_back({name, "m"});
  for (const Boundary& b : scene.boundaries)
    if (b.kind != Boundary::Kind::traction && b.kind != Boundary::Kind::pressure)
      for (int d = 0; d < dimension; ++d) list.push_back({"reaction:" + b.name + "_" + component(d), "N"});
  const Formulation* formulation = find_formulation(scene.formulation);
  if (formulation != nullptr && formulation->carrier != WaterCarrier::none) {
    list.insert(list.end(), {{"water_mass_error", "-"},
                             {"water_outflow", "m3"},
                             {"max_pore_pressure", "Pa"},
                             {"pressure_roughness", "Pa"},
                             {"discharge:surface", "m3/s"}});
    for (const WaterBoundary& w : scene.water_boundaries) list.push_back({"discharge:" + w.name, "m3/s"});
    for (const WaterLine& w : scene.water_lines)
      if (w.kind != WaterLine::Kind::sheet) list.push_back({"discharge:" + w.name, "m3/s"});
    list.push_back({"pressure_cells", ""});
    if (scene.layered())
      list.insert(list.end(), {{"water_points", ""}, {"water_runout", "m"}, {"water_height", "m"}});
    if (scene.layered() && scene.fluidises()) list.push_back({"fluidised", ""});
    if (has_quasi_static_stage(scene)) {
      for (const char* name : {"relaxations", "relaxation_steps", "unbalanced_relaxations"})
        list.push_back({name, ""});
      list.push_back({"relaxation_water", "m3"});
    }
  }
  return list;
}

}  // namespace polder::coupling
