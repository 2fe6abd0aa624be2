// Mechanical boundaries of the grid: what they do to nodal velocities, and the forces they report for it.
#include "mpm/boundary_set.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

using namespace polder;
using namespace polder::mpm;

namespace {

using Two = std::integral_constant<int, 2>;
using Three = std::integral_constant<int, 3>;

constexpr double kStep = 0.02;

// A grid stored everywhere, with another mass at every node.
template <int D>
struct Nodes {
  Grid<D> grid;
  Reals sums, v;

  explicit Nodes(int cells = 10) : grid(Point<D>{}, filled(cells), 0.1) {
    std::vector<int> all;
    for (int b = 0; b < grid.block_numbers(); ++b) all.push_back(b);
    grid.activate(all);
    resize();
  }
  static Index<D> filled(int n) {
    Index<D> i;
    i.fill(n);
    return i;
  }
  void resize() {
    sums.assign(static_cast<std::size_t>(grid.slots()) * 8, 0.0);
    for (int s = 0; s < grid.slots(); ++s) sums[static_cast<std::size_t>(s) * 8] = mass(s);
    v.assign(static_cast<std::size_t>(grid.slots()) * 4, 0.0);
  }
  double mass(int slot) const { return 1 + slot % 7; }
  void set(const Point<D>& u) {
    for (int s = 0; s < grid.slots(); ++s) set(s, u);
  }
  void set(int slot, const Point<D>& u) {
    for (int d = 0; d < D; ++d) v[static_cast<std::size_t>(slot) * 4 + d] = u[d];
  }
  Point<D> at(int slot) const {
    Point<D> u;
    for (int d = 0; d < D; ++d) u[d] = v[static_cast<std::size_t>(slot) * 4 + d];
    return u;
  }
  Point<D> at(const Index<D>& node) const { return at(grid.slot(node)); }
  // f(slot, node) for all nodes of the box.
  template <class F>
  void each(const F& f) const {
    for (int s = 0; s < grid.slots(); ++s) {
      const Index<D> i = grid.index(s);
      if (std::all_of(i.begin(), i.end(), [&](int n) { return n <= grid.cells()[0]; })) f(s, i);
    }
  }
};

template <int D>
BoundarySpec<D> on_side(BoundaryKind kind, int side, double coefficient = 0) {
  BoundarySpec<D> spec;
  spec.kind = kind, spec.side = side, spec.coefficient = coefficient;
  return spec;
}

BoundarySpec<2> on_segment(BoundaryKind kind, Point<2> from, Point<2> to, int side = -1) {
  BoundarySpec<2> spec;
  spec.kind = kind, spec.side = side, spec.has_segment = true, spec.from = from, spec.to = to;
  return spec;
}

template <int D>
void check_close(const Point<D>& a, const Point<D>& b, double scale = 1) {
  for (int d = 0; d < D; ++d) {
    CAPTURE(d);
    CHECK(std::abs(a[d] - b[d]) < 1e-12 * scale);
  }
}

// Applies the boundaries to nodes that all move with `start`. Every node must then move with due(slot, node),
// and the boundaries together must report the change of momentum.
template <int D, class F>
void check_motion(Nodes<D>& nodes, BoundarySet<D>& boundaries, const Point<D>& start, bool friction,
                  const F& due) {
  boundaries.update(nodes.grid);
  nodes.set(start);
  boundaries.apply(0, kStep, nodes.sums, nodes.v, friction, true);
  Point<D> force{}, reaction{};
  nodes.each([&](int slot, const Index<D>& node) {
    const Point<D> expected = due(slot, node);
    check_close<D>(nodes.at(slot), expected);
    for (int d = 0; d < D; ++d) force[d] += nodes.mass(slot) * (expected[d] - start[d]) / kStep;
  });
  for (std::size_t i = 0; i < boundaries.specs().size(); ++i)
    for (int d = 0; d < D; ++d) reaction[d] += boundaries.reaction(static_cast<int>(i))[d];
  check_close<D>(reaction, force, 1e5);
}

template <int D>
Point<D> some_velocity(double sign) {
  Point<D> u;
  for (int d = 0; d < D; ++d) u[d] = sign * (0.3 + d);
  return u;
}

}  // namespace

TEST_CASE_TEMPLATE("a fixed side stops its nodes, a roller their normal velocity both ways", T, Two, Three) {
  constexpr int D = T::value;
  Nodes<D> nodes;
  for (int side = 0; side < 2 * D; ++side)
    for (const double sign : {1.0, -1.0})
      for (const BoundaryKind kind : {BoundaryKind::fixed, BoundaryKind::roller, BoundaryKind::free}) {
        CAPTURE(side);
        CAPTURE(static_cast<int>(kind));
        const int axis = side / 2, last = side % 2 ? nodes.grid.cells()[axis] : 0;
        const Point<D> u = some_velocity<D>(sign);
        BoundarySet<D> boundaries({on_side<D>(kind, side)});
        int on = 0;
        check_motion<D>(nodes, boundaries, u, true, [&](int, const Index<D>& node) {
          Point<D> due = u;
          if (node[axis] != last || kind == BoundaryKind::free) return due;
          ++on;
          if (kind == BoundaryKind::fixed) due.fill(0);
          due[axis] = 0;
          return due;
        });
        CHECK(on == (kind == BoundaryKind::free ? 0 : ipow(11, D - 1)));
        nodes.each([&](int slot, const Index<D>& node) {
          const int all = kind == BoundaryKind::fixed ? (1 << D) - 1 : 1 << axis;
          const bool held = node[axis] == last && kind != BoundaryKind::free;
          CHECK(boundaries.held_components()[slot] == (held ? all : 0));
        });
      }
}

TEST_CASE("a prescribed velocity follows its function of time in its components only") {
  Nodes<3> nodes;
  BoundarySpec<3> spec = on_side<3>(BoundaryKind::velocity, 5);
  spec.prescribed = {true, false, true};
  spec.velocity[0] = [](double t) { return 0.5 * t; };
  spec.velocity[2] = [](double t) { return t < 2 ? -0.1 : 0.0; };
  BoundarySet<3> boundaries({spec});
  boundaries.update(nodes.grid);
  const Point<3> start{1, 2, 3};
  for (const double t : {0.0, 1.0, 3.0}) {
    nodes.set(start);
    boundaries.apply(t, kStep, nodes.sums, nodes.v, true, true);
    const Point<3> due{0.5 * t, 2, t < 2 ? -0.1 : 0.0};
    double mass = 0;
    nodes.each([&](int slot, const Index<3>& node) {
      check_close<3>(nodes.at(slot), node[2] == 10 ? due : start);
      CHECK(boundaries.held_components()[slot] == (node[2] == 10 ? 0b101 : 0));
      if (node[2] == 10) mass += nodes.mass(slot);
    });
    for (int d = 0; d < 3; ++d)
      CHECK(boundaries.reaction(0)[d] == doctest::Approx(mass * (due[d] - start[d]) / kStep));
  }
}

TEST_CASE_TEMPLATE("friction: soil sticks, slips or leaves, on every side", T, Two, Three) {
  constexpr int D = T::value;
  Nodes<D> nodes;
  const double mu = 0.4;
  for (int side = 0; side < 2 * D; ++side) {
    CAPTURE(side);
    const int axis = side / 2, last = side % 2 ? 10 : 0;
    const double inward = side % 2 ? -1 : 1;
    BoundarySet<D> boundaries({on_side<D>(BoundaryKind::friction, side, mu)});
    // Tangential speed 5 (3 and 4 in 3D) and what pressing with `normal` leaves of it.
    const auto velocity = [&](double normal, double share) {
      Point<D> u;
      for (int d = 0, k = 0; d < D; ++d)
        u[d] = d == axis ? inward * normal : share * (D == 2 ? -5 : k++ ? 4 : -3);
      return u;
    };
    const auto check = [&](double normal, const Point<D>& due, bool friction = true) {
      const Point<D> start = velocity(normal, 1);
      check_motion<D>(nodes, boundaries, start, friction,
                      [&](int, const Index<D>& node) { return node[axis] == last ? due : start; });
    };
    check(-2, velocity(0, 1 - mu * 2 / 5));  // slips: loses 0.4 times 2
    const Point<D> force = boundaries.reaction(0);
    double tangential = 0;
    for (int d = 0; d < D; ++d)
      if (d != axis) tangential += force[d] * force[d];
    CHECK(std::sqrt(tangential) == doctest::Approx(mu * force[axis] * inward));
    check(-12.5001, velocity(0, 0));           // sticks: 0.4 times 12.5 is all it has
    check(-12.499, velocity(0, 1 - 0.99992));  // just not
    check(3, velocity(3, 1));                  // leaves with what it has
    check(0, velocity(0, 1));                  // touches without pressing
    check(-2, velocity(0, 1), false);          // second mapping: no friction again
    check(3, velocity(3, 1), false);
    boundaries.set_sticking(true);
    check(-0.01, velocity(0, 0));
    check(3, velocity(3, 1));
    check(-0.01, velocity(0, 1), false);
    boundaries.set_sticking(false);
    check(-2, velocity(0, 1 - mu * 2 / 5));
    nodes.each([&](int slot, const Index<D>& node) {
      CHECK(boundaries.held_components()[slot] == (node[axis] == last ? 1 << axis : 0));
    });
  }
}

TEST_CASE_TEMPLATE("sealed nodes are held both ways, and what pulls has no friction", T, Two, Three) {
  constexpr int D = T::value;
  Nodes<D> nodes;
  BoundarySet<D> boundaries({on_side<D>(BoundaryKind::friction, 2, 0.5)});
  const auto sealed = [](const Index<D>& node) { return node[0] < 4; };
  std::vector<std::uint8_t> flags(nodes.grid.slots(), 0);
  nodes.each([&](int slot, const Index<D>& node) { flags[slot] = sealed(node); });
  boundaries.set_sealed(flags);
  Point<D> pulled{}, pressed{};
  pulled[0] = 3, pulled[1] = 2, pressed[0] = 3, pressed[1] = -2;
  for (const bool sticking : {false, true}) {
    boundaries.set_sticking(sticking);
    check_motion<D>(nodes, boundaries, pulled, true, [&](int, const Index<D>& node) {
      Point<D> due = pulled;
      if (node[1] == 0 && sealed(node)) due[1] = 0;
      return due;
    });
    CHECK(boundaries.reaction(0)[1] < 0);  // the wall pulls at the soil
    CHECK(boundaries.reaction(0)[0] == 0);
    // What presses meets friction, sealed or not.
    check_motion<D>(nodes, boundaries, pressed, true, [&](int, const Index<D>& node) {
      Point<D> due = pressed;
      if (node[1] == 0) due[1] = 0, due[0] = sticking ? 0 : 3 - 0.5 * 2;
      return due;
    });
  }
  boundaries.set_sealed({});
  check_motion<D>(nodes, boundaries, pulled, true, [&](int, const Index<D>&) { return pulled; });
}

TEST_CASE("sealing means sides of the grid, not walls inside it") {
  Nodes<2> nodes;
  BoundarySet<2> boundaries({on_segment(BoundaryKind::friction, {0.2, 0.5}, {0.8, 0.5})});
  boundaries.set_sealed(std::vector<std::uint8_t>(nodes.grid.slots(), 1));
  check_motion<2>(nodes, boundaries, {1, 2}, true, [](int, const Index<2>&) { return Point<2>{1, 2}; });
}

TEST_CASE("a segment inside the grid holds the nodes on and behind it against motion into it") {
  Nodes<2> nodes(12);
  struct Wall {
    Point<2> from, to;
  };
  for (const Wall& wall : {Wall{{0.2, 0.6}, {0.8, 0.6}}, Wall{{0.6, 0.9}, {0.6, 0.3}},
                           Wall{{0.9, 0.9}, {0.3, 0.3}}, Wall{{0.2, 0.7}, {0.8, 0.4}}}) {
    const double tx = wall.to[0] - wall.from[0], ty = wall.to[1] - wall.from[1], l = std::hypot(tx, ty);
    const Point<2> tangent{tx / l, ty / l}, normal{-ty / l, tx / l};  // the soil lies to the left
    const auto velocity = [&](double along, double across) {
      return Point<2>{along * tangent[0] + across * normal[0], along * tangent[1] + across * normal[1]};
    };
    const auto behind = [&](const Index<2>& node) {  // on the wall or up to two cells behind it
      const double x = 0.1 * node[0] - wall.from[0], y = 0.1 * node[1] - wall.from[1];
      const double along = x * tangent[0] + y * tangent[1], across = x * normal[0] + y * normal[1];
      return along > -1e-8 && along < l + 1e-8 && across < 1e-8 && across > -0.2 - 2e-4;
    };
    int held = 0;
    nodes.each([&](int, const Index<2>& node) { held += behind(node); });
    CHECK(held > 8);
    for (const BoundaryKind kind : {BoundaryKind::roller, BoundaryKind::friction, BoundaryKind::fixed}) {
      CAPTURE(static_cast<int>(kind));
      BoundarySpec<2> spec = on_segment(kind, wall.from, wall.to);
      spec.coefficient = 0.25;
      BoundarySet<2> boundaries({spec});
      const double slip = kind == BoundaryKind::roller ? 4 : kind == BoundaryKind::friction ? 3.5 : 0;
      check_motion<2>(nodes, boundaries, velocity(4, -2), true, [&](int, const Index<2>& node) {
        return behind(node) ? velocity(slip, 0) : velocity(4, -2);
      });
      check_motion<2>(nodes, boundaries, velocity(4, 2), true, [&](int, const Index<2>& node) {
        return kind == BoundaryKind::fixed && behind(node) ? Point<2>{} : velocity(4, 2);
      });
    }
  }
}

TEST_CASE("a later boundary overrules earlier ones where they share a side, and only there") {
  Nodes<2> nodes;
  const Point<2> u{1, -2};
  const auto part = [](const Index<2>& node) { return node[0] >= 3 && node[0] <= 6; };
  for (const BoundaryKind later : {BoundaryKind::roller, BoundaryKind::free, BoundaryKind::friction}) {
    CAPTURE(static_cast<int>(later));
    BoundarySpec<2> over = on_segment(later, {0.6, 0}, {0.3, 0}, 2);
    over.coefficient = 0.25;
    BoundarySet<2> boundaries({on_side<2>(BoundaryKind::fixed, 2), over});
    const Point<2> due = later == BoundaryKind::roller ? Point<2>{1, 0}
                         : later == BoundaryKind::free ? u
                                                       : Point<2>{0.5, 0};
    double first = 0, second = 0;
    check_motion<2>(nodes, boundaries, u, true, [&](int slot, const Index<2>& node) {
      if (node[1] != 0) return u;
      (part(node) ? second : first) += nodes.mass(slot);
      return part(node) ? due : Point<2>{};
    });
    // Each reports its own nodes.
    for (int d = 0; d < 2; ++d) {
      CHECK(boundaries.reaction(0)[d] == doctest::Approx(-first * u[d] / kStep));
      CHECK(boundaries.reaction(1)[d] == doctest::Approx(second * (due[d] - u[d]) / kStep));
    }
    // The other way round the whole side has the last word.
    BoundarySet<2> reversed({over, on_side<2>(BoundaryKind::fixed, 2)});
    check_motion<2>(nodes, reversed, u, true,
                    [&](int, const Index<2>& node) { return node[1] == 0 ? Point<2>{} : u; });
    check_close<2>(reversed.reaction(0), {0, 0});
  }
}

TEST_CASE("at a corner of two sides both act, the later one last") {
  Nodes<2> nodes;
  BoundarySpec<2> push = on_side<2>(BoundaryKind::velocity, 0);
  push.prescribed = {true, false};
  push.velocity[0] = [](double) { return 0.3; };
  const BoundarySpec<2> base = on_side<2>(BoundaryKind::fixed, 2);
  const Point<2> u{1, -2};
  for (const bool push_last : {false, true}) {
    BoundarySet<2> boundaries(push_last ? std::vector{base, push} : std::vector{push, base});
    check_motion<2>(nodes, boundaries, u, true, [&](int, const Index<2>& node) {
      if (node[0] == 0 && node[1] == 0) return Point<2>{push_last ? 0.3 : 0.0, 0.0};
      if (node[1] == 0) return Point<2>{};
      return node[0] == 0 ? Point<2>{0.3, -2} : u;
    });
  }
  BoundarySet<2> rollers({on_side<2>(BoundaryKind::roller, 1), on_side<2>(BoundaryKind::roller, 3)});
  check_motion<2>(nodes, rollers, u, true, [&](int, const Index<2>& node) {
    return Point<2>{node[0] == 10 ? 0 : u[0], node[1] == 10 ? 0 : u[1]};
  });
  CHECK(rollers.held_components()[nodes.grid.slot({10, 10})] == 0b11);
}

TEST_CASE("reactions are those of the last recorded step") {
  Nodes<2> nodes;
  BoundarySet<2> boundaries({on_side<2>(BoundaryKind::roller, 2)});
  check_close<2>(boundaries.reaction(0), {0, 0});
  boundaries.update(nodes.grid);
  const auto apply = [&](double v, bool record) {
    nodes.set({0, v});
    boundaries.apply(0, kStep, nodes.sums, nodes.v, true, record);
    return boundaries.reaction(0)[1];
  };
  const double once = apply(-1, true);
  CHECK(once > 0);
  CHECK(apply(-5, false) == once);
  CHECK(apply(-1, true) == once);  // not the sum of two
  CHECK(apply(-2, true) == doctest::Approx(2 * once));
}

TEST_CASE("the held nodes follow the blocks of the grid") {
  Nodes<2> nodes(40);
  BoundarySet<2> boundaries({on_side<2>(BoundaryKind::fixed, 2), on_side<2>(BoundaryKind::roller, 1)});
  for (const Index<2>& cell : {Index<2>{1, 1}, Index<2>{39, 39}, Index<2>{39, 1}, Index<2>{20, 20}}) {
    nodes.grid.activate({nodes.grid.block_number(cell)});
    nodes.resize();
    const Point<2> u{1, 2};
    check_motion<2>(nodes, boundaries, u, true, [&](int, const Index<2>& node) {
      if (node[1] == 0) return Point<2>{};
      return node[0] == 40 ? Point<2>{0, 2} : u;
    });
    CHECK(static_cast<int>(boundaries.held_components().size()) == nodes.grid.slots());
    nodes.each([&](int slot, const Index<2>& node) {  // nothing is left of what the slot was before
      CHECK(boundaries.held_components()[slot] == (node[1] == 0 ? 0b11 : node[0] == 40 ? 0b01 : 0));
    });
  }
}

TEST_CASE("tied sides move with their common momentum, and nothing else holds them") {
  Nodes<2> nodes;
  std::vector<BoundarySpec<2>> specs;
  for (int side = 0; side < 4; ++side) specs.push_back(on_side<2>(BoundaryKind::roller, side));
  specs.push_back(on_side<2>(BoundaryKind::tied, 0));
  specs.push_back(on_side<2>(BoundaryKind::fixed, 2));
  BoundarySet<2> boundaries(specs);
  boundaries.update(nodes.grid);
  nodes.each([&](int slot, const Index<2>& node) { nodes.set(slot, {0.1 * node[0] + 0.2, -0.3 * node[0]}); });
  const int n = nodes.grid.cells()[0];
  boundaries.apply(0, kStep, nodes.sums, nodes.v, true, false);
  for (int j = 0; j <= n; ++j) {
    CAPTURE(j);
    const int a = nodes.grid.slot({0, j}), b = nodes.grid.slot({n, j});
    const double share = nodes.mass(b) / (nodes.mass(a) + nodes.mass(b));
    const Point<2> common{0.2 + share * 0.1 * n, j == n ? 0.0 : -share * 0.3 * n};  // the top is a roller
    const Point<2> due = j == 0 ? Point<2>{} : common;
    check_close<2>(nodes.at(a), due);
    check_close<2>(nodes.at(b), due);
  }
  check_close<2>(nodes.at(Index<2>{3, 4}), {0.5, -0.9});
}
