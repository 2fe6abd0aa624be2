// Loads on material surfaces and boundaries on patches: forces, areas and normals, at rest and after motion.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "core/threads.hpp"
#include "mpm/boundary_set.hpp"
#include "mpm/plane_patch.hpp"
#include "mpm/surface_load.hpp"

using namespace polder;
using namespace polder::mpm;

namespace {

using Matrix = std::array<std::array<double, 3>, 3>;

constexpr double kPressure = 1234.5;

// A grid that is stored everywhere.
template <int D>
Grid<D> full_grid(int cells, double spacing) {
  Index<D> n;
  n.fill(cells);
  Grid<D> grid(Point<D>{}, n, spacing);
  std::vector<int> all;
  for (int b = 0; b < grid.block_numbers(); ++b) all.push_back(b);
  grid.activate(all);
  return grid;
}

double determinant(const Matrix& f) {
  return f[0][0] * (f[1][1] * f[2][2] - f[1][2] * f[2][1]) -
         f[0][1] * (f[1][0] * f[2][2] - f[1][2] * f[2][0]) +
         f[0][2] * (f[1][0] * f[2][1] - f[1][1] * f[2][0]);
}

// cof(F) a: what the vector area a becomes under the uniform deformation F (Nanson).
Point<3> deformed_area(const Matrix& f, const Point<3>& a) {
  Point<3> r{};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
      r[i] += (f[i1][j1] * f[i2][j2] - f[i1][j2] * f[i2][j1]) * a[j];
    }
  return r;
}

// Sums of nodes with unit mass.
template <int D>
Reals unit_masses(const Grid<D>& grid) {
  Reals sums(static_cast<std::size_t>(grid.slots()) * 8, 0.0);
  for (std::size_t i = 0; i < sums.size(); i += 8) sums[i] = 1;
  return sums;
}

// Force lanes of all nodes together.
template <int D>
Point<D> nodal_sum(const Grid<D>& grid, const Reals& sums) {
  Point<D> f{};
  for (int s = 0; s < grid.slots(); ++s)
    for (int d = 0; d < D; ++d) f[d] += sums[static_cast<std::size_t>(s) * 8 + 1 + D + d];
  return f;
}

// Their moment about the origin.
Point<3> nodal_moment(const Grid<3>& grid, const Reals& sums) {
  Point<3> m{};
  for (int s = 0; s < grid.slots(); ++s) {
    const Point<3> x = grid.position(grid.index(s));
    const double* f = &sums[static_cast<std::size_t>(s) * 8 + 4];
    for (int d = 0; d < 3; ++d) m[d] += x[(d + 1) % 3] * f[(d + 2) % 3] - x[(d + 2) % 3] * f[(d + 1) % 3];
  }
  return m;
}

template <int D>
void check_close(const Point<D>& a, const Point<D>& b, double scale) {
  for (int d = 0; d < D; ++d) {
    CAPTURE(d);
    CHECK(std::abs(a[d] - b[d]) < 1e-12 * scale);
  }
}

struct Surface {
  const char* name;
  std::vector<Point<3>> corners;
  Point<3> area;  // vector area
};

// Plane surfaces with known areas. The tilted ones lie in the plane z = 0.9 - 0.5 x.
std::vector<Surface> surfaces() {
  return {
      {"flat", {{0.2, 0.2, 0.8}, {0.2, 0.9, 0.8}, {1.0, 0.9, 0.8}, {1.0, 0.2, 0.8}}, {0, 0, -0.56}},
      {"tilted", {{0.2, 0.2, 0.8}, {0.2, 0.9, 0.8}, {1.0, 0.9, 0.4}, {1.0, 0.2, 0.4}}, {-0.28, 0, -0.56}},
      {"triangle", {{0.2, 0.2, 0.8}, {0.2, 0.93, 0.8}, {1.0, 0.3, 0.4}}, {-0.146, 0, -0.292}},
      {"L",
       {{0.2, 0.2, 0.8},
        {0.2, 0.9, 0.8},
        {0.43, 0.9, 0.685},
        {0.43, 0.5, 0.685},
        {1.0, 0.5, 0.4},
        {1.0, 0.2, 0.4}},
       {-0.5 * (0.8 * 0.3 + 0.23 * 0.4), 0, -(0.8 * 0.3 + 0.23 * 0.4)}},
  };
}

}  // namespace

TEST_CASE("a patch is cut into pieces that fill it and share their corners") {
  for (const Surface& s : surfaces()) {
    CAPTURE(s.name);
    const PlanePatch patch(s.corners);
    const double area = std::hypot(s.area[0], s.area[1], s.area[2]);
    CHECK(patch.area() == doctest::Approx(area).epsilon(1e-13));
    for (int d = 0; d < 3; ++d) CHECK(patch.normal()[d] == doctest::Approx(s.area[d] / area).epsilon(1e-13));
    for (const double size : {2.0, 0.13, 0.05}) {
      const PatchPieces cut = cut_patch(patch.corners(), size);
      double sum = 0;
      for (const std::vector<int>& p : cut.pieces) {
        std::vector<Point<3>> x;
        for (const int v : p) x.push_back({cut.vertices[v][0], cut.vertices[v][1], 0});
        const double piece = vector_area(x)[2];
        CHECK(piece > 0);
        CHECK(piece < size * size * (1 + 1e-9));
        sum += piece;
      }
      CHECK(sum == doctest::Approx(area).epsilon(1e-12));
      // No two vertices in one place.
      std::set<std::array<long long, 2>> places;
      for (const Point<2>& v : cut.vertices)
        places.insert({std::llround(v[0] * 1e8), std::llround(v[1] * 1e8)});
      CHECK(places.size() == cut.vertices.size());
    }
  }
  // A rectangle becomes a lattice of equal rectangles.
  const PatchPieces lattice = cut_patch({{0, 0}, {0.8, 0}, {0.8, 0.5}, {0, 0.5}}, 0.1);
  CHECK(lattice.pieces.size() == 40);
  CHECK(lattice.vertices.size() == 54);
}

TEST_CASE("the grid gets pressure times area along the normal, before and after motion") {
  set_threads(1);
  const Grid<3> grid = full_grid<3>(16, 0.1);
  // A rate of stretching, shearing and turning; the velocity L (x - c) is linear, so nodes carry it exactly.
  const Matrix rate{{{0.2, -0.5, 0.1}, {0.3, -0.1, 0.25}, {-0.15, 0.05, 0.3}}};
  const Point<3> centre{0.6, 0.6, 0.7};
  Reals v(static_cast<std::size_t>(grid.slots()) * 4, 0.0);
  for (int s = 0; s < grid.slots(); ++s) {
    const Point<3> x = grid.position(grid.index(s));
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) v[static_cast<std::size_t>(s) * 4 + i] += rate[i][j] * (x[j] - centre[j]);
  }
  constexpr double kStep = 0.05;
  for (const ShapeKind shape : {ShapeKind::linear, ShapeKind::gimp, ShapeKind::quadratic_bspline})
    for (const Surface& s : surfaces()) {
      CAPTURE(s.name);
      CAPTURE(static_cast<int>(shape));
      SurfaceLoad<3> load = patch_load("patch", s.corners, 0.05);
      load.pressure = [](double) { return kPressure; };
      SurfaceLoad<3> drag = patch_load("patch", s.corners, 0.05);
      const Point<3> traction{30, -20, 10};
      for (int d = 0; d < 3; ++d) drag.traction[d] = [&, d](double) { return traction[d]; };
      const double area = std::hypot(s.area[0], s.area[1], s.area[2]);
      Matrix f{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
      for (int step = 0; step < 4; ++step) {
        Reals sums = unit_masses(grid);
        const Point<3> total = load.apply(grid, shape, 0, sums);
        Point<3> due = deformed_area(f, s.area);
        for (double& x : due) x *= kPressure;
        check_close<3>(total, due, kPressure * area);
        check_close<3>(nodal_sum<3>(grid, sums), due, kPressure * area);
        // The moment too: a uniform pressure on a plane piece acts at its middle, and nodes reproduce
        // positions.
        if (s.corners.size() == 4) {
          Point<3> middle{}, moment;
          for (const Point<3>& x : s.corners)
            for (int i = 0; i < 3; ++i) {
              middle[i] += 0.25 * centre[i];
              for (int j = 0; j < 3; ++j) middle[i] += 0.25 * f[i][j] * (x[j] - centre[j]);
            }
          for (int d = 0; d < 3; ++d)
            moment[d] = middle[(d + 1) % 3] * due[(d + 2) % 3] - middle[(d + 2) % 3] * due[(d + 1) % 3];
          check_close<3>(nodal_moment(grid, sums), moment, kPressure * area);
        }
        Reals dragged = unit_masses(grid);
        drag.apply(grid, shape, 0, dragged);
        Point<3> dragging;
        for (int d = 0; d < 3; ++d) dragging[d] = traction[d] * area;
        check_close<3>(nodal_sum<3>(grid, dragged), dragging, kPressure * area);
        load.move(grid, shape, kStep, v, sums);
        drag.move(grid, shape, kStep, v, sums);
        Matrix next = f;  // x <- x + dt L (x - c)
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j)
            for (int k = 0; k < 3; ++k) next[i][j] += kStep * rate[i][k] * f[k][j];
        f = next;
      }
      CHECK(std::abs(determinant(f) - 1) > 0.01);  // it has deformed
    }
}

TEST_CASE("a closed surface under pressure feels nothing, whatever its shape has become") {
  set_threads(1);
  const Grid<3> grid = full_grid<3>(12, 0.1);
  // A velocity that bends faces: pieces are no longer plane.
  Reals v(static_cast<std::size_t>(grid.slots()) * 4, 0.0);
  for (int s = 0; s < grid.slots(); ++s) {
    const Point<3> x = grid.position(grid.index(s));
    double* u = &v[static_cast<std::size_t>(s) * 4];
    u[0] = std::sin(3 * x[1]) * x[2], u[1] = std::cos(2 * x[0] + x[2]), u[2] = x[0] * x[1] * x[2];
  }
  constexpr double a = 0.31, b = 0.79;
  const auto face = [=](int axis, double at, bool upper) {
    std::vector<Point<3>> c;
    for (const auto& [p, q] : {std::pair{a, a}, std::pair{b, a}, std::pair{b, b}, std::pair{a, b}}) {
      Point<3> x;
      x[axis] = at, x[(axis + 1) % 3] = p, x[(axis + 2) % 3] = q;
      c.push_back(x);
    }
    if (upper) std::reverse(c.begin(), c.end());  // the material lies below
    return c;
  };
  std::vector<SurfaceLoad<3>> faces;
  for (int axis = 0; axis < 3; ++axis)
    for (const bool upper : {false, true}) {
      faces.push_back(patch_load("face", face(axis, upper ? b : a, upper), 0.05));
      faces.back().pressure = [](double) { return kPressure; };
    }
  for (int step = 0; step < 5; ++step) {
    Point<3> total{};
    Reals sums = unit_masses(grid);
    for (SurfaceLoad<3>& f : faces) {
      const Point<3> force = f.apply(grid, ShapeKind::gimp, 0, sums);
      for (int d = 0; d < 3; ++d) total[d] += force[d];
      f.move(grid, ShapeKind::gimp, 0.02, v, sums);
    }
    check_close<3>(total, {0, 0, 0}, kPressure);
    check_close<3>(nodal_sum<3>(grid, sums), {0, 0, 0}, kPressure);
  }
}

TEST_CASE("nodes without soil get no force and do not hold the surface back") {
  set_threads(1);
  const Grid<3> grid = full_grid<3>(12, 0.1);
  Reals sums = unit_masses(grid), v(static_cast<std::size_t>(grid.slots()) * 4, 0.0);
  // Soil up to the nodes at z = 0.6, all of it moving.
  for (int s = 0; s < grid.slots(); ++s)
    if (grid.position(grid.index(s))[2] > 0.65)
      sums[static_cast<std::size_t>(s) * 8] = 0;
    else
      v[static_cast<std::size_t>(s) * 4] = 0.5;
  const auto top = [](double z) {
    return std::vector<Point<3>>{{0.2, 0.2, z}, {0.2, 0.8, z}, {0.8, 0.8, z}, {0.8, 0.2, z}};
  };
  SurfaceLoad<3> load = patch_load("a little above", top(0.64), 0.05);
  load.pressure = [](double) { return kPressure; };
  check_close<3>(load.apply(grid, ShapeKind::gimp, 0, sums), {0, 0, -0.36 * kPressure}, kPressure);
  check_close<3>(nodal_sum<3>(grid, sums), {0, 0, -0.36 * kPressure}, kPressure);
  for (int s = 0; s < grid.slots(); ++s)
    if (sums[static_cast<std::size_t>(s) * 8] == 0) CHECK(sums[static_cast<std::size_t>(s) * 8 + 6] == 0);
  load.move(grid, ShapeKind::gimp, 0.1, v, sums);
  CHECK(load.vertices()[0][0] == doctest::Approx(0.25).epsilon(1e-12));
  SurfaceLoad<3> lost = patch_load("in the air", top(0.9), 0.05);
  lost.pressure = load.pressure;
  check_close<3>(lost.apply(grid, ShapeKind::gimp, 0, sums), {0, 0, 0}, kPressure);
}

TEST_CASE("loads move to the same bits with 1, 2 and 4 threads") {
  const Grid<3> grid = full_grid<3>(12, 0.1);
  Reals v(static_cast<std::size_t>(grid.slots()) * 4, 0.0);
  for (std::size_t i = 0; i < v.size(); ++i) v[i] = std::sin(0.37 * static_cast<double>(i));
  std::vector<std::vector<Point<3>>> ends;
  std::vector<Reals> forces;
  for (const int n : {1, 2, 4}) {
    set_threads(n);
    SurfaceLoad<3> load = patch_load("patch", surfaces()[3].corners, 0.02);
    load.pressure = [](double) { return kPressure; };
    Reals sums = unit_masses(grid);
    for (int step = 0; step < 3; ++step) load.move(grid, ShapeKind::quadratic_bspline, 0.01, v, sums);
    load.apply(grid, ShapeKind::quadratic_bspline, 0, sums);
    ends.push_back(load.vertices());
    forces.push_back(sums);
  }
  set_threads(1);
  CHECK(ends[0] != std::vector<Point<3>>(ends[0].size()));
  CHECK(ends[1] == ends[0]);
  CHECK(ends[2] == ends[0]);
  CHECK(forces[1] == forces[0]);
  CHECK(forces[2] == forces[0]);
}

TEST_CASE("friction at a corner does not depend on the order of the boundaries") {
  const Grid<2> grid = full_grid<2>(8, 0.1);
  BoundarySpec<2> base, wall, push;
  base.kind = BoundaryKind::friction, base.side = 2, base.coefficient = 0.5;
  wall.kind = BoundaryKind::roller, wall.side = 0;
  push.kind = BoundaryKind::velocity, push.side = 0, push.prescribed = {true, false};
  push.velocity[0] = [](double) { return 0.3; };
  const Reals sums = unit_masses(grid);
  const int corner = grid.slot({0, 0});
  const auto velocity = [&](std::vector<BoundarySpec<2>> specs, const Point<2>& start) {
    BoundarySet<2> boundaries(std::move(specs));
    boundaries.update(grid);
    Reals v(static_cast<std::size_t>(grid.slots()) * 4, 0.0);
    for (int d = 0; d < 2; ++d) v[static_cast<std::size_t>(corner) * 4 + d] = start[d];
    boundaries.apply(0, 1, sums, v, true, true);
    // What the boundaries did to the node is what they report.
    Point<2> reaction{};
    for (std::size_t i = 0; i < boundaries.specs().size(); ++i)
      for (int d = 0; d < 2; ++d) reaction[d] += boundaries.reaction(static_cast<int>(i))[d];
    Point<2> u;
    for (int d = 0; d < 2; ++d) {
      u[d] = v[static_cast<std::size_t>(corner) * 4 + d];
      if (boundaries.specs()[0].kind != BoundaryKind::velocity &&
          boundaries.specs().back().kind != BoundaryKind::velocity)
        CHECK(reaction[d] == doctest::Approx(u[d] - start[d]));
    }
    return u;
  };
  // A node pressed into wall and base does not slip; one that only slides along the base loses 0.5 times 2.
  for (const auto& order : {std::vector{base, wall}, std::vector{wall, base}})
    check_close<2>(velocity(order, {-9, -2}), {0, 0}, 1);
  check_close<2>(velocity({base}, {-9, -2}), {-8, 0}, 1);
  // The wall that pushes has its velocity, whatever the base holds.
  for (const auto& order : {std::vector{base, push}, std::vector{push, base}})
    check_close<2>(velocity(order, {1, -2}), {0.3, 0}, 1);
}

TEST_CASE("a boundary on a patch holds the nodes on and behind it, along its normal") {
  const Grid<3> grid = full_grid<3>(12, 0.1);
  BoundarySpec<3> wall;  // z = 0.9 - 0.5 x, the soil above it
  wall.kind = BoundaryKind::roller;
  wall.patch = {{0.2, 0.2, 0.8}, {1.0, 0.2, 0.4}, {1.0, 0.9, 0.4}, {0.2, 0.9, 0.8}};
  BoundarySet<3> boundaries({wall});
  boundaries.update(grid);
  const double length = std::sqrt(1.25);
  const Point<3> normal{0.5 / length, 0, 1 / length};
  Reals sums(static_cast<std::size_t>(grid.slots()) * 8, 1.0), v(static_cast<std::size_t>(grid.slots()) * 4);
  const Point<3> u{0.3, 0.4, -2}, leaving{0.3, 0.4, 2};
  for (const Point<3>& start : {u, leaving}) {
    for (int s = 0; s < grid.slots(); ++s)
      for (int d = 0; d < 3; ++d) v[static_cast<std::size_t>(s) * 4 + d] = start[d];
    boundaries.apply(0, 1, sums, v, true, true);
    const double across = start[0] * normal[0] + start[2] * normal[2];
    int held = 0, free = 0;
    for (int s = 0; s < grid.slots(); ++s) {
      const Point<3> x = grid.position(grid.index(s));
      const double height = (x[2] - 0.9 + 0.5 * x[0]) / length;
      // Foot of the perpendicular on the patch, in x and y.
      const double foot = x[0] - height * normal[0];
      const bool on = height < 1e-7 && height > -0.2001 && foot > 0.2 - 1e-7 && foot < 1 + 1e-7 &&
                      x[1] > 0.2 - 1e-7 && x[1] < 0.9 + 1e-7;
      for (int d = 0; d < 3; ++d) {
        const double due = on && across < 0 ? start[d] - across * normal[d] : start[d];
        CHECK(v[static_cast<std::size_t>(s) * 4 + d] == doctest::Approx(due).epsilon(1e-12));
      }
      ++(on ? held : free);
    }
    CHECK(held > 100);
    CHECK(free > 100);
    for (int d = 0; d < 3; ++d)  // unit mass a node, unit step
      CHECK(boundaries.reaction(0)[d] ==
            doctest::Approx(across < 0 ? -held * across * normal[d] : 0).epsilon(1e-9));
  }
}
