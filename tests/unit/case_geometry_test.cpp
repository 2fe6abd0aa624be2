// Plane geometry behind the checks of bodies, against areas known in closed form.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "app/geometry.hpp"

using namespace polder;
using namespace polder::app;
using coupling::Body;

namespace {

Polygon rectangle(double x0, double y0, double x1, double y1) {
  return {{x0, y0, 0}, {x1, y0, 0}, {x1, y1, 0}, {x0, y1, 0}};
}

Body ball(double x, double y, double z, double radius) {
  Body b;
  b.centre = {x, y, z};
  b.radius = radius;
  return b;
}

coupling::GridSpec grid(double cell) {
  coupling::GridSpec g;
  g.size = {10, 10, 10};
  g.cell = cell;
  return g;
}

}  // namespace

TEST_CASE("areas and their sign") {
  CHECK(signed_area(rectangle(0, 0, 3, 2)) == 6);
  Polygon clockwise{{0, 0, 0}, {0, 1, 0}, {1, 0, 0}};
  CHECK(signed_area(clockwise) == -0.5);
  CHECK(measure(ball(1, 1, 0, 2), 2) == doctest::Approx(4 * std::numbers::pi));
  CHECK(measure(ball(1, 1, 0, 2), 3) == doctest::Approx(32 * std::numbers::pi / 3));
}

TEST_CASE("shared areas are exact") {
  CHECK(overlap_area(rectangle(0, 0, 2, 2), rectangle(1, 1, 3, 3)) == doctest::Approx(1));
  CHECK(overlap_area(rectangle(0, 0, 2, 2), rectangle(2, 0, 3, 2)) == 0);
  CHECK(overlap_area(rectangle(0, 0, 4, 4), rectangle(1, 1, 2, 2)) == doctest::Approx(1));
  // A square and the same one turned by 45 degrees: a regular octagon, 8 (sqrt 2 - 1) for half side 1.
  const double r = std::numbers::sqrt2;
  const Polygon turned{{r, 0, 0}, {0, r, 0}, {-r, 0, 0}, {0, -r, 0}};
  CHECK(overlap_area(rectangle(-1, -1, 1, 1), turned) == doctest::Approx(8 * (r - 1)).epsilon(1e-13));
  // Not convex: a U and a bar across both arms.
  const Polygon u{{0, 0, 0}, {3, 0, 0}, {3, 3, 0}, {2, 3, 0}, {2, 1, 0}, {1, 1, 0}, {1, 3, 0}, {0, 3, 0}};
  CHECK(overlap_area(u, rectangle(-1, 2, 4, 2.5)) == doctest::Approx(1));
}

TEST_CASE("crossings are found, corners are not crossings") {
  CHECK_FALSE(crossing_edges(rectangle(0, 0, 3, 2)));
  CHECK_FALSE(crossing_edges({{0, 0, 0}, {9, 0, 0}, {3, 3, 0}, {0, 3, 0}}));
  CHECK(crossing_edges({{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}}));
  CHECK(crossing_edges({{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {2, 1, 0}}));             // folds back
  CHECK(crossing_edges({{0, 0, 0}, {2, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}}));  // a corner on an edge
  CHECK_FALSE(crossing_edges(
      {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}}));  // a corner in a straight line
}

TEST_CASE("overlap of disks, balls and boxes") {
  CHECK(overlap(ball(0, 0, 0, 1), ball(2, 0, 0, 1), 2) == 0);
  // Two unit disks a distance 1 apart share 2 pi / 3 - sqrt(3) / 2; the outline has 128 corners.
  CHECK(overlap(ball(0, 0, 0, 1), ball(1, 0, 0, 1), 2) ==
        doctest::Approx(2 * std::numbers::pi / 3 - std::sqrt(3) / 2).epsilon(2e-3));
  CHECK(overlap(ball(0, 0, 0, 1), ball(1.5, 1.5, 0, 1), 3) == 0);
  CHECK(overlap(ball(0, 0, 0, 1), ball(1, 1, 0, 1), 3) > 0);
  Body box;
  box.box = {{{1, 1, 1}, {2, 2, 2}}};
  Body other;
  other.box = {{{1.5, 1.5, 1.5}, {3, 3, 3}}};
  CHECK(overlap(box, other, 3) == doctest::Approx(0.125));
  CHECK(overlap(ball(0, 0, 0, 1.7), box, 3) == 0);  // the corner is sqrt(3) away
  CHECK(overlap(ball(0, 0, 0, 1.8), box, 3) > 0);
}

TEST_CASE("prisms: volume, extent, overlap, distance") {
  Body prism;  // right triangle in x and z, along y
  prism.polygon = {{0, 0, 0}, {2, 0, 0}, {0, 1, 0}};
  prism.extrude = {1, 4};
  CHECK(measure(prism, 3) == doctest::Approx(3));
  CHECK(measure(prism, 2) == doctest::Approx(1));
  const Extent e = extent(prism, 3);
  CHECK(e.lower == coupling::Vector3{0, 1, 0});
  CHECK(e.upper == coupling::Vector3{2, 4, 1});
  Body box;
  box.box = {{{1, 3, 0}, {3, 6, 1}}};
  CHECK(overlap(prism, box, 3) == doctest::Approx(0.25));  // triangle of 1 by 0.5, 1 m long
  box.box = {{{1.5, 0, 0.5}, {3, 6, 1}}};                  // beyond the slope, though the extents meet
  CHECK(overlap(prism, box, 3) == 0);
  Body other = prism;
  other.extrude = {3.5, 5};
  CHECK(overlap(prism, other, 3) == doctest::Approx(0.5));
  other.extrude = {4, 5};
  CHECK(overlap(prism, other, 3) == 0);
  CHECK(distance(prism, {0.5, 2, 0.5}, 3) == 0);
  CHECK(distance(prism, {-3, 5, 4}, 3) == doctest::Approx(std::sqrt(9 + 1 + 9)));
  CHECK(overlap(ball(0.5, 0.5, 0.2, 0.4), prism, 3) == 0);
  CHECK(overlap(ball(0.5, 0.5, 0.2, 0.6), prism, 3) > 0);
  CHECK(holds_a_particle(prism, grid(0.1), 3));
  prism.polygon = {{0.06, 0, 0}, {0.07, 0, 0}, {0.07, 5, 0}, {0.06, 5, 0}};
  CHECK_FALSE(holds_a_particle(prism, grid(0.1), 3));
}

TEST_CASE("bodies between the particle positions hold none") {
  Body sliver;
  sliver.polygon = {
      {0.06, 0, 0}, {0.07, 0, 0}, {0.07, 5, 0}, {0.06, 5, 0}};  // positions at 0.025, 0.075, ...
  CHECK_FALSE(holds_a_particle(sliver, grid(0.1), 2));
  sliver.polygon[1][0] = sliver.polygon[2][0] = 0.08;
  CHECK(holds_a_particle(sliver, grid(0.1), 2));
  CHECK(holds_a_particle(ball(0.075, 0.075, 0.075, 0.01), grid(0.1), 3));
  CHECK_FALSE(holds_a_particle(ball(0.1, 0.1, 0.1, 0.04), grid(0.1), 3));  // the nearest is 0.0433 away
  CHECK(holds_a_particle(ball(0.1, 0.1, 0.1, 0.045), grid(0.1), 3));
}

TEST_CASE("distances") {
  const Polygon p = rectangle(0, 0, 2, 1);
  CHECK(distance(p, 1, 0.5) == 0);
  CHECK(distance(p, 3, 2) == doctest::Approx(std::sqrt(2)));
  CHECK(distance(p, 1, -0.5) == doctest::Approx(0.5));
}
