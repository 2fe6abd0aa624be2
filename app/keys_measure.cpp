// Measures and expectations.
#include <algorithm>

#include "app/case_keys.hpp"
#include "app/codecs.hpp"
#include "app/columns.hpp"
#include "coupling/quantities.hpp"
#include "io/csv.hpp"

namespace polder::app {

using coupling::Expectation;
using coupling::Measure;
using Kind = Measure::Kind;

namespace {

// The one quantity of kind = "stability".
const std::string kFactorOfSafety = "factor_of_safety";

std::vector<std::string> names_of(const std::vector<coupling::Quantity>& quantities, int dimension) {
  std::vector<std::string> names;
  for (const auto& q : quantities) {
    const bool out_of_plane = q.name.ends_with("_z") || q.name.ends_with("_yz") || q.name.ends_with("_zx");
    if (dimension != 2 || !out_of_plane) names.push_back(q.name);
  }
  return names;
}

// A number in SI units or a text with a unit, whose dimension is that of the measure (check_scene.cpp).
Codec<double> of_the_measure() {
  Codec<double> c = number(dimension::kNone);
  Node with_unit = Node::table();
  with_unit.set("type", Node::of("string"));
  Node schema = Node::table();
  schema.set("anyOf", Node::array({c.schema.find("anyOf")->items.front(), std::move(with_unit)}));
  c.schema = std::move(schema);
  c.type = "number in SI units, or with a unit of the measure";
  c.read = [plain = c.read](const Node& n, const std::string& key, double& value, Reader& reader) {
    if (n.is(Node::Kind::text)) {
      const Quantity q = parse_quantity(n.text);
      if (q.error.empty() && q.has_unit) {
        value = q.value;
        reader.note_dimension(key, q.dimension);
        return true;
      }
    }
    return plain(n, key, value, reader);
  };
  return c;
}

void check_quantity(Measure& m, const std::string& path, Reader& reader) {
  if (reader.failed(path)) return;
  if (m.is_profile()) {
    const bool initial = m.along.starts_with("initial_");
    if (m.along.back() - 'x' >= reader.dimension())
      reader.error(key_path(path, "along"), "a 2D grid has no z", "x, y, initial_x, initial_y");
    else if (initial && m.kind == Kind::cells)
      reader.error(key_path(path, "along"), "cells stay where they are",
                   reader.dimension() == 2 ? "x, y" : "x, y, z");
  }
  if (m.kind == Kind::history) return;
  if (m.kind == Kind::stability) {
    if (m.quantity != kFactorOfSafety)
      reader.error(
          key_path(path, "quantity"),
          "stability has no quantity \"" + m.quantity + "\"" + did_you_mean(m.quantity, {kFactorOfSafety}),
          kFactorOfSafety);
    return;
  }
  const bool cell = m.kind == Kind::cell || m.kind == Kind::cells;
  const std::vector<std::string> names =
      names_of(cell ? coupling::cell_quantities() : coupling::particle_quantities(), reader.dimension());
  if (std::find(names.begin(), names.end(), m.quantity) == names.end())
    reader.error(key_path(path, "quantity"),
                 "a " + std::string(cell ? "cell" : "particle") + " has no quantity \"" + m.quantity + "\"" +
                     did_you_mean(m.quantity, names),
                 join(names));
}

void check_csv(const Expectation& e, const std::string& path, Reader& reader) {
  const std::string key = key_path(path, "reference");
  const std::filesystem::path file = reader.directory() / e.reference;
  std::error_code failure;
  if (!std::filesystem::is_regular_file(file, failure)) {
    reader.error(key, "no such file \"" + e.reference + "\"", "a CSV file, its path seen from the case file");
    return;
  }
  try {
    const CsvTable table(file);
    if (table.columns().size() < 2)
      reader.error(key, "\"" + e.reference + "\" has only one column", "a CSV file with two columns or more");
    else if (!e.column.empty() && find_column(table.columns(), e.column).empty())
      reader.error(key_path(path, "column"),
                   "\"" + e.reference + "\" has no column \"" + e.column + "\"" +
                       did_you_mean(e.column, table.columns()),
                   join(table.columns()));
  } catch (const InputError& problem) {
    reader.error(key, "\"" + e.reference + "\" cannot be used: " + problem.diagnostics().front().problem,
                 "a CSV file of numbers");
  } catch (const EnvironmentError&) {
    reader.error(key, "\"" + e.reference + "\" cannot be read", "a readable CSV file");
  }
}

// One thing to compare with, and a norm that fits it.
void check_expectation(Expectation& e, const std::string& path, Reader& reader) {
  if (reader.failed(path)) return;
  const int given = int(e.value.has_value()) + int(!e.reference.empty()) + int(e.has_bounds());
  const std::string one = "reference; value; at_least, at_most or both";
  if (given == 0) {
    reader.error(path, "nothing to compare with", one);
    return;
  }
  if (given > 1) {
    const bool both = e.value.has_value() && !e.reference.empty();
    reader.error(key_path(path, e.value      ? "value"
                                : e.at_least ? "at_least"
                                             : "at_most"),
                 std::string(both      ? "reference and value contradict"
                             : e.value ? "value and bounds contradict"
                                       : "reference and bounds contradict") +
                     " each other",
                 one);
    return;
  }
  if (e.at_least && e.at_most && !(*e.at_least <= *e.at_most)) {
    reader.error(key_path(path, "at_most"), "below at_least", "at least " + format_number(*e.at_least));
    return;
  }
  const std::string tolerance = key_path(path, "tolerance");
  if (e.has_bounds() && e.tolerance)
    reader.error(tolerance, "does not apply here", "only with reference or value");
  if (!e.has_bounds() && !e.tolerance) reader.error(tolerance, "missing", "number, greater than 0");
  if (!e.reference.empty()) {
    check_csv(e, path, reader);
    return;
  }
  if (!reader.given(key_path(path, "norm")))
    e.norm = "last";
  else if (e.norm == "l2" || e.norm == "max")
    reader.error(
        key_path(path, "norm"),
        "\"" + e.norm + "\" compares curves, " + (e.value ? "value is" : "bounds are for") + " one number",
        "last, largest, smallest, magnitude, mean, change");
  if (!e.column.empty()) reader.error(key_path(path, "column"), "does not apply here", "only with reference");
}

}  // namespace

const Table<Measure>& measure_keys() {
  static const Table<Measure> table = [] {
    using M = Measure;
    const auto placed = [](const M& m) { return m.kind == Kind::particle || m.kind == Kind::cell; };
    const auto profile = [](const M& m) { return m.is_profile(); };
    Table<M> t;
    t.add("name", identifier(), &M::name, "Name in results and in [[expect]].").required();
    t.add("kind",
          choice<Kind>({{"particle", Kind::particle},
                        {"cell", Kind::cell},
                        {"history", Kind::history},
                        {"body", Kind::body},
                        {"particles", Kind::particles},
                        {"cells", Kind::cells},
                        {"stability", Kind::stability}}),
          &M::kind,
          "One value in time: particle follows the one nearest to `at`; cell stays at `at`; history is a "
          "column of history.csv; body is the mean over a body's mass. Profiles, many values at a time in "
          "profile_NAME.csv: particles, of all; cells, of all with water. stability: one number for a run, "
          "by strength reduction as `polder stability` does it; the search is in stability_NAME.csv.");
    t.add("quantity", text(), &M::quantity,
          "particle, particles, body: " + join(names_of(coupling::particle_quantities(), 3)) +
              "; cell, cells: " + join(names_of(coupling::cell_quantities(), 3)) +
              "; history: the name of a column; stability: " + kFactorOfSafety + ".")
        .required();
    t.add("at", vector(dimension::kLength), &M::at, "Place in the initial state.")
        .required()
        .only_with("kind", "kind = \"particle\" or \"cell\"", placed);
    t.add("body", text(), &M::body, "Name of the body.")
        .required()
        .only_with("kind", "kind = \"body\"", [](const M& m) { return m.kind == Kind::body; });
    t.add("along", word({"x", "y", "z", "initial_x", "initial_y", "initial_z"}), &M::along,
          "Coordinate over which the profile is taken: at present, or (particles) where displacements are "
          "counted from.")
        .required()
        .only_with("kind", "kind = \"particles\" or \"cells\"", profile);
    t.add("within", box(), &M::within, "Only what lies in this box, in the coordinates that `along` names.")
        .only_with("kind", "kind = \"particles\" or \"cells\"", profile);
    t.add("stage", text(), &M::stage,
          "The factor of safety at the end of this stage; default: at the end of the run.")
        .only_with("kind", "kind = \"stability\"", [](const M& m) { return m.kind == Kind::stability; });
    t.add("every", number(dimension::kTime, kNotNegative), &M::every,
          "Time between records; the shortest of all measures counts. 0: with every line of the history. A "
          "profile has its own; 0: at the end of each stage and at the times of expectations. Those are "
          "recorded for every measure.")
        .only_with("kind", "a kind other than \"stability\"",
                   [](const M& m) { return m.kind != Kind::stability; });
    t.check(check_quantity);
    return t;
  }();
  return table;
}

const Table<Expectation>& expect_keys() {
  static const Table<Expectation> table = [] {
    using E = Expectation;
    Table<E> t;
    t.add("measure", text(), &E::measure, "Name of the measure.").required();
    t.add("reference", text(), &E::reference,
          "CSV file of the expected curve, its path seen from the case file: values over time in its column "
          "`time`, `t` or the first; for a profile over the coordinate in the first.");
    t.add("column", text(), &E::column, "Column of the reference; default: its second.");
    t.add("value", of_the_measure(), &E::value, "Expected number instead of a reference.");
    t.add("at_least", of_the_measure(), &E::at_least, "Lower bound instead.");
    t.add("at_most", of_the_measure(), &E::at_most, "Upper bound instead.");
    t.add(
        "norm", word({"l2", "max", "last", "largest", "smallest", "magnitude", "mean", "change"}), &E::norm,
        "l2, max: norm of the difference of two curves, of a profile over its points; one number of the "
        "measure: its last, largest or smallest, the largest magnitude, the mean (over time, of a profile "
        "over its points), the change from its first to its last value. With value or bounds the default is "
        "last.");
    t.add("from_stage", text(), &E::from_stage,
          "Stage at whose start times begin, and before which nothing is compared; default: the beginning of "
          "the run.");
    t.add("time", number(dimension::kTime, kPositive), &E::time,
          "Time up to which the measure counts, so that last is its value then; a profile is the one at this "
          "time. A step ends there. Default: the end of the run.");
    t.add(
        "tolerance", number(dimension::kNone, kPositive), &E::tolerance,
        "Largest error that passes; relative where the reference is not 0, absolute otherwise. Required with "
        "reference or value.");
    t.check(check_expectation);
    return t;
  }();
  return table;
}

}  // namespace polder::app
