// Unsaturated water in cells: agreement with the saturated equation, rest, volumes, refusals, determinism.
#include <doctest/doctest.h>

#include "core/threads.hpp"
#include "fdm/unsaturated_field.hpp"
#include "tests/unit/fdm_scene.hpp"

using namespace polder;
using namespace polder::fdm;
using namespace polder::fdm::test;
using Kind2 = WaterBoundary<2>::Kind;

namespace {

// A block under open water, moved about by a prescribed velocity: largest difference of the pressures of both
// equations over the largest pressure, after 100 steps.
template <int D>
double difference_from_saturated(const Retention& retention) {
  Index<D> size;
  size.fill(10);
  size[D - 1] = 8;
  UnsaturatedScene<D> s(Point<D>{}, size, 0.5);
  s.fill_below(3.6);  // the surface inside a layer of cells
  s.conditions.outside_level = 5;
  s.conditions.boundaries = {boundary<D>(WaterBoundary<D>::Kind::head, 0, 6.0)};
  s.cells_to(s.darcy_mobility, [](const auto& x) { return 1e-4 * (1 + x[0]) / kGamma; });
  s.nodes_to(s.mobility, [](const auto& x) { return 2e-6 * (1 + 0.2 * x[0]); });
  s.update();
  std::fill(s.fraction.begin(), s.fraction.end(), 1.0);
  PressureField<D> saturated(s.cells, water<D>(2e8));
  Soil<D> soil;
  soil.retention = retention;
  UnsaturatedField<D> field(s.cells, water<D>(2e8), {soil});
  saturated.refresh();
  field.refresh();
  saturated.steady(s.darcy_mobility);
  field.pressure() = saturated.pressure();
  field.set_tolerance(1e-11);
  double worst = 0, largest = 0;
  for (int i = 0; i < 100; ++i) {
    s.velocity_to([&](const Point<D>& x) {
      Point<D> v{};
      v[0] = 1e-4 * std::sin(0.3 * i + x[1]) * x[0];
      v[D - 1] = -2e-4 * x[D - 1] * std::cos(0.1 * i + x[0]);
      return v;
    });
    saturated.solve(s.step(2e-3));
    UnsaturatedStep step = s.unsaturated(2e-3);
    step.velocity = s.velocity, step.mobility = s.mobility;
    const StepReport r = field.solve(step);
    REQUIRE(r.converged);
    CHECK(r.iterations <= 2);
    for (const auto& c : s.cells.cells()) {
      REQUIRE(saturated.pressure()[c.slot] > 0);
      worst = std::max(worst, std::abs(field.pressure()[c.slot] - saturated.pressure()[c.slot]));
      worst = std::max(worst, std::abs(field.increment()[c.slot] - saturated.increment()[c.slot]));
      largest = std::max(largest, saturated.pressure()[c.slot]);
    }
  }
  std::vector<double> a(s.grid.slots() * 4), b(a);
  saturated.node_gradient(saturated.pressure(), BoundaryValues::present, WallNormal::none, a);
  field.node_gradient(field.positive_pressure(), BoundaryValues::present, WallNormal::none, b);
  for (std::size_t i = 0; i < a.size(); ++i) worst = std::max(worst, std::abs(a[i] - b[i]));
  return worst / largest;
}

}  // namespace

TEST_CASE("where everything is saturated a step is that of the saturated equation") {
  const Retention saturated, curve = van_genuchten<2>().retention;
  CHECK(difference_from_saturated<2>(saturated) < 1e-7);
  CHECK(difference_from_saturated<2>(curve) < 1e-7);
  CHECK(difference_from_saturated<3>(curve) < 1e-7);
}

TEST_CASE("hydrostatic suction rests, wherever the surface and the water table lie") {
  const double height = 2;
  for (int i = 0; i < 8; ++i)
    for (const bool moving : {false, true}) {
      CAPTURE(i);
      CAPTURE(moving);
      const double table = 0.83;
      UnsaturatedScene<2> s({0, 0}, {6, 24}, 0.1);
      s.fill_below(height + 0.1 * (i + 0.5) / 8);
      s.conditions.boundaries = {boundary<2>(Kind2::head, 0, table)};
      s.cells_to(s.darcy_mobility, [](const auto& x) { return (x[0] < 0.3 ? 1e-3 : 1e-7) / kGamma; });
      s.nodes_to(s.mobility, [](const auto&) { return 5e-7; });
      s.update();
      for (const auto& c : s.cells.cells()) s.soil[c.slot] = s.cells.centre(c.index)[1] > 1.2;
      UnsaturatedField<2> field(s.cells, water2(), {van_genuchten<2>(), van_genuchten<2>(8, 3)});
      field.refresh();
      for (const auto& c : s.cells.cells())
        field.pressure()[c.slot] = kGamma * (table - s.cells.centre(c.index)[1]);
      double worst = 0;
      for (int step = 0; step < 200; ++step) {
        UnsaturatedStep u = s.unsaturated(step < 100 ? 1e-3 : 1e4);
        if (moving) u.velocity = s.velocity, u.mobility = s.mobility;
        REQUIRE(field.solve(u).converged);
      }
      for (const auto& c : s.cells.cells())
        worst = std::max(worst,
                         std::abs(field.pressure()[c.slot] - kGamma * (table - s.cells.centre(c.index)[1])));
      CHECK(worst < 1e-10 * kGamma * height);
      CHECK(std::abs(field.discharge().total()) < 1e-18);
    }
}

TEST_CASE("soil fraction keeps the volume of soil") {
  for (const Space space : {Space::plane_strain, Space::axisymmetric}) {
    UnsaturatedScene<2> s({0, 0}, {20, 12}, 0.1, space);
    s.fill_cells([](const auto& x) {
      return std::clamp((0.9 - 0.4 * x[0] + 0.1 * std::sin(9 * x[0]) - x[1]) / 0.1 + 0.5, 0.0, 1.0);
    });
    s.update();
    double soil = 0, counted = 0;
    for (int slot = 0; slot < s.grid.slots(); ++slot)
      soil += s.fill[slot] * (space == Space::axisymmetric ? s.centre(slot)[0] : 1) * 0.01;
    for (const auto& c : s.cells.cells()) {
      CHECK(s.fraction[c.slot] >= s.fill[c.slot]);
      counted += s.fraction[c.slot] * c.volume;
    }
    CHECK(counted == doctest::Approx(soil).epsilon(1e-12));
    REQUIRE(s.cells.count() > 60);
  }
}

TEST_CASE("a step that does not converge changes nothing and says so") {
  UnsaturatedScene<2> s({0, 0}, {1, 20}, 0.05);
  s.fill_cells([](const auto&) { return 1.0; });
  s.conditions.boundaries = {boundary<2>(Kind2::pressure, 3, 0)};
  s.cells_to(s.darcy_mobility, [](const auto&) { return 1e-4 / kGamma; });
  s.update();
  UnsaturatedField<2> field(s.cells, water2(), {van_genuchten<2>(8, 3)});
  field.refresh();
  for (const auto& c : s.cells.cells()) field.pressure()[c.slot] = -5 * kGamma;
  REQUIRE(field.solve(s.unsaturated(1)).converged);
  const Reals p = field.pressure(), saturation = field.saturation();
  const double balance = field.balance().storage;
  field.set_max_iterations(2);
  const StepReport r = field.solve(s.unsaturated(1e3));
  CHECK_FALSE(r.converged);
  CHECK(r.iterations == 2);
  CHECK(r.residual > 1e-7);
  CHECK(r.failure == "no convergence in 2 iterations");
  CHECK(field.pressure() == p);
  CHECK(field.saturation() == saturation);
  CHECK(field.balance().storage == balance);
  field.set_max_iterations(100);
  CHECK(field.solve(s.unsaturated(1e3)).converged);
  CHECK(field.pressure() != p);
}

TEST_CASE("the saturated equation refuses what only the unsaturated one knows") {
  UnsaturatedScene<2> s({0, 0}, {4, 4}, 0.5);
  s.fill_cells([](const auto&) { return 1.0; });
  auto seepage = boundary<2>(Kind2::head, 0, 1.0), surface = boundary<2>(Kind2::pressure, kFreeSurface, 0);
  seepage.seepage_above = true;
  for (const auto& b :
       {boundary<2>(Kind2::flux, 0, 1e-6), boundary<2>(Kind2::atmosphere, 3, 1e-6), seepage, surface}) {
    s.conditions.boundaries = {b};
    s.update();
    PressureField<2> field(s.cells, water2());
    CHECK_THROWS_AS(field.refresh(), std::logic_error);
  }
}

TEST_CASE("flow along the layers and across them has the arithmetic and the harmonic mean, with anisotropy") {
  for (const bool along : {true, false}) {
    UnsaturatedScene<2> s({0, 0}, {8, 8}, 0.25);
    s.fill_cells([](const auto&) { return 1.0; });
    const int axis = along ? 0 : 1;
    // Pressures that make the head 3 m and 2 m at the two ends.
    s.conditions.boundaries = {
        boundary<2>(along ? Kind2::head : Kind2::pressure, 2 * axis, along ? 3 : 3 * kGamma),
        boundary<2>(along ? Kind2::head : Kind2::pressure, 2 * axis + 1, along ? 2 : 0)};
    s.cells_to(s.darcy_mobility, [](const auto& x) { return (x[1] < 1 ? 1e-4 : 4e-4) / kGamma; });
    s.update();
    Soil<2> soil = van_genuchten<2>();
    soil.anisotropy = {2, 0.5};
    UnsaturatedField<2> field(s.cells, water2(), {soil});
    field.refresh();
    const StepReport r = field.steady(s.unsaturated(10));
    REQUIRE(r.converged);
    const double q =
        along ? 0.5 * (1e-4 + 4e-4) * 2 * 1.0 / 2 * 2 : 0.5 * 2 / (1 / 1e-4 + 1 / 4e-4) * 1.0 / 2 * 2;
    CHECK(field.discharge().boundary[1] == doctest::Approx(q).epsilon(1e-6));
    CHECK(field.discharge().boundary[0] == doctest::Approx(-q).epsilon(1e-6));
  }
}

TEST_CASE("the same bits for any number of threads, with either solver") {
  for (const SolverKind kind : {SolverKind::direct, SolverKind::multigrid}) {
    Reals first;
    for (const int n : {1, 2, 4}) {
      set_threads(n);
      UnsaturatedScene<2> s({0, 0}, {60, 48}, 0.05);
      s.fill_cells([](const auto& x) { return in_levee(x[0] / 3, x[1] / 5) ? 1.0 : 0.0; });
      auto head = boundary<2>(Kind2::head, 0, 0.8), rain = boundary<2>(Kind2::atmosphere, kFreeSurface, 2e-5);
      s.conditions.boundaries = {head, rain};
      s.cells_to(s.darcy_mobility, [](const auto&) { return 1e-4 / kGamma; });
      s.update();
      UnsaturatedField<2> field(s.cells, water2(), {van_genuchten<2>(3, 2)}, kind);
      field.refresh();
      for (const auto& c : s.cells.cells())
        field.pressure()[c.slot] = kGamma * (0.2 - s.cells.centre(c.index)[1]);
      for (int i = 0; i < 5; ++i) REQUIRE(field.solve(s.unsaturated(60)).converged);
      if (n == 1)
        first = field.pressure();
      else
        CHECK(field.pressure() == first);
    }
  }
  set_threads(1);
}
