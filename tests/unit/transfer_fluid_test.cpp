// Transfers of points of a fluid against those of points that may carry stress, and against plain loops: the
// same sums at nodes and in cells, weights by the cell around a point, and moves by a nodal displacement.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "mpm/point_stencil.hpp"
#include "mpm/transfer.hpp"
#include "tests/unit/random.hpp"

using namespace polder;
using namespace polder::mpm;

namespace {

using Two = std::integral_constant<int, 2>;
using Three = std::integral_constant<int, 3>;

constexpr double kSpacing = 0.1;

// Points all over the grid, its sides included, that have moved a little since they were sorted.
template <int D>
struct Pool {
  Grid<D> grid;
  ParticleSet<D> set;
  Transfer<D> transfer;
  Reals of_cell;

  explicit Pool(AffineKind affine) : grid(origin(), cells(), kSpacing) {
    constexpr int kPoints = 500;
    set.density_solid = 1000, set.reference_half_size = 0.25 * kSpacing;
    set.wet.resize(1);
    set.conductivity.resize(1);
    if (affine != AffineKind::none)
      for (Reals& c : set.affine) c.resize(1);
    set.append(kPoints);
    for (ParticleField& f : set.fields()) f.values->resize(kPoints);
    verify::Random random(7);
    const auto place = [&](int p, double reach) {
      for (int d = 0; d < D; ++d)
        set.position[d][p] = std::clamp(set.position[d][p] + reach * (random() - 0.5), grid.origin()[d],
                                        grid.upper()[d] * (1 - 1e-12));
    };
    for (int p = 0; p < kPoints; ++p) {
      for (int d = 0; d < D; ++d) {
        set.position[d][p] = grid.origin()[d];
        set.velocity[d][p] = random() - 0.5;
        set.half_size[d][p] = (0.2 + 0.2 * random()) * kSpacing;
      }
      place(p, 2 * (grid.upper()[0] - grid.origin()[0]));
      set.wet[p] = 1, set.conductivity[p] = 1;
      set.volume[p] = 0.5 + random(), set.mass[p] = 1000 * set.volume[p];
      for (Reals& c : set.affine)
        if (!c.empty()) c[p] = random() - 0.5;
    }
    grid.activate(set.occupied_block_numbers(grid));
    set.sort(grid);
    for (int p = 0; p < set.slots(); ++p)
      if (set.id[p] >= 0) place(p, 0.8 * kSpacing);
    transfer.grid = &grid;
    transfer.bodies = {{&set, nullptr, 0.0}};
    transfer.resize();
    of_cell.resize(grid.slots());
    for (double& x : of_cell) x = 1 + random();
    transfer.weight.of_cell = &of_cell;
  }
  static Point<D> origin() {
    Point<D> x;
    x.fill(0.3);
    return x;
  }
  static Index<D> cells() {
    Index<D> n;
    n.fill(2 * Grid<D>::kSide + 3);
    return n;
  }
};

template <int D>
void check_scatter(AffineKind affine) {
  Pool<D> pool(affine);
  Reals sums, velocity, expected_sums, expected_velocity;
  scatter_fluid(pool.transfer, affine, sums, velocity);
  scatter_state(pool.transfer, affine, expected_sums, expected_velocity);
  double largest = 0, difference = 0, weight = 0, expected = 0;
  for (std::size_t i = 0; i < sums.size(); ++i) {
    largest = std::max(largest, std::abs(expected_sums[i]));
    difference = std::max(difference, std::abs(sums[i] - expected_sums[i]));
    if (i % 8 == Transfer<D>::kVolume) weight += sums[i];
  }
  CHECK(difference <= 1e-14 * largest);
  for (std::size_t i = 0; i < velocity.size(); ++i)
    difference = std::max(difference, std::abs(velocity[i] - expected_velocity[i]));
  CHECK(difference <= 1e-10);
  for (int p = 0; p < pool.set.slots(); ++p)
    if (pool.set.id[p] >= 0)
      expected += pool.set.volume[p] * pool.of_cell[pool.grid.slot(pool.set.cell_of(pool.grid, p))];
  CHECK(weight == doctest::Approx(expected).epsilon(1e-12));
}

}  // namespace

TEST_CASE_TEMPLATE("a fluid's mass, momentum and weight come to the nodes", T, Two, Three) {
  check_scatter<T::value>(AffineKind::none);
  check_scatter<T::value>(AffineKind::apic);
}

TEST_CASE_TEMPLATE("of soil in water only the grains may be weighed", T, Two, Three) {
  constexpr int D = T::value;
  Pool<D> pool(AffineKind::none);
  ParticleSet<D>& set = pool.set;
  set.density_solid = 2000;
  set.retained_water.assign(set.slots(), 0.0);
  double expected = 0;
  for (int p = 0; p < set.slots(); ++p) {
    if (set.id[p] < 0) continue;
    // Half of the volume is grains; some points retain more water than they have room for.
    set.retained_water[p] = 100.0 * (p % 10) * set.volume[p];
    expected += pool.of_cell[pool.grid.slot(set.cell_of(pool.grid, p))] * set.volume[p] *
                std::min(1.0, 0.5 + 0.1 * (p % 10));
  }
  pool.transfer.weight.grains_only = true, pool.transfer.weight.retained_density = 1000;
  Reals sums, velocity;
  scatter_state(pool.transfer, AffineKind::none, sums, velocity);
  double weight = 0;
  for (std::size_t i = Transfer<D>::kVolume; i < sums.size(); i += 8) weight += sums[i];
  CHECK(weight == doctest::Approx(expected).epsilon(1e-12));
}

TEST_CASE_TEMPLATE("a fluid's volume in the cells is that of wet soil", T, Two, Three) {
  Pool<T::value> pool(AffineKind::none);
  Reals volume, cells;
  scatter_volume(pool.transfer, volume);
  scatter_cells(pool.transfer, cells);
  REQUIRE(volume.size() * 4 == cells.size());
  double all = 0;
  for (std::size_t i = 0; i < volume.size(); ++i) {
    CHECK(volume[i] == doctest::Approx(cells[i * 4]).epsilon(1e-14));
    all += volume[i];
  }
  CHECK(all > 0);
}

TEST_CASE_TEMPLATE("points move by the displacement of the nodes, as far as they may", T, Two, Three) {
  constexpr int D = T::value;
  constexpr double kMost = 0.03 * kSpacing;
  Pool<D> pool(AffineKind::none);
  verify::Random random(11);
  Reals displacement(static_cast<std::size_t>(pool.grid.slots()) * 4, 0.0);
  for (std::size_t i = 0; i < displacement.size(); ++i)
    if (i % 4 < D) displacement[i] = 0.2 * kSpacing * (random() - 0.5);
  const auto before = pool.set.position;
  const double largest = shift_points(pool.transfer, displacement, kMost);
  double expected = 0;
  for (int p = 0; p < pool.set.slots(); ++p) {
    Point<D> x;
    for (int d = 0; d < D; ++d) x[d] = before[d][p];
    const Point<D> u = interpolate<D>(pool.grid, ShapeKind::linear, x, displacement, 4);
    for (int d = 0; d < D; ++d) {
      const double move = pool.set.id[p] < 0 ? 0.0 : std::clamp(u[d], -kMost, kMost);
      CHECK(pool.set.position[d][p] == doctest::Approx(x[d] + move).epsilon(1e-13));
      expected = std::max(expected, std::abs(move));
    }
  }
  CHECK(largest == doctest::Approx(expected).epsilon(1e-12));
}
