#include "fdm/water_lines.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace polder::fdm {
namespace {

// Adds the length of the segment from a to b to every cell (by slot) that it crosses.
template <int D>
void add_segment(const Grid<D>& grid, const Point<D>& a, const Point<D>& b, std::map<int, double>& lengths) {
  const double h = grid.spacing();
  double length = 0;
  std::vector<double> cuts{0, 1};
  for (int d = 0; d < D; ++d) {
    const double run = b[d] - a[d];
    length += run * run;
    if (run == 0) continue;
    const double from = (std::min(a[d], b[d]) - grid.origin()[d]) / h;
    const double to = (std::max(a[d], b[d]) - grid.origin()[d]) / h;
    for (int i = std::max(0, static_cast<int>(std::ceil(from))); i <= std::min<double>(to, grid.cells()[d]);
         ++i)
      cuts.push_back((grid.origin()[d] + i * h - a[d]) / run);
  }
  length = std::sqrt(length);
  std::sort(cuts.begin(), cuts.end());
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
    const double begin = std::clamp(cuts[i], 0.0, 1.0), end = std::clamp(cuts[i + 1], 0.0, 1.0);
    if (end - begin < 1e-12) continue;
    Index<D> index;
    bool inside = true;
    for (int d = 0; d < D; ++d) {
      const double x = a[d] + 0.5 * (begin + end) * (b[d] - a[d]);
      const double at = std::floor((x - grid.origin()[d]) / h);
      inside = inside && at >= 0 && at < grid.cells()[d];
      index[d] = inside ? static_cast<int>(at) : 0;
    }
    const int slot = inside ? grid.slot(index) : -1;
    if (slot >= 0) lengths[slot] += (end - begin) * length;
  }
}

// Whether the straight way from p to q crosses the segment from a to b in the plane of the first two axes. A
// point on the line of the segment counts to its left, so that a sheet through cell centres blocks one row of
// faces.
bool crosses(const double* p, const double* q, const double* a, const double* b) {
  constexpr double kEnd = 1e-9;  // segments that meet leave no gap
  const double bx = b[0] - a[0], by = b[1] - a[1];
  const double side_p = bx * (p[1] - a[1]) - by * (p[0] - a[0]);
  const double side_q = bx * (q[1] - a[1]) - by * (q[0] - a[0]);
  if ((side_p >= 0) == (side_q >= 0)) return false;
  const double t = side_p / (side_p - side_q);
  const double x = p[0] + t * (q[0] - p[0]) - a[0], y = p[1] + t * (q[1] - p[1]) - a[1];
  const double along = (x * bx + y * by) / (bx * bx + by * by);
  return along >= -kEnd && along <= 1 + kEnd;
}

}  // namespace

template <int D>
std::vector<CrossedCell> crossed_cells(const WaterCells<D>& cells, const std::vector<Point<D>>& line) {
  const Grid<D>& grid = cells.grid();
  std::map<int, double> lengths;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) add_segment<D>(grid, line[i], line[i + 1], lengths);
  if (lengths.empty() && !line.empty()) {
    Index<D> index;
    bool inside = true;
    for (int d = 0; d < D; ++d) {
      const double at = std::floor((line[0][d] - grid.origin()[d]) / grid.spacing());
      inside = inside && at >= 0 && at < grid.cells()[d];
      index[d] = inside ? static_cast<int>(at) : 0;
    }
    const int slot = inside ? grid.slot(index) : -1;
    if (slot >= 0) lengths[slot] = 1;
  }
  std::vector<CrossedCell> crossed;
  double total = 0;
  for (const auto& [slot, length] : lengths) {
    if (!cells.active(slot)) continue;
    crossed.push_back({cells.number(slot), length});
    total += length;
  }
  std::sort(crossed.begin(), crossed.end(), [](const auto& x, const auto& y) { return x.cell < y.cell; });
  for (CrossedCell& c : crossed) c.share /= total;
  return crossed;
}

template <int D>
std::vector<unsigned char> blocked_faces(const WaterCells<D>& cells,
                                         const std::vector<WaterSheet<D>>& sheets) {
  std::vector<unsigned char> blocked;
  if (sheets.empty()) return blocked;
  const auto interior = cells.interior_faces();
  blocked.assign(interior.size(), 0);
  for (std::size_t f = 0; f < interior.size(); ++f) {
    if (D == 3 && interior[f].axis == 2) continue;
    const Point<D> p = cells.centre(cells.cells()[interior[f].low].index);
    const Point<D> q = cells.centre(cells.cells()[interior[f].high].index);
    for (const WaterSheet<D>& sheet : sheets) {
      if (D == 3 && !(p[D - 1] >= sheet.bottom && p[D - 1] <= sheet.top)) continue;
      for (std::size_t i = 0; i + 1 < sheet.points.size(); ++i)
        if (crosses(p.data(), q.data(), sheet.points[i].data(), sheet.points[i + 1].data())) blocked[f] = 1;
    }
  }
  return blocked;
}

template std::vector<CrossedCell> crossed_cells<2>(const WaterCells<2>&, const std::vector<Point<2>>&);
template std::vector<CrossedCell> crossed_cells<3>(const WaterCells<3>&, const std::vector<Point<3>>&);
template std::vector<unsigned char> blocked_faces<2>(const WaterCells<2>&, const std::vector<WaterSheet<2>>&);
template std::vector<unsigned char> blocked_faces<3>(const WaterCells<3>&, const std::vector<WaterSheet<3>>&);

}  // namespace polder::fdm
