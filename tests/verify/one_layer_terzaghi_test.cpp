// Consolidation under a load: Terzaghi's column, two layers, and finite strain.
#include "core/threads.hpp"
#include "tests/verify/one_layer_demands.hpp"

using namespace polder;
using namespace polder::verify;

TEST_CASE("Terzaghi: pore pressure of ten cells at three times, the same step for every conductivity") {
  set_threads(1);
  for (const ShapeKind shape : kShapes)
    for (const double k : {1e-3, 1e-4}) check_ten_cells(shape, k);
}

TEST_CASE("Terzaghi: order of convergence, 5 to 20 cells") {
  set_threads(1);
  check_order({0.2, 0.1, 0.05});
}

TEST_CASE("two layers, soft over stiff: second order with GIMP") {
  set_threads(1);
  for (const ShapeKind shape : kShapes) {
    CAPTURE(name_of(shape));
    std::vector<Consolidation> runs;
    for (const double h : {0.1, 0.05})
      runs.push_back(two_layer({.cell = h, .shape = shape}, "soft_over_stiff"));
    // B-splines reach one cell further and smear the stiffness over the boundary of the layers.
    if (shape == ShapeKind::gimp)
      check_series(runs, {0.003, 0.001, 0.0005}, 1.7);
    else
      check_series(runs, {0.005, 0.004, 0.003}, 0.4);
    CHECK(runs.back().settlement_ratio ==
          doctest::Approx(1).epsilon(shape == ShapeKind::gimp ? 0.002 : 0.02));
  }
}

TEST_CASE("finite strain: settlement of 16 % under load and weight") {
  set_threads(1);
  for (const ShapeKind shape : kShapes) {
    CAPTURE(name_of(shape));
    const bool gimp = shape == ShapeKind::gimp;
    std::vector<Consolidation> runs;
    for (const double h : {0.4, 0.2, 0.1}) runs.push_back(large_strain({.cell = h, .shape = shape}));
    // The surface passes through the cells as it settles, so errors of single grids go up and down.
    if (gimp)
      check_series(runs, {0.002, 0.0015, 0.0005}, 1.5);
    else
      check_series(runs, {0.004, 0.003, 0.001}, 1.2);
    CHECK(runs.back().settlement_ratio == doctest::Approx(1).epsilon(gimp ? 0.002 : 0.01));
  }
}
