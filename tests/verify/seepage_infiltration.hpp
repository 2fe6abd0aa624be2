// Infiltration into columns of unsaturated soil with known answers, measured: for the tests and the report.
#pragma once

#include <vector>

namespace polder::verify {

struct InfiltrationChoice {
  int cells = 100;
  double step = 0;         // [s]; 0: chosen by the number of iterations
  double first_step = 60;  // [s], of those
  bool upstream = false;
};

struct Infiltration {
  double profile_error = 0;  // relative L2 error of the water content over the depth, at the end
  double front_error = 0;    // the same of its increase over the initial one
  double inflow_error = 0;   // relative, of the cumulative inflow
  double defect = 0;         // of the mass balance over the infiltrated volume
  long steps = 0, rejected = 0;
  double iterations = 0;  // a step
  double seconds = 0;     // processor time [s]
};

// New Mexico soil (Celia, Bouloutas & Zarba 1990): suction head 10 m, 0.75 m at the top from t = 0; at 1 d.
Infiltration celia_new_mexico(const InfiltrationChoice& choice);
// Haverkamp's sand (Celia et al. 1990, after Haverkamp et al. 1977): 0.615 m, 0.207 m at the top; at 360 s.
Infiltration celia_haverkamp(const InfiltrationChoice& choice);

}  // namespace polder::verify
