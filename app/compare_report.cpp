#include "app/compare_report.hpp"

#include <algorithm>
#include <cmath>

#include "app/digits.hpp"
#include "app/text_table.hpp"
#include "io/atomic_file.hpp"
#include "io/log.hpp"

namespace polder::app {
namespace {

std::string number(double v, int n = 3) {
  return std::isnan(v) ? "-" : digits(v, n);
}

constexpr double kMostShare = 10;  // beyond which it does not matter how much

std::string percent(double share) {
  if (std::isnan(share)) return "-";
  return share > kMostShare ? "over " + digits(100 * kMostShare, 4) + " %" : digits(100 * share, 2) + " %";
}

std::string index(std::size_t run) {
  return std::to_string(run + 1);
}

std::string row_name(const Comparison& c, std::size_t i) {
  return index(i) + " " + c.runs[i].label;
}

std::string expectations_text(const RunRecord& run) {
  if (run.expectations.empty()) return "-";
  std::size_t met = 0;
  for (const ExpectationResult& e : run.expectations) met += e.pass ? 1 : 0;
  return std::to_string(met) + " of " + std::to_string(run.expectations.size());
}

std::string runs_table(const Comparison& c) {
  TextRows rows{{"run", "status", "steps", "mean step [s]", "smallest [s]", "limited by", "particles",
                 "wall [s]", "mechanics", "water", "balances", "output", "1e6 particle-steps/s"}};
  for (std::size_t i = 0; i < c.runs.size(); ++i) {
    const ComparedRun& r = c.runs[i];
    const RunRecord& run = r.run;
    if (!r.has_results()) {
      rows.push_back({row_name(c, i), "FAILED"});
      continue;
    }
    const std::string limit =
        run.limited_by.empty() ? "-" : run.limited_by + " (" + digits(100 * run.limited_share, 3) + " %)";
    const std::string restarted = run.computed_steps < run.steps ? "*" : "";
    rows.push_back({row_name(c, i), r.failure.empty() ? run.status : "FAILED", std::to_string(run.steps),
                    number(run.dt_mean), number(run.dt_min), limit,
                    std::to_string(run.solid_particles) +
                        (run.water_particles > 0 ? " + " + std::to_string(run.water_particles) : ""),
                    number(run.wall.total) + restarted, number(run.wall.mechanics), number(run.wall.water),
                    number(run.wall.audit), number(run.wall.output),
                    number(run.particle_steps_per_second / 1e6)});
  }
  return markdown_table(rows);
}

// What the table of runs cannot hold.
std::string remarks(const Comparison& c) {
  std::string text;
  bool restarted = false, several = false;
  for (const ComparedRun& r : c.runs) {
    restarted = restarted || (r.has_results() && r.run.computed_steps < r.run.steps);
    several = several || (r.has_results() && c.runs.front().has_results() &&
                          r.run.program != c.runs.front().run.program);
  }
  if (c.case_file.empty()) {  // of runs made earlier
    text += "\n";
    for (std::size_t i = 0; i < c.runs.size(); ++i)
      text += "- " + row_name(c, i) + ": " + c.runs[i].run.folder.string() + "\n";
  }
  if (restarted) text += "\n\\* restarted: wall times are those of the last call.\n";
  if (several) {
    text += "\nNot all runs were made by the same program:\n\n";
    for (std::size_t i = 0; i < c.runs.size(); ++i)
      if (c.runs[i].has_results()) text += "- " + row_name(c, i) + ": " + c.runs[i].run.program + "\n";
  }
  bool first = true;
  for (std::size_t i = 0; i < c.runs.size(); ++i) {
    if (c.runs[i].failure.empty()) continue;
    text += std::string(first ? "\n" : "") + "- " + row_name(c, i) + " FAILED: " + c.runs[i].failure + "\n";
    first = false;
  }
  return text;
}

std::string balances_table(const Comparison& c) {
  TextRows rows{{"run", "solid mass", "water mass", "momentum", "energy", "roughness, last [Pa]",
                 "largest [Pa]", "expectations met"}};
  for (std::size_t i = 0; i < c.runs.size(); ++i) {
    if (!c.runs[i].has_results()) continue;
    const RunRecord& run = c.runs[i].run;
    const RunRecord::Balances& b = run.balances;
    rows.push_back({row_name(c, i), number(b.solid_mass), number(b.water_mass), number(b.momentum),
                    number(b.energy), number(run.roughness_last), number(run.roughness_largest),
                    expectations_text(run)});
  }
  return markdown_table(rows);
}

std::string missed_lines(const Comparison& c) {
  std::string text;
  for (std::size_t i = 0; i < c.runs.size(); ++i) {
    std::string missed;
    for (const ExpectationResult& e : c.runs[i].run.expectations)
      if (!e.pass)
        missed += (missed.empty() ? "" : ", ") + e.measure + " (" + e.norm +
                  (e.when.empty() ? "" : " " + e.when) + ")";
    if (!missed.empty()) text += "- " + row_name(c, i) + " missed: " + missed + "\n";
  }
  return text.empty() ? text : "\n" + text;
}

std::string last_values_table(const Comparison& c) {
  TextRows rows{{"quantity", "unit"}};
  for (std::size_t i = 0; i < c.runs.size(); ++i) rows.front().push_back(index(i));
  for (const ComparedMeasure& m : c.measures) {
    if (m.measure.is_profile()) continue;
    rows.push_back({m.measure.name, m.unit});
    for (const double v : m.last) rows.back().push_back(number(v, 5));
  }
  return rows.size() > 1 ? markdown_table(rows) : "nothing is measured over time\n";
}

// "5.3, 5.2, 5.1 %"
std::string percents(const std::vector<double>& shares) {
  std::string text;
  for (const double v : shares) text += (text.empty() ? "" : ", ") + number(100 * v, 2);
  return text + " %";
}

std::string differences_table(const Comparison& c) {
  TextRows rows{{"quantity", "scale", "between runs", "mean square", "largest", "at [s]",
                 "discretisation error", "beyond it", "mean square, coarse to fine cells"}};
  for (const ComparedMeasure& m : c.measures)
    for (const VariantDifference& d : m.differences) {
      const bool known = !std::isnan(d.error_l2);
      rows.push_back({m.measure.name, number(m.scale) + (m.unit == "-" ? "" : " " + m.unit),
                      index(d.first) + " and " + index(d.second), percent(d.difference.l2),
                      percent(d.difference.max), number(d.difference.max_at),
                      known ? percent(d.error_l2) + ", largest " + percent(d.error_max)
                            : "not known: give --cell several",
                      verdict_text(d.verdict), d.by_cell.size() > 1 ? percents(d.l2_by_cell) : "-"});
    }
  return rows.size() > 1 ? markdown_table(rows) : "";
}

std::string family_text(const FamilyError& e) {
  if (!e.known()) return "not known";
  if (!e.converges) return percent(e.l2) + ", does not converge";
  if (e.members < 3 || std::isnan(e.order)) return percent(e.l2) + ", order 1 assumed";
  return percent(e.l2) + (e.order < kMostOrderSought ? ", order " : ", order above ") +
         digits(std::min(e.order, kMostOrderSought), 2);
}

std::string errors_table(const Comparison& c) {
  TextRows rows{{"quantity", "run", "of cells", "of steps", "together, mean square", "largest"}};
  for (const ComparedMeasure& m : c.measures)
    for (const DiscretisationError& e : m.errors)
      if (e.known())
        rows.push_back({m.measure.name, row_name(c, e.run), family_text(e.cells), family_text(e.steps),
                        percent(e.l2()), percent(e.max())});
  return rows.size() > 1 ? markdown_table(rows) : "";
}

// "P1, P2 (1 and 3)" for every pair of variants.
std::string verdict_lines(const Comparison& c) {
  std::string text;
  for (std::size_t i = 0; i < c.variants.size(); ++i)
    for (std::size_t j = i + 1; j < c.variants.size(); ++j) {
      std::string lists[4];
      for (const ComparedMeasure& m : c.measures)
        for (const VariantDifference& d : m.differences)
          if (c.runs[d.first].variant == c.variants[i] && c.runs[d.second].variant == c.variants[j]) {
            std::string& list = lists[static_cast<int>(d.verdict)];
            list += (list.empty() ? "" : ", ") + m.measure.name;
          }
      const std::string pair = c.variants[i] + " and " + c.variants[j];
      const auto say = [&](Verdict v, const std::string& how) {
        if (const std::string& list = lists[static_cast<int>(v)]; !list.empty())
          text += "- " + pair + " " + how + ": " + list + "\n";
      };
      say(Verdict::differ, "differ by more than their discretisation error");
      say(Verdict::at_times, "differ by more than it only at times");
      say(Verdict::alike, "are closer than their discretisation error");
      say(Verdict::unknown, "differ by what may be their discretisation error, which is not known");
    }
  return text;
}

// ---- spreadsheets
// ----------------------------------------------------------------------------------------------------

std::string cell(double v) {
  return std::isnan(v) ? "" : digits(v, 10);
}

std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

std::string csv(const TextRows& rows) {
  std::string text;
  for (const auto& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) text += (i > 0 ? "," : "") + quoted(row[i]);
    text += '\n';
  }
  return text;
}

std::string runs_csv(const Comparison& c) {
  TextRows rows{{"run",
                 "variant",
                 "formulation",
                 "cell[m]",
                 "courant[-]",
                 "time_step[s]",
                 "status",
                 "steps",
                 "dt_mean[s]",
                 "dt_min[s]",
                 "dt_max[s]",
                 "limited_by",
                 "limited_share[-]",
                 "particles_solid",
                 "particles_water",
                 "cells",
                 "cells_pressure",
                 "wall[s]",
                 "wall_mechanics[s]",
                 "wall_water[s]",
                 "wall_audit[s]",
                 "wall_output[s]",
                 "particle_steps_per_second[1/s]",
                 "solid_mass_error[-]",
                 "water_mass_error[-]",
                 "momentum_error[-]",
                 "energy_error[-]",
                 "roughness_last[Pa]",
                 "roughness_largest[Pa]",
                 "expectations",
                 "expectations_met"}};
  for (const ComparedMeasure& m : c.measures)
    if (!m.measure.is_profile()) rows.front().push_back(m.measure.name + "[" + m.unit + "]");
  for (std::size_t i = 0; i < c.runs.size(); ++i) {
    const ComparedRun& r = c.runs[i];
    const RunRecord& run = r.run;
    if (!r.has_results()) {
      rows.push_back({r.label, r.variant});
      rows.back().resize(rows.front().size());
      rows.back()[6] = "failed";
      continue;
    }
    const auto whole = [](std::int64_t n) { return std::to_string(n); };
    const coupling::NumericsSpec& numerics = run.scene.numerics;
    std::int64_t met = 0;
    for (const ExpectationResult& e : run.expectations) met += e.pass ? 1 : 0;
    rows.push_back({r.label,
                    r.variant,
                    run.scene.formulation,
                    cell(run.scene.grid.cell),
                    numerics.time_step ? "" : cell(numerics.courant),
                    numerics.time_step ? cell(*numerics.time_step) : "",
                    r.failure.empty() ? run.status : "failed",
                    whole(run.steps),
                    cell(run.dt_mean),
                    cell(run.dt_min),
                    cell(run.dt_max),
                    run.limited_by,
                    cell(run.limited_share),
                    whole(run.solid_particles),
                    whole(run.water_particles),
                    whole(run.active_cells),
                    whole(run.pressure_cells),
                    cell(run.wall.total),
                    cell(run.wall.mechanics),
                    cell(run.wall.water),
                    cell(run.wall.audit),
                    cell(run.wall.output),
                    cell(run.particle_steps_per_second),
                    cell(run.balances.solid_mass),
                    cell(run.balances.water_mass),
                    cell(run.balances.momentum),
                    cell(run.balances.energy),
                    cell(run.roughness_last),
                    cell(run.roughness_largest),
                    whole(static_cast<std::int64_t>(run.expectations.size())),
                    whole(met)});
    for (const ComparedMeasure& m : c.measures)
      if (!m.measure.is_profile()) rows.back().push_back(cell(m.last[i]));
  }
  return csv(rows);
}

std::string differences_csv(const Comparison& c) {
  TextRows rows{{"quantity", "unit", "scale", "first", "second", "l2[-]", "max[-]", "max_at[s]",
                 "error_l2[-]", "error_max[-]", "beyond"}};
  for (const ComparedMeasure& m : c.measures)
    for (const VariantDifference& d : m.differences)
      rows.push_back({m.measure.name, m.unit, cell(m.scale), c.runs[d.first].label, c.runs[d.second].label,
                      cell(d.difference.l2), cell(d.difference.max), cell(d.difference.max_at),
                      cell(d.error_l2), cell(d.error_max), verdict_text(d.verdict)});
  return csv(rows);
}

std::string errors_csv(const Comparison& c) {
  TextRows rows{{"quantity", "unit", "scale", "run", "variant", "cell_members", "cell_order[-]", "cell_l2[-]",
                 "cell_max[-]", "step_members", "step_order[-]", "step_l2[-]", "step_max[-]", "l2[-]",
                 "max[-]"}};
  for (const ComparedMeasure& m : c.measures)
    for (const DiscretisationError& e : m.errors)
      rows.push_back({m.measure.name, m.unit, cell(m.scale), c.runs[e.run].label, c.runs[e.run].variant,
                      std::to_string(e.cells.members), cell(e.cells.order), cell(e.cells.l2),
                      cell(e.cells.max), std::to_string(e.steps.members), cell(e.steps.order),
                      cell(e.steps.l2), cell(e.steps.max), cell(e.l2()), cell(e.max())});
  return csv(rows);
}

}  // namespace

std::string compare_text(const Comparison& c) {
  std::string text = "# " + (c.title.empty() ? "Comparison" : c.title) + "\n\n";
  if (!c.case_file.empty()) text += "`" + c.case_file + "`\n\n";
  text += "## Runs\n\n" + runs_table(c) + remarks(c);
  text += "\n## Balances and noise\n\nLargest relative errors over the run, energy at its end.\n\n" +
          balances_table(c) + missed_lines(c);
  text += "\n## Last values\n\n" + last_values_table(c);
  if (const std::string table = errors_table(c); !table.empty())
    text +=
        "\n## Discretisation error\n\nOf the finest run of each variant, as shares of the scale: the range "
        "of the quantity, of a factor of safety its value.\n\n" +
        table;
  if (const std::string table = differences_table(c); !table.empty())
    text += "\n## Differences between variants\n\nShares of the scale, over the time that both have.\n\n" +
            table + "\n" + verdict_lines(c);
  return text;
}

void write_comparison(const Comparison& c, const std::filesystem::path& folder) {
  write_file_atomically(folder / "compare.json", compare_json(c, folder));
  write_file_atomically(folder / "compare.csv", runs_csv(c));
  write_file_atomically(folder / "compare_differences.csv", differences_csv(c));
  write_file_atomically(folder / "compare_errors.csv", errors_csv(c));
  write_file_atomically(folder / "compare.md", compare_text(c));
}

}  // namespace polder::app
