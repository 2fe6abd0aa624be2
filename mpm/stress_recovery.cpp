#include "mpm/stress_recovery.hpp"

#include <algorithm>
#include <cmath>

#include "core/cholesky.hpp"
#include "core/threads.hpp"

namespace polder::mpm {
namespace {

// Keeps the fit solvable where a cell has no neighbour along an axis, and the slope along it zero; a share of
// the cell squared.
constexpr double kRegular = 1e-12;

template <int D>
struct CellMean {
  static constexpr int kStress = ParticleSet<D>::kStress;
  double volume = 0;
  Point<D> centroid{};
  std::array<double, kStress> stress{};
  std::array<Point<D>, kStress> slope{};  // [Pa/m]
};

template <int D>
int home_of(const Grid<D>& grid, const ParticleSet<D>& set, int p) {
  Index<D> cell;
  for (int d = 0; d < D; ++d)
    cell[d] =
        std::clamp(static_cast<int>(std::floor((set.position[d][p] - grid.origin()[d]) / grid.spacing())), 0,
                   grid.cells()[d] - 1);
  return grid.slot(cell);
}

}  // namespace

template <int D>
std::array<Reals, ParticleSet<D>::kStress> recover_stress(const Grid<D>& grid, const ParticleSet<D>& set) {
  constexpr int kStress = ParticleSet<D>::kStress;
  std::vector<CellMean<D>> cells(grid.slots());
  for (int p = 0; p < set.slots(); ++p) {
    if (set.id[p] < 0) continue;
    CellMean<D>& c = cells[home_of<D>(grid, set, p)];
    c.volume += set.volume[p];
    for (int d = 0; d < D; ++d) c.centroid[d] += set.volume[p] * set.position[d][p];
    for (int k = 0; k < kStress; ++k) c.stress[k] += set.volume[p] * set.stress[k][p];
  }
  parallel_for(grid.slots(), [&](int s) {
    CellMean<D>& c = cells[s];
    if (c.volume == 0) return;
    for (double& x : c.centroid) x /= c.volume;
    for (double& x : c.stress) x /= c.volume;
  });
  const double h = grid.spacing();
  parallel_for(grid.slots(), [&](int s) {
    CellMean<D>& c = cells[s];
    if (c.volume == 0) return;
    std::array<Point<D>, D> matrix{};
    std::array<Point<D>, kStress> right{};
    for (int d = 0; d < D; ++d) matrix[d][d] = kRegular * h * h;
    const Index<D> home = grid.index(s);
    for (int n = 0; n < ipow(3, D); ++n) {
      Index<D> index = home;
      for (int d = 0, rest = n; d < D; ++d, rest /= 3) index[d] += rest % 3 - 1;
      const int slot = grid.slot(index);
      if (slot < 0 || slot == s || cells[slot].volume == 0) continue;
      const CellMean<D>& other = cells[slot];
      // A cell that is hardly filled has few points, whose mean lies anywhere in it.
      const double weight = other.volume;
      Point<D> r;
      for (int d = 0; d < D; ++d) r[d] = other.centroid[d] - c.centroid[d];
      for (int i = 0; i < D; ++i)
        for (int j = 0; j < D; ++j) matrix[i][j] += weight / c.volume * r[i] * r[j];
      for (int k = 0; k < kStress; ++k)
        for (int i = 0; i < D; ++i) right[k][i] += weight / c.volume * r[i] * (other.stress[k] - c.stress[k]);
    }
    for (int k = 0; k < kStress; ++k) c.slope[k] = solve_positive_definite(matrix, right[k]);
  });
  std::array<Reals, kStress> recovered;
  for (Reals& r : recovered) r.assign(set.slots(), 0.0);
  parallel_for(set.slots(), [&](int p) {
    if (set.id[p] < 0) return;
    const CellMean<D>& c = cells[home_of<D>(grid, set, p)];
    for (int k = 0; k < kStress; ++k) {
      double value = c.stress[k];
      for (int d = 0; d < D; ++d) value += c.slope[k][d] * (set.position[d][p] - c.centroid[d]);
      recovered[k][p] = value;
    }
  });
  return recovered;
}

template std::array<Reals, ParticleSet<2>::kStress> recover_stress<2>(const Grid<2>&, const ParticleSet<2>&);
template std::array<Reals, ParticleSet<3>::kStress> recover_stress<3>(const Grid<3>&, const ParticleSet<3>&);

}  // namespace polder::mpm
