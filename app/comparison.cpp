#include "app/comparison.hpp"

#include <algorithm>
#include <cmath>

#include "app/columns.hpp"
#include "app/measured.hpp"
#include "app/stability_measures.hpp"
#include "app/tables.hpp"
#include "core/units.hpp"
#include "io/csv.hpp"

namespace polder::app {
namespace {

using coupling::Measure;
using coupling::Stage;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr double kAnyCell = 0;
constexpr double kConstant = 1e-9;  // range beside the magnitude below which a quantity does not change

// Errors and noise of the computation, which every run has of its own: told for each, not compared.
bool is_audit(const std::string& quantity) {
  for (const char* word : {"_error", "roughness", "transfer_loss", "unbalanced", "relaxation", "dt", "step"})
    if (quantity.find(word) != std::string::npos) return true;
  return false;
}

// Columns of the history that tell what happened, whether the case asks for them or not.
const std::vector<std::string>& usual_columns() {
  static const std::vector<std::string> names{
      "runout", "height", "kinetic_energy", "max_speed", "max_pore_pressure", "water_outflow"};
  return names;
}

// All but searches for equilibrium.
std::vector<std::size_t> compared_stages(const coupling::Scene& scene) {
  std::vector<std::size_t> list;
  for (std::size_t i = 0; i < scene.stages.size(); ++i)
    if (scene.stages[i].mode != Stage::Mode::equilibrium) list.push_back(i);
  return list;
}

// What a run has measured: its tables, read once.
class Measured {
 public:
  explicit Measured(const RunRecord& run) : run_(&run) {
    const RunFolder folder(run.folder, RunFolder::Mode::read);
    history_.emplace(folder.history(), history_words());
    std::error_code failure;
    if (std::filesystem::exists(folder.probes(), failure)) probes_.emplace(folder.probes());
  }

  const CsvTable& history() const { return *history_; }
  // The table of histories that may hold a measure; null if the run has none.
  const CsvTable* table(const Measure& m) const {
    bool in_history = false;
    measure_column(m, in_history);
    return in_history ? &*history_ : probes_ ? &*probes_ : nullptr;
  }
  std::string column(const Measure& m) const {
    bool in_history = false;
    const std::string name = measure_column(m, in_history);
    if (m.kind == Measure::Kind::stability) return "factor[-]";
    const CsvTable* t = table(m);
    return t ? find_column(t->columns(), name) : std::string();
  }
  // Empty if the run has no such column.
  Trace trace(const Measure& m) const {
    Trace trace;
    if (m.kind == Measure::Kind::stability) return factor_of_safety(m);
    if (column(m).empty()) return trace;
    const Curve all = measured_curve(m, *table(m));
    const std::vector<std::size_t> stages = compared_stages(run_->scene);
    if (stages.empty() && !all.x.empty()) return {{{0.0}, {all.value.back()}}};  // the equilibrium found
    for (const std::size_t s : stages) {
      if (s >= run_->stages.size()) break;
      const RunRecord::Stage& stage = run_->stages[s];
      trace.push_back(part(all, stage.start, stage.start + stage.time));
    }
    return trace;
  }

  // All it has been, also where only its end is compared.
  Extremes extremes(const Measure& m) const {
    Extremes e;
    const Trace compared = trace(m);
    extend(e, compared);
    if (compared_stages(run_->scene).empty() && table(m) && !column(m).empty())
      extend(e, {measured_curve(m, *table(m))});
    return e;
  }
  double last(const Measure& m) const {
    if (m.kind == Measure::Kind::stability) {
      const Trace found = factor_of_safety(m);
      return found.empty() ? kNone : found.front().value.front();
    }
    const std::string name = column(m);
    return name.empty() || table(m)->rows() == 0 ? kNone : table(m)->column(name).back();
  }

 private:
  // One number, whose time in the run does not matter.
  Trace factor_of_safety(const Measure& m) const {
    const RunFolder folder(run_->folder, RunFolder::Mode::read);
    std::error_code failure;
    if (!std::filesystem::exists(StabilityMeasures::file(folder, m), failure)) return {};
    const Curve found = read_measure(m, folder, 0, run_->time);
    if (found.value.empty() || !std::isfinite(found.value.back())) return {};
    return {{{0.0}, {found.value.back()}}};
  }

  const RunRecord* run_;
  std::optional<CsvTable> history_, probes_;
};

bool same_quantity(const Measure& a, const Measure& b) {
  return a.name == b.name && a.kind == b.kind && a.quantity == b.quantity;
}

std::vector<ComparedMeasure> candidates(const Comparison& c) {
  std::vector<ComparedMeasure> list;
  const auto add = [&](const Measure& m, bool asked) {
    for (const ComparedMeasure& have : list)
      if (same_quantity(have.measure, m)) return;
    list.push_back({});
    list.back().measure = m, list.back().asked = asked;
  };
  for (const ComparedRun& r : c.runs)
    for (const Measure& m : r.run.scene.measures)
      if (!m.is_profile() && !(m.kind == Measure::Kind::history && is_audit(m.quantity))) add(m, true);
  for (const std::string& name : usual_columns()) {
    const bool asked = std::any_of(list.begin(), list.end(), [&](const ComparedMeasure& m) {
      return m.measure.kind == Measure::Kind::history && m.measure.quantity == name;
    });
    Measure m;
    m.name = name, m.kind = Measure::Kind::history, m.quantity = name;
    if (!asked) add(m, false);
  }
  return list;
}

std::string unit_of(const std::string& column) {
  const std::size_t open = column.find('[');
  return open == std::string::npos ? "" : column.substr(open + 1, column.size() - open - 2);
}

// ---- families
// -------------------------------------------------------------------------------------------------------

// A run whose traces count.
bool counts(const ComparedRun& r, const Trace& trace) {
  return r.failure.empty() && !trace.empty();
}

class Families {
 public:
  Families(const Comparison& c, const std::vector<Trace>& traces) : c_(c), traces_(traces) {}

  // The run of the variant with the smallest step in this cell, or in its smallest one.
  std::optional<std::size_t> finest(const std::string& variant, double cell = kAnyCell) const {
    std::optional<std::size_t> best;
    for (std::size_t i = 0; i < c_.runs.size(); ++i) {
      const ComparedRun& r = c_.runs[i];
      if (r.variant != variant || !counts(r, traces_[i]) || (cell != kAnyCell && r.cell() != cell)) continue;
      if (!best || r.cell() < c_.runs[*best].cell() ||
          (r.cell() == c_.runs[*best].cell() && r.step() < c_.runs[*best].step()))
        best = i;
    }
    return best;
  }

  // Sizes of cells that both variants have, from coarse to fine.
  std::vector<double> common_cells(const std::string& a, const std::string& b) const {
    std::vector<double> cells;
    for (std::size_t i = 0; i < c_.runs.size(); ++i)
      if (c_.runs[i].variant == a && counts(c_.runs[i], traces_[i]) && finest(b, c_.runs[i].cell()))
        cells.push_back(c_.runs[i].cell());
    std::sort(cells.begin(), cells.end(), std::greater<>());
    cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
    return cells;
  }

  // Of the run, from those of its variant that are coarser in one of cell and step and alike in the other.
  DiscretisationError error(std::size_t run) const {
    DiscretisationError e;
    e.run = run;
    const ComparedRun& base = c_.runs[run];
    e.cells = family(
        run,
        [&](const ComparedRun& r) {
          return r.step() == base.step() && r.cell() > base.cell() ? r.cell() : 0;
        },
        base.cell());
    e.steps = family(
        run,
        [&](const ComparedRun& r) {
          return r.cell() == base.cell() && r.step() > base.step() ? r.step() : 0;
        },
        base.step());
    return e;
  }

 private:
  // size: of a member, 0 if the run is none.
  template <class Size>
  FamilyError family(std::size_t base, const Size& size, double base_size) const {
    std::vector<std::pair<double, std::size_t>> members{{base_size, base}};
    for (std::size_t i = 0; i < c_.runs.size(); ++i) {
      const ComparedRun& r = c_.runs[i];
      if (r.variant != c_.runs[base].variant || !counts(r, traces_[i])) continue;
      if (const double h = size(r); h > 0) members.emplace_back(h, i);
    }
    std::sort(members.begin(), members.end(), std::greater<>());
    std::vector<double> sizes;
    std::vector<Trace> traces;
    for (const auto& [h, i] : members) sizes.push_back(h), traces.push_back(traces_[i]);
    return family_error(sizes, traces);
  }

  const Comparison& c_;
  const std::vector<Trace>& traces_;
};

void divide(FamilyError& e, double whole) {
  e.l2 /= whole, e.max /= whole;
}

Verdict verdict(const VariantDifference& d) {
  if (std::isnan(d.error_l2)) return Verdict::unknown;
  if (d.difference.l2 > d.error_l2) return Verdict::differ;
  return d.difference.max > d.error_max ? Verdict::at_times : Verdict::alike;
}

void compare_measure(const Comparison& c, const std::vector<Trace>& traces,
                     const std::vector<std::optional<Measured>>& measured, ComparedMeasure& m) {
  const Families families(c, traces);
  double magnitude = 0;
  for (const std::string& v : c.variants)
    if (const auto run = families.finest(v)) {
      const Extremes e = measured[*run]->extremes(m.measure);
      m.extremes.low = std::min(m.extremes.low, e.low), m.extremes.high = std::max(m.extremes.high, e.high);
    }
  magnitude = std::max(std::abs(m.extremes.low), std::abs(m.extremes.high));
  m.scale = m.measure.kind == Measure::Kind::stability ? magnitude : m.extremes.range();
  if (!(m.scale > kConstant * magnitude)) return;
  const double whole = m.scale;
  const auto error_of = [&](std::size_t run) {
    DiscretisationError e = families.error(run);
    divide(e.cells, whole), divide(e.steps, whole);
    return e;
  };
  for (const std::string& v : c.variants)
    if (const auto run = families.finest(v)) m.errors.push_back(error_of(*run));
  for (std::size_t i = 0; i < c.variants.size(); ++i)
    for (std::size_t j = i + 1; j < c.variants.size(); ++j) {
      const std::vector<double> cells = families.common_cells(c.variants[i], c.variants[j]);
      const double cell = cells.empty() ? kAnyCell : cells.back();
      const auto first = families.finest(c.variants[i], cell), second = families.finest(c.variants[j], cell);
      if (!first || !second) continue;
      VariantDifference d;
      d.first = *first, d.second = *second;
      d.difference = difference(traces[*first], traces[*second]);
      d.difference.l2 /= whole, d.difference.max /= whole;
      const DiscretisationError a = error_of(*first), b = error_of(*second);
      d.error_l2 = a.known() && b.known() ? a.l2() + b.l2() : kNone;
      d.error_max = a.known() && b.known() ? a.max() + b.max() : kNone;
      d.verdict = verdict(d);
      d.by_cell = cells;
      for (const double h : cells)
        d.l2_by_cell.push_back(
            difference(traces[*families.finest(c.variants[i], h)], traces[*families.finest(c.variants[j], h)])
                .l2 /
            whole);
      m.differences.push_back(d);
    }
}

double sum_of_known(const FamilyError& a, const FamilyError& b, double FamilyError::*value) {
  return (a.known() ? a.*value : 0) + (b.known() ? b.*value : 0);
}

}  // namespace

double DiscretisationError::l2() const {
  return known() ? sum_of_known(cells, steps, &FamilyError::l2) : kNone;
}

double DiscretisationError::max() const {
  return known() ? sum_of_known(cells, steps, &FamilyError::max) : kNone;
}

const char* verdict_text(Verdict v) {
  switch (v) {
    case Verdict::alike:
      return "no";
    case Verdict::at_times:
      return "at times";
    case Verdict::differ:
      return "yes";
    case Verdict::unknown:
      break;
  }
  return "not known";
}

bool is_coarser(const coupling::Scene& a, const coupling::Scene& b) {
  if (a.grid.cell != b.grid.cell) return a.grid.cell > b.grid.cell;
  return a.numerics.time_step.value_or(a.numerics.courant) >
         b.numerics.time_step.value_or(b.numerics.courant);
}

std::string run_label(const std::string& variant, const coupling::Scene& s, bool cells, bool steps) {
  std::string label = variant;
  if (cells) label += ", cell " + format_number(s.grid.cell) + " m";
  if (steps)
    label += s.numerics.time_step ? ", step " + format_number(*s.numerics.time_step) + " s"
                                  : ", courant " + format_number(s.numerics.courant);
  return label;
}

void compare_runs(Comparison& c) {
  std::vector<std::optional<Measured>> measured;
  for (ComparedRun& r : c.runs) {
    if (std::find(c.variants.begin(), c.variants.end(), r.variant) == c.variants.end())
      c.variants.push_back(r.variant);
    measured.emplace_back();
    if (!r.has_results()) continue;
    measured.back().emplace(r.run);
    const std::vector<std::size_t> stages = compared_stages(r.run.scene);
    if (!stages.empty() && stages.front() < r.run.stages.size()) r.start = r.run.stages[stages.front()].start;
  }
  c.measures = candidates(c);
  for (ComparedMeasure& m : c.measures) {
    std::vector<Trace> traces;
    for (const auto& run : measured) {
      traces.push_back(run ? run->trace(m.measure) : Trace());
      const std::string column = run ? run->column(m.measure) : std::string();
      m.last.push_back(run ? run->last(m.measure) : kNone);
      if (m.unit.empty() && !column.empty()) m.unit = unit_of(column);
    }
    compare_measure(c, traces, measured, m);
  }
  // A column that nobody asked for and that says nothing.
  std::erase_if(c.measures, [](const ComparedMeasure& m) { return !m.asked && m.errors.empty(); });
}

}  // namespace polder::app
