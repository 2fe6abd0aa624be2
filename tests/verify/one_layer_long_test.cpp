// Consolidation that takes minutes: nearly impermeable soil, fine grids.
#include "core/threads.hpp"
#include "tests/verify/one_layer_demands.hpp"

using namespace polder;
using namespace polder::verify;

TEST_CASE("Terzaghi: ten cells of nearly impermeable soil, up to 660,000 steps") {
  set_threads(1);
  for (const ShapeKind shape : kShapes)
    for (const double k : {1e-5, 1e-6}) check_ten_cells(shape, k);
}

TEST_CASE("Terzaghi: order of convergence, 20 to 40 cells") {
  set_threads(1);
  check_order({0.05, 0.025});
}

TEST_CASE("two layers, stiff over soft") {
  set_threads(1);
  for (const ShapeKind shape : kShapes) {
    CAPTURE(name_of(shape));
    std::vector<Consolidation> runs;
    for (const double h : {0.1, 0.05})
      runs.push_back(two_layer({.cell = h, .shape = shape}, "stiff_over_soft"));
    check_series(runs, {0.003, 0.001, 0.0006}, 1.7);
    CHECK(runs.back().settlement_ratio ==
          doctest::Approx(1).epsilon(shape == ShapeKind::gimp ? 0.002 : 0.02));
  }
}

TEST_CASE("finite strain on finer grids: order with GIMP") {
  set_threads(1);
  // Without the average over cells, which at such strains costs accuracy on the finest grid.
  std::vector<Consolidation> runs;
  for (const double h : {0.4, 0.2, 0.1, 0.05})
    runs.push_back(large_strain({.cell = h, .locking = coupling::LockingCure::none}));
  check_series(runs, {6e-4, 3e-4, 2e-4}, 1.6);
  CHECK(runs.back().settlement_ratio == doctest::Approx(1).epsilon(0.0005));
}
