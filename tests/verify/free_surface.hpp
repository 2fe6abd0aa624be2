// Seepage with a free surface through dams and levees, steady and after a change of level: unsaturated flow
// with a capillary fringe that is made thin, measured against solutions without one. For the tests and the
// report.
//
// The fringe is Gardner's, k_r = S_e = exp(-alpha h) under the suction head h, with alpha h1 = 2000: thinner
// than a cell, whose curves are means over its height (UnsaturatedField::set_averages). It lets the dam carry
// (h1 - exit) / alpha more than a dam without a fringe (Charny's integral), 0.05 to 0.1 %.
#pragma once

#include <vector>

namespace polder::verify {

struct FreeSurface {
  bool converged = false;
  int iterations = 0;         // of the flow
  int linear_iterations = 0;  // of the solver in all of them
  double seconds = 0;
  double inflow = 0;   // through the upstream face [m2/s]
  double outflow = 0;  // through the downstream face and the seepage face [m2/s]
  double exit = 0;     // height at which the surface leaves the downstream face [m], NaN: not found
};

struct Fringe {
  double steepness = 2000;  // alpha h1
  bool averages = true;     // curves over the height of a cell, not at its centre
};

// Rectangular dam of conductivity 1e-4 m/s on an impermeable base, levels h1 (= height) and h2, `cells` over
// the height; starts from Dupuit's surface.
FreeSurface rectangular_dam(double length, double h1, double h2, int cells, Fringe fringe = {});
double charny_discharge(double length, double h1, double h2);  // k (h1^2 - h2^2) / (2 L) [m2/s]

// Levee of triangular section, base [m], slopes 1 : upstream and 1 : downstream, k = 1e-4 m/s; starts from a
// level surface that falls evenly from the upstream slope on.
FreeSurface trapezoidal_levee(double base, double upstream, double downstream, double h1, double h2,
                              double cell, Fringe fringe = {});

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
