// Benchmarks of precision from the scenes of the verification tests: the two compression waves of a saturated
// column, and infiltration into dry soil.
#include <cmath>

#include "bench/precision.hpp"
#include "core/units.hpp"
#include "tests/verify/seepage_infiltration.hpp"
#include "tests/verify/two_layer_waves.hpp"

namespace polder::bench {
namespace {

using verify::Choice;
using verify::ColumnEquations;

// Waves under a load that rises within 0.2 ms in stiff, permeable soil, trials of one benchmark.
class Waves {
 public:
  Waves(Benchmark benchmark, ColumnEquations equations, std::string standard, const Place& place)
      : benchmark_(std::move(benchmark)),
        equations_(equations),
        standard_(std::move(standard)),
        place_(place) {}

  // Cells from a twentieth of a metre on, each half of the one before.
  void add(const std::string& name, Choice choice, const std::vector<double>& courants, int cells = 4,
           int quick = 0) {
    for (const double courant : courants)
      for (int i = 0; i < cells; ++i) {
        Choice c = choice;
        c.cell = 0.05 / (1 << i), c.courant = courant;
        Trial t;
        t.setting = name, t.is_default = name == standard_, t.cell = c.cell;
        t.step = "courant " + format_number(courant);
        t.quick = i < quick && courant == courants[0];
        t.run = [c, equations = equations_, place = place_] {
          return in_own_process(place, 3, [&] {
            const verify::TwoWaves r = verify::two_waves(c, equations);
            const int layers =
                coupling::find_formulation(c.formulation)->carrier == coupling::WaterCarrier::particles ? 2
                                                                                                        : 1;
            return Outcome{{r.pressure, r.stress, r.grains},
                           r.seconds,
                           static_cast<double>(r.steps),
                           2.0 * layers * c.per_axis * c.per_axis * std::round(1 / c.cell)};
          });
        };
        benchmark_.trials.push_back(std::move(t));
      }
  }
  Benchmark take() { return std::move(benchmark_); }

 private:
  Benchmark benchmark_;
  ColumnEquations equations_;
  std::string standard_;
  Place place_;
};

Choice with_bspline(Choice c) {
  c.shape = verify::ShapeKind::quadratic_bspline;
  return c;
}

const std::vector<std::string> kWaveErrors{"pressure", "effective stress", "velocity of grains"};

// What a formulation leaves out is part of its error here.
Benchmark two_waves(const Place& place) {
  Waves w({"two-waves",
           "First and second compression wave in a saturated column",
           "transform of the equations with all inertia",
           kWaveErrors,
           false,
           {},
           {}},
          ColumnEquations::uw, "two-layer, gimp", place);
  Choice two{.formulation = "two-layer"}, usl = two, compressible = two, point{.formulation = "v-w"};
  usl.musl = false, compressible.pressure = coupling::PressureMethod::compressible;
  w.add("two-layer, gimp", two, {0.5, 0.25, 0.1}, 4, 2);
  w.add("two-layer, bspline", with_bspline(two), {0.5, 0.25, 0.1});
  w.add("two-layer, gimp, usl", usl, {0.5, 0.25, 0.1});
  w.add("two-layer compressible, gimp", compressible, {0.5, 0.25}, 4, 2);
  w.add("two-layer compressible, bspline", with_bspline(compressible), {0.5, 0.25});
  w.add("v-w, gimp", point, {0.5, 1});
  w.add("v-w, bspline", with_bspline(point), {0.5, 1});
  point.drag = coupling::DragStep::by_last_velocities;
  w.add("v-w, gimp, explicit drag", point, {0.5, 1});
  w.add("two-layer-darcy, gimp", {.formulation = "two-layer-darcy"}, {0.5}, 3);
  w.add("one-layer, gimp", {.formulation = "one-layer"}, {0.5}, 3);
  return w.take();
}

// The equations of those that neglect the water's inertia relative to the grains.
Benchmark one_wave(const Place& place) {
  Waves w({"one-wave",
           "Compression wave in the same column without relative inertia",
           "transform of the u-p equations",
           kWaveErrors,
           false,
           {},
           {}},
          ColumnEquations::up, "two-layer-darcy, gimp", place);
  const Choice darcy{.formulation = "two-layer-darcy"};
  Choice usl = darcy;
  usl.musl = false;
  w.add("two-layer-darcy, gimp", darcy, {0.5, 0.25, 0.1}, 4, 2);
  w.add("two-layer-darcy, bspline", with_bspline(darcy), {0.5, 0.25, 0.1});
  w.add("two-layer-darcy, gimp, usl", usl, {0.5, 0.25, 0.1});
  // Darcy flow of an explicit pressure limits the step by the square of the cell.
  w.add("u-p, gimp", {.formulation = "u-p"}, {1}, 2);
  // Leaves the skeleton's acceleration out of Darcy's law besides.
  w.add("one-layer, gimp", {}, {0.5}, 3);
  return w.take();
}

// New Mexico soil of Celia, Bouloutas & Zarba (1990), a day of infiltration.
Benchmark infiltration(const Place& place) {
  Benchmark b{"infiltration",
              "Infiltration into dry soil (Celia et al. 1990)",
              "finite volumes, converged",
              {"increase of the water content", "inflow"},
              false,
              {},
              {}};
  for (const bool upstream : {false, true})
    for (const double step : {0.0, 1800.0, 600.0, 120.0})
      for (const int cells : {25, 50, 100, 200, 400}) {
        const verify::InfiltrationChoice c{.cells = cells, .step = step, .upstream = upstream};
        Trial t;
        t.setting = upstream ? "upstream conductivity" : "mean conductivity";
        t.step = step > 0 ? format_number(step) + " s" : "by iterations";
        t.is_default = !upstream && step == 0;
        t.cell = 1.0 / cells;
        t.quick = !upstream && step == 600 && cells <= 100;
        t.run = [c, place] {
          return in_own_process(place, 2, [&] {
            const verify::Infiltration r = verify::celia_new_mexico(c);
            return Outcome{{r.front_error, std::abs(r.inflow_error)},
                           r.seconds,
                           static_cast<double>(r.steps),
                           static_cast<double>(c.cells)};
          });
        };
        b.trials.push_back(std::move(t));
      }
  return b;
}

}  // namespace

std::vector<Benchmark> scene_benchmarks(const Place& place) {
  return {two_waves(place), one_wave(place), manufactured_benchmark(place), infiltration(place)};
}

}  // namespace polder::bench
