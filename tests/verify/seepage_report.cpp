// Prints the tables of docs/validation/seepage.md: unsaturated flow in cells with known answers, measured
// with the functions that the tests use.
#define DOCTEST_CONFIG_IMPLEMENT
#include <doctest/doctest.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <string>

#include "tests/verify/report.hpp"
#include "tests/verify/seepage_columns.hpp"
#include "tests/verify/seepage_infiltration.hpp"
#include "tests/verify/seepage_plane.hpp"
#include "tests/verify/seepage_scene.hpp"

using namespace polder::verify;

namespace {

void infiltration_row(const char* soil, const InfiltrationChoice& choice, const Infiltration& r) {
  const std::string step = choice.step > 0 ? std::to_string(static_cast<int>(choice.step)) : "chosen";
  std::printf("| %s | %d | %s%s | %.2f | %.2f | %+.2f | %.0e | %ld | %.1f | %.2f |\n", soil, choice.cells,
              step.c_str(), choice.upstream ? ", upstream" : "", 100 * r.profile_error, 100 * r.front_error,
              100 * r.inflow_error, std::abs(r.defect), r.steps, r.iterations, r.seconds);
  std::fflush(stdout);
}

void infiltration_table() {
  std::printf(
      "| soil | cells | step [s] | profile L2 [%%] | of the increase [%%] | inflow [%%] | balance | steps | "
      "iterations a step | wall [s] |\n|---|---|---|---|---|---|---|---|---|---|\n");
  const auto celia = [](const InfiltrationChoice& c) {
    infiltration_row("New Mexico", c, celia_new_mexico(c));
  };
  const auto sand = [](const InfiltrationChoice& c) { infiltration_row("Haverkamp", c, celia_haverkamp(c)); };
  for (const int cells : {50, 100, 200, 400}) celia({.cells = cells, .step = 60});
  for (const double step : {3600, 1800, 900, 450}) celia({.cells = 100, .step = step});
  celia({.cells = 100, .step = 0});
  celia({.cells = 100, .step = 600, .upstream = true});
  for (const int cells : {20, 40, 80, 160}) sand({.cells = cells, .step = 1});
  for (const double step : {20, 10, 5}) sand({.cells = 160, .step = step});
}

// ---- columns

void row(const char* name, int cells, const std::vector<double>& values, double factor) {
  std::printf("| %s | %d |", name, cells);
  for (const double v : values) std::printf(" %.3g |", factor * v);
}

void absorption_table() {
  std::printf("| cells | volume [%%] | profile L2 [%%] | balance | steps |\n|---|---|---|---|---|\n");
  for (const int cells : {30, 60, 120, 240}) {
    const Absorption r = sorptivity(cells);
    std::printf("| %d | %+.2f | %.2f | %.0e | %ld |\n", cells, 100 * r.volume_error, 100 * r.profile_error,
                std::abs(r.defect), r.steps);
  }
}

void green_ampt_table() {
  std::printf(
      "| cells | ponded: volume [%%] | rain: time of ponding / exact | volume [%%] | run-off [%%] | balance "
      "|\n|---|---|---|---|---|---|\n");
  for (const int cells : {50, 100, 200, 400}) {
    const SharpFront g = green_ampt(cells), p = ponding(cells);
    std::printf("| %d | %.2f | %.3f | %+.2f | %.2f | %.0e |\n", cells, 100 * g.volume_error, p.ponding_time,
                100 * p.volume_error, 100 * p.run_off, std::max(std::abs(g.balance), std::abs(p.balance)));
  }
}

void srivastava_yeh_table() {
  std::printf(
      "| | cells | 1 h | | | | | | | last | flow at the base "
      "|\n|---|---|---|---|---|---|---|---|---|---|---|\n");
  for (const bool wetting : {true, false})
    for (const int cells : {25, 50, 100}) {
      const Profiles r = srivastava_yeh(wetting, cells, 60);
      row(wetting ? "wetting" : "drying", cells, r.error, 100);
      std::printf(" %.2f |\n", 100 * r.flux_error);
    }
}

void steady_table() {
  std::printf("Gardner, flow over conductivity -0.9, -0.5, -0.1, 0, 0.02, 0.04, 0.05:\n\n");
  std::printf(
      "| | cells | | | | | | | | limiting evaporation [%%] | iterations "
      "|\n|---|---|---|---|---|---|---|---|---|---|---|\n");
  for (const int cells : {20, 40, 80}) {
    const Profiles r = gardner(cells);
    row("Gardner", cells, r.error, 100);
    std::printf(" %+.2f | %d |\n", 100 * limiting_evaporation(cells), r.iterations);
  }
  std::printf("\nvan Genuchten, flow -1e-5, -1e-6, 0, 1e-8, 1e-7 m/s:\n\n");
  std::printf("| | cells | | | | | | iterations |\n|---|---|---|---|---|---|---|---|\n");
  for (const int cells : {20, 40, 80}) {
    const Profiles r = steady_van_genuchten(cells);
    row("New Mexico", cells, r.error, 100);
    std::printf(" %d |\n", r.iterations);
  }
}

void falling_head_table() {
  std::printf("| cells | rigid | compressible |\n|---|---|---|\n");
  for (const int cells : {10, 20, 40}) {
    const FallingHead r = falling_head(cells);
    std::printf("| %d | %.1e | %.1e |\n", cells, r.rigid_error, r.compressible_error);
  }
}

// ---- plane

void cost(const Cost& c) {
  std::printf(" %ld | %.1f | %.2f |\n", c.steps, c.iterations, c.seconds);
  std::fflush(stdout);
}

void tracy_table() {
  std::printf(
      "| cells | 2 h | 5 h | 10 h | 20 h | steady | balance | iterations to steady | steps | iterations a "
      "step | wall "
      "[s] |\n|---|---|---|---|---|---|---|---|---|---|---|\n");
  for (const int cells : {20, 40, 80}) {
    const Tracy r = tracy(cells);
    std::printf("| %d x %d |", cells, cells);
    for (const double e : r.head_error) std::printf(" %.2f |", 100 * e);
    std::printf(" %.0e | %d |", std::abs(r.defect), r.steady_iterations);
    cost(r.cost);
  }
}

void vauclin_table() {
  std::printf(
      "| cells | water table 2 h [mm] | 3 h | 4 h | 8 h | heads [mm] | | | | outflow / inflow [%%] | | | | "
      "balance "
      "| steps | iterations a step | wall [s] "
      "|\n|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  for (const int cells : {20, 40}) {
    const Recharge r = vauclin(cells);
    std::printf("| %d x %d |", cells * 3 / 2, cells);
    for (const double e : r.table_error) std::printf(" %.1f |", 1000 * e);
    for (const double e : r.head_error) std::printf(" %.1f |", 1000 * e);
    for (const double e : r.outflow_error) std::printf(" %+.2f |", 100 * e);
    std::printf(" %.0e |", std::abs(r.defect));
    cost(r.cost);
  }
}

void block_table() {
  std::printf(
      "| cells | | 0.1 h | 0.25 h | 0.5 h | 1 h | 2 h | 4 h | 10 h | balance | steps | iterations a step | "
      "wall [s] "
      "|\n|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  for (const int cells : {15, 30, 60}) {
    const Wetting r = block_wetting(cells);
    std::printf("| %d x %d | water table [mm] |", cells * 4 / 3, cells);
    for (const double e : r.table_error) std::printf(" %.1f |", 1000 * e);
    std::printf(" %.0e |", std::abs(r.defect));
    cost(r.cost);
    std::printf("| | inflow [%%] |");
    for (const double e : r.inflow_error) std::printf(" %+.2f |", 100 * e);
    std::printf(" | | | |\n| | seepage face / inflow [%%] |");
    for (const double e : r.face_error) std::printf(" %+.2f |", 100 * e);
    std::printf(" | | | |\n");
  }
}

void dam_table() {
  std::printf(
      "| cells | 1/alpha [m] | k_r | discharge / Charny | highest saturated cell at the face [m] | "
      "iterations | wall "
      "[s] |\n|---|---|---|---|---|---|---|\n");
  for (const int cells : {20, 40, 80})
    for (const double fringe : {0.5, 0.1, 0.05})
      for (const auto weighting : {polder::fdm::FaceWeighting::mean, polder::fdm::FaceWeighting::upstream}) {
        const Dam r = dam(cells, fringe, weighting);
        std::printf("| %d | %g | %s | %.4f | %.3f | %d%s | %.2f |\n", cells, fringe,
                    weighting == polder::fdm::FaceWeighting::mean ? "mean" : "upstream", r.discharge, r.exit,
                    r.report.iterations, r.report.converged ? "" : " (not converged)", r.seconds);
        std::fflush(stdout);
      }
}

void sheet_pile_table() {
  std::printf("| depth | cells | discharge [%%] | exit gradient [%%] |\n|---|---|---|---|\n");
  for (const double depth : {0.2, 0.5, 0.8})
    for (const int cells : {20, 40, 80, 160}) {
      const SheetPile r = sheet_pile(cells, depth);
      std::printf("| %g | %d | %+.2f | %+.2f |\n", depth, cells, 100 * r.discharge_error,
                  100 * r.gradient_error);
    }
}

// ---- cost

// Best of some steps of half a wave step on a saturated block under water with a moving skeleton.
void cost_table() {
  using namespace polder;
  std::printf(
      "| cells | saturated equation [ms] | unsaturated one [ms] | retention curve [ns a cell] "
      "|\n|---|---|---|---|\n");
  const auto best = [](const auto& f) {
    double least = 1e9;
    for (int i = 0; i < 12; ++i) {
      const auto start = std::chrono::steady_clock::now();
      f();
      least =
          std::min(least, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    }
    return least;
  };
  for (const int n : {24, 60, 120}) {
    fdm::Soil<2> soil;
    soil.retention.model = fdm::Retention::Model::van_genuchten;
    soil.retention.alpha = 3, soil.retention.n = 2, soil.retention.residual = 0.1;
    SeepageScene s({0, 0}, {2 * n, n}, 0.1, {soil}, 2.2e9);
    s.set_conductivity(1e-4);
    s.conditions.outside_level = 0.1 * n + 1;
    s.conditions.boundaries = {fdm::test::boundary<2>(fdm::WaterBoundary<2>::Kind::surface, 3, 0)};
    s.update();
    s.set_head([&](const auto& x) { return s.conditions.outside_level - x[1]; });
    s.nodes_to(s.mobility, [](const auto&) { return 3e-7; });
    s.velocity_to([](const Point<2>& x) { return Point<2>{1e-3 * std::sin(x[1]), -1e-3 * x[1]}; });
    fdm::PressureField<2> saturated(s.cells, fdm::test::water2(2.2e9));
    saturated.refresh();
    saturated.pressure() = s.field.pressure();
    fdm::UnsaturatedStep step = s.unsaturated(6e-4);
    step.velocity = s.velocity, step.mobility = s.mobility;
    const double one = best([&] { saturated.solve(s.Scene<2>::step(6e-4)); });
    const double other = best([&] { REQUIRE(s.field.solve(step).converged); });
    std::vector<int> which(100000);
    std::vector<double> p(which.size()), saturation(p), capacity(p), relative(p);
    for (std::size_t i = 0; i < p.size(); ++i)
      which[i] = static_cast<int>(i), p[i] = -1000.0 - static_cast<double>(i);
    const double curve = best([&] { s.field.curve(0).evaluate(which, p, saturation, capacity, relative); });
    std::printf("| %d | %.2f | %.2f | %.0f |\n", 2 * n * n, 1e3 * one, 1e3 * other,
                1e9 * curve / static_cast<double>(p.size()));
  }
}

}  // namespace

int main(int count, char** names) {
  doctest::Context context;  // the reader of the reference solutions asserts
  context.setAsDefaultForAssertsOutOfTestCases();
  return print_tables("seepage_report",
                      {{"infiltration", infiltration_table},
                       {"absorption", absorption_table},
                       {"green_ampt", green_ampt_table},
                       {"srivastava_yeh", srivastava_yeh_table},
                       {"steady", steady_table},
                       {"falling_head", falling_head_table},
                       {"tracy", tracy_table},
                       {"vauclin", vauclin_table},
                       {"block", block_table},
                       {"dam", dam_table},
                       {"sheet_pile", sheet_pile_table},
                       {"cost", cost_table}},
                      count, names);
}
