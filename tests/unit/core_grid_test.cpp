// The background grid: numbering of slots, the set of stored blocks, and fields that follow it.
#include <doctest/doctest.h>

#include <algorithm>
#include <cstdlib>
#include <set>

#include "core/grid.hpp"

using namespace polder;

namespace {

using Two = std::integral_constant<int, 2>;
using Three = std::integral_constant<int, 3>;

template <int D>
Index<D> filled(int value) {
  Index<D> i;
  i.fill(value);
  return i;
}

// f(index) for all indices of a box with `count` of them along each axis.
template <int D, class F>
void for_box(const Index<D>& count, const F& f) {
  int total = 1;
  for (int n : count) total *= n;
  for (int k = 0; k < total; ++k) {
    Index<D> i;
    for (int d = 0, rest = k; d < D; ++d) i[d] = rest % count[d], rest /= count[d];
    f(i);
  }
}

template <int D>
std::vector<int> all_blocks(const Grid<D>& grid) {
  std::vector<int> all(grid.block_numbers());
  for (int b = 0; b < grid.block_numbers(); ++b) all[b] = b;
  return all;
}

// Number of the block with this index (in blocks).
template <int D>
int number_of(const Grid<D>& grid, Index<D> block) {
  for (int& x : block) x *= Grid<D>::kSide;
  return grid.block_number(block);
}

// Largest distance along an axis, in blocks.
template <int D>
int distance(const Index<D>& a, const Index<D>& b) {
  int largest = 0;
  for (int d = 0; d < D; ++d) largest = std::max(largest, std::abs(a[d] - b[d]));
  return largest;
}

// A box whose sides are one cell short of, at, and one cell beyond a whole number of blocks.
template <int D>
Grid<D> uneven_grid() {
  constexpr int s = Grid<D>::kSide;
  if constexpr (D == 2)
    return Grid<2>({-1.5, 2}, {2 * s, 3 * s - 1}, 0.25);
  else
    return Grid<3>({-1.5, 2, 4}, {2 * s, 3 * s - 1, s + 1}, 0.25);
}

}  // namespace

TEST_CASE_TEMPLATE("slot and index are inverse to each other for every node of the box", T, Two, Three) {
  constexpr int D = T::value;
  Grid<D> grid = uneven_grid<D>();
  grid.activate(all_blocks(grid));
  Index<D> nodes = grid.cells();
  for (int& n : nodes) ++n;
  std::set<int> seen;
  for_box<D>(nodes, [&](const Index<D>& node) {
    const int slot = grid.slot(node);
    REQUIRE(slot >= 0);
    REQUIRE(slot < grid.slots());
    CHECK(grid.index(slot) == node);
    CHECK(seen.insert(slot).second);
    for (int d = 0; d < D; ++d) CHECK(grid.position(node)[d] == grid.origin()[d] + 0.25 * node[d]);
  });
  // All other slots lie beyond the upper sides and belong to no node.
  for (int slot = 0; slot < grid.slots(); ++slot) {
    if (seen.count(slot)) continue;
    const Index<D> i = grid.index(slot);
    bool beyond = false;
    for (int d = 0; d < D; ++d) beyond = beyond || i[d] > grid.cells()[d];
    CHECK(beyond);
    CHECK(grid.slot(i) == -1);
  }
}

TEST_CASE_TEMPLATE("slots run x first inside a block and leave it at its border", T, Two, Three) {
  constexpr int D = T::value, s = Grid<D>::kSide, c = Grid<D>::kCells;
  Grid<D> grid = uneven_grid<D>();
  grid.activate(all_blocks(grid));
  int stride = 1;
  for (int d = 0; d < D; ++d, stride *= s) {
    Index<D> i{};
    for (i[d] = 0; i[d] < s; ++i[d]) CHECK(grid.slot(i) == i[d] * stride);
    // The next cell is the first of the next block.
    const int next = grid.stored_block(grid.block_number(i));
    CHECK(next > 0);
    CHECK(grid.slot(i) == next * c);
    CHECK(grid.block_origin(next) == i);
  }
}

TEST_CASE_TEMPLATE("cells end before the upper sides, nodes on them, nothing is beyond", T, Two, Three) {
  constexpr int D = T::value;
  Grid<D> grid = uneven_grid<D>();
  grid.activate(all_blocks(grid));
  for (int d = 0; d < D; ++d) {
    CAPTURE(d);
    Index<D> i = filled<D>(1);
    const int n = grid.cells()[d];
    const auto at = [&](int k) -> const Index<D>& { return i[d] = k, i; };
    CHECK_FALSE(grid.is_cell(at(-1)));
    CHECK(grid.slot(at(-1)) == -1);
    CHECK(grid.is_cell(at(0)));
    CHECK(grid.is_cell(at(n - 1)));
    CHECK_FALSE(grid.is_cell(at(n)));
    CHECK(grid.slot(at(n)) >= 0);
    CHECK_FALSE(grid.is_cell(at(n + 1)));
    CHECK(grid.slot(at(n + 1)) == -1);
    CHECK(grid.upper()[d] == grid.position(at(n))[d]);
  }
}

TEST_CASE_TEMPLATE("occupied blocks come first, then their neighbours, each in lexicographic order", T, Two,
                   Three) {
  constexpr int D = T::value;
  Grid<D> grid(Point<D>{}, filled<D>(4 * Grid<D>::kSide), 1.0);  // 5 blocks along an axis
  const Index<D> corner = filled<D>(0), inner = filled<D>(3);
  const int a = number_of<D>(grid, corner), b = number_of<D>(grid, inner);
  CHECK(grid.revision() == 0);
  CHECK(grid.activate({b, a, b}));
  CHECK(grid.revision() == 1);
  CHECK(grid.occupied_blocks() == 2);
  CHECK(grid.block_index(0) == corner);
  CHECK(grid.block_index(1) == inner);
  CHECK(grid.blocks() == ipow(2, D) + ipow(3, D));  // the corner has no neighbours outside the box
  CHECK(grid.slots() == grid.blocks() * Grid<D>::kCells);
  for (int k = 3; k < grid.blocks(); ++k)
    CHECK(number_of<D>(grid, grid.block_index(k - 1)) < number_of<D>(grid, grid.block_index(k)));
  for_box<D>(filled<D>(5), [&](const Index<D>& block) {
    const bool near = distance<D>(block, corner) <= 1 || distance<D>(block, inner) <= 1;
    const int stored = grid.stored_block(number_of<D>(grid, block));
    CHECK((stored >= 0) == near);
    if (stored >= 0) CHECK(grid.block_index(stored) == block);
  });
}

TEST_CASE_TEMPLATE("the numbering changes only when the occupied blocks do", T, Two, Three) {
  constexpr int D = T::value;
  Index<D> cells = filled<D>(Grid<D>::kSide - 1);  // two blocks along x, one along the others
  cells[0] = Grid<D>::kSide;
  Grid<D> grid(Point<D>{}, cells, 1.0);
  REQUIRE(grid.block_numbers() == 2);
  CHECK(grid.activate({0}));
  CHECK_FALSE(grid.activate({0, 0}));
  CHECK(grid.revision() == 1);
  // The stored set stays the same, the roles of its blocks change.
  CHECK(grid.activate({1}));
  CHECK(grid.block_index(0)[0] == 1);
  CHECK(grid.occupied_blocks() == 1);
  CHECK(grid.activate({1, 0}));
  CHECK(grid.block_index(0)[0] == 0);
  CHECK(grid.occupied_blocks() == 2);
  CHECK(grid.activate({0}));  // the numbering of the blocks stays, but one of them has lost its points
  CHECK(grid.occupied_blocks() == 1);
  CHECK(grid.revision() == 4);
}

TEST_CASE_TEMPLATE("neighbours are the stored blocks around a block, x fastest", T, Two, Three) {
  constexpr int D = T::value;
  Grid<D> grid(Point<D>{}, filled<D>(4 * Grid<D>::kSide), 1.0);
  grid.activate({number_of<D>(grid, filled<D>(0)), number_of<D>(grid, filled<D>(2))});
  int missing_inside = 0;
  for (int block = 0; block < grid.blocks(); ++block) {
    const auto& around = grid.neighbours(block);
    CHECK(around[Grid<D>::kNeighbours / 2] == block);
    int k = 0;
    for_box<D>(filled<D>(3), [&](const Index<D>& offset) {
      Index<D> other = grid.block_index(block);
      bool inside = true;
      for (int d = 0; d < D; ++d) {
        other[d] += offset[d] - 1;
        inside = inside && other[d] >= 0 && other[d] < 5;
      }
      const int expected = inside ? grid.stored_block(number_of<D>(grid, other)) : -1;
      CHECK(around[k] == expected);
      if (inside && expected < 0) ++missing_inside;
      if (block < grid.occupied_blocks() && inside) CHECK(around[k] >= 0);
      if (expected >= 0) CHECK(grid.neighbours(expected)[Grid<D>::kNeighbours - 1 - k] == block);
      ++k;
    });
  }
  CHECK(missing_inside > 0);
}

TEST_CASE_TEMPLATE("the stencil of any point of an occupied block is stored", T, Two, Three) {
  constexpr int D = T::value, s = Grid<D>::kSide;
  Grid<D> grid(Point<D>{}, filled<D>(4 * s), 1.0);
  for (const int at : {0, 2, 3}) {  // block 4 has the nodes of the upper sides and no cell
    const Index<D> block = filled<D>(at);
    grid.activate({number_of<D>(grid, block)});
    for_box<D>(filled<D>(s + 3), [&](const Index<D>& offset) {
      Index<D> node;
      bool inside = true;
      for (int d = 0; d < D; ++d) {
        node[d] = block[d] * s - 1 + offset[d];
        inside = inside && node[d] >= 0 && node[d] <= grid.cells()[d];
      }
      CHECK((grid.slot(node) >= 0) == inside);
    });
  }
}

TEST_CASE_TEMPLATE("a field keeps its values where blocks stay, and starts anew where they come", T, Two,
                   Three) {
  constexpr int D = T::value, kWidth = 3;
  Grid<D> grid(Point<D>{}, filled<D>(6 * Grid<D>::kSide), 1.0);
  const auto value = [&](int slot, int component) {  // of the place, whatever its slot
    double x = 1 + component;
    for (int i : grid.index(slot)) x = 64 * x + i;
    return x;
  };
  const auto block = [&](int i) { return number_of<D>(grid, filled<D>(i)); };
  Reals field;
  std::vector<char> had(grid.block_numbers(), 0);
  // Blocks come and go; what was there in the step before keeps its values, also from a halo that becomes
  // occupied; what comes back does not.
  const std::vector<std::vector<int>> sets = {{1}, {2}, {1, 2, 5}, {5}, {1, 5}, {0, 1, 2, 3, 4, 5, 6}, {3}};
  for (const std::vector<int>& set : sets) {
    std::vector<int> occupied;
    for (int i : set) occupied.push_back(block(i));
    REQUIRE(grid.activate(occupied));
    grid.carry(field, kWidth, -7);
    REQUIRE(field.size() == static_cast<std::size_t>(grid.slots()) * kWidth);
    std::vector<char> has(grid.block_numbers(), 0);
    int wrong = 0;
    for (int slot = 0; slot < grid.slots(); ++slot) {
      const int number = number_of<D>(grid, grid.block_index(slot / Grid<D>::kCells));
      has[number] = 1;
      for (int c = 0; c < kWidth; ++c) {
        double& x = field[static_cast<std::size_t>(slot) * kWidth + c];
        wrong += x != (had[number] ? value(slot, c) : -7);
        x = value(slot, c);
      }
    }
    CHECK(wrong == 0);
    had = has;
  }
  CHECK(std::count(had.begin(), had.end(), 1) == ipow(3, D));
}

TEST_CASE("a field that did not exist before is filled") {
  Grid<2> grid({0, 0}, {40, 40}, 1.0);
  grid.activate({0});
  grid.activate({0, 12});
  Reals field;
  grid.carry(field, 1, 2.5);
  CHECK(field == Reals(grid.slots(), 2.5));
}
