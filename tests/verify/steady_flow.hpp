// Steady flow from starts near and far, through soils from sand to silty clay: for the tests and the report.
#pragma once

#include <string>
#include <vector>

namespace polder::verify {

enum class SteadyStart {
  near,   // Dupuit's surface, or a straight one
  still,  // the level downstream, everywhere
  dry,    // one suction everywhere, 2 to 3 m
};

struct SteadyScene {
  std::string name;
  bool levee = false;  // else a rectangular dam of 1 m, 40 cells
  bool drain = false;  // in the toe of the levee
  double conductivity = 0;
  // Retention: Gardner's with n = 0, else van Genuchten's.
  double alpha = 0, n = 0, residual = 0;
};
// Dams of 1 m by 1 m between 1 m and 0.2 m, and the levee of cases/levee-story (crest 3 m, slope 1 : 2, water
// to 2.375 m, cells of 0.1 m) with and without a drain of 2 m at its toe.
std::vector<SteadyScene> steady_scenes();

struct SteadyFlow {
  bool converged = false;
  int iterations = 0, linear_iterations = 0;
  double seconds = 0;
  double inflow = 0, outflow = 0;  // [m2/s]
};
SteadyFlow steady_flow(const SteadyScene& scene, SteadyStart start, bool averages);

}  // namespace polder::verify
