// Sparse Cholesky factorisation L D L^T of a symmetric positive definite matrix: CHOLMOD's simplicial code
// with an approximate minimum degree ordering (Chen, Davis, Hager, Rajamanickam 2008, ACM TOMS 35). The
// symbolic analysis is kept; the permutation is applied while the values are filled in, so that CHOLMOD
// factorises without copying.
#pragma once

#include <memory>
#include <span>
#include <vector>

namespace polder::fdm {

class Cholesky {
 public:
  Cholesky();
  ~Cholesky();
  Cholesky(Cholesky&&) noexcept;
  Cholesky& operator=(Cholesky&&) noexcept;

  struct Pair {
    int first, second;  // unknowns; a pair may occur only once, in either order
  };
  // Non-zero off-diagonal entries of an n x n matrix.
  void analyse(int n, std::span<const Pair> off_diagonal);
  // Values in the order of the unknowns and of the pairs. Throws NumericalError if the matrix is not positive
  // definite.
  void factorise(std::span<const double> diagonal, std::span<const double> off_diagonal);
  void solve(std::span<const double> rhs, std::span<double> x);
  int size() const;
  double factor_entries() const;  // non-zeros of L

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace polder::fdm
