#include "app/stability_measures.hpp"

#include <algorithm>

#include "coupling/strength_reduction.hpp"
#include "io/csv.hpp"

namespace polder::app {
namespace {

using coupling::Measure;
using coupling::Simulation;

const std::vector<std::string> kColumns{"time[s]", "factor_of_safety[-]", "stands[-]", "fails[-]", "trials",
                                        "steps"};

// Number of the stage at whose end the measure is taken.
int stage_of(const Measure& m, const std::vector<coupling::Stage>& stages) {
  const auto found =
      std::find_if(stages.begin(), stages.end(), [&](const coupling::Stage& s) { return s.name == m.stage; });
  return static_cast<int>(m.stage.empty() ? stages.size() - 1
                                          : static_cast<std::size_t>(found - stages.begin()));
}

// Whether the simulation stands where this stage has ended and the next one has not begun.
bool stands_at_end_of(int stage, const Simulation& s) {
  if (s.finished()) return stage + 1 == static_cast<int>(s.scene().stages.size());
  return s.stage() == stage + 1 && s.stages()[static_cast<std::size_t>(s.stage())].steps == 0;
}

}  // namespace

std::filesystem::path StabilityMeasures::file(const RunFolder& folder, const Measure& m) {
  return folder.path() / ("stability_" + m.name + ".csv");
}

StabilityMeasures::StabilityMeasures(const Simulation& s, const RunFolder& folder, bool restart) {
  for (const Measure& m : s.scene().measures) {
    if (m.kind != Measure::Kind::stability) continue;
    One one{m, file(folder, m), stage_of(m, s.scene().stages)};
    std::error_code none;
    one.done = restart && std::filesystem::exists(one.file, none);
    all_.push_back(std::move(one));
  }
}

bool StabilityMeasures::see(Simulation& s, const std::function<bool()>& goes_on) {
  for (One& one : all_) {
    if (one.done || !stands_at_end_of(one.stage, s)) continue;
    bool complete = true;
    const coupling::StabilityResult r =
        find_factor_of_safety(s, {}, [&](const coupling::StabilityTrial&) { return complete = goes_on(); });
    if (!complete) return false;
    std::int64_t steps = 0;
    for (const coupling::StabilityTrial& t : r.trials) steps += t.steps;
    CsvWriter table(one.file, kColumns, CsvWriter::Mode::fresh);
    const double factor = r.stands > 0 ? r.factor() : 0;  // as far as is known
    table.row({s.time(), factor, r.stands, r.fails, static_cast<std::int64_t>(r.trials.size()), steps});
    table.sync();
    one.done = true;
  }
  return true;
}

void StabilityMeasures::drop_after(double time) {
  for (One& one : all_) {
    if (!one.done) continue;
    CsvWriter table(one.file, kColumns, CsvWriter::Mode::append);
    table.drop_after(time);
    table.sync();
    one.done = CsvTable(one.file).rows() > 0;
  }
}

}  // namespace polder::app
