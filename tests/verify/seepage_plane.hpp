// Plane seepage, steady and transient, saturated and not, with exact or converged solutions, measured: for
// the tests and the report.
#pragma once

#include <vector>

#include "fdm/unsaturated_field.hpp"

namespace polder::verify {

struct Cost {
  long steps = 0, rejected = 0;
  double iterations = 0;  // a step
  double seconds = 0;     // wall
};

// Tracy (2006): infiltration into a dry square of exponential soil, cells a side.
struct Tracy {
  std::vector<double> head_error;  // relative L2 of the rise of head in the cells at 2, 5, 10, 20 h and in
                                   // steady state
  double defect = 0;
  int steady_iterations = 0;
  Cost cost;
};
Tracy tracy(int cells);

// Recharge of a water table by rain on a part of the surface (set-up of Vauclin, Khanji & Vachaud 1979);
// cells over the height of 2 m.
struct Recharge {
  std::vector<double> table_error;    // largest, at 2, 3, 4, 8 h [m]
  std::vector<double> head_error;     // largest where suction is less than 0.3 m [m]
  std::vector<double> outflow_error;  // over the inflow up to then
  double defect = 0;                  // of the mass balance over the inflow
  Cost cost;
};
Recharge vauclin(int cells);

// Sudden rise of the upstream level on an unsaturated block with a seepage face; cells over 1.5 m.
struct Wetting {
  std::vector<double> table_error;   // largest up to 0.2 m from the downstream face, at 0.1 ... 10 h [m]
  std::vector<double> inflow_error;  // relative
  std::vector<double> face_error;    // flow through the seepage face over the inflow
  double defect = 0;
  Cost cost;
};
Wetting block_wetting(int cells);

// Steady seepage through a rectangular dam of 10 x 10 m from 10 to 2 m of water, in soil whose capillary
// fringe is `fringe` high: discharge over Charny's, height of the seepage face over the exact one. Cells over
// 10 m.
struct Dam {
  double discharge = 0, exit = 0;
  fdm::StepReport report;
  double seconds = 0;
};
Dam dam(int cells, double fringe, fdm::FaceWeighting weighting = fdm::FaceWeighting::mean);

// Seepage under a sheet pile to the part `depth` of a layer of 1 m; cells over the layer. Errors relative to
// Harr (1962).
struct SheetPile {
  double discharge_error = 0, gradient_error = 0;
};
SheetPile sheet_pile(int cells, double depth);

}  // namespace polder::verify
