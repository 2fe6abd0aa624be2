// Benchmarks of precision from the case files: one-dimensional consolidation against Terzaghi's series,
// seepage through a dam against Charny's discharge, and free motion – water, sand, the model levee – against
// fine solutions of the same cases.
#include <algorithm>
#include <cmath>
#include <memory>

#include "bench/case_trial.hpp"
#include "bench/precision.hpp"
#include "core/units.hpp"

namespace polder::bench {
namespace {

using coupling::Scene;
using Settings = std::vector<std::string>;

// Words of one trial's step: for the table, and what they set.
struct Step {
  std::string words;
  Settings settings;
};

std::vector<Step> courants(const std::vector<double>& shares) {
  std::vector<Step> steps;
  for (const double c : shares)
    steps.push_back({"courant " + format_number(c), {"numerics.courant=" + format_number(c)}});
  return steps;
}

struct Setting {
  std::string name;
  Settings settings;
  std::vector<double> cells;  // from coarse to fine [m]
  std::vector<Step> steps;
  bool is_default = false;
  int quick = 0;  // its first cells, with its first step, belong to --quick
};

// A case file with all that is varied of it.
struct CaseTable {
  std::string file;
  Settings settings;  // of every trial
  std::function<void(Scene&)> change;
  std::vector<Setting> variants;
};

std::vector<Trial> trials_of(const CaseTable& table, const Place& place) {
  std::vector<Trial> trials;
  for (const Setting& s : table.variants)
    for (const Step& step : s.steps)
      for (std::size_t i = 0; i < s.cells.size(); ++i) {
        CaseVariant v{table.file, table.settings, table.change};
        v.settings.insert(v.settings.end(), s.settings.begin(), s.settings.end());
        v.settings.insert(v.settings.end(), step.settings.begin(), step.settings.end());
        v.settings.push_back("grid.cell=" + format_number(s.cells[i]));
        Trial t;
        t.setting = s.name, t.is_default = s.is_default, t.cell = s.cells[i], t.step = step.words;
        t.quick = static_cast<int>(i) < s.quick && &step == &s.steps.front();
        t.run = [v, place] { return run_trial(v, place); };
        trials.push_back(std::move(t));
      }
  return trials;
}

const char* const kBspline = "grid.shape=quadratic-bspline";

// ---- consolidation

Benchmark terzaghi(const Place& place) {
  CaseTable table{"terzaghi/terzaghi.toml",
                  {},
                  [](Scene& s) {
                    std::erase_if(s.expectations, [](const auto& e) { return e.measure != "pore-pressure"; });
                    s.stages[0].duration = *s.expectations.back().time;
                  },
                  {}};
  const std::vector<double> cells{0.2, 0.1, 0.05, 0.025};
  // An explicit pressure takes steps that shrink with the square of the cells (Darcy flow).
  const std::vector<double> coarse{0.2, 0.1, 0.05};
  const auto wide = courants({0.5, 0.25, 1}), narrow = courants({0.5, 0.25}), water = courants({1, 0.5});
  const auto add = [&](const char* name, Settings settings, const std::vector<double>& of,
                       const std::vector<Step>& steps, int quick = 0) {
    table.variants.push_back(
        {name, std::move(settings), of, steps, std::string(name) == "one-layer, gimp", quick});
  };
  const std::string two = "formulation=two-layer", higo = "formulation=higo";
  add("one-layer, gimp", {}, cells, wide, 3);
  add("one-layer, bspline", {kBspline}, cells, wide, 2);
  add("one-layer, linear", {"grid.shape=linear"}, cells, wide);
  add("one-layer, gimp, tpic", {"numerics.transfer=tpic"}, cells, wide);
  add("one-layer, gimp, usl", {"numerics.order=usl"}, cells, narrow);
  add("two-layer, gimp", {two}, cells, narrow);
  add("two-layer, bspline", {two, kBspline}, cells, narrow);
  add("two-layer-darcy, gimp", {"formulation=two-layer-darcy"}, cells, narrow);
  add("higo, gimp", {higo}, coarse, water);
  add("higo, bspline", {higo, kBspline}, coarse, water);
  add("two-layer compressible, gimp", {two, "numerics.pressure=compressible"}, coarse, narrow);
  add("u-p, gimp", {"formulation=u-p"}, coarse, water);
  add("v-w, gimp", {"formulation=v-w"}, coarse, water);
  return {"terzaghi",
          "Consolidation of one layer (Terzaghi 1943)",
          "exact series",
          {"p at T 0.05", "p at T 0.2", "p at T 0.5"},
          false,
          {},
          trials_of(table, place)};
}

// ---- seepage

Benchmark dam_seepage(const Place& place) {
  CaseTable table{"dam-seepage/dam-seepage.toml", {}, {}, {}};
  const std::vector<double> cells{0.4, 0.2, 0.1, 0.05};
  for (const double fringe : {0.1, 0.025, 0.00625})
    for (const bool means : {true, false}) {
      Setting s;
      s.name = std::string(means ? "cell means" : "cell centres") + ", fringe " +
               format_number(100 * fringe) + " cm";
      s.settings = {std::string("numerics.cell_means=") + (means ? "true" : "false"),
                    "material.sand.retention.alpha=" + format_number(1 / fringe)};
      s.cells = cells, s.steps = {{"by iterations", {}}};
      s.is_default = means && fringe == 0.025;
      s.quick = s.is_default ? 3 : 0;
      table.variants.push_back(s);
    }
  return {"dam-seepage",
          "Seepage through a rectangular dam",
          "discharge by Charny (1951), exact without a fringe",
          {"outflow", "inflow"},
          false,
          {},
          trials_of(table, place)};
}

// ---- free motion, against fine solutions

void add_history(Scene& scene, const char* name, const char* quantity) {
  coupling::Measure m;
  m.name = name, m.kind = coupling::Measure::Kind::history, m.quantity = quantity;
  scene.measures.push_back(m);
}

// `compared` are measures of the table's cases.
Benchmark against_fine(Benchmark b, CaseTable table, const Settings& fine_settings,
                       const std::string& from_stage, const Place& place) {
  CaseVariant fine{table.file, table.settings, table.change};
  fine.settings.insert(fine.settings.end(), fine_settings.begin(), fine_settings.end());
  const auto solution = std::make_shared<FineSolution>(b.name, fine, b.errors, from_stage, place);
  table.change = [change = table.change, solution](Scene& s) {
    if (change) change(s);
    solution->expect(s);
  };
  b.prepare = [solution] { solution->compute(); };
  b.trials = trials_of(table, place);
  return b;
}

Benchmark dam_break(const Place& place) {
  // 6 by 12 cm, so that all cells divide it.
  CaseTable table{"dam-break/dam-break.toml",
                  {},
                  [](Scene& s) {
                    s.water_bodies[0].box = {{coupling::Vector3{}, coupling::Vector3{0.06, 0.12, 0}}};
                    add_history(s, "fall", "work_gravity");
                  },
                  {}};
  const std::vector<double> cells{0.01, 0.005, 0.0025};
  const std::string apic = "numerics.water_transfer=apic", flip = "numerics.water_transfer=flip";
  const auto steps = courants({0.5, 0.25});
  const auto add = [&](const char* name, Settings settings, const std::vector<double>& of) {
    table.variants.push_back({name, std::move(settings), of, steps, std::string(name) == "flip 0.99, gimp",
                              std::string(name) == "apic, gimp" ? 2 : 0});
  };
  add("apic, gimp", {apic}, cells);
  add("apic, bspline", {apic, kBspline}, cells);
  add("flip 0.99, gimp", {flip}, cells);
  add("flip 0.99, bspline", {flip, kBspline}, cells);
  add("flip 0.95, gimp", {flip, "numerics.water_flip=0.95"}, cells);
  // Twenty times as fast as the water flows, instead of 1500 m/s.
  const std::vector<std::string> soft{"numerics.pressure=compressible", "pore_water.bulk_modulus=2e6"};
  const auto with = [&](Settings s) {
    s.insert(s.end(), soft.begin(), soft.end());
    return s;
  };
  add("apic, gimp, compressible 2 MPa", with({apic}), cells);
  add("flip 0.99, gimp, compressible 2 MPa", with({flip}), cells);
  return against_fine({"dam-break",
                       "Collapse of a column of water",
                       "apic, gimp with cells of 1.25 mm",
                       {"front", "fall"},
                       false,
                       {},
                       {}},
                      table, {apic, "grid.cell=0.00125"}, "", place);
}

Benchmark column_collapse(const Place& place) {
  CaseTable table{"column-collapse/column-collapse.toml",
                  {},
                  [](Scene& s) { add_history(s, "fall", "work_gravity"); },
                  {}};
  const auto wide = courants({0.5, 0.25, 1}), narrow = courants({0.5, 0.25});
  const auto add = [&](const char* name, Settings settings, const std::vector<Step>& steps, int quick = 0) {
    table.variants.push_back({name,
                              std::move(settings),
                              {0.05, 0.025, 0.0125, 0.00625},
                              steps,
                              std::string(name) == "musl, gimp",
                              quick});
  };
  const std::string tpic = "numerics.transfer=tpic", usl = "numerics.order=usl";
  add("musl, gimp", {}, wide, 2);
  add("musl, bspline", {kBspline}, wide);
  add("musl, linear", {"grid.shape=linear"}, wide);
  add("musl, gimp, flip 0.999", {"numerics.flip=0.999"}, wide);
  add("usl, gimp", {usl}, narrow);
  add("usl, bspline", {usl, kBspline}, narrow);
  add("musl, tpic, gimp", {tpic}, wide);
  add("musl, tpic, bspline", {tpic, kBspline}, wide);
  add("usl, apic, gimp", {usl, "numerics.transfer=apic"}, narrow);
  add("usl, tpic, bspline", {usl, tpic, kBspline}, narrow);
  // A blend of FLIP and PIC smooths by a share of the velocities in every step, so that it converges slowly.
  return against_fine({"column-collapse",
                       "Collapse of a column of dry sand",
                       "musl, tpic, gimp with cells of 3.125 mm",
                       {"run-out", "fall"},
                       false,
                       {},
                       {}},
                      table, {tpic, "grid.cell=0.003125"}, "", place);
}

Benchmark levee(const Place& place) {
  CaseTable table{"levee/levee.toml",
                  {},
                  [](Scene& s) {
                    add_history(s, "fall", "work_gravity");
                    s.stages.back().duration = 5;  // [s]; the front has come to rest
                  },
                  {}};
  const auto one = courants({1, 0.5}), two = courants({0.5, 0.25});
  const auto add = [&](const char* name, Settings settings, const std::vector<Step>& steps) {
    table.variants.push_back(
        {name, std::move(settings), {0.2, 0.1}, steps, std::string(name) == "one-layer, gimp", 0});
  };
  add("one-layer, gimp", {}, one);
  add("one-layer, bspline", {kBspline}, one);
  add("one-layer, gimp, flip 0.999", {"numerics.flip=0.999"}, one);
  add("one-layer, gimp, tpic", {"numerics.transfer=tpic"}, one);
  add("two-layer, gimp", {"formulation=two-layer"}, two);
  add("two-layer-darcy, gimp", {"formulation=two-layer-darcy"}, two);
  return against_fine({"levee",
                       "Run-out of the model levee",
                       "one-layer, gimp with cells of 5 cm",
                       {"front", "fall"},
                       true,
                       {},
                       {}},
                      table, {"grid.cell=0.05"}, "failure", place);
}

}  // namespace

std::vector<Benchmark> case_benchmarks(const Place& place) {
  return {terzaghi(place), dam_seepage(place), dam_break(place), column_collapse(place), levee(place)};
}

}  // namespace polder::bench
