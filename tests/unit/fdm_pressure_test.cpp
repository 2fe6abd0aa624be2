#include <doctest/doctest.h>

#include "core/error.hpp"
#include "core/threads.hpp"
#include "tests/unit/fdm_scene.hpp"

using namespace polder;
using namespace polder::fdm;
using namespace polder::fdm::test;

namespace {

constexpr double kPi = 3.14159265358979323846;

// Increment phi with zero normal derivative at the walls and zero at the surface z = 1, from the velocity Lam
// grad phi; Lam varies in space. Returns the largest error of the increment.
template <int D>
double manufactured(int n, Space space, SolverKind solver) {
  const double h = 1.07 / n;  // the surface z = 1 lies inside a cell
  Index<D> size;
  size.fill(n);
  Scene<D> s(Point<D>{}, size, h, space);
  const double width = n * h;
  s.fill_below(1.0);
  const auto mobility = [&](const Point<D>& x) {
    return 1e-6 * (1 + 0.5 * x[0] + 0.3 * x[D - 1] * x[D - 1]);
  };
  const auto phi = [&](const Point<D>& x) {
    double value = std::cos(0.5 * kPi * x[D - 1]);
    for (int d = 0; d + 1 < D; ++d) value *= std::cos(kPi * x[d] / width);
    return value;
  };
  s.nodes_to(s.mobility, mobility);
  s.velocity_to([&](const Point<D>& x) {
    Point<D> v;
    for (int d = 0; d < D; ++d) {
      const double a = d + 1 < D ? kPi / width : 0.5 * kPi;
      v[d] = -mobility(x) * a * std::sin(a * x[d]);
      for (int e = 0; e < D; ++e)
        if (e != d) v[d] *= std::cos((e + 1 < D ? kPi / width : 0.5 * kPi) * x[e]);
    }
    return v;
  });
  s.cells.update(s.fill, s.conditions);
  PressureField<D> field(s.cells, water<D>(kInfinity, 0), solver);
  field.refresh();
  field.solve(s.step(1e-3, 0));
  double error = 0;
  for (const auto& c : s.cells.cells())
    error = std::max(error, std::abs(field.increment()[c.slot] - phi(s.cells.centre(c.index))));
  return error;
}

// Everything irregular: a levee with a varying fill at its surface, random velocities, conductivities and
// masses.
void random_levee(Scene<2>& s, int nx) {
  verify::Random random(12345);
  s.fill_cells(
      [&](const auto& x) { return in_levee(x[0] / nx, x[1] / nx) ? 0.6 + 0.6 * random() : 0.45 * random(); });
  s.cells_to(s.darcy_mobility, [&](const auto&) { return std::pow(10.0, -11 + 4 * random()); });
  s.cells_to(s.porosity, [&](const auto&) { return 0.3 + 0.3 * random(); });
  s.nodes_to(s.mobility, [&](const auto&) { return 5e-7 * (0.7 + 0.6 * random()); });
  s.velocity_to([&](const auto&) { return Point<2>{random() - 0.5, random() - 0.5}; });
  s.conditions.boundaries = {boundary<2>(WaterBoundary<2>::Kind::head, 0, 0.12 * nx),
                             boundary<2>(WaterBoundary<2>::Kind::pressure, 2, 3e4)};
}

}  // namespace

TEST_CASE("manufactured pressure converges with second order in 2D, axisymmetry and 3D") {
  const auto check = [](const std::string& space, double coarse, double fine, double least_order) {
    const double order = std::log2(coarse / fine);
    MESSAGE(space << ": largest errors " << coarse << ", " << fine << ", order " << order);
    CHECK(order > least_order);
    CHECK(fine < 4e-3);
  };
  check("plane strain", manufactured<2>(32, Space::plane_strain, SolverKind::direct),
        manufactured<2>(64, Space::plane_strain, SolverKind::direct), 1.9);
  check("axisymmetric", manufactured<2>(32, Space::axisymmetric, SolverKind::multigrid),
        manufactured<2>(64, Space::axisymmetric, SolverKind::multigrid), 1.9);
  check("3D", manufactured<3>(10, Space::three_d, SolverKind::automatic),
        manufactured<3>(20, Space::three_d, SolverKind::automatic), 1.9);
}

TEST_CASE("hydrostatic pressure stays as it is with the surface at 8 places in a cell") {
  const double h = 0.1;
  for (double offset : {0.05, 0.15, 0.25, 0.45, 0.52, 0.65, 0.8, 0.95})
    for (bool submerged : {false, true})
      for (Space space : {Space::plane_strain, Space::axisymmetric})
        for (SolverKind kind : {SolverKind::direct, SolverKind::multigrid}) {
          CAPTURE(offset);
          const double top = (12 + offset) * h, level = submerged ? top + 0.33 : top;
          Scene<2> s({0, 0}, {8, 16}, h, space);
          s.fill_below(top);
          if (submerged) s.conditions.outside_level = level;
          s.cells_to(s.darcy_mobility, [](const auto&) { return 1e-3 / 9810; });
          s.nodes_to(s.mobility, [](const auto& x) { return 5e-7 * (1 + x[0]); });
          s.cells.update(s.fill, s.conditions);
          PressureField<2> field(s.cells, water2(2.2e9), kind);
          field.refresh();
          for (const auto& c : s.cells.cells())
            field.pressure()[c.slot] = 9810 * (level - s.cells.centre(c.index)[1]);
          field.solve(s.step(1e-3));
          double largest = 0;
          for (const auto& c : s.cells.cells())
            largest = std::max(largest, std::abs(field.increment()[c.slot]));
          CHECK(largest < 1e-10 * 9810 * 1.3);
          CHECK(std::abs(field.discharge().surface) < 1e-14);
        }
}

TEST_CASE("the Rhie-Chow term vanishes for pressure linear in the height up to the surface") {
  Scene<2> s({0, 0}, {12, 10}, 0.1);
  s.fill_below(0.93);
  s.nodes_to(s.mobility, [](const auto&) { return 5e-7; });
  s.cells.update(s.fill, s.conditions);
  PressureField<2> field(s.cells, water2());
  field.refresh();
  for (const auto& c : s.cells.cells()) field.pressure()[c.slot] = 777 * (0.93 - s.cells.centre(c.index)[1]);
  field.solve(s.step(1e-3, 1.0));
  for (const auto& c : s.cells.cells()) CHECK(std::abs(field.increment()[c.slot]) < 1e-10 * 777);
}

TEST_CASE("a checkerboard decays by 1 / (1 + chi) a step, and stays for ever without the Rhie-Chow term") {
  // Away from the walls the nodal gradient of a checkerboard is zero: nothing but the Rhie-Chow term can see
  // it. With k = 0 its equation is (1 + chi) L dp = - chi L p, hence p -> p / (1 + chi).
  const int n = 60;
  for (double chi : {0.0, 0.05}) {
    Scene<2> s({0, 0}, {n, n}, 0.1);
    s.fill_cells([](const auto&) { return 1.0; });
    s.conditions.boundaries = {boundary<2>(WaterBoundary<2>::Kind::surface, 3, 0)};
    s.nodes_to(s.mobility, [](const auto&) { return 5e-7; });
    s.cells.update(s.fill, s.conditions);
    PressureField<2> field(s.cells, water2(kInfinity, 0));
    field.refresh();
    const auto sign = [](const Index<2>& i) { return (i[0] + i[1]) % 2 ? 1 : -1; };
    for (const auto& c : s.cells.cells()) field.pressure()[c.slot] = sign(c.index);
    Reals g(s.grid.slots() * 4);
    const auto amplitude = [&] {
      double sum = 0;
      int cells = 0;
      for (const auto& c : s.cells.cells())
        if (std::abs(c.index[0] - n / 2) < 8 && std::abs(c.index[1] - n / 2) < 8) {
          sum += sign(c.index) * field.pressure()[c.slot];
          ++cells;
        }
      return sum / cells;
    };
    for (int step = 1; step <= 100; ++step) {
      field.node_gradient(field.pressure(), BoundaryValues::present, WallNormal::none, g);
      for (std::size_t i = 0; i < g.size(); ++i) s.velocity[i] = -s.mobility[i / 4] * g[i];  // from rest
      field.solve(s.step(1e-3, chi));
      if (step == 20) CHECK(amplitude() == doctest::Approx(std::pow(1 + chi, -20)).epsilon(0.01));
    }
    if (chi > 0)
      CHECK(std::abs(amplitude()) < 0.02);
    else
      CHECK(amplitude() > 0.95);
  }
}

TEST_CASE("the corrected nodal velocity is divergence-free to the order of the approximate projection") {
  const auto largest = [](int n) {
    Scene<2> s({0, 0}, {n, n}, 1.0 / n);
    s.fill_cells([](const auto&) { return 1.0; });
    s.conditions.boundaries = {boundary<2>(WaterBoundary<2>::Kind::surface, 3, 0)};
    s.nodes_to(s.mobility, [](const auto&) { return 1e-6; });
    s.velocity_to([](const auto& x) {
      return Point<2>{std::sin(kPi * x[0]) * std::cos(kPi * x[1]),
                      std::sin(0.5 * kPi * x[1]) * std::cos(kPi * x[0])};
    });
    s.cells.update(s.fill, s.conditions);
    PressureField<2> field(s.cells, water2(kInfinity, 0));
    field.refresh();
    field.solve(s.step(1e-3, 0));
    Reals g(s.grid.slots() * 4);
    field.node_gradient(field.increment(), BoundaryValues::homogeneous, WallNormal::none, g);
    for (std::size_t i = 0; i < g.size(); ++i) s.velocity[i] -= 1e-6 * g[i];
    Reals divergence(s.grid.slots());
    field.cell_divergence(s.velocity, divergence);
    double sum = 0;
    for (const auto& c : s.cells.cells()) sum += std::abs(divergence[c.slot]);
    return sum / s.cells.count();
  };
  CHECK(largest(16) < 0.1);  // of pi before the projection
  CHECK(std::log2(largest(16) / largest(32)) > 1.4);
}

TEST_CASE("water balance closes to 1e-10 on an irregular levee") {
  for (SolverKind kind : {SolverKind::direct, SolverKind::multigrid})
    for (double bulk_modulus : {2.2e9, kInfinity}) {
      const int nx = 60;
      Scene<2> s({0, 0}, {nx, nx / 2}, 1.0);
      random_levee(s, nx);
      s.cells.update(s.fill, s.conditions);
      PressureField<2> field(s.cells, water2(bulk_modulus), kind);
      field.set_tolerance(1e-12);
      field.refresh();
      for (int step = 0; step < 3; ++step) {
        field.solve(s.step(1e-3));
        const WaterBalance& b = field.balance();
        CHECK(b.magnitude > 1);
        CHECK(std::abs(b.defect()) < 1e-10 * b.magnitude);
        CHECK(b.outflow == doctest::Approx(field.discharge().total()).epsilon(1e-12));
      }
      // With another velocity the skeleton's part, and nothing else, is exchanged.
      std::vector<double> still(s.velocity.size(), 0.0);
      CHECK(field.balance(still).skeleton == 0);
      CHECK(field.balance(still).storage == field.balance().storage);
    }
}

TEST_CASE("both solvers give the same increment") {
  const int nx = 60;
  Scene<2> s({0, 0}, {nx, nx / 2}, 1.0);
  random_levee(s, nx);
  s.cells.update(s.fill, s.conditions);
  PressureField<2> direct(s.cells, water2(2.2e9), SolverKind::direct);
  PressureField<2> multigrid(s.cells, water2(2.2e9), SolverKind::multigrid);
  for (auto* field : {&direct, &multigrid}) {
    field->set_tolerance(1e-12);
    field->refresh();
    field->solve(s.step(1e-3));
  }
  double largest = 0, difference = 0;
  for (const auto& c : s.cells.cells()) {
    largest = std::max(largest, std::abs(direct.increment()[c.slot]));
    difference = std::max(difference, std::abs(direct.increment()[c.slot] - multigrid.increment()[c.slot]));
  }
  CHECK(largest > 0);
  CHECK(difference < 1e-8 * largest);
}

TEST_CASE("same bits with 1, 2 and 4 threads") {
  for (SolverKind kind : {SolverKind::direct, SolverKind::multigrid}) {
    const bool direct = kind == SolverKind::direct;
    const int nx = direct ? 200 : 400;
    Reals first_p, first_g;
    for (int n : {1, 2, 4}) {
      set_threads(n);
      Scene<2> s({0, 0}, {nx, nx / 2}, 1.0);
      random_levee(s, nx);
      s.cells.update(s.fill, s.conditions);
      REQUIRE(s.cells.count() > (direct ? 8192 : 32768));  // long enough for parallel loops
      PressureField<2> field(s.cells, water2(2.2e9), kind);
      field.refresh();
      field.solve(s.step(1e-3));
      Reals g(s.grid.slots() * 4);
      field.node_gradient(field.pressure(), BoundaryValues::present, WallNormal::inward, g);
      if (n == 1) first_p = field.pressure(), first_g = g;
      CHECK(field.pressure() == first_p);
      CHECK(g == first_g);
    }
    set_threads(0);
  }
}

TEST_CASE("a closed basin of incompressible water is pinned and its balance closes") {
  Scene<2> s({0, 0}, {20, 15}, 0.1);
  s.fill_cells([](const auto&) { return 1.0; });
  s.nodes_to(s.mobility, [](const auto&) { return 1e-6; });
  s.velocity_to([](const auto& x) {  // tangential at the walls
    return Point<2>{std::sin(kPi * x[0] / 2) * x[1], std::sin(kPi * x[1] / 1.5) * x[0]};
  });
  s.cells.update(s.fill, s.conditions);
  for (SolverKind kind : {SolverKind::direct, SolverKind::multigrid}) {
    PressureField<2> field(s.cells, water2(), kind);
    field.refresh();
    field.solve(s.step(1e-3));
    CHECK(field.pinned_basins() == 1);
    const double largest = std::abs(*std::max_element(field.increment().begin(), field.increment().end()));
    CHECK(largest > 1);
    CHECK(std::abs(field.increment()[s.cells.cells()[0].slot]) < 1e-9 * largest);
    CHECK(std::abs(field.balance().defect()) < 1e-10 * field.balance().magnitude);
  }
}

TEST_CASE("storage alone: a closed compressible basin follows its change of volume") {
  Scene<2> s({0, 0}, {6, 5}, 0.2);
  s.fill_cells([](const auto&) { return 1.0; });
  s.velocity_to([](const auto& x) { return Point<2>{-1e-3 * x[0], -2e-3 * x[1]}; });
  s.nodes_to(s.mobility, [](const auto&) { return 1e-7; });
  s.cells.update(s.fill, s.conditions);
  PressureField<2> field(s.cells, water2(1e9));
  field.refresh();
  field.solve(s.step(1e-2));
  CHECK(field.pinned_basins() == 0);
  // n / Kw dp/dt = - div v = 3e-3 1/s
  for (const auto& c : s.cells.cells())
    CHECK(field.increment()[c.slot] == doctest::Approx(3e-3 * 1e9 / 0.4 * 1e-2).epsilon(1e-9));
}

TEST_CASE("pressure follows the grid and is zero where water has left; misuse is reported") {
  Scene<2> s({0, 0}, {40, 8}, 1.0);
  s.grid.activate({0});
  s.fill.assign(s.grid.slots(), 1.0);
  s.cells.update(s.fill, s.conditions);
  PressureField<2> field(s.cells, water2());
  CHECK_THROWS_AS(field.solve(s.step(1e-3)), std::logic_error);
  field.refresh();
  for (int slot = 0; slot < s.grid.slots(); ++slot) field.pressure()[slot] = 1 + s.grid.index(slot)[0];
  s.grid.activate({0, 1, 2});
  s.fill.assign(s.grid.slots(), 0.0);
  for (int slot = 0; slot < s.grid.slots(); ++slot) s.fill[slot] = s.grid.index(slot)[0] < 5 ? 1 : 0;
  s.cells.update(s.fill, s.conditions);
  CHECK_THROWS_AS(field.refresh(), std::logic_error);
  field.carry();
  field.refresh();
  for (int i = 0; i < 20; ++i) CHECK(field.pressure()[s.grid.slot({i, 3})] == (i < 5 ? 1 + i : 0));
}

TEST_CASE("a cell coupled to nothing is named") {
  Scene<2> s({0, 0}, {4, 4}, 1.0);
  s.fill_below(2.0);
  s.cells.update(s.fill, s.conditions);
  PressureField<2> field(s.cells, water2());
  field.refresh();
  CHECK_THROWS_WITH_AS(field.solve(s.step(1e-3)), doctest::Contains("0.500000, 0.500000"), NumericalError);
}
