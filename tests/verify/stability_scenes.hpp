// Slopes with published factors of safety. SI units, angles in radians.
#pragma once

#include <string>
#include <vector>

#include "coupling/scene.hpp"

namespace polder::verify {

// A slope of 10 m at 2 : 1, descending to the right, on `below` m of the same soil; its toe is `toe` m from
// the left side. psi = 0, as in the publications.
struct PublishedSlope {
  std::string name;  // of its row in slopes_literature.csv
  double below, toe, width;
  double cohesion, friction;  // [Pa], [rad]
  bool undrained;             // Tresca with the cohesion as strength
};

std::vector<PublishedSlope> published_slopes();
coupling::Scene scene_of(const PublishedSlope& slope, double cell);

// An infinite slope: a column `cells` high with tied sides, in a frame that is tilted by the slope's angle;
// psi = phi. Without the cure of volumetric locking: a column in simple shear does not lock, and where points
// of one cell dilate differently the cure is not symmetric and can feed on itself.
struct InfiniteSlope {
  double angle, friction, cohesion;  // [rad], [rad], [Pa]
  double weight, saturated_weight;   // [N/m3]
  double depth;                      // vertical [m]
  double water;                      // its share of the depth, flowing parallel to the slope
};
coupling::Scene scene_of(const InfiniteSlope& slope, int cells);

}  // namespace polder::verify
