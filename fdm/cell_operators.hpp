// What the pressure equations have in common, cell by cell and face by face: divergence of a nodal velocity,
// mobility of a face, mean conductivity of two cells, connected sets of cells.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "fdm/node_gradient.hpp"
#include "fdm/water_cells.hpp"

namespace polder::fdm {

// Two half cells in a row: exact for flow across layers that meet at the face.
inline double harmonic_mean(double a, double b) {
  return a + b > 0 ? 2 * a * b / (a + b) : 0;
}

// Mean over the nodes of a face that carry mass (mobility > 0).
template <int D>
double face_mobility(const FaceNodes<D>& nodes, std::span<const double> mobility) {
  double sum = 0;
  int count = 0;
  for (int node : nodes) {
    sum += mobility[node];
    count += mobility[node] > 0;
  }
  return count > 0 ? sum / count : 0;
}

// Flow of the nodal velocity out of the cell [m3/s]: on each side the mean normal velocity of its nodes.
template <int D>
double cell_outflow(const ActiveCell<D>& cell, std::span<const double> velocity) {
  constexpr double kMean = 1.0 / ipow(2, D - 1);
  double sum = 0;
  for (int d = 0; d < D; ++d) {
    double low = 0, high = 0;
    for (int corner = 0; corner < ipow(2, D); ++corner) {
      const double v = velocity[static_cast<std::size_t>(cell.nodes[corner]) * NodeGradient<D>::kStride + d];
      ((corner >> d) & 1 ? high : low) += v;
    }
    sum += kMean * (high * cell.areas[2 * d + 1] - low * cell.areas[2 * d]);
  }
  return sum;
}

// Sets of active cells joined by interior faces, those left out that are `blocked` (a flag each; empty:
// none).
struct Basins {
  std::vector<int> of_cell;     // set each active cell belongs to
  std::vector<int> first_cell;  // lowest cell of each set
};
template <int D>
Basins find_basins(const WaterCells<D>& cells, std::span<const unsigned char> blocked = {}) {
  const int n = cells.count();
  std::vector<int> root(n);
  for (int c = 0; c < n; ++c) root[c] = c;
  const auto find = [&](int c) {
    while (root[c] != c) c = root[c] = root[root[c]];
    return c;
  };
  const auto interior = cells.interior_faces();
  for (std::size_t i = 0; i < interior.size(); ++i) {
    if (!blocked.empty() && blocked[i]) continue;
    const InteriorFace<D>& f = interior[i];
    const int a = find(f.low), b = find(f.high);
    root[std::max(a, b)] = std::min(a, b);
  }
  Basins basins;
  basins.of_cell.assign(n, -1);
  for (int c = 0; c < n; ++c) {
    const int first = find(c);  // the lowest number of the set, met first
    if (first == c) {
      basins.of_cell[c] = static_cast<int>(basins.first_cell.size());
      basins.first_cell.push_back(c);
    } else {
      basins.of_cell[c] = basins.of_cell[first];
    }
  }
  return basins;
}

}  // namespace polder::fdm
