// Drag between water and grains at one node of the grid: the algebra of coupling/drag_exchange.hpp, where its
// symbols are explained. Divisions are made once for a node, and not for each component of its velocities.
#pragma once

#include <cmath>

namespace polder::coupling {

// Components of velocities. fixed: a boundary gives the grains the velocity `own`; wall: one holds the
// water's, and takes its momentum, so that grains drag on something immovable.
struct NodeDrag {
  double soil = 0, water = 0;  // masses [kg]
  double b = 0;                // dt B / M_w; infinite: soil holds its water
  double tied = 0;             // t
  // Found by set():
  double ratio = 0;            // M_w / M_s
  double share = 0;            // a, with t: b / (1 - t + b)
  double kept = 1, taken = 0;  // what is left of w~, and what grains add to it: w = kept w~ + taken v
  double released = 1;         // v over P, of grains that nothing holds

  // For a node that has both.
  void set(double drag, double tied_share = 0) {
    b = drag, tied = tied_share;
    ratio = water / soil;
    if (std::isinf(b)) {
      share = 1, kept = 0, taken = 1;
    } else {
      kept = 1 / (1 - tied + b);
      share = b * kept, taken = (b - tied) * kept;
    }
    released = 1 / (1 + share * ratio);
  }

  // Trial velocity w~ of the water, from what it was and what the grains had; nothing is tied at a wall.
  double trial(double w, double water_old, double grains_old, bool wall) const {
    return wall ? w : w + tied * (grains_old - water_old);
  }
  // P - v~.
  double push(double w, double own, bool fixed, bool wall) const {
    if (wall) return fixed || std::isinf(b) ? 0 : b * ratio * w;
    return share * ratio * (w - (fixed ? own : 0.0));
  }
  // v of grains that nothing holds, from P.
  double after(double p, bool wall) const {
    if (wall) return std::isinf(b) ? p : p / (1 + b * ratio);
    return p * released;
  }
  double water_after(double w, double v) const { return kept * w + taken * v; }
  // Change of the velocity of tied water with that of the grains.
  double following() const { return b > 0 ? tied * taken : 0; }
};

}  // namespace polder::coupling
