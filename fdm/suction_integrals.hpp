// Integrals of a retention curve over the suction head, for means over the height of a cell.
//
// Where water in a cell hangs at rest, the suction head grows by the cell's height from its lower to its
// upper side. A curve that is steep over that height, as that of coarse soil in large cells, is then badly
// represented by its value at the centre: a free surface would move from cell to cell in jumps. The mean over
// the height moves it evenly, and is the water that the cell holds. With I(h) the integral of f from 0 to h,
//   mean of f over [h - H/2, h + H/2] = [I(h + H/2) - I(h - H/2)] / H,   its derivative from f itself.
//
// The integrals are tabulated once over ln(1 + h/h_0), by Gauss's rule between the nodes and cubics through
// them whose slopes are the curve itself. Heads in m, suction positive; for h < 0 both functions are 1.
#pragma once

#include <functional>
#include <utility>
#include <vector>

namespace polder::fdm {

class SuctionIntegrals {
 public:
  // curve: effective saturation and relative conductivity at a suction head > 0; scale: a head where they
  // change, on a node of the table (an air-entry head, say); driest: the last node.
  SuctionIntegrals(const std::function<std::pair<double, double>(double)>& curve, double scale,
                   double driest);

  double saturation(double h) const;    // of S_e from 0 to h [m]
  double conductivity(double h) const;  // of k_r from h to the driest head [m]; its digits do not suffer
                                        // where little is left

 private:
  struct Node {
    double head, s, k;  // and the curves there
    double sum_s, rest_k;
  };
  const Node* node_below(double h) const;
  double first_ = 0;  // h_0 [m]
  std::vector<Node> nodes_;
};

}  // namespace polder::fdm
