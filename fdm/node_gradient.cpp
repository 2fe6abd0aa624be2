#include "fdm/node_gradient.hpp"

#include <algorithm>

#include "core/threads.hpp"
#include "fdm/loops.hpp"

namespace polder::fdm {

template <int D>
void NodeGradient<D>::build(const WaterCells<D>& cells) {
  const Grid<D>& grid = cells.grid();
  const auto interior = cells.interior_faces();
  const auto boundary = cells.boundary_faces();
  const int mesh_faces = static_cast<int>(interior.size() + boundary.size());

  // Extensions. A face is found by the slot of the cell position on its upper side.
  struct Extension {
    int axis;
    Index<D> position;
  };
  std::vector<Extension> where, wall_where;
  extensions_.clear();
  walls_.clear();
  std::vector<int> face_at(static_cast<std::size_t>(D) * grid.slots(), -1);
  const auto at = [&](int axis, int slot) -> int& {
    return face_at[static_cast<std::size_t>(axis) * grid.slots() + slot];
  };
  for (const ActiveCell<D>& c : cells.cells())
    for (int side = 0; side < 2 * D; ++side) {
      Index<D> position = c.index;
      position[side / 2] += side % 2;
      at(side / 2, grid.slot(position)) =
          c.faces[side] >= 0 ? c.faces[side] : mesh_faces;  // a wall stays a wall
    }
  std::vector<int> extension_at(face_at.size(), -1);
  for (int b = 0; b < static_cast<int>(boundary.size()); ++b) {
    const BoundaryFace<D>& f = boundary[b];
    if (!f.free_surface) continue;
    Index<D> position = cells.cells()[f.cell].index;
    position[f.axis] += f.outward > 0 ? 2 : -1;
    const int slot = grid.slot(position);
    if (slot < 0 || at(f.axis, slot) >= 0) continue;
    const int source = static_cast<int>(interior.size()) + b;
    if (position[f.axis] == 0 || position[f.axis] == grid.cells()[f.axis]) {
      Index<D> beyond = cells.cells()[f.cell].index;
      beyond[f.axis] += f.outward;
      if (!cells.is_open_surface(beyond, 2 * f.axis + (f.outward > 0))) {
        walls_.push_back({source, source});
        wall_where.push_back({f.axis, position});
        continue;
      }
    }
    int& known = extension_at[static_cast<std::size_t>(f.axis) * grid.slots() + slot];
    if (known >= 0) {
      extensions_[known].second = source;
      continue;
    }
    known = static_cast<int>(extensions_.size());
    extensions_.push_back({source, source});
    where.push_back({f.axis, position});
  }

  // Walls, and the faces that stand in for boundaries while they are closed.
  opposite_.assign(boundary.size(), -1);
  for (const ActiveCell<D>& c : cells.cells())
    for (int side = 0; side < 2 * D; ++side) {
      const int opposite = c.faces[side ^ 1];
      if (c.faces[side] >= static_cast<int>(interior.size()))
        opposite_[c.faces[side] - interior.size()] = opposite;
      if (c.faces[side] >= 0 || opposite < 0) continue;
      Index<D> position = c.index;
      position[side / 2] += side % 2;
      walls_.push_back({opposite, opposite});
      wall_where.push_back({side / 2, position});
    }

  const int first_wall = mesh_faces + static_cast<int>(extensions_.size());
  const int empty = first_wall + static_cast<int>(walls_.size());
  gradient_.assign(empty + 1, 0);
  weight_.assign(empty + 1, 0);
  std::fill_n(weight_.begin(), interior.size(), 1.0);
  std::fill(weight_.begin() + mesh_faces, weight_.begin() + first_wall, 1.0);

  // Nodes, each with the faces that meet in it.
  nodes_.clear();
  node_at_.assign(grid.slots(), -1);
  std::vector<std::array<int, D>> used;
  const auto attach = [&](int slot, int axis, int face) {
    if (slot < 0) return;
    if (node_at_[slot] < 0) {
      node_at_[slot] = static_cast<int>(nodes_.size());
      Node n{};
      for (auto& f : n.faces) f.fill(empty);
      nodes_.push_back(n);
      used.push_back({});
    }
    const int n = node_at_[slot];
    nodes_[n].faces[axis][used[n][axis]++] = face;
  };
  for (int f = 0; f < static_cast<int>(interior.size()); ++f)
    for (int slot : interior[f].nodes) attach(slot, interior[f].axis, f);
  for (int b = 0; b < static_cast<int>(boundary.size()); ++b)
    for (int slot : boundary[b].nodes) attach(slot, boundary[b].axis, static_cast<int>(interior.size()) + b);
  const auto attach_all = [&](const std::vector<Extension>& faces, int first) {
    for (int f = 0; f < static_cast<int>(faces.size()); ++f)
      for (int m = 0; m < kMeeting; ++m) {
        Index<D> node = faces[f].position;
        for (int d = 0, bit = 0; d < D; ++d)
          if (d != faces[f].axis) node[d] += (m >> bit++) & 1;
        attach(grid.slot(node), faces[f].axis, first + f);
      }
  };
  attach_all(where, mesh_faces);
  attach_all(wall_where, first_wall);
}

template <int D>
void NodeGradient<D>::evaluate(const WaterCells<D>& cells, std::span<const BoundaryFace<D>> boundary,
                               std::span<const double> field, BoundaryValues values, WallNormal walls,
                               std::span<double> out) {
  const auto list = cells.cells();
  const auto interior = cells.interior_faces();
  const int n_interior = static_cast<int>(interior.size());
  const int n_boundary = static_cast<int>(boundary.size());
  const double per_spacing = 1 / cells.grid().spacing();
  double* const g = gradient_.data();
  double* const w = weight_.data();

  for_each(n_interior, [&](int f) {
    g[f] = (field[list[interior[f].high].slot] - field[list[interior[f].low].slot]) * per_spacing;
  });
  const double scale = values == BoundaryValues::present ? 1 : 0;
  for (int b = 0; b < n_boundary; ++b) {
    const BoundaryFace<D>& f = boundary[b];
    w[n_interior + b] = f.open ? 1 : 0;
    g[n_interior + b] = f.open ? f.outward * (scale * f.pressure - field[list[f.cell].slot]) / f.distance : 0;
  }
  const bool inward = walls == WallNormal::inward;
  for (int b = 0; inward && b < n_boundary; ++b) {
    const int source = opposite_[b];
    if (boundary[b].open || source < 0 || w[source] == 0) continue;
    if (source >= n_interior && !boundary[source - n_interior].open)
      continue;  // closed on both sides: no value
    w[n_interior + b] = 1;
    g[n_interior + b] = g[source];
  }
  double* next = g + n_interior + n_boundary;
  for (const Copy& c : extensions_) *next++ = 0.5 * (g[c.first] + g[c.second]);
  const int first_wall = static_cast<int>(next - g);
  for (int i = 0; i < static_cast<int>(walls_.size()); ++i) {
    w[first_wall + i] = inward ? w[walls_[i].first] : 0;
    g[first_wall + i] = inward ? g[walls_[i].first] : 0;
  }

  constexpr int kBlock = Grid<D>::kCells;
  parallel_for(static_cast<int>(node_at_.size()) / kBlock, [&](int block) {
    for (int slot = block * kBlock; slot < (block + 1) * kBlock; ++slot) {
      double* to = &out[static_cast<std::size_t>(slot) * kStride];
      std::fill_n(to, kStride, 0.0);
      if (node_at_[slot] < 0) continue;
      const Node& n = nodes_[node_at_[slot]];
      for (int d = 0; d < D; ++d) {
        double sum = 0, count = 0;
        for (int face : n.faces[d]) sum += g[face], count += w[face];
        if (count > 0) to[d] = sum / count;
      }
    }
  });
}

template class NodeGradient<2>;
template class NodeGradient<3>;

}  // namespace polder::fdm
