// A column with its water table at half height whose elastic skeleton moves: rest, undrained rise of pressure
// below the table, consolidation into the unsaturated soil above.
//
// The skeleton is a chain of lumped masses on the grid's own nodes, so that the water is tested alone: node
// velocities v* from stress, gradient of p+ and suction, then the step of the water, then the correction.
#include <doctest/doctest.h>

#include <algorithm>

#include "core/threads.hpp"
#include "tests/verify/seepage_scene.hpp"

using namespace polder;
using namespace polder::verify;
using fdm::BoundaryValues;
using fdm::WallNormal;

namespace {

constexpr int kCells = 20;
constexpr double kCell = 0.1, kModulus = 1e7, kPorosity = 0.4, kDensity = 0.6 * 2650 + 400, kLoad = 1e4;

class Column {
 public:
  int most_iterations = 0;
  double iterations = 0;
  double defect = 0, through = 0;  // [m3]

  Column(const fdm::Retention& retention, double conductivity, double table)
      : scene_({0, 0}, {1, kCells}, kCell, {fdm::Soil<2>{.retention = retention}}, 2.2e9) {
    scene_.set_conductivity(conductivity);
    scene_.conditions.boundaries = {
        fdm::test::boundary<2>(fdm::WaterBoundary<2>::Kind::surface, 3, 0)};  // free to seep, and free of p+
    scene_.update();
    scene_.set_head([&](const Point<2>& x) { return table - x[1]; });
    gradient_.assign(scene_.velocity.size(), 0);
    positive_.assign(scene_.grid.slots(), 0);
    double total = 0;  // stress of the mixture at the centre of the cell: its weight above
    for (int j = kCells - 1; j >= 0; --j) {
      total -= 0.5 * kDensity * 9.81 * kCell;
      stress_[j] = total + suction_part(j) + pushing(j);
      total -= 0.5 * kDensity * 9.81 * kCell;
    }
  }

  double pressure(int cell) const { return scene_.field.pressure()[scene_.grid.slot({0, cell})]; }
  long steps() const { return step_; }
  double settlement() const { return settlement_; }
  double speed() const { return std::abs(velocity_[kCells]); }

  void run(double duration, double load) {
    const double dt = 0.5 * kCell / std::sqrt(kModulus / kDensity);
    for (const long end = step_ + std::lround(duration / dt); step_ < end; ++step_) {
      for (int j = 0; j < kCells; ++j) positive_[scene_.grid.slot({0, j})] = pushing(j);
      scene_.field.node_gradient(positive_, BoundaryValues::present, WallNormal::none, gradient_);
      predict(dt, load * std::min(1.0, static_cast<double>(step_) * dt / 0.05));
      fdm::UnsaturatedStep step = scene_.unsaturated(dt);
      step.velocity = scene_.velocity, step.mobility = scene_.mobility;
      const fdm::StepReport r = scene_.field.solve(step);
      REQUIRE(r.converged);
      iterations += r.iterations;
      most_iterations = std::max(most_iterations, r.iterations);
      defect += dt * scene_.field.balance().defect();
      through += dt * scene_.field.balance().magnitude;
      scene_.field.node_gradient(scene_.field.increment(), BoundaryValues::homogeneous, WallNormal::none,
                                 gradient_);
      for (int i = 1; i <= kCells; ++i) velocity_[i] = predicted_[i] - dt / kDensity * gradient_at(i);
      for (int j = 0; j < kCells; ++j)
        stress_[j] += kModulus * dt * (velocity_[j + 1] - velocity_[j]) / kCell;
      settlement_ -= dt * velocity_[kCells];
    }
  }

 private:
  double pushing(int cell) const { return std::max(pressure(cell), -scene_.field.full_suction(0)); }
  // What Bishop's stress S p leaves to the soil besides the part that pushes.
  double suction_part(int cell) const {
    const double p = pressure(cell);
    return (p < 0 ? scene_.field.curve(0).saturation(p) * p : p) - pushing(cell);
  }
  double gradient_at(int node) const {
    return gradient_[static_cast<std::size_t>(scene_.grid.slot({0, node})) * 4 + 1];
  }
  void predict(double dt, double load) {
    constexpr double kDamping = 0.02;
    for (int i = 0; i <= kCells; ++i) {
      const double share = i == 0 || i == kCells ? 0.5 : 1;  // of a cell
      double force = -load * (i == kCells) - share * kDensity * 9.81 * kCell;
      if (i < kCells) force += stress_[i] - suction_part(i);
      if (i > 0) force -= stress_[i - 1] - suction_part(i - 1);
      force -= share * kCell * gradient_at(i);
      predicted_[i] = i == 0 ? 0 : (1 - kDamping) * velocity_[i] + dt * force / (share * kCell * kDensity);
      for (int side = 0; side < 2; ++side) {
        const int slot = scene_.grid.slot({side, i});
        scene_.velocity[static_cast<std::size_t>(slot) * 4 + 1] = predicted_[i];
        scene_.mobility[slot] = dt / kDensity;
      }
    }
  }

  SeepageScene scene_;
  std::vector<double> gradient_, positive_;
  double stress_[kCells]{}, velocity_[kCells + 1]{}, predicted_[kCells + 1]{};
  double settlement_ = 0;
  long step_ = 0;
};

fdm::Retention curve(double alpha, double n) {
  fdm::Retention r;
  r.model = fdm::Retention::Model::van_genuchten;
  r.alpha = alpha, r.n = n, r.residual = 0.05;
  return r;
}

}  // namespace

TEST_CASE("a column with a water table inside rests to round-off, skeleton and water") {
  set_threads(1);
  for (const double table : {1.0, 1.05, 1.08}) {
    CAPTURE(table);
    Column c(curve(2, 2), 1e-4, table);
    c.run(1, 0);
    CHECK(std::abs(c.settlement()) < 1e-14);
    for (int j = 0; j < kCells; ++j)
      CHECK(std::abs(c.pressure(j) - kGamma * (table - (j + 0.5) * kCell)) < 1e-9 * kGamma);
  }
}

TEST_CASE("a load on it raises the pressure below the table only, and consolidation ends drained") {
  set_threads(1);
  for (const double table : {1.02, 1.05, 1.08})
    for (const auto& retention : {curve(2, 2), curve(10, 3)}) {
      CAPTURE(table);
      CAPTURE(retention.alpha);
      Column tight(retention, 1e-8, table), open(retention, 1e-3, table);
      // Undrained: saturated soil carries nothing of the load, unsaturated all of it.
      tight.run(0.5, kLoad);
      for (int j = 0; j < 7; ++j)
        CHECK(tight.pressure(j) - kGamma * (table - (j + 0.5) * kCell) ==
              doctest::Approx(kLoad).epsilon(0.04));
      for (int j = 12; j < kCells; ++j)
        CHECK(std::abs(tight.pressure(j) - kGamma * (table - (j + 0.5) * kCell)) < 0.02 * kLoad);
      // From the first saturated cell's upper face upwards, about.
      CHECK(tight.settlement() == doctest::Approx(kLoad / kModulus * (kCells * kCell - table)).epsilon(0.1));
      open.run(4, kLoad);
      CHECK(open.settlement() == doctest::Approx(kLoad / kModulus * kCells * kCell).epsilon(0.04));
      CHECK(open.speed() < 1e-4);
      for (const Column* c : {&tight, &open}) {
        CHECK(c->most_iterations <= 15);
        CHECK(c->iterations < 4.5 * static_cast<double>(c->steps()));
        CHECK(std::abs(c->defect) < 1e-6 * c->through);
      }
    }
}
