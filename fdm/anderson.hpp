// Acceleration of a fixed-point iteration x <- g(x): the next x is the combination of the last results g(x_i)
// whose combined change g(x_i) - x_i is the smallest (Anderson 1965, J. ACM 12; Walker & Ni 2011, SIAM J.
// Numer. Anal. 49, algorithm AA). For a linear g this is GMRES, for a mildly nonlinear one a secant method
// that needs no derivative. Sums have a fixed shape: the same bits for any number of threads.
#pragma once

#include <array>
#include <span>

#include "core/aligned.hpp"

namespace polder::fdm {

class Anderson {
 public:
  void resize(std::size_t n);
  void restart() { count_ = 0, previous_ = false; }

  // x: the point, g: its image, weight: of each entry's change in the norm. Writes the next point to x.
  void next(std::span<double> x, std::span<const double> g, std::span<const double> weight);

 private:
  static constexpr int kDepth = 5;
  int count_ = 0;          // differences held
  int newest_ = 0;         // position of the newest
  bool previous_ = false;  // whether change_ and image_ hold the last point's
  std::array<Reals, kDepth> change_step_,
      image_step_;  // differences of successive changes (weighted), images
  Reals change_, image_, scaled_;
};

}  // namespace polder::fdm
