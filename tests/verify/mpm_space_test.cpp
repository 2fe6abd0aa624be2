// Loads and boundaries on patches in space: uniform stress under pressure, and the plane strain state.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/threads.hpp"
#include "tests/verify/mpm_scene.hpp"

using namespace polder;
using namespace polder::verify;

namespace {

constexpr double kPressure = 1e3;
constexpr ShapeKind kShapes[] = {ShapeKind::gimp, ShapeKind::quadratic_bspline};

double rise(double t) {
  return kPressure * std::min(1.0, t / 0.2);
}

SkeletonOptions options_of(ShapeKind shape, Space space) {
  SkeletonOptions o;
  o.space = space, o.shape = shape, o.cell_average = shape == ShapeKind::gimp;
  return o;
}

// A weak block, 0.4 m wide and 0.6 m high between rollers, under a pressure on the left half of its top; its
// right side is free. In space it is a slice of 0.2 m.
template <int D>
std::unique_ptr<Scene<D>> half_loaded(ShapeKind shape, bool cell_average, double top_offset) {
  constexpr double kSpacing = 0.1;
  constexpr int up = D - 1;
  const double height = 0.6 + top_offset * kSpacing;
  Index<D> cells;
  cells.fill(2);
  cells[0] = 8, cells[up] = 8;
  SkeletonOptions options = options_of(shape, D == 3 ? Space::three_d : Space::plane_strain);
  options.cell_average = cell_average;
  auto scene = std::make_unique<Scene<D>>(Grid<D>(Point<D>{}, cells, kSpacing), options,
                                          all_sides<D>(BoundaryKind::roller));
  Point<D> upper;
  upper.fill(0.2);
  upper[0] = 0.4, upper[up] = height;
  scene->add(mohr_coulomb(2000, 1e6, 0.3, 0.5, 2000, 0), Point<D>{}, upper);
  if constexpr (D == 2)
    scene->skeleton.loads().push_back(
        line_load("top", {0.2, height}, {0, height}, 0.5 * kSpacing, Space::plane_strain));
  else
    scene->skeleton.loads().push_back(patch_load(
        "top", {{0, 0, height}, {0, 0.2, height}, {0.2, 0.2, height}, {0.2, 0, height}}, 0.5 * kSpacing));
  scene->skeleton.loads().back().pressure = rise;
  scene->gravity[up] = -9.81;
  scene->damping = 0.2;
  return scene;
}

// A box with any directions of its edges.
struct TurnedBox {
  Point<3> origin;
  std::array<Point<3>, 3> edge;
  Point<3> at(double a, double b, double c) const {
    Point<3> x = origin;
    for (int d = 0; d < 3; ++d) x[d] += a * edge[0][d] + b * edge[1][d] + c * edge[2][d];
    return x;
  }
  // Corners of the face where coordinate `axis` is `end`, counter-clockwise seen from inside.
  std::vector<Point<3>> face(int axis, int end) const {
    std::vector<Point<3>> corners;
    for (const auto& [p, q] : {std::pair{0, 0}, std::pair{1, 0}, std::pair{1, 1}, std::pair{0, 1}}) {
      double u[3];
      u[axis] = end, u[(axis + 1) % 3] = p, u[(axis + 2) % 3] = q;
      corners.push_back(at(u[0], u[1], u[2]));
    }
    if (end == 1) std::reverse(corners.begin(), corners.end());
    return corners;
  }
};

}  // namespace

TEST_CASE("pressure or traction on the top of a block in space: uniform stress") {
  set_threads(1);
  constexpr double kSpacing = 0.1;
  struct Run {
    ShapeKind shape;
    bool traction;
    double top_offset, tolerance;
  };
  // The same tolerances as in the plane: a B-spline under a surface between nodes integrates the stress to a
  // few per cent.
  for (const Run& run :
       {Run{ShapeKind::gimp, true, 0, 1e-4}, Run{ShapeKind::gimp, false, 0, 1e-4},
        Run{ShapeKind::gimp, false, 0.3, 2e-3}, Run{ShapeKind::quadratic_bspline, false, 0, 1e-3},
        Run{ShapeKind::quadratic_bspline, true, 0.3, 0.03}}) {
    CAPTURE(static_cast<int>(run.shape));
    CAPTURE(run.traction);
    CAPTURE(run.top_offset);
    const double height = 0.5 + run.top_offset * kSpacing;
    Scene<3> scene(Grid<3>({0, 0, 0}, {3, 3, 8}, kSpacing), options_of(run.shape, Space::three_d),
                   all_sides<3>(BoundaryKind::roller));
    scene.add(elastic(2000, 1e7, 0.3), {0, 0, 0}, {0.3, 0.3, height});
    SurfaceLoad<3> top = patch_load(
        "top", {{0, 0, height}, {0, 0.3, height}, {0.3, 0.3, height}, {0.3, 0, height}}, 0.5 * kSpacing);
    if (run.traction)
      top.traction[2] = [](double t) { return -rise(t); };
    else
      top.pressure = rise;
    scene.skeleton.loads().push_back(top);
    scene.damping = 0.3;
    const double dt = scene.wave_step(0.5);
    while (scene.time < 0.5) scene.step(dt);
    CHECK(scene.skeleton.applied_load()[2] == doctest::Approx(-kPressure * 0.09).epsilon(1e-9));
    double square = 0;
    int n = 0;
    scene.each([&](const ParticleSet<3>& q, int p) {
      const double lateral = -kPressure * 0.3 / 0.7;
      square += std::pow(q.stress[2][p] / -kPressure - 1, 2) +
                std::pow((q.stress[0][p] - lateral) / kPressure, 2) +
                std::pow((q.stress[1][p] - lateral) / kPressure, 2);
      ++n;
    });
    MESSAGE("block under its top load, RMS error " << std::sqrt(square / n));
    CHECK(std::sqrt(square / n) < run.tolerance);
  }
}

TEST_CASE("a turned block under pressure all around: its mean stress is the pressure") {
  set_threads(1);
  constexpr double kSpacing = 0.1;
  const double angle = std::numbers::pi / 6, c = std::cos(angle), s = std::sin(angle);
  const TurnedBox box{{0.6, 0.25, 0.3}, {{{0.8 * c, 0, 0.8 * s}, {0, 0.5, 0}, {-0.6 * s, 0, 0.6 * c}}}};
  for (const ShapeKind shape : kShapes) {
    Scene<3> scene(Grid<3>({0, 0, 0}, {16, 10, 14}, kSpacing), options_of(shape, Space::three_d),
                   all_sides<3>(BoundaryKind::free));
    ParticleSet<3>& set =
        scene.add(elastic(2000, 1e6, 0.25), {0, 0.25, 0}, {1.6, 0.75, 1.4}, 2, 0, [&](const Point<3>& x) {
          const double u = (x[0] - 0.6) * c + (x[2] - 0.3) * s, w = -(x[0] - 0.6) * s + (x[2] - 0.3) * c;
          return u > 0 && u < 0.8 && w > 0 && w < 0.6;
        });
    for (int axis = 0; axis < 3; ++axis)
      for (const int end : {0, 1}) {
        SurfaceLoad<3> face = patch_load("face", box.face(axis, end), 0.5 * kSpacing);
        face.pressure = rise;
        scene.skeleton.loads().push_back(face);
      }
    scene.damping = 0.3;
    const double dt = scene.wave_step(0.5);
    while (scene.time < 0.6) {
      scene.step(dt);
      // A closed surface feels no force.
      for (int d = 0; d < 3; ++d) CHECK(std::abs(scene.skeleton.applied_load()[d]) < 1e-9 * kPressure);
    }
    // At rest the stresses balance the loads in the mean over any body: sum of V sigma = sum of x f, which
    // for a uniform pressure is -p times the volume inside the surface.
    double volume = 0, inner = 0;
    std::array<double, 6> mean{};
    int n = 0;
    double square = 0;
    scene.each([&](const ParticleSet<3>& q, int p) {
      volume += q.volume[p];
      for (int k = 0; k < 6; ++k) mean[k] += q.volume[p] * q.stress[k][p] / kPressure;
      // Points two cells inside.
      const double x = q.initial_position[0][p] - 0.6, z = q.initial_position[2][p] - 0.3;
      const double u = x * c + z * s, w = -x * s + z * c, y = q.initial_position[1][p] - 0.25;
      if (std::min({u, 0.8 - u, w, 0.6 - w, y, 0.5 - y}) < 2 * kSpacing) return;
      inner += q.stress[0][p] / -kPressure, ++n;
      for (int k = 0; k < 3; ++k) square += std::pow(q.stress[k][p] / kPressure + 1, 2) / 3;
    });
    REQUIRE(n > 20);
    const double enclosed = 0.8 * 0.5 * 0.6 * (1 - kPressure * 3 * (1 - 2 * 0.25) / 1e6);
    for (int k = 0; k < 6; ++k) {
      CAPTURE(k);
      // Where the surface reaches past the last node with mass its force moves inwards, to the nodes that
      // have some; GIMP's supports end earlier than the spline's.
      CHECK(std::abs(mean[k] / enclosed - (k < 3 ? -1 : 0)) < (shape == ShapeKind::gimp ? 2e-3 : 1e-3));
    }
    MESSAGE("turned block: points fill " << volume / enclosed << " of the surface, RMS error inside "
                                         << std::sqrt(square / n));
    CHECK(std::sqrt(square / n) < 0.03);
    CHECK(set.count() > 1500);
  }
}

TEST_CASE("a slice in space between rollers has the plane strain state") {
  set_threads(1);
  struct Run {
    ShapeKind shape;
    bool cell_average;
    double top_offset, position, stress;  // largest difference of positions, RMS of stresses, relative
  };
  // Rounding, as yielding lets it grow. The cell average spreads a change of volume over the strains along
  // all axes of the grid: in space a third goes to the axis across the slice, which in plane strain has none.
  // So the stresses of the points of one cell scatter differently.
  for (const Run& run :
       {Run{ShapeKind::gimp, false, 0, 1e-5, 1e-5}, Run{ShapeKind::gimp, false, 0.3, 1e-5, 1e-5},
        Run{ShapeKind::quadratic_bspline, false, 0, 1e-5, 1e-5},
        Run{ShapeKind::quadratic_bspline, false, 0.3, 1e-5, 1e-5},
        Run{ShapeKind::gimp, true, 0, 0.04, 0.25}}) {
    CAPTURE(static_cast<int>(run.shape));
    CAPTURE(run.cell_average);
    CAPTURE(run.top_offset);
    const auto plane = half_loaded<2>(run.shape, run.cell_average, run.top_offset);
    const auto space = half_loaded<3>(run.shape, run.cell_average, run.top_offset);
    const double dt = plane->wave_step(0.5);
    REQUIRE(space->wave_step(0.5) == doctest::Approx(dt).epsilon(1e-14));
    while (plane->time < 0.25) plane->step(dt), space->step(dt);
    const ParticleSet<2>& a = *plane->skeleton.bodies()[0];
    const ParticleSet<3>& b = *space->skeleton.bodies()[0];
    REQUIRE(b.count() == 4 * a.count());
    // Points of one place in the plane: y is the middle index of the seeding order.
    constexpr int kAcross = 8, kDepth = 4;
    double position = 0, stress = 0, scale = 0, largest = 0, plastic = 0;
    for (int row = 0; row < a.count() / kAcross; ++row)
      for (int j = 0; j < kDepth; ++j)
        for (int i = 0; i < kAcross; ++i) {
          const int p = a.find(row * kAcross + i), q = b.find((row * kDepth + j) * kAcross + i);
          position = std::max({position, std::abs(a.position[0][p] - b.position[0][q]),
                               std::abs(a.position[1][p] - b.position[2][q])});
          // xx, yy, zz, xy in the plane; xx, yy, zz, xy, yz, zx in space with z up.
          constexpr int kInSpace[] = {0, 2, 1, 5};
          for (int k = 0; k < 4; ++k) {
            stress += std::pow(a.stress[k][p] - b.stress[kInSpace[k]][q], 2);
            scale += std::pow(a.stress[k][p], 2);
          }
          largest = std::max(largest, std::hypot(a.position[0][p] - a.initial_position[0][p],
                                                 a.position[1][p] - a.initial_position[1][p]));
          for (const Reals& x : a.state) plastic = std::max(plastic, std::abs(x[p]));
        }
    stress = std::sqrt(stress / scale);
    MESSAGE("slice against plane strain: positions differ by "
            << position / largest << " of the motion, stresses by " << stress << " of their RMS");
    CHECK(largest > 1e-3);
    CHECK(plastic > 0);  // the slice yields, so that all of the law is compared
    CHECK(position < run.position * largest);
    CHECK(stress < run.stress);
  }
}
