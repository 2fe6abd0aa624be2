// Linear systems that are not symmetric: the generalised minimal residual method with a preconditioner that
// may itself be an iteration (flexible GMRES, Saad 1993, SIAM J. Sci. Comput. 14). Vectors are built by
// modified Gram-Schmidt, the small least-squares problem by Givens rotations. Sums have a fixed shape: the
// same bits for any number of threads.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "core/aligned.hpp"

namespace polder::fdm {

class FlexibleGmres {
 public:
  using Map = std::function<void(std::span<const double> in, std::span<double> out)>;
  struct Report {
    int iterations = 0;
    double reduction = 1;  // norm of the residual over that of the right-hand side
  };

  // x from A x = b, starting at zero, until the residual has fallen by `reduction` or after `most` iterations
  // (no restart).
  Report solve(const Map& matrix, const Map& preconditioner, std::span<const double> b, double reduction,
               int most, std::span<double> x);

 private:
  std::vector<Reals> basis_, direction_;
  std::vector<std::vector<double>> hessenberg_;  // by columns
};

}  // namespace polder::fdm
