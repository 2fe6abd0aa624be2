// Stress recovered from the means over cells: linear fields, means, missing neighbours.
#include <doctest/doctest.h>

#include <cmath>

#include "core/threads.hpp"
#include "mpm/seed_particles.hpp"
#include "mpm/stress_recovery.hpp"

using namespace polder;
using namespace polder::mpm;

namespace {

constexpr double kSpacing = 0.1;

// Points at random places of an irregular body, each with the stress that is right at the mean of its cell.
template <int D>
void check_linear_field() {
  Index<D> cells;
  cells.fill(9);
  Grid<D> grid(Point<D>{}, cells, kSpacing);
  ParticleSet<D> set;
  Point<D> lower, upper;
  lower.fill(0.1), upper.fill(0.8);
  std::array<bool, D> free{};
  const SeedRegion<D> region = seed_region<D>(grid, 2, lower, upper, free);
  seed_particles<D>(set, region, D == 3 ? Space::three_d : Space::plane_strain, 2000, 0.8, 3,
                    [](const Point<D>& x) { return x[0] + 2 * x[D - 1] < 1.7; });
  grid.activate(set.occupied_block_numbers(grid));
  set.sort(grid);
  const auto exact = [](int k, const Point<D>& x) {
    double s = 100 * (k + 1);
    for (int d = 0; d < D; ++d) s += (37 * (k + 2) - 91 * d) * x[d];
    return s;
  };
  std::vector<double> volume(grid.slots());
  std::vector<Point<D>> middle(grid.slots());
  const auto home = [&](int p) {
    Index<D> cell;
    for (int d = 0; d < D; ++d) cell[d] = static_cast<int>(set.position[d][p] / kSpacing);
    return grid.slot(cell);
  };
  for (int p = 0; p < set.slots(); ++p) {
    if (set.id[p] < 0) continue;
    const int c = home(p);
    volume[c] += set.volume[p];
    for (int d = 0; d < D; ++d) middle[c][d] += set.volume[p] * set.position[d][p];
  }
  for (int p = 0; p < set.slots(); ++p) {
    if (set.id[p] < 0) continue;
    Point<D> x = middle[home(p)];
    for (double& v : x) v /= volume[home(p)];
    for (int k = 0; k < ParticleSet<D>::kStress; ++k) set.stress[k][p] = exact(k, x);
  }
  const auto recovered = recover_stress<D>(grid, set);
  double worst = 0, before = 0;
  for (int p = 0; p < set.slots(); ++p) {
    if (set.id[p] < 0) continue;
    Point<D> x;
    for (int d = 0; d < D; ++d) x[d] = set.position[d][p];
    for (int k = 0; k < ParticleSet<D>::kStress; ++k) {
      worst = std::max(worst, std::abs(recovered[k][p] - exact(k, x)));
      before = std::max(before, std::abs(set.stress[k][p] - exact(k, x)));
    }
  }
  CHECK(before > 5);
  CHECK(worst < 1e-7);
}

}  // namespace

TEST_CASE("a linear stress is recovered exactly from its means over cells") {
  set_threads(1);
  check_linear_field<2>();
  check_linear_field<3>();
}

TEST_CASE("recovery keeps the means over cells, and is flat where there are no neighbours") {
  set_threads(1);
  Grid<2> grid({0, 0}, {6, 6}, kSpacing);
  ParticleSet<2> set;  // one column of cells
  const SeedRegion<2> region = seed_region<2>(grid, 2, {0.2, 0}, {0.3, 0.5}, {true, true});
  seed_particles<2>(set, region, Space::plane_strain, 2000, 0, 1, [](const Point<2>&) { return true; });
  grid.activate(set.occupied_block_numbers(grid));
  set.sort(grid);
  for (int p = 0; p < set.slots(); ++p)
    for (int k = 0; k < 4; ++k)
      set.stress[k][p] = std::sin(40.0 * set.position[0][p] + 17 * k * set.position[1][p]);
  const auto recovered = recover_stress<2>(grid, set);
  for (int k = 0; k < 4; ++k)
    for (int row = 0; row < 5; ++row) {
      double mean = 0, after = 0;
      std::vector<double> left, right;
      for (int p = 0; p < set.slots(); ++p) {
        if (set.id[p] < 0 || static_cast<int>(set.position[1][p] / kSpacing) != row) continue;
        mean += 0.25 * set.stress[k][p], after += 0.25 * recovered[k][p];
        (set.position[0][p] < 0.25 ? left : right).push_back(recovered[k][p]);
      }
      CHECK(after == doctest::Approx(mean).epsilon(1e-12));
      REQUIRE(left.size() == 2);
      REQUIRE(right.size() == 2);
      CHECK(left[0] + left[1] == doctest::Approx(right[0] + right[1]).epsilon(1e-9));
    }
}
