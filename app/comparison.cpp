#include "app/comparison.hpp"

#include <algorithm>
#include <cmath>

#include "app/run_traces.hpp"
#include "core/units.hpp"

namespace polder::app {
namespace {

using coupling::Measure;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr double kAnyCell = 0;
constexpr double kConstant = 1e-9;  // range beside the magnitude below which a quantity does not change

// Errors and noise of the computation, which every run has of its own: told for each, not compared.
bool is_audit(const std::string& quantity) {
  for (const char* word : {"_error", "roughness", "transfer_loss", "unbalanced", "relaxation"})
    if (quantity.find(word) != std::string::npos) return true;
  return quantity == "dt" || quantity == "step" || quantity == "stage";
}

// Columns of the history that tell what happened, whether the case asks for them or not.
const std::vector<std::string>& usual_columns() {
  static const std::vector<std::string> names{
      "runout", "height", "kinetic_energy", "max_speed", "max_pore_pressure", "water_outflow"};
  return names;
}

bool same_quantity(const Measure& a, const Measure& b) {
  return a.name == b.name && a.kind == b.kind && a.quantity == b.quantity;
}

// Whether a run has stages other than searches for equilibrium, which tell of height and speed only how they
// were found.
bool passes_time(const Comparison& c) {
  return std::any_of(c.runs.begin(), c.runs.end(), [](const ComparedRun& r) {
    const auto& stages = r.run.scene.stages;
    return std::any_of(stages.begin(), stages.end(),
                       [](const coupling::Stage& s) { return s.mode != coupling::Stage::Mode::equilibrium; });
  });
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
      if (m.kind != Measure::Kind::history || !is_audit(m.quantity)) add(m, true);
  if (!passes_time(c)) return list;
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
                     const std::vector<std::optional<RunTraces>>& measured, ComparedMeasure& m) {
  const Families families(c, traces);
  double magnitude = 0;
  for (const std::string& v : c.variants)
    if (const auto run = families.finest(v)) {
      const Extremes e = measured[*run]->extremes(m.measure, m.times);
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
      if (m.measure.is_profile()) d.difference.max_at = m.times.at(d.difference.max_curve);
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
  std::vector<std::optional<RunTraces>> measured;
  for (ComparedRun& r : c.runs) {
    if (std::find(c.variants.begin(), c.variants.end(), r.variant) == c.variants.end())
      c.variants.push_back(r.variant);
    measured.emplace_back();
    if (!r.has_results()) continue;
    measured.back().emplace(r.run);
    r.start = measured.back()->start();
  }
  c.measures = candidates(c);
  for (ComparedMeasure& m : c.measures) {
    if (m.measure.is_profile())
      for (const auto& run : measured)
        if (run && run->profile_times(m.measure).size() > m.times.size())
          m.times = run->profile_times(m.measure);
    std::vector<Trace> traces;
    for (const auto& run : measured) {
      traces.push_back(run ? run->trace(m.measure, m.times) : Trace());
      m.last.push_back(run ? run->last(m.measure) : kNone);
      if (m.unit.empty() && run) m.unit = run->unit(m.measure);
    }
    compare_measure(c, traces, measured, m);
  }
  // A column that nobody asked for and that says nothing.
  std::erase_if(c.measures, [](const ComparedMeasure& m) { return !m.asked && m.errors.empty(); });
}

}  // namespace polder::app
