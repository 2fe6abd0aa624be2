// Fast direct solver for systems whose values do not vary along all axes but one: cosine (sine) transforms
// along these axes turn the system into one tridiagonal system for each wave number, along the remaining one
// (Hockney 1965, J. ACM 12; Swarztrauber 1977, SIAM Rev. 19, "Fourier analysis" method).
//
// It applies to a full rectangle or box of cells where, with one axis `a` (the depth, of level layers, say),
//   * links along every axis and sinks depend on the position along a only,
//   * each side across another axis is either a wall or carries, in all its cells, a further sink of twice
//     the link across it: a prescribed value on the face, half a cell away,
//   * sinks at the two ends of axis a are arbitrary,
//   * or everything is closed but for a sink in a single cell (the pin of a closed basin).
// Constant coefficients on a rectangle with walls, faces of prescribed value or a level surface are the
// common case; layers of any contrast cost nothing more. Not covered: prescribed values at another distance
// from the sides, holes, coefficients that vary in the plane. As a preconditioner for those the transform
// loses to multigrid, so it is not offered as one.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "core/aligned.hpp"
#include "core/fourier.hpp"
#include "fdm/defect.hpp"
#include "fdm/linear_system.hpp"

namespace polder::fdm {

template <int D>
class CosineSolver final : public LinearSolver<D> {
 public:
  const char* name() const override { return "cosine transform"; }
  void analyse(const Connectivity<D>& connectivity) override;
  // Throws NumericalError where applies() is false.
  SolveReport solve(const SystemValues& system, const Accuracy& accuracy, std::span<double> x) override;

  // Whether the cells fill a box; false spares the look at the values.
  bool full_box() const { return full_box_; }
  // Whether the transform diagonalises the system; ends early where it does not.
  bool applies(const SystemValues& system);

 private:
  // The system as far as it decides the method, by position along the axis a.
  struct Layers {
    int axis = D - 1;                                      // a
    std::array<std::vector<double>, D> link;               // along each axis; along a: to the next layer
    std::vector<double> sink;                              // of cells inside
    std::array<std::array<Parity, 2>, D> ends{};           // of the sides across the other axes
    std::optional<std::pair<std::size_t, double>> pinned;  // cell, sink, of an otherwise closed box
  };
  int cell_at(const Index<D>& place) const;
  // False where the values are not those of layers across `axis`.
  bool find_layers(const SystemValues& system, int axis, Layers& layers) const;
  bool find_links(const SystemValues& system, Layers& layers) const;
  bool find_sinks(const SystemValues& system, Layers& layers) const;
  void arrange();
  void factorise();
  void solve_layers(std::span<const double> rhs, std::span<double> x);

  Connectivity<D> connectivity_;
  Defect defect_;
  bool full_box_ = false;
  Index<D> lower_{}, size_{};
  std::vector<int> number_;  // cell at each place of the box, x fastest

  Layers layers_;
  int count_ = 0, stride_ = 0, layer_cells_ = 0;     // layers, cells from one to the next, cells in one
  std::vector<CellTransform::Axis> transform_axes_;  // slowest first
  std::optional<CellTransform> transform_;
  std::array<Reals, D> eigenvalue_;  // of the second difference along each axis, by column
  int arranged_axis_ = -1;
  std::vector<int> position_;  // of each cell in work_
  Reals work_, pivot_;         // layers of stride_; pivot_: inverse pivots
};

extern template class CosineSolver<2>;
extern template class CosineSolver<3>;

}  // namespace polder::fdm
