#include "mpm/boundary_set.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "mpm/plane_patch.hpp"

namespace polder::mpm {
namespace {

constexpr double kOn = 1e-6;       // a node this close to a line or plane, in cells, lies on it
constexpr double kBehind = 2.001;  // rows of nodes held behind an inner segment or patch, in cells

// Is the node constrained by the boundary, and with which normal?
template <int D>
bool constrained(const Grid<D>& grid, const BoundarySpec<D>& spec, const std::optional<PlanePatch>& patch,
                 const Index<D>& node, Point<D>& normal) {
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
  } else {
    if (!patch) return false;
    normal = patch->normal();
    const Point<D> x = grid.position(node);
    const double height = patch->height(x);
    return height <= kOn * h && height >= -kBehind * h && patch->contains(patch->project(x), kOn * h);
  }
}

}  // namespace

template <int D>
void BoundarySet<D>::tie(const Grid<D>& grid, int side) {
  const int axis = side / 2;
  std::erase_if(nodes_,
                [&](const Node& n) { return specs_[n.spec].side >= 0 && specs_[n.spec].side / 2 == axis; });
  for (int slot = 0; slot < grid.slots(); ++slot) {
    Index<D> node = grid.index(slot);
    if (node[axis] != 0) continue;
    node[axis] = grid.cells()[axis];
    const int across = grid.slot(node);
    if (across >= 0) ties_.push_back({slot, across});
  }
}

template <int D>
void BoundarySet<D>::update(const Grid<D>& grid) {
  if (revision_ == grid.revision()) return;
  revision_ = grid.revision();
  nodes_.clear();
  ties_.clear();
  held_.assign(grid.slots(), 0);
  for (std::size_t s = 0; s < specs_.size(); ++s) {
    const BoundarySpec<D>& spec = specs_[s];
    if (spec.kind == BoundaryKind::tied) {
      tie(grid, spec.side);
      continue;
    }
    std::optional<PlanePatch> patch;
    if (spec.side < 0 && !spec.patch.empty()) patch.emplace(spec.patch);
    // One rule for a node of one side: the later one.
    bool overrules = false;
    for (std::size_t e = 0; e < s; ++e) overrules |= spec.side >= 0 && specs_[e].side == spec.side;
    for (int slot = 0; slot < grid.slots(); ++slot) {
      const Index<D> node = grid.index(slot);
      bool inside = true;
      for (int d = 0; d < D; ++d) inside &= node[d] <= grid.cells()[d];
      Point<D> normal;
      if (!inside || !constrained<D>(grid, spec, patch, node, normal)) continue;
      if (overrules)
        std::erase_if(nodes_,
                      [&](const Node& n) { return n.slot == slot && specs_[n.spec].side == spec.side; });
      if (spec.kind == BoundaryKind::free) continue;
      nodes_.push_back({slot, static_cast<int>(s), normal, 0});
    }
  }
  // By node, in the order of the case, friction last.
  std::stable_sort(nodes_.begin(), nodes_.end(), [&](const Node& a, const Node& b) {
    if (a.slot != b.slot) return a.slot < b.slot;
    return specs_[a.spec].kind != BoundaryKind::friction && specs_[b.spec].kind == BoundaryKind::friction;
  });
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
  for (const auto& [a, b] : ties_) {
    const double m = sums[static_cast<std::size_t>(a) * 8], n = sums[static_cast<std::size_t>(b) * 8];
    if (!(m + n > 0)) continue;
    for (int d = 0; d < D; ++d) {
      double &u = v[static_cast<std::size_t>(a) * 4 + d], &w = v[static_cast<std::size_t>(b) * 4 + d];
      u = w = (m * u + n * w) / (m + n);
    }
  }
  thread_local std::vector<std::array<double, D>> prescribed;  // work space
  prescribed.assign(specs_.size(), {});
  for (std::size_t s = 0; s < specs_.size(); ++s)
    for (int d = 0; d < D; ++d)
      if (specs_[s].kind == BoundaryKind::velocity && specs_[s].prescribed[d])
        prescribed[s][d] = still_ ? 0.0 : specs_[s].velocity[d](time);
  for (std::size_t first = 0, next = 0; first < nodes_.size(); first = next) {
    const int slot = nodes_[first].slot;
    double* u = &v[static_cast<std::size_t>(slot) * 4];
    const double mass = sums[static_cast<std::size_t>(slot) * 8];
    double before[D];
    std::array<bool, D> driven{};  // components with a prescribed velocity
    const auto keep = [&] {
      for (int d = 0; d < D; ++d) before[d] = u[d];
    };
    const auto account = [&](int spec) {
      if (record)
        for (int d = 0; d < D; ++d) reaction_[spec][d] += mass * (u[d] - before[d]) / dt;
    };
    for (; next < nodes_.size() && nodes_[next].slot == slot; ++next) {
      Node& n = nodes_[next];
      const BoundarySpec<D>& spec = specs_[n.spec];
      keep();
      double normal = 0;
      for (int d = 0; d < D; ++d) normal += u[d] * n.normal[d];
      switch (spec.kind) {
        case BoundaryKind::free:
        case BoundaryKind::tied:
          break;
        case BoundaryKind::fixed:
          for (int d = 0; d < D; ++d) u[d] = 0;
          break;
        case BoundaryKind::velocity:
          for (int d = 0; d < D; ++d)
            if (spec.prescribed[d]) u[d] = prescribed[n.spec][d], driven[d] = true;
          break;
        case BoundaryKind::roller:
          // A side of the grid holds both ways; behind a wall inside it material may leave the wall.
          if (spec.side >= 0 || normal < 0)
            for (int d = 0; d < D; ++d) u[d] -= normal * n.normal[d];
          break;
        case BoundaryKind::friction:
          n.pressed = std::max(0.0, -normal);  // otherwise it leaves the wall, unless water seals it
          if (n.pressed > 0 || (spec.side >= 0 && !sealed_.empty() && sealed_[slot]))
            for (int d = 0; d < D; ++d) u[d] -= normal * n.normal[d];
          break;
      }
      account(n.spec);
    }
    // Friction acts on what the other boundaries of the node leave of its velocity: beside a wall the trial
    // velocity into that wall is no slip.
    for (std::size_t i = first; i < next; ++i) {
      Node& n = nodes_[i];
      const BoundarySpec<D>& spec = specs_[n.spec];
      if (spec.kind != BoundaryKind::friction) continue;
      if (!friction) {
        double away = 0;
        for (int d = 0; d < D; ++d) away += u[d] * n.normal[d];
        for (int d = 0; d < D && n.stopped; ++d)
          if (!driven[d]) u[d] = away * n.normal[d];
        continue;
      }
      n.stopped = false;
      if (!(n.pressed > 0)) continue;
      double slip = 0;
      for (int d = 0; d < D; ++d) slip += driven[d] ? 0 : u[d] * u[d];
      slip = std::sqrt(slip);
      n.stopped = slip == 0;
      if (n.stopped) continue;
      keep();
      const double share =
          sticking_ ? 0.0 : std::max(0.0, 1 - friction_share_ * spec.coefficient * n.pressed / slip);
      n.stopped = share == 0;
      for (int d = 0; d < D; ++d)
        if (!driven[d]) u[d] *= share;
      account(n.spec);
    }
  }
}

template class BoundarySet<2>;
template class BoundarySet<3>;

}  // namespace polder::mpm
