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

// An infinite slope: a slab of strong soil, `cells` high and ten times as long, on a layer of the soil in
// question two cells thick, in a frame that is tilted by the slope's angle; the ends of the slab are free.
struct InfiniteSlope {
  double angle, friction, cohesion;  // [rad], [rad], [Pa]
  double weight, saturated_weight;   // [N/m3]
  double depth;                      // vertical [m]
  double water;                      // its share of the depth, flowing parallel to the slope
  bool associated;                   // psi = phi, else 0
};
coupling::Scene scene_of(const InfiniteSlope& slope, int cells);

}  // namespace polder::verify
