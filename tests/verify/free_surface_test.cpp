// Steady and transient seepage with a free surface against solutions without a capillary fringe.
#include "tests/verify/free_surface.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "core/threads.hpp"
#include "tests/unit/reference_csv.hpp"

using namespace polder;
using namespace polder::verify;

namespace {

// Height over h1 at which the free surface leaves a rectangular dam (Polubarinova-Kochina 1962).
double exact_exit(double length, double h2) {
  const ReferenceCsv table("rect_dam_table.csv");
  for (const auto& row : table.rows)
    if (row[0] == length && row[1] == h2) return row[2];
  FAIL("no such row");
  return 0;
}

}  // namespace

TEST_CASE("rectangular dams with 40 cells of height: Charny's discharge within half a per cent") {
  set_threads(1);
  for (const auto& [length, h2] : {std::pair{0.5, 0.0}, {1.0, 0.0}, {2.0, 0.0}, {0.5, 0.5}, {1.0, 0.3}}) {
    CAPTURE(length);
    CAPTURE(h2);
    const FreeSurfaceLimit dam = rectangular_dam(length, 1, h2, 40, 160);
    const double exact = charny_discharge(length, 1, h2);
    for (std::size_t i = 0; i < dam.found.size(); ++i) {
      CHECK(dam.found[i].converged);
      CHECK(dam.found[i].inflow == doctest::Approx(dam.found[i].outflow).epsilon(1e-5));
      // Gardner's fringe carries more water than none, and less than Charny's integral with a dry
      // downstream face above the exit allows.
      CHECK(dam.found[i].outflow > exact);
      CHECK(dam.found[i].outflow < exact + 1e-4 * (1 - dam.found[i].exit) / (dam.alpha[i] * length) * 1.02);
    }
    CHECK(dam.discharge == doctest::Approx(exact).epsilon(0.005));
  }
}

TEST_CASE("rectangular dams with 80 cells of height: the seepage face ends within two per cent") {
  set_threads(1);
  for (const auto& [length, h2] : {std::pair{0.5, 0.0}, {1.0, 0.0}, {1.0, 0.3}, {1.0, 0.5}}) {
    CAPTURE(length);
    CAPTURE(h2);
    const FreeSurfaceLimit dam = rectangular_dam(length, 1, h2, 80, 160);
    CHECK(dam.exit == doctest::Approx(exact_exit(length, h2)).epsilon(0.02));
  }
}

TEST_CASE("levees of triangular section: discharge within a per cent") {
  set_threads(1);
  const ReferenceCsv table("levee_summary.csv");
  for (const auto& row : table.rows) {
    CAPTURE(row[0]);
    CAPTURE(row[4]);
    const FreeSurfaceLimit levee = trapezoidal_levee(row[0], row[1], row[2], row[3], row[4], 0.05, 80);
    for (const FreeSurface& f : levee.found) CHECK(f.converged);
    CHECK(levee.discharge == doctest::Approx(row[6]).epsilon(0.01));
  }
}

TEST_CASE("drawdown and rise of a tenth: the linearised Boussinesq equation but for the flow near the face") {
  set_threads(1);
  const std::vector<double> times{2e4, 5e4, 1e5};
  const double alpha = 20;
  const LevelChange down = level_change(1, 0.9, 0.05, alpha, times);
  const LevelChange up = level_change(0.9, 1, 0.05, alpha, times);
  CHECK(std::abs(down.defect) < 1e-6);
  CHECK(std::abs(up.defect) < 1e-6);
  for (std::size_t i = 0; i < times.size(); ++i) {
    CAPTURE(times[i]);
    // In the mean of both directions what is quadratic in the change cancels. Missing is the bend of the
    // streamlines into the face, a constant volume.
    const double linear = linearised_volume(1, 0.9, 1 / alpha, times[i]);
    const double found = 0.5 * (down.volume[i] - up.volume[i]);
    CHECK(found < linear);
    CHECK(found > linear - 0.01 * 0.2 * 10 * 0.1);  // a hundredth of all that moves
    CHECK(down.volume[i] < -up.volume[i]);          // a falling table conducts less
  }
}
