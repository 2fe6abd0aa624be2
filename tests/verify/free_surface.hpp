// Seepage with a free surface through dams and levees, steady and after a change of level: unsaturated flow
// with a capillary fringe that is made thin, measured against solutions without one. For the tests and the
// report.
//
// The fringe is Gardner's, k_r = S_e = exp(-alpha h) under the suction head h. It carries water above the
// free surface and lifts it, by amounts that vanish with 1/alpha. Two values of alpha, one twice the other,
// give an estimate of the limit: linear in 1/alpha for discharges (Charny's integral gives their excess as
// (h1 - exit) / alpha to first order), alpha^(-2/3) for the point where the surface leaves the downstream
// face (found: the distance to the exact point falls by 0.64 to 0.68 for each doubling).
#pragma once

#include <vector>

namespace polder::verify {

struct FreeSurface {
  bool converged = false;
  int iterations = 0;  // linear systems
  double inflow = 0;   // through the upstream face [m2/s]
  double outflow = 0;  // through the downstream face and the seepage face [m2/s]
  double exit = 0;     // height at which the surface leaves the downstream face [m]
};

struct FreeSurfaceLimit {
  std::vector<double> alpha;       // [1/m]
  std::vector<FreeSurface> found;  // for each
  double discharge = 0, exit = 0;  // estimates for a vanishing fringe, from the last two
};

// Rectangular dam of conductivity 1e-4 m/s on an impermeable base, levels h1 (= height) and h2, `cells` over
// the height; alpha doubles from 20 / h1 to `steepest` / h1, each state the start of the next.
FreeSurfaceLimit rectangular_dam(double length, double h1, double h2, int cells, double steepest);
double charny_discharge(double length, double h1, double h2);  // k (h1^2 - h2^2) / (2 L) [m2/s]

// Levee of triangular section, base [m], slopes 1 : upstream and 1 : downstream, k = 1e-4 m/s. Its exit is
// that of the highest face that lets water out, known to a cell.
FreeSurfaceLimit trapezoidal_levee(double base, double upstream, double downstream, double h1, double h2,
                                   double cell, double steepest);

// Block of 10 m on an impermeable base, closed at its end, k = 1e-4 m/s, drainable porosity 0.2; the level at
// x = 0 goes from h0 to hb at t = 0.
struct LevelChange {
  std::vector<double> time, volume;  // [s]; drained (+) or taken up (-) [m2]
  double defect = 0;                 // of the balance over the volume exchanged
  long steps = 0;
};
LevelChange level_change(double h0, double hb, double cell, double alpha, const std::vector<double>& times);
// The volume after Boussinesq's equation linearised about the mean level, D = k ((h0 + hb) / 2 + fringe) /
// n_e; fringe: what flows in it counts as so much more height, 1 / alpha [m].
double linearised_volume(double h0, double hb, double fringe, double time);

}  // namespace polder::verify
