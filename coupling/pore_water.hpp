// Pore water in the grid's cells (formulations one-layer and higo): what a wet world owns besides its
// skeleton.
//
// A scene without retention curves is saturated wherever it is wet: `pressure` is solved for, `unsaturated`
// is not there and no curve is ever evaluated. With retention curves `unsaturated` is solved for instead; all
// porous soil then belongs to its cells, and points carry the degree of saturation and the suction stress.
#pragma once

#include <memory>
#include <vector>

#include "fdm/pressure_field.hpp"
#include "fdm/unsaturated_field.hpp"

namespace polder::coupling {

// What unsaturated flow needs besides the field itself; over slots.
template <int D>
struct UnsaturatedWater {
  UnsaturatedWater(const fdm::WaterCells<D>& cells, const fdm::WaterProperties<D>& properties,
                   std::vector<fdm::Soil<D>> soils)
      : field(cells, properties, std::move(soils)) {}

  fdm::UnsaturatedField<D> field;
  std::vector<int> soil;            // material of most of a cell's soil
  std::uint64_t soil_revision = 0;  // of the cells that `soil` belongs to
  Reals volume_fraction;            // of soil counted to a cell, slivers of its neighbours included [-]
  Reals compressibility;            // of the skeleton where it is held rigid, 1 / (lambda + 2 G) [1/Pa]
  Reals point_saturation;           // mean of the points in a cell at the last mapping, -1: none
  Reals travel;                     // of the soil in a cell since then [cells]
  Reals was_active;                 // 1 where a cell was active then
  bool mapped = false;              // there has been a mapping
  Reals pushing;                    // pressure of full soil, see fdm::UnsaturatedField [Pa]
  Reals change, room_share, even_share, suction, suction_stress;  // work space
};

template <int D>
struct PoreWater {
  PoreWater(const Grid<D>& grid, Space space, const fdm::WaterProperties<D>& properties)
      : cells(grid, space), pressure(cells, properties) {}

  fdm::WaterCells<D> cells;
  fdm::PressureField<D> pressure;                    // of saturated scenes
  std::unique_ptr<UnsaturatedWater<D>> unsaturated;  // of the others
  fdm::WaterConditions<D> conditions;
  // Cells (slots): soil's share, its porosity, its saturated conductivity over unit weight. Nodes (slots * 4
  // or slots).
  Reals cell_sums, fill, porosity, darcy_mobility;
  Reals node_gradient, acceleration, correction, mobility;
  std::uint64_t sealed_revision = 0;  // of the cells whose nodes the boundaries know as sealed
  double wall_seconds = 0;            // spent on the water's part of the steps
  double outflow = 0;                 // water that has left by Darcy flow [m3]
  double storage = 0;                 // taken up by compression of water and (rigid) skeleton [m3]
  // Pressure from the bulk modulus of the water, explicitly (explicit_water.hpp), instead of by projection.
  bool compressible = false;
  Reals specific_volume;                 // of the mixture in the cells, 1 / rho [m3/kg]
  fdm::ExplicitLimit explicit_limit{0};  // of the last explicit step; 0: not known

  // Pore pressure of the cells [Pa], negative where there is suction.
  const Reals& pore_pressure() const {
    return unsaturated ? unsaturated->field.pressure() : pressure.pressure();
  }
  // The part of it that pushes the skeleton through its gradient; the rest, suction, acts as a stress.
  const Reals& pushing_pressure() const { return unsaturated ? unsaturated->pushing : pressure.pressure(); }
  const fdm::Discharge& discharge() {
    return unsaturated ? unsaturated->field.discharge() : pressure.discharge();
  }
  const char* solver_name() const {
    if (compressible) return "explicit";
    return unsaturated ? unsaturated->field.solver_name() : pressure.solver_name();
  }
};

}  // namespace polder::coupling
