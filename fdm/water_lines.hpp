// Wells, drains and impermeable sheets, given as lines in space: which cells they cross and which faces they
// block.
//
// A line crosses a cell over a length; a well's flow and a drain's conductance are split over its active
// cells in that proportion (a single point, or a line no longer than rounding, belongs to its cell alone). A
// sheet blocks the faces between cells whose centres lie on different sides of it: a staircase that is as
// tight as the sheet, with ends at faces. In space a sheet stands upright over the line's plan between two
// heights.
#pragma once

#include <vector>

#include "fdm/water_cells.hpp"

namespace polder::fdm {

struct CrossedCell {
  int cell;      // number of the active cell
  double share;  // of the line's length in active cells; all shares of a line sum to 1
};

// In the order of the cells' numbers. Empty if the line meets no active cell.
template <int D>
std::vector<CrossedCell> crossed_cells(const WaterCells<D>& cells, const std::vector<Point<D>>& line);

// For each interior face whether one of the sheets blocks it; empty without sheets.
template <int D>
std::vector<unsigned char> blocked_faces(const WaterCells<D>& cells,
                                         const std::vector<WaterSheet<D>>& sheets);

}  // namespace polder::fdm
