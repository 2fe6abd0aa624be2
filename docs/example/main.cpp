// A program outside Polder that uses its background grid: stores the blocks under a levee's cross-section and
// moves a cell field along when the levee slides. Lengths in metres.
#include <cmath>
#include <cstdio>
#include <vector>

#include "core/grid.hpp"
#include "core/simd_level.hpp"
#include "core/threads.hpp"

namespace {

// Crest 3 m wide and 3 m high, slope 1:2, shifted by `shift` to the right.
bool inside_levee(double x, double y, double shift) {
  x -= shift;
  return x >= 0 && y >= 0 && y <= 3 && x <= 3 + 2 * (3 - y);
}

// Cells whose centre lies in the levee.
std::vector<polder::Index<2>> levee_cells(const polder::Grid<2>& grid, double shift) {
  std::vector<polder::Index<2>> cells;
  const double half = 0.5 * grid.spacing();
  for (int j = 0; j < grid.cells()[1]; ++j)
    for (int i = 0; i < grid.cells()[0]; ++i) {
      const polder::Point<2> corner = grid.position({i, j});
      if (inside_levee(corner[0] + half, corner[1] + half, shift)) cells.push_back({i, j});
    }
  return cells;
}

bool activate(polder::Grid<2>& grid, const std::vector<polder::Index<2>>& cells) {
  std::vector<int> blocks;
  for (const auto& cell : cells) blocks.push_back(grid.block_number(cell));
  return grid.activate(blocks);
}

double area(const polder::Grid<2>& grid, const polder::Reals& fill) {
  double sum = 0;
  for (const double f : fill) sum += f;
  return sum * grid.spacing() * grid.spacing();
}

}  // namespace

int main() {
  polder::Grid<2> grid({0.0, 0.0}, {120, 40}, 0.1);
  const auto cells = levee_cells(grid, 0.0);
  activate(grid, cells);

  polder::Reals fill(grid.slots(), 0.0);
  for (const auto& cell : cells) fill[grid.slot(cell)] = 1.0;
  const double before = area(grid, fill);
  std::printf("vector level %s, %d threads\n", polder::to_string(polder::simd_level()).c_str(),
              polder::threads());
  std::printf("%d blocks hold soil, %d stored, %d slots; area %.2f m2\n", grid.occupied_blocks(),
              grid.blocks(), grid.slots(), before);

  // One block to the right: the numbering changes; what the levee covers before and after keeps its values.
  const bool renumbered = activate(grid, levee_cells(grid, 0.8));
  grid.carry(fill);
  std::printf("moved by 0.8 m: renumbered %s, area carried %.2f m2\n", renumbered ? "yes" : "no",
              area(grid, fill));

  const bool exact = std::abs(before - 18.0) < 1e-9 && std::abs(area(grid, fill) - before) < 1e-9;
  return renumbered && exact ? 0 : 1;
}
