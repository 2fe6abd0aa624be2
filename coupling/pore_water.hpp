// Pore water: what a wet world owns besides its skeleton. Pressure lives in the grid's cells; `layer` is
// there where the water has points of its own. Only with `points` the skeleton's own points carry pressure
// and water, and cells are found from them for those who look.
//
// A scene without retention curves is saturated wherever it is wet: `pressure` is solved for, `unsaturated`
// is not there and no curve is ever evaluated. With retention curves `unsaturated` is solved for instead; all
// porous soil then belongs to its cells, and points carry the degree of saturation and the suction stress.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "coupling/node_drag.hpp"
#include "coupling/scene.hpp"
#include "coupling/water_viscosity.hpp"
#include "fdm/pressure_field.hpp"
#include "fdm/unsaturated_field.hpp"
#include "fdm/volume_correction.hpp"
#include "mpm/fluid_layer.hpp"

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

// What water on points of its own needs (two_layer.hpp).
template <int D>
struct WaterLayer {
  WaterLayer(const Grid<D>& grid, const Scene& scene, mpm::BoundarySet<D> boundaries,
             const fdm::WaterCells<D>& cells, fdm::PressureField<D>& pressure)
      : fluid(grid, scene.grid.space, scene.grid.shape,
              scene.numerics.water_transfer == Transfer::apic ? mpm::AffineKind::apic : mpm::AffineKind::none,
              scene.numerics.water_flip, std::move(boundaries)),
        correction(cells, pressure),
        relative_inertia(find_formulation(scene.formulation)->inertia == RelativeInertia::kept) {
    if (scene.water.viscous) viscosity = std::make_unique<WaterViscosity<D>>(grid, scene.water.viscosity);
  }

  mpm::FluidLayer<D> fluid;
  fdm::VolumeCorrection<D> correction;
  bool relative_inertia;                         // of water in pores, kept
  std::unique_ptr<WaterViscosity<D>> viscosity;  // where the scene asks for it
  double spacing = 0;                            // of new points [m]
  // Cells (slots): volume of the water's points; that of the grains with the water they retain [m3]; share
  // taken by soil, its pores included; part of that soil which lies in water; resistance of the pores per
  // volume of water [Pa s/m2]; volume that has come in through open sides and has no point yet [m3].
  Reals water_volume, grain_volume, soil_fill, submerged, drag, owed;
  Reals cell_volume;  // where cells differ (axisymmetry) [m3]
  // Where relative inertia is neglected, share of the water that is in pores: of cells, of nodes [-]; and
  // change of the nodes' velocity of water with that of the grains.
  Reals in_pores, tied, following;
  // Nodes with grains or water: all that a step has to look at. The fields of nodes are zero elsewhere.
  std::vector<int> nodes, found_nodes;  // the latter: work space
  // Nodes (slots * 4): velocities with drag exchanged and their responses to a unit pressure gradient.
  Reals grains, water, grains_response, water_response;
  Reals divergence, face_flow, face_mobility;  // of cells and faces, see fdm/mixture_flow.hpp
  std::vector<NodeDrag> node_drag;             // of `nodes`
  Reals specific_volume;         // of faces, where pressure is explicit: mobility over the step [m3/kg]
  Reals displacement;            // of the nodes, that takes the drift out of the volumes [m]
  std::vector<Reals> fluidised;  // bodies, by the number of the point: 1 where it is (fluidisation.hpp)
  fdm::Discharge discharge;
  bool held = false;              // by the soil, while it relaxes
  double added = 0, removed = 0;  // volume of the points that came and went through open sides [m3]
};

// What the soil's change of volume asks of the water in quasi-static stages (volume_feedback.hpp). Cells
// (slots); empty in other stages.
struct VolumeFeedback {
  Reals compressibility;  // of the skeleton, that the flow foresees [1/Pa]
  Reals foreseen;         // water that went into so foreseen expansion since equilibrium was last sought [m3]
  Reals owed;             // water that pores which have opened beyond that still take from the cell [m3]
  Reals rate;             // work space of the active cells [m3/s]
};

// A node on a side of the grid through which water may pass.
struct SideNode {
  int slot, axis, outward, boundary;  // the last: number in Scene::water_boundaries
  double height;                      // mean of the soil around it [m]
};

// What water on the skeleton's points needs (point_water.hpp).
template <int D>
struct PointWater {
  PointWater(bool relative_inertia, mpm::BoundarySet<D> walls)
      : relative_inertia(relative_inertia), walls(std::move(walls)) {}

  bool relative_inertia;  // points carry a velocity of the water
  mpm::Transfer<D> transfer;
  mpm::BoundarySet<D> walls;                       // of the water
  std::vector<SideNode> sides;                     // where water may pass
  std::vector<std::array<double, 2>> height_sums;  // of nodes: volume and its moment of height; work space
  std::vector<int> side_blocks;                    // whose points reach those with a head
  std::vector<SideNode> frictional;                // on walls with friction that hold the water
  std::uint64_t revision = 0;                      // of the grid that the nodal fields belong to
  // Nodes: sums of mpm::scatter_pore_water [slots * 8]; velocities of the water before and after the step,
  // and as its points' momenta give them; flow relative to the grains; trial velocity of the grains under
  // their boundaries [slots * 4].
  Reals sums, velocity_old, velocity, mapped, flow, grains;
  std::vector<Reals> volume;  // of the points before they move, by body
  std::vector<Reals> rate;    // of them: volume of soil gained and water lost by a unit of volume in the step
  std::vector<std::array<double, 2>> parts;  // work space
  // Mixed quadrature, over slots of cells: full of points, their mean pressure, rate at their centres; the
  // points' pressures, by body, while those of full cells are set aside.
  std::vector<std::uint8_t> full;
  Reals cell_pressure, cell_rate;
  std::vector<Reals> pushing;
  double time = 0;                // that the pressures at the sides belong to [s]
  double gravity = 1;             // share of the scene's gravity
  bool held = false;              // by the soil, while it relaxes
  bool cells_found = false;       // cells are those of the points as they are
  const char* limit_reason = "";  // of PoreWater::explicit_limit, which is that of the whole step here
  fdm::Discharge discharge;
};

template <int D>
struct PoreWater {
  PoreWater(const Grid<D>& grid, Space space, const fdm::WaterProperties<D>& properties)
      : cells(grid, space), pressure(cells, properties) {}

  fdm::WaterCells<D> cells;
  fdm::PressureField<D> pressure;                    // of saturated scenes
  std::unique_ptr<UnsaturatedWater<D>> unsaturated;  // of the others
  std::unique_ptr<WaterLayer<D>> layer;              // where water has points of its own
  std::unique_ptr<PointWater<D>> points;             // where it is on the skeleton's
  fdm::WaterConditions<D> conditions;
  // Cells (slots): soil's share, its porosity, its saturated conductivity over unit weight. Nodes (slots * 4
  // or slots).
  Reals cell_sums, fill, porosity, darcy_mobility;
  Reals node_gradient, acceleration, correction, mobility;
  std::uint64_t sealed_revision = 0;  // of the cells whose nodes the boundaries know as sealed
  double wall_seconds = 0;            // spent on the water's part of the steps
  double outflow = 0;                 // water that has left by Darcy flow [m3]
  double storage = 0;  // taken up by compression of water and (rigid) skeleton, less what is owed [m3]
  VolumeFeedback feedback;
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
    if (layer) return layer->discharge;
    if (points) return points->discharge;
    return unsaturated ? unsaturated->field.discharge() : pressure.discharge();
  }
  fdm::SolverCounts solver_counts() const {
    return unsaturated ? unsaturated->field.solver_counts() : pressure.solver_counts();
  }
  const char* solver_name() const {
    if (compressible) return "explicit";
    return unsaturated ? unsaturated->field.solver_name() : pressure.solver_name();
  }
};

}  // namespace polder::coupling
