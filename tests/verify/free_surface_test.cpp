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

TEST_CASE("rectangular dams: Charny's discharge within a thousandth, the seepage face within a hundredth") {
  set_threads(1);
  for (const double length : {0.5, 1.0, 2.0})
    for (const double h2 : {0.0, 0.3, 0.5}) {
      CAPTURE(length);
      CAPTURE(h2);
      const FreeSurface dam = rectangular_dam(length, 1, h2, 40);
      CHECK(dam.converged);
      CHECK(dam.iterations <= 60);
      CHECK(dam.inflow == doctest::Approx(dam.outflow).epsilon(1e-6));
      CHECK(dam.outflow == doctest::Approx(charny_discharge(length, 1, h2)).epsilon(0.001));
      CHECK(dam.exit == doctest::Approx(exact_exit(length, h2)).epsilon(0.01));
    }
}

TEST_CASE("rectangular dams: the end of the seepage face lies at the same height in coarse and fine cells") {
  set_threads(1);
  for (const auto& [length, h2] : {std::pair{0.5, 0.0}, {1.0, 0.0}, {1.0, 0.5}}) {
    CAPTURE(length);
    CAPTURE(h2);
    const double exact = exact_exit(length, h2);
    const double coarse = rectangular_dam(length, 1, h2, 20).exit / exact - 1;
    const double fine = rectangular_dam(length, 1, h2, 80).exit / exact - 1;
    CHECK(std::abs(coarse) < 0.01);
    CHECK(std::abs(fine) < 0.003);
  }
}

TEST_CASE("a fringe as thick as a cell: means over cells and values at their centres agree") {
  set_threads(1);
  const FreeSurface mean = rectangular_dam(1, 1, 0.3, 40, {.steepness = 40, .averages = true});
  const FreeSurface point = rectangular_dam(1, 1, 0.3, 40, {.steepness = 40, .averages = false});
  CHECK(mean.converged);
  CHECK(point.converged);
  CHECK(mean.outflow == doctest::Approx(point.outflow).epsilon(0.002));
  // Charny's integral with the fringe's water: at most (h1 - exit) / alpha more.
  const double exact = charny_discharge(1, 1, 0.3);
  CHECK(mean.outflow > exact);
  CHECK(mean.outflow < exact + 1e-4 * (1 - mean.exit) / 40);
}

TEST_CASE(
    "levees of triangular section: discharge within a hundredth, the end of the seepage face in its cell") {
  set_threads(1);
  const ReferenceCsv table("levee_summary.csv");
  for (const auto& row : table.rows) {
    CAPTURE(row[0]);
    CAPTURE(row[4]);
    double coarse = 0;
    for (const double cell : {0.1, 0.05}) {
      CAPTURE(cell);
      const FreeSurface levee = trapezoidal_levee(row[0], row[1], row[2], row[3], row[4], cell);
      CHECK(levee.converged);
      CHECK(levee.iterations <= 100);
      CHECK(levee.inflow == doctest::Approx(levee.outflow).epsilon(1e-6));
      CHECK(levee.outflow == doctest::Approx(row[6]).epsilon(0.004));
      CHECK(std::abs(levee.exit - row[7]) < 0.5 * cell);
      const double error = std::abs(levee.outflow / row[6] - 1);
      if (coarse > 0) CHECK(error < coarse);
      coarse = error;
    }
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
