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

// Griffiths & Lane (1999), example 3: uniform clay of 50 kPa with a layer of `ratio` times that, a fifth of
// the height thick where it is level, a tenth where it runs parallel to the face.
coupling::Scene weak_layer_scene(double ratio, double cell);

// Example 5: the slope of example 1 under water that stands `drawdown` times the height below the crest,
// inside and outside.
coupling::Scene drawdown_scene(double drawdown, double cell);

// An infinite slope: a column `cells` high with tied sides, in a frame that is tilted by the slope's angle;
// psi = phi. Its strength is kSpareStrength times that given, and so is its factor: above 1 a reduction cuts
// the dilation angle with the friction angle, below it friction would grow and leave the dilation behind.
// Without the cure of volumetric locking: a column in simple shear does not lock, and where points
// of one cell dilate differently the cure is not symmetric and can feed on itself.
inline constexpr double kSpareStrength = 2;
struct InfiniteSlope {
  double angle, friction, cohesion;  // [rad], [rad], [Pa]
  double weight, saturated_weight;   // [N/m3]
  double depth;                      // vertical [m]
  double water;                      // its share of the depth
  bool horizontal;                   // it flows level, out of the slope; else parallel to it
  bool dilates = true;               // psi = phi; else psi = 0
};
coupling::Scene scene_of(const InfiniteSlope& slope, int cells);

}  // namespace polder::verify
