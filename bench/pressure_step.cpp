// Time of one pressure step on a levee-shaped mask, by solver and number of cells: the measurement behind
// kDirectCells in fdm/solver_choice.cpp. Every step has new masses, velocities and conductivities (contrast
// 3 or 1e4); the mask stands. Columns in milliseconds, the fastest of the repetitions.
//   bench_pressure_step [repetitions = 200]
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <vector>

#include "core/threads.hpp"
#include "fdm/pressure_field.hpp"

using namespace polder;
using namespace polder::fdm;

namespace {

double seconds(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

struct Levee {
  Grid<2> grid;
  WaterCells<2> cells;
  WaterConditions<2> conditions;
  std::vector<double> fill, porosity, darcy_mobility, mobility, velocity;

  explicit Levee(int nx) : grid({0, 0}, {nx, nx / 2}, 12.0 / nx), cells(grid, Space::plane_strain) {
    std::vector<int> all(grid.block_numbers());
    for (int b = 0; b < grid.block_numbers(); ++b) all[b] = b;
    grid.activate(all);
    fill.assign(grid.slots(), 0);
    porosity.assign(grid.slots(), 0.46);
    for (auto* a : {&darcy_mobility, &mobility}) a->assign(grid.slots(), 0);
    velocity.assign(4 * grid.slots(), 0);
    for (int s = 0; s < grid.slots(); ++s) {
      const Point<2> x = cells.centre(grid.index(s));
      const double top = x[0] < 3 ? 3 : std::max(0.0, 3 - (x[0] - 3) / 2);  // 1 : 2
      fill[s] = grid.is_cell(grid.index(s)) ? std::clamp((top - x[1]) / grid.spacing() + 0.5, 0.0, 1.0) : 0;
    }
    WaterBoundary<2> left;
    left.name = "left";
    left.value = 2.5;
    conditions.boundaries = {left};
  }
  void vary(int step, double contrast) {
    for (int s = 0; s < grid.slots(); ++s) {
      const Point<2> x = grid.position(grid.index(s));
      const double wave = std::sin(0.7 * step + 5 * x[0] + 3 * x[1]);
      mobility[s] = 3e-7 * (1 + 0.1 * wave);
      darcy_mobility[s] = 5e-8 * (std::sin(2 * x[1] + x[0]) > 0 ? contrast : 1) * (1 + 0.01 * wave);
      velocity[4 * s] = 1e-3 * wave;
      velocity[4 * s + 1] = -1e-3 * wave * x[1];
    }
  }
};

}  // namespace

int main(int argc, char** argv) {
  const int repetitions = argc > 1 ? std::atoi(argv[1]) : 200;
  std::printf("%d threads\n", threads());
  std::printf("%7s %9s %-10s %7s %9s %9s %9s %6s\n", "cells", "contrast", "solver", "solve", "gradient",
              "step", "new mask", "iter.");
  for (int nx : {60, 84, 108, 120, 160, 200, 240, 340, 480})
    for (double contrast : {3.0, 1e4})
      for (SolverKind kind : {SolverKind::direct, SolverKind::multigrid}) {
        Levee levee(nx);
        WaterProperties<2> water{.density = 1000, .bulk_modulus = 2.2e9, .gravity = {0, -9.81}};
        PressureField<2> field(levee.cells, water, kind);
        const double new_mask = seconds([&] {
          levee.cells.update(levee.fill, levee.conditions);
          field.refresh();
        });
        Reals gradient(4 * levee.grid.slots()), divergence(levee.grid.slots());
        double best_solve = 1e9, best_gradient = 1e9, best_step = 1e9;
        int iterations = 0;
        for (int step = 0; step < repetitions; ++step) {
          levee.vary(step, contrast);
          std::fill(field.pressure().begin(), field.pressure().end(), 0.0);
          const double a = seconds([&] {
            levee.cells.update(levee.fill, levee.conditions);
            field.node_gradient(field.pressure(), BoundaryValues::present, WallNormal::none, gradient);
          });
          const double b = seconds([&] {
            iterations =
                field
                    .solve({6e-4, levee.velocity, levee.mobility, levee.porosity, levee.darcy_mobility, 0.05})
                    .iterations;
          });
          const double c = seconds([&] {
            field.node_gradient(field.increment(), BoundaryValues::homogeneous, WallNormal::none, gradient);
            field.cell_divergence(levee.velocity, divergence);
            field.discharge();
          });
          best_solve = std::min(best_solve, b);
          best_gradient = std::min(best_gradient, c);
          best_step = std::min(best_step, a + b + c);
        }
        std::printf("%7d %9.0e %-10s %7.3f %9.3f %9.3f %9.3f %6d\n", levee.cells.count(), contrast,
                    kind == SolverKind::direct ? "direct" : "multigrid", 1e3 * best_solve,
                    1e3 * best_gradient, 1e3 * best_step, 1e3 * new_mask, iterations);
        std::fflush(stdout);
      }
}
