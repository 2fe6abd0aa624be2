// Phreatic line, stream function, exit gradients and heave on fields whose answer is known.
#include <doctest/doctest.h>

#include <cmath>

#include "core/threads.hpp"
#include "fdm/flow_results.hpp"
#include "tests/verify/seepage_scene.hpp"

using namespace polder;
using namespace polder::fdm;
using namespace polder::fdm::test;
using namespace polder::verify;
using Kind2 = WaterBoundary<2>::Kind;

namespace {

Soil<2> soil(double alpha) {
  Soil<2> s;
  s.retention.model = alpha > 0 ? Retention::Model::gardner : Retention::Model::saturated;
  s.retention.alpha = alpha;
  return s;
}

void solve_steady(SeepageScene& s, double k, const SeepageScene::At& head) {
  s.set_conductivity(k);
  s.update();
  s.set_head(head);
  s.field.set_tolerance(1e-10);
  REQUIRE(s.field.steady(s.unsaturated(1e3)).converged);
}

}  // namespace

TEST_CASE("stream function of parallel flow is linear across it, and the phreatic line of rest level") {
  SeepageScene s({2, 1}, {12, 8}, 0.5, {soil(0)});
  s.conditions.boundaries = {boundary<2>(Kind2::head, 0, 9), boundary<2>(Kind2::head, 1, 6)};
  solve_steady(s, 1e-4, [](const auto& x) { return 8 - x[1]; });
  const StreamFunction psi = stream_function(s.cells, s.field.face_flow());
  const double u = 1e-4 * 3 / 6;
  CHECK(psi.defect < 1e-9);
  CHECK(psi.highest - psi.lowest == doctest::Approx(4 * u).epsilon(1e-9));
  const double origin = psi.value[s.grid.slot({0, 0})];
  for (int i = 0; i <= 12; ++i)
    for (int j = 0; j <= 8; ++j)
      CHECK(psi.value[s.grid.slot({i, j})] - origin == doctest::Approx(u * 0.5 * j).epsilon(1e-9));

  SeepageScene rest({0, 0}, {10, 12}, 0.25, {soil(3)});
  rest.conditions.boundaries = {boundary<2>(Kind2::head, 0, 1.9)};
  solve_steady(rest, 1e-4, [](const auto& x) { return 1.7 - x[1]; });
  const auto line = phreatic_line(rest.cells, rest.field.pressure());
  REQUIRE(line.size() == 10);
  for (const auto& [x, z] : line) CHECK(z == doctest::Approx(1.9).epsilon(1e-6));
  CHECK(line[3].first == doctest::Approx(0.875));
}

TEST_CASE("exit gradient and factor against heave of a column with flow upwards") {
  SeepageScene s({0, 0}, {3, 16}, 0.25, {soil(0)});
  s.fill_below(3.1);                                                       // the surface inside a cell
  WaterBoundary<2> base = boundary<2>(Kind2::pressure, 2, kGamma * 4.34);  // 1.24 m more than at rest
  s.conditions.boundaries = {base};
  solve_steady(s, 1e-4, [](const auto& x) { return 3.1 - x[1]; });
  const auto gradients = exit_gradients(s.cells, s.field.pressure());
  const auto largest = largest_upward(gradients);
  REQUIRE(largest);
  CHECK(largest->gradient == doctest::Approx(0.4).epsilon(1e-6));
  CHECK(largest->place[1] == doctest::Approx(3.1));
  CHECK(largest->boundary == -1);
  CHECK_FALSE(largest_upward(gradients, 0));  // water enters through the base
  CHECK(critical_gradient(0.4, 2650, 1000) == doctest::Approx(0.99));
  CHECK(heave_factor(0.99, largest->gradient) == doctest::Approx(0.99 / 0.4).epsilon(1e-6));
  CHECK(std::isinf(heave_factor(0.99, 0)));
  CHECK(std::isinf(heave_factor(0.99, -0.1)));
}

TEST_CASE("stream function of a dam spans its discharge, and the phreatic line falls from level to exit") {
  SeepageScene s({0, 0}, {40, 40}, 0.025, {soil(40)});
  WaterBoundary<2> left = boundary<2>(Kind2::head, 0, 1), right = boundary<2>(Kind2::head, 1, 0.2);
  right.seepage_above = true;
  s.conditions.boundaries = {left, right};
  solve_steady(s, 1e-4, [](const auto& x) { return std::sqrt(1 - 0.96 * x[0]) - x[1]; });
  const StreamFunction psi = stream_function(s.cells, s.field.face_flow());
  CHECK(psi.defect < 1e-6);
  CHECK(psi.highest - psi.lowest == doctest::Approx(-s.field.discharge().boundary[0]).epsilon(1e-6));
  const auto line = phreatic_line(s.cells, s.field.pressure());
  REQUIRE(line.size() == 40);
  for (std::size_t i = 1; i < line.size(); ++i) CHECK(line[i].second <= line[i - 1].second + 1e-9);
  CHECK(line.front().second > 0.97);
  CHECK(line.back().second > 0.35);
  CHECK(line.back().second < 0.5);
  // Storage makes the flows of cells unequal: the defect tells.
  Reals flow = s.field.face_flow();
  flow[500] += 0.1 * (psi.highest - psi.lowest);
  CHECK(stream_function(s.cells, flow).defect > 0.05);
}
