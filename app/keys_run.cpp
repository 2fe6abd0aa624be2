// Stages, measures, expectations and output.
#include <algorithm>

#include "app/case_keys.hpp"
#include "app/codecs.hpp"
#include "app/columns.hpp"
#include "coupling/quantities.hpp"
#include "io/csv.hpp"

namespace polder::app {

using coupling::Expectation;
using coupling::Measure;
using coupling::OutputSpec;
using coupling::Stage;

namespace {

std::vector<std::string> names_of(const std::vector<coupling::Quantity>& quantities, int dimension) {
  std::vector<std::string> names;
  for (const auto& q : quantities) {
    const bool out_of_plane = q.name.ends_with("_z") || q.name.ends_with("_yz") || q.name.ends_with("_zx");
    if (dimension != 2 || !out_of_plane) names.push_back(q.name);
  }
  return names;
}

void check_quantity(Measure& m, const std::string& path, Reader& reader) {
  const std::string key = key_path(path, "quantity");
  if (reader.failed(path) || m.kind == Measure::Kind::history) return;
  const bool particle = m.kind == Measure::Kind::particle;
  const std::vector<std::string> names =
      names_of(particle ? coupling::particle_quantities() : coupling::cell_quantities(), reader.dimension());
  if (std::find(names.begin(), names.end(), m.quantity) == names.end())
    reader.error(key,
                 "a " + std::string(particle ? "particle" : "cell") + " has no quantity \"" + m.quantity +
                     "\"" + did_you_mean(m.quantity, names),
                 join(names));
}

void check_reference(Expectation& e, const std::string& path, Reader& reader) {
  if (reader.failed(path)) return;
  const bool has_value = e.value.has_value(), has_file = !e.reference.empty();
  if (has_value == has_file) {
    reader.error(has_value ? key_path(path, "value") : path,
                 has_value ? "reference and value contradict each other" : "nothing to compare with",
                 "reference or value");
    return;
  }
  const std::string key = key_path(path, "reference");
  const bool curve = e.norm == "l2" || e.norm == "max";
  if (has_value) {
    if (!reader.given(key_path(path, "norm")))
      e.norm = "last";
    else if (curve)
      reader.error(key_path(path, "norm"), "\"" + e.norm + "\" compares curves, value is one number",
                   "last, largest, smallest");
    if (!e.column.empty())
      reader.error(key_path(path, "column"), "does not apply here", "only with reference");
    return;
  }
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

}  // namespace

const Table<Stage>& stage_keys() {
  static const Table<Stage> table = [] {
    const auto equilibrium = [](const Stage& s) { return s.mode == Stage::Mode::equilibrium; };
    const std::string with_equilibrium = "mode = \"equilibrium\"";
    Table<Stage> t;
    t.add("name", identifier(), &Stage::name, "Name in messages and results; default: stage-1, stage-2, ...");
    t.add("mode",
          choice<Stage::Mode>({{"equilibrium", Stage::Mode::equilibrium}, {"dynamic", Stage::Mode::dynamic}},
                              {"seepage", "quasi-static"}),
          &Stage::mode, "equilibrium: until the forces balance; dynamic: with inertia, for the duration.")
        .required();
    t.add("duration", number(dimension::kTime, kPositive), &Stage::duration,
          "Simulated time; of an equilibrium stage at most.")
        .required();
    t.add("damping", number(dimension::kNone, {.min = 0, .max = 1, .max_open = true}), &Stage::damping,
          "Local damping: share of the out-of-balance force that opposes the motion.");
    t.add("plastic", boolean(), &Stage::plastic, "false: the materials respond elastically.");
    t.add("sticking", boolean(), &Stage::sticking, "true: friction boundaries hold without slip.");
    t.add("water_flows", boolean(), &Stage::water_flows, "false: the pore pressure stays as it is.");
    t.add("gravity_ramp", number(dimension::kTime, kNotNegative), &Stage::gravity_ramp,
          "Time over which gravity grows from nothing; 0: full from the start.");
    t.add("force_tolerance", number(dimension::kNone, {.min = 0, .max = 1, .min_open = true}),
          &Stage::force_tolerance, "Out-of-balance force ratio below which an equilibrium stage ends.")
        .only_with("mode", with_equilibrium, equilibrium);
    t.add("energy_tolerance", number(dimension::kNone, {.min = 0, .max = 1, .min_open = true}),
          &Stage::energy_tolerance, "Kinetic energy ratio below which an equilibrium stage ends.")
        .only_with("mode", with_equilibrium, equilibrium);
    t.add("reset_displacement", boolean(), &Stage::reset_displacement,
          "At the end of the stage displacements and plastic strains start from zero.");
    t.add("reset_velocity", boolean(), &Stage::reset_velocity,
          "At the end of the stage the soil is brought to rest.");
    t.later("until", "events that end a stage");
    t.check([](Stage& s, const std::string& path, Reader& reader) {
      if (s.gravity_ramp > s.duration && !reader.failed(path))
        reader.error(key_path(path, "gravity_ramp"), "longer than the stage",
                     "at most duration, " + format_number(s.duration) + " s");
    });
    return t;
  }();
  return table;
}

const Table<Measure>& measure_keys() {
  using Kind = Measure::Kind;
  static const Table<Measure> table = [] {
    using M = Measure;
    const auto placed = [](const M& m) { return m.kind != Kind::history; };
    Table<M> t;
    t.add("name", identifier(), &M::name, "Name in results and in [[expect]].").required();
    t.add(
        "kind",
        choice<Kind>({{"particle", Kind::particle}, {"cell", Kind::cell}, {"history", Kind::history}}),
        &M::kind,
        "particle: follows the one nearest to `at`; cell: stays at `at`; history: a column of history.csv.");
    t.add("quantity", text(), &M::quantity,
          "particle: " + join(names_of(coupling::particle_quantities(), 3)) + "; cell: " +
              join(names_of(coupling::cell_quantities(), 3)) + "; history: the name of a column.")
        .required();
    t.add("at", vector(dimension::kLength), &M::at, "Place in the initial state.")
        .required()
        .only_with("kind", "kind = \"particle\" or \"cell\"", placed);
    t.add("every", number(dimension::kTime, kNotNegative), &M::every,
          "Time between records; the shortest of all measures counts. 0: with every line of the history.");
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
          "CSV file of the expected curve, its path seen from the case file.");
    t.add("column", text(), &E::column, "Column of the reference; default: its second.");
    t.add("value", number(dimension::kNone), &E::value,
          "Expected number, in SI units, instead of a reference.");
    t.add("norm", word({"l2", "max", "last", "largest", "smallest"}), &E::norm,
          "l2, max: norm of the difference of two curves; last, largest, smallest: one value of the measure. "
          "With value the "
          "default is last.");
    t.add("from_stage", text(), &E::from_stage,
          "Stage at whose start the times of the reference begin, and before which nothing is compared; "
          "default: the beginning of the run.");
    t.add("tolerance", number(dimension::kNone, kPositive), &E::tolerance,
          "Largest error that passes; relative where the reference is not 0, absolute otherwise.")
        .required();
    t.check(check_reference);
    return t;
  }();
  return table;
}

const Table<OutputSpec>& output_keys() {
  static const Table<OutputSpec> table = [] {
    using O = OutputSpec;
    Table<O> t;
    t.add("fields", words(names_of(coupling::frame_quantities(), 3)), &O::fields,
          "Fields of the soil's frames.");
    t.add("every", number(dimension::kTime, kNotNegative), &O::every,
          "Simulated time between frames; 0: first and last only.");
    t.add("history_every", number(dimension::kTime, kNotNegative), &O::history_every,
          "Simulated time between lines of the history; 0: a thousandth of the duration.");
    t.add("checkpoint", number(dimension::kTime, kPositive), &O::checkpoint_every,
          "Time of the clock on the wall between checkpoints.");
    return t;
  }();
  return table;
}

}  // namespace polder::app
