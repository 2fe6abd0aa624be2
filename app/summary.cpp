#include "app/summary.hpp"

#include <sys/resource.h>

#include <cmath>
#include <limits>

#include "app/columns.hpp"
#include "app/measured.hpp"
#include "app/stability_measures.hpp"
#include "app/tables.hpp"
#include "app/version.hpp"
#include "core/simd_level.hpp"
#include "io/atomic_file.hpp"
#include "io/csv.hpp"
#include "io/json.hpp"

namespace polder::app {
namespace {

using coupling::Simulation;

double peak_memory_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return 1024.0 * static_cast<double>(usage.ru_maxrss);  // Linux counts in KiB
}

// The present value of a history column; null in JSON if the run has none.
double value_of(const std::vector<coupling::Column>& history, const std::string& name) {
  for (const coupling::Column& c : history)
    if (c.name.substr(0, c.name.find('[')) == name) return c.value;
  return std::numeric_limits<double>::quiet_NaN();
}

// The energy that the transfers between particles and grid lose, beside all work done.
double energy_error(const std::vector<coupling::Column>& history) {
  double scale = value_of(history, "kinetic_energy") + value_of(history, "elastic_energy");
  for (const coupling::Column& c : history)
    if (c.name.starts_with("work_")) scale = std::max(scale, std::abs(c.value));
  return scale > 0 ? value_of(history, "transfer_loss") / scale : 0;
}

Json stages(const Simulation& s, const RunSummary& summary) {
  Json list = Json::array();
  for (std::size_t i = 0; i < s.stages().size(); ++i) {
    const coupling::StageReport& r = s.stages()[i];
    Json stage = Json::object();
    stage["name"] = r.name;
    stage["mode"] = r.mode;
    stage["steps"] = r.steps;
    stage["time"] = r.time;
    stage["wall"] = i < summary.stage_wall_seconds.size() ? summary.stage_wall_seconds[i] : 0.0;
    stage["ended_by"] = r.ended_by;
    list.push_back(std::move(stage));
  }
  return list;
}

// What was not computed, beside what would have been. Systems are those of this call.
Json saved(const Simulation& s) {
  const coupling::Savings saved = s.savings();
  Json all = Json::object();
  Json cells = Json::object();
  cells["grid"] = saved.all_cells;
  cells["stored"] = saved.stored_cells;
  cells["in_pressure_system"] = saved.pressure_cells;
  all["cells"] = std::move(cells);
  Json systems = Json::object();
  systems["solved"] = saved.systems;
  systems["structures_analysed"] = saved.structures;
  systems["factorisations"] = saved.factors;
  all["pressure_systems"] = std::move(systems);
  Json sleep = Json::object();
  sleep["particle_steps"] = s.steps() * s.particles();
  sleep["particle_steps_skipped"] = saved.skipped_particle_steps;
  sleep["blocks_put_to_sleep"] = saved.blocks_asleep;
  sleep["blocks_woken"] = saved.blocks_woken;
  all["sleep"] = std::move(sleep);
  return all;
}

// The last recorded value of every measure.
Json measures(const Simulation& s, const RunFolder& folder, const std::vector<coupling::Column>& history) {
  Json all = Json::object();
  std::error_code failure;
  const bool probes = std::filesystem::exists(folder.probes(), failure);
  for (const coupling::Measure& m : s.scene().measures) {
    if (m.kind == coupling::Measure::Kind::stability) {
      if (std::filesystem::exists(StabilityMeasures::file(folder, m), failure))
        all[m.name] = number_of("last", read_measure(m, folder, 0, s.time()), false);
      continue;
    }
    bool in_history = false;
    const std::string name = measure_column(m, in_history);
    if (in_history) {
      all[m.name] = value_of(history, name);
    } else if (probes) {
      const CsvTable table(folder.probes());
      const std::string column = find_column(table.columns(), name);
      if (!column.empty() && table.rows() > 0) all[m.name] = table.column(column).back();
    }
  }
  return all;
}

}  // namespace

std::string program_version() {
  return kVersion;
}
std::string program_commit() {
  return kCommit;
}
std::string program_build() {
  return std::string(kBuildType) + ", vector level " + to_string(simd_level());
}

Json expectation_json(const ExpectationResult& e) {
  Json item = Json::object();
  item["measure"] = e.measure;
  item["norm"] = e.norm;
  if (!e.when.empty()) item["when"] = e.when;
  item["measured"] = e.measured;
  item["expected"] = e.expected;
  item["error"] = e.error;
  item["tolerance"] = e.tolerance;
  item["pass"] = e.pass;
  if (!e.problem.empty()) item["problem"] = e.problem;
  return item;
}

void write_summary(const Simulation& s, const RunFolder& folder, const RunSummary& summary) {
  const std::vector<coupling::Column> history = s.history();
  Json root = Json::object();
  Json program = Json::object();
  program["version"] = program_version();
  program["commit"] = program_commit();
  program["build"] = program_build();
  program["threads"] = summary.threads;
  root["program"] = std::move(program);
  root["case"] = summary.case_file;
  root["formulation"] = s.scene().formulation;
  root["status"] = summary.status;
  if (!summary.message.empty()) root["message"] = summary.message;
  root["stages"] = stages(s, summary);
  Json happened = Json::array();
  for (const coupling::Event& e : s.events()) {
    Json item = Json::object();
    item["stage"] = e.stage;
    item["event"] = e.is_failure() ? "failure" : "local failure";
    item["time"] = e.time;
    Json place = Json::array();
    for (int d = 0; d < s.scene().dimension(); ++d) place.push_back(e.place[d]);
    item["place"] = std::move(place);
    item["displacement"] = e.displacement;
    item["text"] = e.text();
    happened.push_back(std::move(item));
  }
  root["events"] = std::move(happened);
  root["time"] = s.time();

  const coupling::Timing t = s.timing();
  Json wall = Json::object();
  wall["mechanics"] = t.mechanics;
  wall["water"] = t.water;
  wall["audit"] = t.audit;
  wall["output"] = summary.output_seconds;
  wall["output_waited"] = summary.waited_for_writer;  // part of output
  wall["writer"] = summary.writer_seconds;            // beside the rest, in a thread of its own
  wall["total"] = summary.wall_seconds;
  root["wall_seconds"] = std::move(wall);

  Json particles = Json::object();
  particles["solid"] = s.particles();
  particles["water"] = 0;
  root["particles"] = std::move(particles);
  Json cells = Json::object();
  cells["active"] = s.cells();
  cells["pressure"] = s.pressure_cells();
  root["cells"] = std::move(cells);
  root["dems"] = 0;
  root["steps"] = s.steps();
  // Times are those of this call, which a restart makes shorter than the run.
  const double computed = static_cast<double>(s.steps() - summary.first_step);
  root["computed_steps"] = s.steps() - summary.first_step;
  root["particle_steps_per_second"] =
      t.total > 0 ? computed * static_cast<double>(s.particles()) / t.total : 0.0;
  Json dt = Json::object();
  dt["min"] = s.smallest_step();
  dt["max"] = s.largest_step();
  dt["limit"] = s.step_limit().dt;
  dt["limited_by"] = s.step_limit().reason;
  root["dt"] = std::move(dt);

  Json conservation = Json::object();
  conservation["solid_mass"] = value_of(history, "solid_mass_error");
  conservation["water_mass"] = value_of(history, "water_mass_error");
  conservation["momentum"] = value_of(history, "momentum_error");
  conservation["energy"] = energy_error(history);
  root["conservation"] = std::move(conservation);

  root["measures"] = measures(s, folder, history);
  Json expectations = Json::array();
  for (const ExpectationResult& e : summary.expectations) expectations.push_back(expectation_json(e));
  root["expectations"] = std::move(expectations);
  root["peak_memory_bytes"] = peak_memory_bytes();
  root["skipped"] = Json::array_of(s.skipped());
  root["saved"] = saved(s);
  write_file_atomically(folder.summary(), root.text());
}

}  // namespace polder::app
