// Explicit steps of the pore pressure: the step limit, agreement with implicit steps, water kept where cells
// fill and empty, refusals, determinism.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "core/threads.hpp"
#include "fdm/unsaturated_field.hpp"
#include "tests/unit/fdm_scene.hpp"

using namespace polder;
using namespace polder::fdm;
using namespace polder::fdm::test;
using Kind2 = WaterBoundary<2>::Kind;

namespace {

constexpr double kBulk = 2.2e8, kPorosity = 0.4, kDensity = 1990;

template <int D>
struct Block : Scene<D> {
  std::vector<double> specific_volume, fraction;
  std::vector<int> soil;

  Block(Index<D> size, double h, double conductivity) : Scene<D>(Point<D>{}, size, h) {
    this->fill_cells([](const auto&) { return 1.0; });
    this->cells_to(this->darcy_mobility, [&](const auto&) { return conductivity / kGamma; });
    specific_volume.assign(this->grid.slots(), 1 / kDensity);
    soil.assign(this->grid.slots(), 0);
  }
  void update() {
    this->cells.update(this->fill, this->conditions);
    fraction.assign(this->grid.slots(), 0);
    soil_fraction<D>(this->cells, this->fill, fraction);
  }
  UnsaturatedStep unsaturated(double dt) const {
    return {.dt = dt,
            .porosity = this->porosity,
            .volume_fraction = fraction,
            .darcy_mobility = this->darcy_mobility,
            .soil = soil,
            .velocity = this->velocity,
            .mobility = this->mobility};
  }
};

Soil<2> sand(double alpha = 2, double n = 2) {
  Soil<2> s;
  s.retention.model = Retention::Model::van_genuchten;
  s.retention.alpha = alpha, s.retention.n = n, s.retention.residual = 0.1;
  return s;
}

double norm(const Reals& p) {
  double sum = 0;
  for (double x : p) sum += x * x;
  return std::sqrt(sum);
}

// Growth of the norm of a random pressure over `steps` of Darcy flow through a rigid skeleton.
template <int D>
double growth(Block<D>& s, double dt, int steps) {
  PressureField<D> field(s.cells, water<D>(kBulk, 0));
  field.refresh();
  verify::Random random(3);
  for (const auto& c : s.cells.cells()) field.pressure()[c.slot] = 2 * random() - 1;
  const double before = norm(field.pressure());
  for (int i = 0; i < steps; ++i) field.advance(s.step(dt, 0));
  return norm(field.pressure()) / before;
}

}  // namespace

TEST_CASE(
    "the limit of a closed column is (dt/dt_w)^2 + dt/dt_k = 1, that of a block the worst of its modes") {
  const double h = 0.1, stiffness = kBulk / kPorosity;
  const double wave = h * std::sqrt(kDensity / stiffness);
  for (const double k : {1e-12, 1e-5, 1e-4, 1e-3, 1e-2}) {
    CAPTURE(k);
    const double diffusion = h * h / (2 * k / kGamma * stiffness);
    Block<2> column({1, 10}, h, k);
    column.update();
    PressureField<2> field(column.cells, water2(kBulk));
    field.refresh();
    const ExplicitLimit limit = field.explicit_limit(column.step(1, 0), column.specific_volume);
    CHECK(std::pow(limit.dt / wave, 2) + limit.dt / diffusion == doctest::Approx(1).epsilon(1e-12));
    CHECK(limit.darcy == (limit.dt / diffusion > 0.5));

    Block<3> block({6, 6, 6}, h, k);
    block.update();
    PressureField<3> in_space(block.cells, water3(kBulk));
    in_space.refresh();
    const double dt = in_space.explicit_limit(block.step(1, 0), block.specific_volume).dt;
    const double along_one = std::pow(dt / wave, 2) + dt / diffusion, along_all = 3 * dt / diffusion;
    CHECK(std::max(along_one, along_all) == doctest::Approx(1).epsilon(1e-12));
  }
}

TEST_CASE("Darcy flow decays up to the limit, and grows beyond it where it is sharp") {
  set_threads(1);
  const auto limit_of = [](Block<2>& s) {
    PressureField<2> field(s.cells, water2(kBulk, 0));
    field.refresh();
    s.specific_volume.assign(s.grid.slots(), 0);
    return field.explicit_limit(s.step(1, 0), s.specific_volume).dt;
  };
  Block<2> closed({16, 16}, 0.1, 1e-3);
  closed.update();
  const double limit = limit_of(closed);
  CHECK(limit == doctest::Approx(0.01 * kGamma * kPorosity / (4 * 1e-3 * kBulk)).epsilon(1e-12));
  CHECK(growth(closed, 0.999 * limit, 3000) < 1);
  CHECK(growth(closed, 1.03 * limit, 400) > 1e3);
  // The surface at different distances from the centres of the cells below it.
  for (const double top : {0.671, 0.68, 0.7, 0.73, 0.76}) {
    CAPTURE(top);
    Block<2> cut({16, 16}, 0.1, 1e-3);
    cut.fill_below(top);
    cut.update();
    const double of_cut = limit_of(cut);
    CHECK(growth(cut, 0.999 * of_cut, 3000) < 1);
    CHECK(growth(cut, 1.2 * of_cut, 400) > 1e3);
  }
}

TEST_CASE("explicit and implicit steps draw near to each other with the step, a hydrostatic state rests") {
  set_threads(1);
  Block<2> s({8, 10}, 0.1, 1e-4);
  s.fill_below(0.83);
  s.conditions.boundaries = {boundary<2>(Kind2::head, 0, 0.9)};
  s.velocity_to([](const Point<2>& x) { return Point<2>{0, -1e-4 * x[1]}; });
  s.update();
  const auto difference = [&](double dt, int steps) {
    PressureField<2> a(s.cells, water2(kBulk)), b(s.cells, water2(kBulk));
    a.refresh(), b.refresh();
    for (int i = 0; i < steps; ++i) a.advance(s.step(dt, 0)), b.solve(s.step(dt, 0));
    Reals d = a.pressure();
    for (std::size_t i = 0; i < d.size(); ++i) d[i] -= b.pressure()[i];
    return norm(d) / norm(b.pressure());
  };
  const double coarse = difference(4e-5, 50), fine = difference(1e-5, 200);
  CHECK(coarse < 0.03);
  CHECK(fine < 0.3 * coarse);

  Block<2> rest({8, 10}, 0.1, 1e-4);
  rest.fill_below(0.83);
  rest.update();
  PressureField<2> field(rest.cells, water2(kBulk));
  field.refresh();
  for (const auto& c : rest.cells.cells())
    field.pressure()[c.slot] = kGamma * (0.83 - rest.centre(c.slot)[1]);
  const Reals before = field.pressure();
  for (int i = 0; i < 100; ++i) field.advance(rest.step(2e-5, 0));
  for (const auto& c : rest.cells.cells())
    CHECK(field.pressure()[c.slot] == doctest::Approx(before[c.slot]).epsilon(1e-10));
}

TEST_CASE("saturated soil: both equations make the same explicit steps") {
  set_threads(1);
  Block<2> s({10, 8}, 0.5, 1e-4);
  s.fill_below(3.6);
  s.conditions.outside_level = 5;
  s.conditions.boundaries = {boundary<2>(Kind2::head, 0, 6.0)};
  s.nodes_to(s.mobility, [](const auto& x) { return 2e-8 * (1 + 0.2 * x[0]); });
  s.update();
  std::fill(s.fraction.begin(), s.fraction.end(), 1.0);
  PressureField<2> saturated(s.cells, water2(kBulk));
  UnsaturatedField<2> field(s.cells, water2(kBulk), {sand()});
  saturated.refresh(), field.refresh();
  saturated.steady(s.darcy_mobility);
  field.pressure() = saturated.pressure();
  double worst = 0;
  for (int i = 0; i < 200; ++i) {
    s.velocity_to([&](const Point<2>& x) {
      return Point<2>{1e-4 * std::sin(0.3 * i + x[1]) * x[0], -2e-4 * x[1] * std::cos(0.1 * i + x[0])};
    });
    saturated.advance(s.step(1e-4));
    const ExplicitLimit limit = field.advance_explicitly(s.unsaturated(1e-4), s.specific_volume);
    const ExplicitLimit same = saturated.explicit_limit(s.step(1e-4), s.specific_volume);
    CHECK(limit.dt == doctest::Approx(same.dt).epsilon(1e-12));
    for (const auto& c : s.cells.cells())
      worst = std::max(worst, std::abs(field.pressure()[c.slot] - saturated.pressure()[c.slot]));
    CHECK(field.balance().outflow == doctest::Approx(saturated.balance().outflow).epsilon(1e-9));
  }
  CHECK(worst < 1e-9 * norm(saturated.pressure()));
}

TEST_CASE("no water is lost where cells fill and empty, and the result is that of implicit steps") {
  set_threads(1);
  Block<2> s({1, 10}, 0.1, 1e-3);
  s.conditions.boundaries = {boundary<2>(Kind2::flux, 3, 5e-4), boundary<2>(Kind2::pressure, 2, -2000)};
  s.update();
  UnsaturatedField<2> moving(s.cells, water2(kBulk), {sand()}), implicit(s.cells, water2(kBulk), {sand()});
  for (UnsaturatedField<2>* f : {&moving, &implicit}) {
    f->refresh();
    for (const auto& c : s.cells.cells()) f->pressure()[c.slot] = -9810;
  }
  const auto stored = [&](const UnsaturatedField<2>& f) {
    double sum = 0;
    for (const auto& c : s.cells.cells()) {
      const double p = f.pressure()[c.slot], water = f.curve(0).saturation(p);
      sum += c.volume * kPorosity * water;
    }
    return sum;
  };
  const double start = stored(moving), dt = 0.01;
  double inflow = 0, compression = 0;
  for (int i = 0; i < 10000; ++i) {
    const ExplicitLimit limit = moving.advance_explicitly(s.unsaturated(dt), s.specific_volume);
    CHECK(limit.dt > dt);
    UnsaturatedStep rigid = s.unsaturated(dt);
    rigid.velocity = rigid.mobility = {};
    REQUIRE(implicit.solve(rigid).converged);
    inflow -= dt * moving.balance().outflow;
    compression += dt * moving.balance().storage;
  }
  CHECK(inflow > 0.005);
  CHECK(compression == doctest::Approx(inflow).epsilon(1e-10));
  // Suction stretches the water, too, by p / K_w of it.
  CHECK(stored(moving) - start == doctest::Approx(inflow).epsilon(1e-4));
  for (const auto& c : s.cells.cells())
    CHECK(moving.pressure()[c.slot] == doctest::Approx(implicit.pressure()[c.slot]).epsilon(1e-3));
}

TEST_CASE("a cell that fills within a step takes the pressure of what is too much, and gives it back") {
  set_threads(1);
  Block<2> s({1, 1}, 0.1, 1e-3);
  s.update();
  UnsaturatedField<2> field(s.cells, water2(kBulk), {sand()});
  field.refresh();
  const int slot = s.cells.cells()[0].slot;
  field.pressure()[slot] = -500;
  const double room = 1 - field.curve(0).saturation(-500);
  // Squeezed by twice the air that it had.
  const double strain = 2 * room * kPorosity, dt = 1e-3;
  s.velocity_to([&](const Point<2>& x) { return Point<2>{0, -strain / dt * x[1]}; });
  field.advance_explicitly(s.unsaturated(dt), s.specific_volume);
  const double excess = strain - kPorosity * room;  // of water over pores, a share of the cell
  CHECK(field.pressure()[slot] == doctest::Approx(kBulk / kPorosity * excess - 500).epsilon(1e-6));
  CHECK(field.saturation()[slot] == 1);
  s.velocity_to([&](const Point<2>& x) { return Point<2>{0, strain / dt * x[1]}; });
  field.advance_explicitly(s.unsaturated(dt), s.specific_volume);
  // The stretched cell has S n (1 + strain) = water of before: the pores are counted before the step.
  CHECK(field.saturation()[slot] < 1);
  CHECK(field.pressure()[slot] < 0);
  CHECK(field.balance().defect() == doctest::Approx(0).scale(field.balance().magnitude).epsilon(1e-9));
}

TEST_CASE("an open drain holds its cell at its pressure, a closed step refuses") {
  set_threads(1);
  Block<2> s({4, 4}, 0.1, 1e-3);
  s.conditions.boundaries = {boundary<2>(Kind2::pressure, 0, 5000)};
  s.conditions.drains = {{"drain", {Point<2>{0.35, 0.25}}, 1000}};
  s.update();
  UnsaturatedField<2> field(s.cells, water2(kBulk), {sand()});
  field.refresh();
  for (const auto& c : s.cells.cells()) field.pressure()[c.slot] = 5000;
  const double dt = 0.5 * field.explicit_limit(s.unsaturated(1), s.specific_volume).dt;
  for (int i = 0; i < 20000; ++i) field.advance_explicitly(s.unsaturated(dt), s.specific_volume);
  const int slot = s.cells.cells()[s.cells.number(s.grid.slot({3, 2}))].slot;
  CHECK(field.pressure()[slot] == doctest::Approx(1000).epsilon(1e-3));
  CHECK(field.discharge().drain[0] == doctest::Approx(-field.discharge().boundary[0]).epsilon(1e-6));

  PressureField<2> stiff(s.cells, water2(kInfinity));
  CHECK_THROWS_AS(stiff.advance(s.step(1)), InputError);
  CHECK_THROWS_AS((void)stiff.explicit_limit(s.step(1), s.specific_volume), InputError);
  UnsaturatedField<2> rigid(s.cells, water2(kBulk), {sand()});
  rigid.refresh();
  UnsaturatedStep without = s.unsaturated(dt);
  without.velocity = without.mobility = {};
  CHECK_THROWS_AS(rigid.advance_explicitly(without, s.specific_volume), std::logic_error);
}

TEST_CASE("the same bits for 1, 2 and 4 threads") {
  const auto run = [](int n) {
    set_threads(n);
    Block<2> s({60, 60}, 0.1, 1e-3);  // more cells than one thread does alone
    s.fill_below(5.53);
    s.nodes_to(s.mobility, [](const auto& x) { return 2e-8 * (1 + 0.2 * x[0]); });
    s.velocity_to([](const Point<2>& x) { return Point<2>{1e-3 * std::sin(x[1]) * x[0], -1e-3 * x[1]}; });
    s.update();
    UnsaturatedField<2> field(s.cells, water2(kBulk), {sand()});
    field.refresh();
    for (const auto& c : s.cells.cells()) field.pressure()[c.slot] = kGamma * (3 - s.centre(c.slot)[1]);
    PressureField<2> saturated(s.cells, water2(kBulk));
    saturated.refresh();
    Reals bits;
    for (int i = 0; i < 20; ++i) {
      bits.push_back(field.advance_explicitly(s.unsaturated(1e-6), s.specific_volume).dt);
      saturated.advance(s.step(1e-6));
    }
    bits.insert(bits.end(), field.pressure().begin(), field.pressure().end());
    bits.insert(bits.end(), saturated.pressure().begin(), saturated.pressure().end());
    return bits;
  };
  const Reals one = run(1);
  CHECK(run(2) == one);
  CHECK(run(4) == one);
  set_threads(1);
}
