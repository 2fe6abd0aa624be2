// Order, padding and conservation of particle sets under sorting, and points that leave the grid.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "core/error.hpp"
#include "core/particles.hpp"
#include "tests/unit/random.hpp"

using namespace polder;

namespace {

using Two = std::integral_constant<int, 2>;
using Three = std::integral_constant<int, 3>;

constexpr double kSpacing = 0.1;

template <int D>
Grid<D> make_grid() {
  Index<D> cells;
  cells.fill(3 * Grid<D>::kSide + 2);
  Point<D> origin;
  origin.fill(-0.35);
  return Grid<D>(origin, cells, kSpacing);
}

// Points in some cells of the grid, in no order, with every array in use and a value in each that tells point
// and array.
template <int D>
ParticleSet<D> make_points(const Grid<D>& grid, int n) {
  ParticleSet<D> set;
  set.name = "levee";
  set.reference_half_size = 0.025;
  set.state.resize(2);
  set.state_padding = {0.0, 3.5};
  set.group_by_cell = true;
  for (int k = 0; k < D * D; ++k) set.affine[k].resize(1);
  for (int d = 0; d < D; ++d) set.body_acceleration[d].resize(1);
  for (Reals* r : {&set.pore_water, &set.suction_stress, &set.conductivity, &set.wet}) r->resize(1);
  set.append(n);
  for (ParticleField& f : set.fields()) f.values->resize(n);
  verify::Random random(2024);
  double tag = 0;
  for (ParticleField& f : set.fields()) {
    tag += 1000;
    for (int p = 0; p < n; ++p) (*f.values)[p] = tag + p + 0.5;
  }
  for (int p = 0; p < n; ++p)
    for (int d = 0; d < D; ++d) {
      const double lowest = p % 3 == 0 ? 0 : 0.4;  // a dense part and a thin one, the rest empty
      set.position[d][p] =
          grid.origin()[d] + (lowest + 0.3 * random()) * (grid.upper()[d] - grid.origin()[d]);
    }
  return set;
}

template <int D>
Index<D> cell_of(const Grid<D>& grid, const ParticleSet<D>& set, int p) {
  Index<D> cell;
  for (int d = 0; d < D; ++d)
    cell[d] = std::min(static_cast<int>(std::floor((set.position[d][p] - grid.origin()[d]) / kSpacing)),
                       grid.cells()[d] - 1);
  return cell;
}

template <int D>
void activate_and_sort(Grid<D>& grid, ParticleSet<D>& set) {
  grid.activate(set.occupied_block_numbers(grid));
  set.sort(grid);
}

// Values of every point: by id, then in the order of fields(), without the home cell.
template <int D>
std::map<int, std::vector<double>> values_of(ParticleSet<D>& set) {
  std::map<int, std::vector<double>> all;
  for (int p = 0; p < set.slots(); ++p)
    if (set.id[p] >= 0)
      for (const ParticleField& f : set.fields())
        if (f.name != "home_cell") all[set.id[p]].push_back((*f.values)[p]);
  return all;
}

// Everything that must hold after a sort; `before`: position of each id in the arrays before it.
template <int D>
void check_order(const Grid<D>& grid, ParticleSet<D>& set, const std::vector<int>& before) {
  REQUIRE(static_cast<int>(set.ranges.size()) == grid.occupied_blocks());
  int next = 0, points = 0, bad_order = 0, bad_home = 0, bad_padding = 0;
  for (int b = 0; b < grid.occupied_blocks(); ++b) {
    const auto& range = set.ranges[b];
    CHECK(range.first == next);
    CHECK(range.count % kPackPadding == 0);
    next += range.count;
    int last_slot = -1, last_before = -1, in_block = 0;
    for (int p = range.first; p < next; ++p) {
      if (set.id[p] < 0) continue;
      ++in_block;
      if (p != range.first + in_block - 1) ++bad_order;  // padding is at the end
      const int slot = grid.slot(cell_of(grid, set, p));
      if (slot / Grid<D>::kCells != b || slot < last_slot) ++bad_order;
      if (slot == last_slot && before[set.id[p]] <= last_before) ++bad_order;  // stable
      last_slot = slot, last_before = before[set.id[p]];
      bad_home += set.home_cell[p] != slot % Grid<D>::kCells;
      CHECK(set.find(set.id[p]) == p);
    }
    points += in_block;
    CHECK(range.count - in_block < kPackPadding);  // no more padding than a pack needs
    for (int p = range.first + in_block; p < next; ++p)
      for (const ParticleField& f : set.fields()) {
        double due = 0;
        for (int d = 0; d < D; ++d) {
          if (f.values == &set.half_size[d]) due = 0.025;
          if (f.values == &set.position[d])
            due = grid.position(grid.block_origin(b))[d] + 0.5 * Grid<D>::kSide * kSpacing;
        }
        if (f.values == &set.state[1]) due = 3.5;
        bad_padding += std::abs((*f.values)[p] - due) > 1e-14;
      }
  }
  CHECK(next == set.slots());
  for (const ParticleField& f : set.fields()) CHECK(static_cast<int>(f.values->size()) == set.slots());
  CHECK(points == set.count());
  CHECK(bad_order == 0);
  CHECK(bad_home == 0);
  CHECK(bad_padding == 0);
}

template <int D>
std::vector<int> places(const ParticleSet<D>& set) {
  std::vector<int> at(set.count());
  for (int i = 0; i < set.count(); ++i) at[i] = set.find(i);
  return at;
}

}  // namespace

TEST_CASE_TEMPLATE("sorting puts points in order of block and cell, and loses nothing", T, Two, Three) {
  constexpr int D = T::value;
  Grid<D> grid = make_grid<D>();
  ParticleSet<D> set = make_points<D>(grid, 501);
  CHECK(set.count() == 501);
  CHECK(set.fields().size() == static_cast<std::size_t>(5 * D + 2 + (D == 2 ? 4 : 6) + 2 + D * D + 4 + 1));
  const auto values = values_of(set);
  const auto before = places(set);
  activate_and_sort(grid, set);
  check_order(grid, set, before);
  CHECK(set.slots() > set.count());
  CHECK(values_of(set) == values);
}

TEST_CASE_TEMPLATE("points stay in order through many motions, and a second sort changes nothing", T, Two,
                   Three) {
  constexpr int D = T::value;
  Grid<D> grid = make_grid<D>();
  ParticleSet<D> set = make_points<D>(grid, 400);
  activate_and_sort(grid, set);
  verify::Random random(2024);
  bool moved_back = false;
  for (int step = 0; step < 12; ++step) {
    for (int p = 0; p < set.slots(); ++p)
      for (int d = 0; d < D; ++d) {
        if (set.id[p] < 0) continue;
        const double lo = grid.origin()[d], hi = grid.upper()[d];
        set.position[d][p] = std::clamp(set.position[d][p] + (2 * random() - 0.9) * 1.5 * kSpacing, lo, hi);
      }
    const auto values = values_of(set);
    const auto before = places(set);
    activate_and_sort(grid, set);
    check_order(grid, set, before);
    CHECK(values_of(set) == values);
    for (int p = 1; p < set.slots(); ++p)  // points that share a cell are not in the order of their ids
      moved_back = moved_back || (set.id[p] >= 0 && set.id[p - 1] > set.id[p] &&
                                  cell_of(grid, set, p) == cell_of(grid, set, p - 1));
    const std::vector<int> ids = set.id;
    std::vector<Reals> arrays;
    for (const ParticleField& f : set.fields()) arrays.push_back(*f.values);
    set.sort(grid);
    CHECK(set.id == ids);
    std::size_t k = 0;
    for (const ParticleField& f : set.fields()) CHECK(*f.values == arrays[k++]);
  }
  CHECK(moved_back);  // otherwise stability was not tried
}

TEST_CASE_TEMPLATE("points on the upper sides belong to the last cells", T, Two, Three) {
  constexpr int D = T::value;
  // In the second grid the upper sides are the borders of blocks: those beyond have nodes only.
  Index<D> whole;
  whole.fill(2 * Grid<D>::kSide);
  for (Grid<D> grid : {make_grid<D>(), Grid<D>(Point<D>{}, whole, kSpacing)}) {
    ParticleSet<D> set = make_points<D>(grid, 2);
    for (int d = 0; d < D; ++d) set.position[d][0] = grid.origin()[d], set.position[d][1] = grid.upper()[d];
    Index<D> last = grid.cells();
    for (int& n : last) --n;
    CHECK(set.occupied_block_numbers(grid) ==
          std::vector<int>{grid.block_number(Index<D>{}), grid.block_number(last)});
    activate_and_sort(grid, set);
    check_order(grid, set, {0, 1});
    CHECK(set.home_cell[set.find(1)] == grid.slot(last) % Grid<D>::kCells);
  }
}

TEST_CASE("padding points occupy no block") {
  Grid<2> grid = make_grid<2>();
  ParticleSet<2> set = make_points<2>(grid, 3);
  for (int p = 0; p < 3; ++p) set.position[0][p] = set.position[1][p] = grid.origin()[0] + 0.55 * kSpacing;
  activate_and_sort(grid, set);
  REQUIRE(set.slots() == kPackPadding);
  for (int p = 0; p < set.slots(); ++p)
    if (set.id[p] >= 0) set.position[0][p] = grid.upper()[0] - 0.5 * kSpacing;
  CHECK(set.occupied_block_numbers(grid) == std::vector<int>{grid.block_number({grid.cells()[0] - 1, 0})});
}

TEST_CASE("two sets share a grid: each has a range for every block, perhaps an empty one") {
  Grid<2> grid = make_grid<2>();
  ParticleSet<2> a = make_points<2>(grid, 20), b = make_points<2>(grid, 9);
  for (int p = 0; p < 20; ++p) a.position[0][p] = a.position[1][p] = grid.origin()[0] + 0.01 + 0.001 * p;
  for (int p = 0; p < 9; ++p) b.position[0][p] = b.position[1][p] = grid.upper()[0] - 0.01 - 0.001 * p;
  std::vector<int> blocks = a.occupied_block_numbers(grid);
  for (int n : b.occupied_block_numbers(grid)) blocks.push_back(n);
  grid.activate(blocks);
  const auto before_a = places(a), before_b = places(b);
  a.sort(grid), b.sort(grid);
  check_order(grid, a, before_a);
  check_order(grid, b, before_b);
  REQUIRE(grid.occupied_blocks() == 2);
  CHECK(a.ranges[0].count == 24);
  CHECK(a.ranges[1].count == 0);
  CHECK(b.ranges[0].count == 0);
  CHECK(b.ranges[1].count == 16);
}

TEST_CASE("points that join later get the next ids and every array grows with them") {
  Grid<2> grid = make_grid<2>();
  ParticleSet<2> set = make_points<2>(grid, 13);
  activate_and_sort(grid, set);
  const auto values = values_of(set);
  const int slots = set.slots();
  set.append(2);
  CHECK(set.count() == 15);
  for (int i = 0; i < 2; ++i) {
    CHECK(set.find(13 + i) == slots + i);
    CHECK(set.mass[slots + i] == 0);
    set.mass[slots + i] = 7 + i;
  }
  for (const ParticleField& f : set.fields()) CHECK(static_cast<int>(f.values->size()) == slots + 2);
  const auto before = places(set);
  activate_and_sort(grid, set);
  check_order(grid, set, before);
  for (int i = 0; i < 2; ++i) CHECK(set.mass[set.find(13 + i)] == 7 + i);
  auto after = values_of(set);
  after.erase(13), after.erase(14);
  CHECK(after == values);
}

TEST_CASE_TEMPLATE("a new point takes an entry of padding in its block while there is one", T, Two, Three) {
  constexpr int D = T::value;
  Grid<D> grid = make_grid<D>();
  ParticleSet<D> set = make_points<D>(grid, 61);
  activate_and_sort(grid, set);
  const auto values = values_of(set);
  const int slots = set.slots();
  int block = 0, spare = 0;
  for (int b = 0; b < grid.occupied_blocks() && spare < 2; ++b) {
    block = b, spare = 0;
    for (int p = set.ranges[b].first; p < set.ranges[b].first + set.ranges[b].count; ++p)
      spare += set.id[p] < 0;
  }
  REQUIRE(spare >= 2);
  for (int i = 0; i < spare; ++i) {
    const int p = set.insert(block);
    REQUIRE(p >= set.ranges[block].first);
    REQUIRE(p < set.ranges[block].first + set.ranges[block].count);
    CHECK(set.id[p] == 61 + i);
    CHECK(set.find(61 + i) == p);
    for (const ParticleField& f : set.fields()) CHECK((*f.values)[p] == 0);
    for (int d = 0; d < D; ++d)
      set.position[d][p] = grid.origin()[d] + (grid.block_origin(block)[d] + 0.5) * kSpacing;
    set.mass[p] = 1;
  }
  CHECK(set.insert(block) == -1);
  CHECK(set.insert(grid.occupied_blocks()) == -1);
  CHECK(set.count() == 61 + spare);
  CHECK(set.slots() == slots);
  const auto before = places(set);
  activate_and_sort(grid, set);
  check_order(grid, set, before);
  auto after = values_of(set);
  for (int i = 0; i < spare; ++i) after.erase(61 + i);
  CHECK(after == values);
}

TEST_CASE_TEMPLATE("a point outside the grid is named with its body", T, Two, Three) {
  constexpr int D = T::value;
  Grid<D> grid = make_grid<D>();
  const double eps = 1e-9, nan = std::numeric_limits<double>::quiet_NaN();
  for (int d = 0; d < D; ++d)
    for (const double x : {grid.origin()[d] - eps, grid.upper()[d] + eps, nan}) {
      ParticleSet<D> set = make_points<D>(grid, 20);
      set.position[d][17] = x;
      CHECK_THROWS_WITH_AS(set.occupied_block_numbers(grid), doctest::Contains("point 17 of body 'levee'"),
                           NumericalError);
      set.position[d][17] = grid.upper()[d] - eps;
      CHECK_NOTHROW(set.occupied_block_numbers(grid));
    }
}
