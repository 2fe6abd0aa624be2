#include "mpm/boundary_set.hpp"

#include <cmath>

namespace polder::mpm {
namespace {

constexpr double kOn = 1e-6;       // a node this close to a line, in cells, lies on it
constexpr double kBehind = 2.001;  // rows of nodes held behind an inner segment, in cells

// Is the node constrained by the boundary, and with which normal?
template <int D>
bool constrained(const Grid<D>& grid, const BoundarySpec<D>& spec, const Index<D>& node, Point<D>& normal) {
  normal = Point<D>{};
  const double h = grid.spacing();
  if (spec.side >= 0) {
    const int axis = spec.side / 2, upper = spec.side % 2;
    if (node[axis] != (upper ? grid.cells()[axis] : 0)) return false;
    normal[axis] = upper ? -1 : 1;
    if (!spec.has_segment) return true;
    const Point<D> x = grid.position(node);
    for (int d = 0; d < D; ++d) {
      if (d == axis) continue;
      const double lo = std::min(spec.from[d], spec.to[d]), hi = std::max(spec.from[d], spec.to[d]);
      if (x[d] < lo - kOn * h || x[d] > hi + kOn * h) return false;
    }
    return true;
  }
  if constexpr (D == 2) {
    const Point<D> x = grid.position(node);
    const double tx = spec.to[0] - spec.from[0], ty = spec.to[1] - spec.from[1], length = std::hypot(tx, ty);
    normal = {-ty / length, tx / length};
    const double along = ((x[0] - spec.from[0]) * tx + (x[1] - spec.from[1]) * ty) / length;
    const double height = (x[0] - spec.from[0]) * normal[0] + (x[1] - spec.from[1]) * normal[1];
    return along >= -kOn * h && along <= length + kOn * h && height <= kOn * h && height >= -kBehind * h;
  }
  return false;
}

}  // namespace

template <int D>
void BoundarySet<D>::update(const Grid<D>& grid) {
  if (revision_ == grid.revision()) return;
  revision_ = grid.revision();
  nodes_.clear();
  held_.assign(grid.slots(), 0);
  for (std::size_t s = 0; s < specs_.size(); ++s) {
    const BoundarySpec<D>& spec = specs_[s];
    // One rule for a node of one side: the later one.
    bool overrules = false;
    for (std::size_t e = 0; e < s; ++e) overrules |= spec.side >= 0 && specs_[e].side == spec.side;
    for (int slot = 0; slot < grid.slots(); ++slot) {
      const Index<D> node = grid.index(slot);
      bool inside = true;
      for (int d = 0; d < D; ++d) inside &= node[d] <= grid.cells()[d];
      Point<D> normal;
      if (!inside || !constrained<D>(grid, spec, node, normal)) continue;
      if (overrules)
        std::erase_if(nodes_,
                      [&](const Node& n) { return n.slot == slot && specs_[n.spec].side == spec.side; });
      if (spec.kind == BoundaryKind::free) continue;
      nodes_.push_back({slot, static_cast<int>(s), normal});
    }
  }
  for (const Node& n : nodes_) {
    const BoundarySpec<D>& spec = specs_[n.spec];
    for (int d = 0; d < D; ++d) {
      const bool across = (spec.kind == BoundaryKind::roller || spec.kind == BoundaryKind::friction) &&
                          std::abs(n.normal[d]) > 1 - 1e-12;
      if (spec.kind == BoundaryKind::fixed || across ||
          (spec.kind == BoundaryKind::velocity && spec.prescribed[d]))
        held_[n.slot] |= static_cast<std::uint8_t>(1u << d);
    }
  }
}

template <int D>
void BoundarySet<D>::apply(double time, double dt, const Reals& sums, Reals& v, bool friction, bool record) {
  if (record) reaction_.assign(specs_.size(), Point<D>{});
  std::vector<std::array<double, D>> prescribed(specs_.size());
  for (std::size_t s = 0; s < specs_.size(); ++s)
    for (int d = 0; d < D; ++d)
      if (specs_[s].kind == BoundaryKind::velocity && specs_[s].prescribed[d])
        prescribed[s][d] = specs_[s].velocity[d](time);
  for (const Node& n : nodes_) {
    double* u = &v[static_cast<std::size_t>(n.slot) * 4];
    const double mass = sums[static_cast<std::size_t>(n.slot) * 8];
    double before[D];
    for (int d = 0; d < D; ++d) before[d] = u[d];
    const BoundarySpec<D>& spec = specs_[n.spec];
    switch (spec.kind) {
      case BoundaryKind::free:
        break;
      case BoundaryKind::fixed:
        for (int d = 0; d < D; ++d) u[d] = 0;
        break;
      case BoundaryKind::velocity:
        for (int d = 0; d < D; ++d)
          if (spec.prescribed[d]) u[d] = prescribed[n.spec][d];
        break;
      case BoundaryKind::roller: {
        double normal = 0;
        for (int d = 0; d < D; ++d) normal += u[d] * n.normal[d];
        // A side of the grid holds both ways; behind a segment inside it material may leave the wall.
        if (spec.side >= 0 || normal < 0)
          for (int d = 0; d < D; ++d) u[d] -= normal * n.normal[d];
        break;
      }
      case BoundaryKind::friction: {
        double normal = 0;
        for (int d = 0; d < D; ++d) normal += u[d] * n.normal[d];
        if (normal >= 0) break;  // leaves the wall
        double slip = 0;
        for (int d = 0; d < D; ++d) u[d] -= normal * n.normal[d], slip += u[d] * u[d];
        slip = std::sqrt(slip);
        if (!friction || slip == 0) break;
        const double keep = sticking_ ? 0.0 : std::max(0.0, 1 + spec.coefficient * normal / slip);
        for (int d = 0; d < D; ++d) u[d] *= keep;
        break;
      }
    }
    if (record)
      for (int d = 0; d < D; ++d) reaction_[n.spec][d] += mass * (u[d] - before[d]) / dt;
  }
}

template class BoundarySet<2>;
template class BoundarySet<3>;

}  // namespace polder::mpm
