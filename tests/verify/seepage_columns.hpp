// Columns of unsaturated soil with exact solutions, measured: for the tests and the report.
#pragma once

#include <vector>

namespace polder::verify {

struct Absorption {
  double volume_error = 0;   // of the water taken in, relative
  double profile_error = 0;  // relative L2 of the water content over the profile
  double defect = 0;         // mass balance over the inflow
  long steps = 0;
};
// Horizontal absorption by New Mexico soil against Philip's similarity solution, after one hour.
Absorption sorptivity(int cells);

struct SharpFront {
  double volume_error = 0;  // largest error of the infiltrated volume over the volume, from 600 s on
  double ponding_time = 0;  // first time the soil takes less than the rain, over Green and Ampt's
  double run_off = 0;       // rain less infiltration and ponding over the rain at the end
  double balance = 0;       // (rain - infiltration - run-off) / rain
  long steps = 0;
};
// Ponded infiltration with a sharp front (Brooks-Corey soil that is nearly a step) against Green & Ampt
// (1911).
SharpFront green_ampt(int cells);
// Rain of five times the conductivity on the same soil.
SharpFront ponding(int cells);

struct Profiles {
  std::vector<double> error;  // relative L2 of the water content (or of the head), at each time or flow
  double flux_error = 0;      // largest error of the flow to the water table over the last one
  int iterations = 0;         // all together
};
// Srivastava & Yeh (1991): exponential soil above a water table, the rain changes; cells a metre.
Profiles srivastava_yeh(bool wetting, int cells, double step);
// Gardner (1958): steady rain and evaporation above a water table, exponential soil.
Profiles gardner(int cells);
// Steady flow above a water table, New Mexico soil, by quadrature.
Profiles steady_van_genuchten(int cells);
// Evaporation beyond what the exponential soil can lift to 1.5 m: the flow over the limiting one, minus 1.
double limiting_evaporation(int cells);

struct FallingHead {
  double rigid_error = 0, compressible_error = 0;  // largest, over the first head
};
FallingHead falling_head(int cells);

}  // namespace polder::verify
