// Where the phreatic line leaves the soil: the upper end of a seepage face, to a fraction of a cell.
//
// The cells next to the face know the end only roughly: the pressure vanishes there along the face and along
// the free surface, which is tangent to the face, so that between the surface half a cell inside and the end
// there may be a cell's height and more. What is known is how the surface bends. In the plane of velocities
// (hodograph) seepage faces are straight lines and free surfaces arcs of the circle u^2 + v^2 + k v = 0
// (Polubarinova-Kochina 1962, Theory of ground water movement, ch. VII). About the end both bound a lune that
// ln of a linear fraction maps to a strip, and the flow, a half plane there, to that strip: with the
// slope beta of the face, theta = pi/2 - beta and the distance s from the end along face or surface,
//   f = (W - A)/(W - B) = (s/R)^(theta/pi) exp(i {0 on the face, theta on the surface}),
// A = k sin(beta) down the face, B = k straight down. It gives the outflow
//   q(s) = k cos(beta) f / (1 - f)        (vertical face: k pi / ln(R/s))
// and the direction of the surface; its integral is the distance of the surface from the face, n(s). R is a
// length that the flow as a whole decides. Two points of the phreatic line, further from the face than what
// the cells there smear, determine R and the end.
//
// Holds for soil that is homogeneous and isotropic near the end, and fringes that are thin against the cells
// used; it is the better extrapolation also elsewhere.
#pragma once

#include <span>
#include <vector>

#include "fdm/water_cells.hpp"

namespace polder::fdm {

struct PhreaticExit {
  Point<2> place{};    // [m]
  double slope = 0;    // angle of the face against the horizontal [rad]
  int boundary = -1;   // number of the condition there, -1: free surface without a name
  int direction = 1;   // +1: the face looks towards +x, -1: towards -x
  bool found = false;  // from the law above; false: the height of the last cell that lets water out
};

// One for each side on which soil lets water out above any level that stands there. pressure: slots [Pa].
std::vector<PhreaticExit> phreatic_exits(const WaterCells<2>& cells, std::span<const double> pressure);

namespace detail {

// Distance along the face from the end to the foot of the surface point that lies `distance` away from it;
// negative: not so far within the law.
double distance_along(double slope, double length_scale, double distance);
// Of two points of the surface at the distances n1 < n2 from the face, whose feet are `apart`: how far the
// first one's foot is from the end.
double distance_to_end(double slope, double n1, double n2, double apart);

}  // namespace detail
}  // namespace polder::fdm
