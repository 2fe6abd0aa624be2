// The linear systems of the pressure equation and the interface of their solvers.
//
// Unknown x_c in every active cell c; for each cell
//   sink_c x_c + sum over links (c, e) of link_ce (x_c - x_e) = rhs_c,
// with sink >= 0 (storage and conductance to prescribed pressures) and link >= 0 (conductance to a
// neighbour). Given in this form the matrix is symmetric, weakly diagonally dominant and an M-matrix by
// construction: positive definite as soon as every connected set of cells has one positive sink.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/aligned.hpp"
#include "core/grid.hpp"

namespace polder::fdm {

// Which cells exist and which are linked; stands as long as the mask of active cells.
template <int D>
struct Connectivity {
  struct Link {
    int low, high;  // cells, neighbours along the axis
    int axis;
  };
  std::vector<Index<D>> cells;  // position of each cell in the grid
  std::vector<Link> links;
};

// Values of one system; spans over cells and links of the Connectivity.
struct SystemValues {
  std::span<const double> sink;
  std::span<const double> link;
  std::span<const double> rhs;
};

struct SolveReport {
  int iterations = 0;  // 0: direct
  double residual =
      0;  // norm of the residual over the norm of the right-hand side, both scaled by diagonal^-1/2
};

// How accurate: || D^-1/2 r || <= tolerance || D^-1/2 b || + floor + 16 eps || D^1/2 x ||. The scaling makes
// rows of very different conductance comparable; the last two terms are what double precision can reach:
// floor covers the cancellation already present in b, 16 eps |x| the products A x (with contrasts of 1e6 no
// solver passes a bare multiple of |b|).
struct Accuracy {
  double tolerance = 1e-10;
  double floor = 0;
};

// What solving has taken so far: structures of the matrix that were analysed, and Cholesky factors of the
// whole system; those that still fit were used again.
struct SolverCounts {
  std::int64_t systems = 0, structures = 0, factors = 0;
};

template <int D>
class LinearSolver {
 public:
  virtual ~LinearSolver() = default;
  virtual const char* name() const = 0;
  virtual void analyse(const Connectivity<D>& connectivity) = 0;
  // The initial guess is always zero: nothing but the system decides the bits of the result. Throws
  // NumericalError if the accuracy is not reached.
  virtual SolveReport solve(const SystemValues& system, const Accuracy& accuracy, std::span<double> x) = 0;
  virtual SolverCounts counts() const { return counts_; }

 protected:
  SolverCounts counts_;
};

enum class SolverKind {
  automatic,  // chosen from size, mask and contrast: fdm/solver_choice.cpp
  direct,     // sparse Cholesky
  multigrid,  // conjugate gradients preconditioned with aggregation multigrid
  cosine,     // cosine transform, for full boxes whose coefficients vary along one axis only
};

template <int D>
std::unique_ptr<LinearSolver<D>> make_solver(SolverKind kind);

// For messages: three digits, with an exponent.
std::string number(double value);

// Sum of a[i] * b[i] in a fixed shape: eight lanes inside chunks of 4096, chunks in order; the same bits for
// any number of threads.
double dot(std::span<const double> a, std::span<const double> b);

}  // namespace polder::fdm
