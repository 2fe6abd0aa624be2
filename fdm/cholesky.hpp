// Sparse Cholesky factorisation of a symmetric positive definite matrix with CHOLMOD (Chen, Davis, Hager,
// Rajamanickam 2008, ACM TOMS 35). The symbolic analysis is kept; the permutation is applied while the values
// are filled in, so that CHOLMOD factorises without copying; and a factor is kept as long as the values are
// the same.
#pragma once

#include <memory>
#include <span>
#include <vector>

namespace polder::fdm {

// How to factorise; which of them is fastest depends on the size (bench/solver_table.cpp).
struct CholeskyMethod {
  enum class Ordering { minimum_degree, nested_dissection };
  Ordering ordering = Ordering::minimum_degree;
  bool supernodal = false;  // dense blocks with BLAS, L L^T; else column by column, L D L^T
  bool operator==(const CholeskyMethod&) const = default;
};

class Cholesky {
 public:
  explicit Cholesky(CholeskyMethod method = {});
  ~Cholesky();
  Cholesky(Cholesky&&) noexcept;
  Cholesky& operator=(Cholesky&&) noexcept;

  struct Pair {
    int first, second;  // unknowns; a pair may occur only once, in either order
  };
  // Non-zero off-diagonal entries of an n x n matrix.
  void analyse(int n, std::span<const Pair> off_diagonal);
  // Values in the order of the unknowns and of the pairs; false if they are those of the present factor,
  // which stays. Throws NumericalError if the matrix is not positive definite.
  bool factorise(std::span<const double> diagonal, std::span<const double> off_diagonal);
  void solve(std::span<const double> rhs, std::span<double> x);
  int size() const;
  double factor_entries() const;  // non-zeros of L

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace polder::fdm
