#include "app/run_record.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "app/case.hpp"
#include "app/columns.hpp"
#include "app/document.hpp"
#include "app/measured.hpp"
#include "core/error.hpp"
#include "io/csv.hpp"
#include "io/run_folder.hpp"

namespace polder::app {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

double number(const json& object, const char* key) {
  const auto at = object.find(key);
  return at == object.end() || !at->is_number() ? RunRecord::kNone : at->get<double>();
}

std::string text(const json& object, const char* key) {
  const auto at = object.find(key);
  return at == object.end() || !at->is_string() ? std::string() : at->get<std::string>();
}

void read_stages(const json& list, RunRecord& run) {
  double start = 0, moving = 0, all = 0;
  std::int64_t moving_steps = 0, all_steps = 0;
  for (const json& stage : list) {
    RunRecord::Stage s;
    s.name = text(stage, "name"), s.mode = text(stage, "mode"), s.ended_by = text(stage, "ended_by");
    s.steps = stage.at("steps").get<std::int64_t>();
    s.start = start, s.time = number(stage, "time");
    start += s.time;
    all += s.time, all_steps += s.steps;
    if (s.mode == "dynamic") moving += s.time, moving_steps += s.steps;
    run.stages.push_back(std::move(s));
  }
  if (moving_steps > 0)
    run.dt_mean = moving / static_cast<double>(moving_steps);
  else if (all_steps > 0)
    run.dt_mean = all / static_cast<double>(all_steps);
}

ExpectationResult read_expectation(const json& j) {
  ExpectationResult e;
  e.measure = text(j, "measure"), e.norm = text(j, "norm"), e.when = text(j, "when");
  e.expected = text(j, "expected"), e.problem = text(j, "problem");
  e.measured = number(j, "measured"), e.error = number(j, "error"), e.tolerance = number(j, "tolerance");
  e.pass = j.at("pass").get<bool>();
  return e;
}

void read_summary(const json& root, RunRecord& run) {
  const json &program = root.at("program"), &wall = root.at("wall_seconds"), &dt = root.at("dt"),
             &particles = root.at("particles"), &cells = root.at("cells");
  const std::string commit = text(program, "commit");
  run.program =
      text(program, "version") + (commit.empty() ? "" : " " + commit) + " (" + text(program, "build") + ")";
  run.threads = program.at("threads").get<int>();
  run.case_file = text(root, "case"), run.status = text(root, "status"), run.message = text(root, "message");
  read_stages(root.at("stages"), run);
  run.time = number(root, "time");
  run.steps = root.at("steps").get<std::int64_t>();
  run.computed_steps = root.value("computed_steps", run.steps);
  run.dt_min = number(dt, "min"), run.dt_max = number(dt, "max"), run.limit_reason = text(dt, "limited_by");
  run.wall = {number(wall, "mechanics"), number(wall, "water"), number(wall, "audit"), number(wall, "output"),
              number(wall, "total")};
  run.particle_steps_per_second = number(root, "particle_steps_per_second");
  run.peak_memory = number(root, "peak_memory_bytes");
  run.solid_particles = particles.at("solid").get<std::int64_t>();
  run.water_particles = particles.at("water").get<std::int64_t>();
  run.active_cells = cells.at("active").get<std::int64_t>();
  run.pressure_cells = cells.at("pressure").get<std::int64_t>();
  run.balances.energy = number(root.at("conservation"), "energy");
  for (const json& e : root.at("expectations")) run.expectations.push_back(read_expectation(e));
}

double largest_magnitude(const CsvTable& table, const char* name) {
  const std::string column = find_column(table.columns(), name);
  if (column.empty()) return RunRecord::kNone;
  double largest = 0;
  for (const double v : table.column(column)) {
    if (std::isnan(v)) return RunRecord::kNone;
    largest = std::max(largest, std::abs(v));
  }
  return largest;
}

void read_history(const fs::path& file, RunRecord& run) {
  const CsvTable table(file, history_words());
  run.balances.solid_mass = largest_magnitude(table, "solid_mass_error");
  run.balances.water_mass = largest_magnitude(table, "water_mass_error");
  run.balances.momentum = largest_magnitude(table, "momentum_error");
  run.roughness_largest = largest_magnitude(table, "pressure_roughness");
  const std::string roughness = find_column(table.columns(), "pressure_roughness");
  if (!roughness.empty() && table.rows() > 0) run.roughness_last = table.column(roughness).back();
  std::map<std::string, std::size_t> counts;
  std::size_t all = 0;
  for (const std::string& limit : table.text("dt_limit"))
    if (!limit.empty()) ++counts[limit], ++all;  // the state before the first step has none
  for (const auto& [limit, count] : counts) {
    const double share = static_cast<double>(count) / static_cast<double>(all);
    if (share > run.limited_share) run.limited_by = limit, run.limited_share = share;
  }
}

}  // namespace

bool RunRecord::finished() const {
  return completed() && !stages.empty() && !stages.back().ended_by.empty();
}

RunRecord read_run(const fs::path& path) {
  std::error_code failure;
  if (!fs::is_directory(path, failure)) throw InputError(path.string() + ": no such folder");
  for (const char* file : {"case.toml", "summary.json", "history.csv"})
    if (!fs::exists(path / file, failure))
      throw InputError(path.string() + ": holds no " + file + "; allowed: the folder of a run");
  RunRecord run;
  run.folder = path;
  run.scene = read_case((path / "case.toml").string());
  try {
    read_summary(json::parse(read_text_file((path / "summary.json").string())), run);
  } catch (const json::exception& e) {
    throw InputError((path / "summary.json").string() + ": cannot be read: " + e.what());
  }
  read_history(path / "history.csv", run);
  return run;
}

}  // namespace polder::app
