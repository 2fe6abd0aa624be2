// The law of the free surface near the end of a seepage face, and where phreatic lines made from it end.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "fdm/phreatic_exit.hpp"
#include "tests/unit/fdm_scene.hpp"

using namespace polder;
using namespace polder::fdm;
using namespace polder::fdm::test;

namespace {

constexpr double kPi = std::numbers::pi;

// Distance of the surface from a vertical face: integral of pi / ln(R/s), s = exp(u), by the midpoint rule.
double vertical_distance(double length_scale, double s) {
  constexpr int kParts = 200000;
  const double high = std::log(s), low = high - 40, width = (high - low) / kParts;
  double sum = 0;
  for (int i = 0; i < kParts; ++i) {
    const double u = low + (i + 0.5) * width;
    sum += kPi / (std::log(length_scale) - u) * std::exp(u) * width;
  }
  return sum;
}

}  // namespace

TEST_CASE("a vertical seepage face: the surface leaves it as the logarithm says") {
  for (const double scale : {30.0, 300.0, 3e4}) {
    const double s = 0.1, n = vertical_distance(scale, s);
    CHECK(detail::distance_along(kPi / 2, scale, n) == doctest::Approx(s).epsilon(0.02));
  }
}

TEST_CASE("seepage faces of any slope: two points of the surface give back its end") {
  for (const double degrees : {15.0, 26.565, 45.0, 60.0, 80.0, 90.0})
    for (const double scale : {100.0, 5000.0}) {
      CAPTURE(degrees);
      CAPTURE(scale);
      const double slope = degrees * kPi / 180;
      const double s1 = detail::distance_along(slope, scale, 0.15);
      const double s2 = detail::distance_along(slope, scale, 0.25);
      REQUIRE(s1 > 0);
      CHECK(s2 > s1);
      CHECK(detail::distance_to_end(slope, 0.15, 0.25, s2 - s1) == doctest::Approx(s1).epsilon(1e-6));
    }
  // The surface is tangent to the face: far from the end in the law's length it is closer than at an angle.
  const double near = detail::distance_along(kPi / 6, 1, 1e-6),
               far = detail::distance_along(kPi / 6, 1, 1e-5);
  CHECK(std::log(10.0) / std::log(far / near) == doctest::Approx(1.5 - 1.0 / 6).epsilon(0.01));
}

TEST_CASE("the end of a phreatic line that follows the law on a vertical face and on a slope") {
  for (const bool steep : {true, false}) {
    CAPTURE(steep);
    const double h = 0.05, end = 0.73, scale = 40;
    const double slope = steep ? kPi / 2 : std::atan(0.5);
    const Point<2> up = steep ? Point<2>{0, 1} : Point<2>{-std::cos(slope), std::sin(slope)};
    const double right = 3;  // of the face at height 0
    Scene<2> s({0, 0}, {60, 30}, h);
    // The soil lies left of the face.
    s.fill_cells([&](const Point<2>& c) {
      constexpr int kStrips = 64;
      double sum = 0;
      for (int i = 0; i < kStrips; ++i) {
        const double x = c[0] + h * ((i + 0.5) / kStrips - 0.5);
        const double surface = steep ? 1e9 : (right - x) * std::tan(slope);
        sum += std::clamp((surface - c[1]) / h + 0.5, 0.0, 1.0);
      }
      return sum / kStrips;
    });
    auto face = boundary<2>(WaterBoundary<2>::Kind::surface, steep ? 1 : kFreeSurface, 0.0);
    s.conditions.boundaries = {face};
    s.cells.update(s.fill, s.conditions);
    // Height of the law's surface over x, by bisection along the face.
    const Point<2> foot{steep ? right : right - end / std::tan(slope), end};
    const Point<2> inward{-up[1], up[0]};
    const auto surface_at = [&](double x) {
      double low = 0, high = 0.5;
      for (int i = 0; i < 60; ++i) {
        const double n = 0.5 * (low + high), along = detail::distance_along(slope, scale, n);
        (along >= 0 && foot[0] + along * up[0] + n * inward[0] > x ? low : high) = n;
      }
      const double n = 0.5 * (low + high);
      return foot[1] + detail::distance_along(slope, scale, n) * up[1] + n * inward[1];
    };
    std::vector<double> pressure(s.grid.slots(), 0);
    for (const auto& c : s.cells.cells()) {
      const Point<2> x = s.cells.centre(c.index);
      const double soil = steep ? 1e9 : (right - x[0]) * std::tan(slope);
      const double water = x[0] < foot[0] ? surface_at(x[0]) : soil;
      pressure[c.slot] = kGamma * (std::min(water, soil) - x[1]);
    }
    const auto exits = phreatic_exits(s.cells, pressure);
    REQUIRE(exits.size() == 1);
    CHECK(exits[0].found);
    CHECK(exits[0].boundary == 0);
    CHECK(exits[0].direction == 1);
    CHECK(exits[0].slope == doctest::Approx(slope).epsilon(0.01));
    CHECK(exits[0].place[1] == doctest::Approx(end).epsilon(0.01));
    CHECK(exits[0].place[0] == doctest::Approx(foot[0]).epsilon(0.01));
  }
}

TEST_CASE("no seepage face, no end; water outside that stands higher is the end") {
  Scene<2> s({0, 0}, {10, 10}, 0.1);
  s.fill_cells([](const auto&) { return 1.0; });
  auto right = boundary<2>(WaterBoundary<2>::Kind::head, 1, 0.55);
  for (const bool seeps : {false, true}) {
    right.seepage_above = seeps;
    s.conditions.boundaries = {right};
    s.cells.update(s.fill, s.conditions);
    std::vector<double> pressure(s.grid.slots(), 0);
    for (const auto& c : s.cells.cells())
      pressure[c.slot] = kGamma * (0.55 - s.cells.centre(c.index)[1]);  // at rest
    CHECK(phreatic_exits(s.cells, pressure).empty());
    for (double& p : pressure) p += kGamma * 0.1;  // 0.1 m higher than outside
    CHECK(phreatic_exits(s.cells, pressure).size() == (seeps ? 1 : 0));
    for (const PhreaticExit& e : phreatic_exits(s.cells, pressure)) CHECK(e.place[1] >= 0.55);
  }
}
