// What a seepage engineer reads from a plane pressure field: phreatic line, stream function, exit gradients
// and the factor against heave.
//
// Heads h = height + p / gamma_w [m]; gradients [-]. Stream function psi [m2/s] (axisymmetric: [m3/s] per
// radian): u = d psi / dy, v = -d psi / dx for the specific discharge (u, v), so that psi(B) - psi(A) is the
// flow across a line from A to B, from its left to its right hand side. Level lines of psi and of the head
// are the flow net.
//
// Flows of faces are those of UnsaturatedField::face_flow(): interior faces first, against the axis (into the
// low cell), then boundary faces, into the soil [m3/s].
#pragma once

#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/aligned.hpp"
#include "fdm/water_cells.hpp"

namespace polder::fdm {

// Height of the highest place in each column of cells, by x, where the pressure passes from positive below to
// zero or less above; where it is positive up to the soil's surface, that surface or the hydrostatic level
// below it. Columns without positive pressure have none. pressure: slots [Pa].
std::vector<std::pair<double, double>> phreatic_line(const WaterCells<2>& cells,
                                                     std::span<const double> pressure);

// At the nodes (slots); NaN where no cell with water touches. The flow through every side of a cell is the
// difference of psi between the side's ends (walls: none), so no integration is needed; in steady flow
// without wells and drains the flows of a cell cancel and every way from node to node gives the same. psi is
// zero at the first node of each connected region.
struct StreamFunction {
  Reals value;
  double lowest = 0, highest = 0;
  double defect = 0;  // largest disagreement of two ways around a cell, over highest - lowest
};
StreamFunction stream_function(const WaterCells<2>& cells, std::span<const double> face_flow);

// Loss of head from a cell's centre to a boundary face over their distance, where water leaves.
struct ExitGradient {
  Point<2> place{};   // of the face
  int slot = -1;      // of the cell
  int axis = 0;       // of its normal
  int outward = 1;    // +1: the water leaves along the axis
  int boundary = -1;  // number of the condition, -1: free surface without a name
  double gradient = 0;
};
std::vector<ExitGradient> exit_gradients(const WaterCells<2>& cells, std::span<const double> pressure);
// The largest one of upward flow; of one boundary (-1: the free surface) or, without it, of all. None if no
// water rises out of the soil there.
std::optional<ExitGradient> largest_upward(std::span<const ExitGradient> gradients,
                                           std::optional<int> boundary = {});

// Gradient of upward flow at which soil becomes weightless, (1 - n) (rho_s / rho_w - 1) (Terzaghi 1922).
double critical_gradient(double porosity, double density_solid, double density_water);
// Factor of safety against heave, critical over present gradient; infinite where no water rises.
double heave_factor(double critical, double gradient);

}  // namespace polder::fdm
