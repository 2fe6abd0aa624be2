// Multigrid on aggregates with piecewise constant transfer, K-cycle.
//
// The Galerkin coarse matrix of constant transfer is again a five- or seven-point system whose links and
// sinks are plain sums, for any mask and any coefficients. The poor scaling of constant transfer is cured by
// the K-cycle: on every coarse level two steps of flexible conjugate gradients, the second left out when the
// first has gained a factor four (Notay 2010, "An aggregation-based algebraic multigrid method", ETNA 37,
// section 3). Smoother: one sweep of damped Jacobi before and after.
#pragma once

#include "fdm/multigrid.hpp"

namespace polder::fdm {

template <int D>
class AggregationMultigrid final : public Multigrid<D> {
 public:
  const char* name() const override { return "conjugate gradients with aggregation multigrid"; }

 private:
  using typename Multigrid<D>::Level;
  using typename Multigrid<D>::Row;

  void coarse_values(int l) override;
  void cycle(int l, const Reals& b, Reals& x) override;
  // Two steps of flexible conjugate gradients for the level's system, from `rhs` to `x`.
  void coarse_correction(int l);
};

extern template class AggregationMultigrid<2>;
extern template class AggregationMultigrid<3>;

}  // namespace polder::fdm
