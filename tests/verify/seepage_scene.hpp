// A box of soil full of cells, its unsaturated water and the loops that drive it: for the seepage tests. SI
// units; x to the right, y up.
#pragma once

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "fdm/unsaturated_field.hpp"
#include "tests/unit/fdm_scene.hpp"

namespace polder::verify {

using fdm::test::kGamma;

struct SeepageScene : fdm::test::UnsaturatedScene<2> {
  fdm::UnsaturatedField<2> field;
  double time = 0, inflow = 0, stored = 0, defect = 0;  // sums over the steps: [s], [m3], [m3], [m3]
  std::vector<double> out;                              // of each named boundary [m3]
  double out_surface = 0;
  long steps = 0, iterations = 0, rejected = 0;

  SeepageScene(Point<2> origin, Index<2> size, double h, std::vector<fdm::Soil<2>> soils,
               double bulk_modulus = fdm::test::kInfinity, fdm::SolverKind kind = fdm::SolverKind::automatic,
               double g = -9.81, Space space = Space::plane_strain)
      : UnsaturatedScene<2>(origin, size, h, space),
        field(cells, fdm::test::water2(bulk_modulus, g), std::move(soils), kind) {
    fill_cells([](const auto&) { return 1.0; });
  }

  // Takes up fill and conditions.
  void update() {
    UnsaturatedScene<2>::update();
    field.refresh();
    out.resize(conditions.boundaries.size(), 0);
  }
  // Pressure from the head h(x) [m].
  void set_head(const At& h) {
    for (const auto& c : cells.cells()) {
      field.pressure()[c.slot] = kGamma * h(cells.centre(c.index));
      field.saturation()[c.slot] = fdm::UnsaturatedField<2>::kFromPressure;
    }
  }
  double head(const fdm::ActiveCell<2>& c) const { return field.pressure()[c.slot] / kGamma; }

  // One step; false and nothing changed if it does not converge.
  bool step(double dt) {
    const fdm::StepReport r = field.solve(unsaturated(dt));
    iterations += r.iterations;
    if (!r.converged) {
      ++rejected;
      return false;
    }
    ++steps;
    time += dt;
    const fdm::WaterBalance& b = field.balance();
    stored += dt * b.storage;
    defect += dt * b.defect();
    inflow -= dt * b.outflow;
    for (std::size_t i = 0; i < out.size(); ++i) out[i] += dt * field.discharge().boundary[i];
    out_surface += dt * field.discharge().surface;
    last_iterations = r.iterations;
    return true;
  }
  // To `end` with steps of the same length.
  void run_fixed(double end, double dt) {
    const long n = std::lround((end - time) / dt);
    const double each = (end - time) / static_cast<double>(n);
    for (long i = 0; i < n; ++i)
      if (!step(each)) throw std::runtime_error("a step did not converge");
  }
  // To `end` with a length that follows the number of iterations.
  void run(double end, double& dt, double longest = fdm::test::kInfinity) {
    while (time < end * (1 - 1e-12)) {
      dt = std::min(dt, longest);
      const double rest = end - time, length = dt >= rest ? rest : std::min(dt, 0.5 * rest + 0.5 * dt);
      if (!step(length)) {
        dt = 0.5 * length;
        if (dt < 1e-12 * end) throw std::runtime_error("the step shrank to nothing");
      } else if (last_iterations <= 5) {
        dt = std::max(dt, length * 1.25);
      } else if (last_iterations > 10) {
        dt = 0.7 * length;
      }
    }
  }
  int last_iterations = 0;

  // Values at the cells of one column (or row) of the grid, in ascending order along `axis`.
  std::vector<double> line(int axis, int fixed, const std::vector<double>& of_slots) const {
    std::vector<double> values;
    for (int i = 0; i < grid.cells()[axis]; ++i) {
      Index<2> index;
      index[axis] = i, index[1 - axis] = fixed;
      values.push_back(of_slots[grid.slot(index)]);
    }
    return values;
  }
};

}  // namespace polder::verify
