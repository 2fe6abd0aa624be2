// Cell-centred geometric multigrid: linear interpolation that follows the conductances, V-cycle. A candidate
// in the comparison of solvers (bench/solver_table.cpp), not part of the program: the aggregation multigrid
// of fdm/ is as fast or faster in nearly every row and converges where this one does not.
//
// A coarse cell is a square or cube of fine cells (2 along each coarsened axis) with its value at the centre.
// A fine cell takes its value from its own coarse cell and, along each axis, from the one it borders on, in
// the ratio of the conductances of the ways there:
//   w = g / (g + 2 t),   g = (1/t_out + 1/(2 t'))^-1,
// with t the strongest link within the coarse cell, t_out the link out of it and t' that of the cell there to
// its own sibling; 1/4 for uniform links, so that linear functions are interpolated exactly, 0 where there is
// nothing beyond, and a sink pulls towards zero like a link to a prescribed value (after Wesseling 1988,
// "Cell-centered multigrid for interface problems", J. Comput. Phys. 79; the resistor weights are ours).
// Restriction is the transpose. Coarse links are half the sums of the fine ones, right for linear functions,
// and better than ways between the centres in series and in parallel where thin layers are tight; so every
// level stays a five- or seven-point system. A sink of a cell beside a missing neighbour is taken as a
// prescribed value beyond its face and gets the way to the coarse centre in series. Smoother: one sweep of
// damped Jacobi before and after.
#pragma once

#include <array>
#include <vector>

#include "fdm/multigrid.hpp"

namespace polder::fdm {

template <int D>
class GeometricMultigrid final : public Multigrid<D> {
 public:
  const char* name() const override { return "conjugate gradients with geometric multigrid"; }

 private:
  using typename Multigrid<D>::Level;
  using typename Multigrid<D>::Row;

  // Transfer between a level and the next, at positions of the finer one. Out: across the border of the
  // coarse cell, along x upwards for odd cells and downwards for even ones.
  struct Transfer {
    Reals own;                                   // 1 - the sum of the cell's weights
    std::array<Reals, D> weight, weight_of_out;  // of the value out there; the weight that cell gives ours
    Reals interpolated;                          // work
  };
  // Links of a cell within its coarse cell and out of it; zero along axes that are not coarsened.
  struct Ways {
    std::array<double, D> in{}, out{};
    std::array<int, D> out_at{};  // position
  };
  Ways ways(const Level& fine, const Row& row, int c) const;
  void coarse_values(int l) override;
  void coarse_links(const Level& fine, Level& coarse) const;
  void set_weights(const Level& fine, Transfer& transfer) const;
  void cycle(int l, const Reals& b, Reals& x) override;
  static void spread(const Level& fine, const Transfer& transfer, const Reals& in, Reals& out);
  static void collect(const Level& fine, const Transfer& transfer, const Reals& in, Reals& out);

  std::vector<Transfer> transfers_;
};

extern template class GeometricMultigrid<2>;
extern template class GeometricMultigrid<3>;

}  // namespace polder::fdm
