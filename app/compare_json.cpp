// compare.json: the comparison for programs and for the pictures. The keys are stable.
#include "app/compare_report.hpp"
#include "app/summary.hpp"
#include "io/json.hpp"

namespace polder::app {
namespace {

Json run_json(const Comparison& c, std::size_t i, const std::filesystem::path& folder) {
  const ComparedRun& r = c.runs[i];
  const RunRecord& run = r.run;
  Json j = Json::object();
  j["label"] = r.label;
  j["variant"] = r.variant;
  j["status"] = r.failure.empty() ? run.status : "failed";
  if (!r.failure.empty()) j["reason"] = r.failure;
  if (!r.has_results()) return j;
  j["folder"] = run.folder.lexically_proximate(folder).string();
  j["reused"] = r.reused;
  j["formulation"] = run.scene.formulation;
  j["program"] = run.program;
  j["threads"] = run.threads;
  j["cell"] = run.scene.grid.cell;
  const coupling::NumericsSpec& numerics = run.scene.numerics;
  j["courant"] = numerics.time_step ? Json() : Json(numerics.courant);
  j["time_step"] = numerics.time_step ? Json(*numerics.time_step) : Json();
  j["start"] = r.start;
  Json stages = Json::array();  // those compared
  for (const RunRecord::Stage& s : run.stages) {
    if (s.mode == "equilibrium") continue;
    Json stage = Json::object();
    stage["name"] = s.name;
    stage["start"] = s.start;
    stage["time"] = s.time;
    stages.push_back(std::move(stage));
  }
  j["stages"] = std::move(stages);
  j["time"] = run.time;
  j["steps"] = run.steps;
  j["computed_steps"] = run.computed_steps;
  Json dt = Json::object();
  dt["min"] = run.dt_min;
  dt["mean"] = run.dt_mean;
  dt["max"] = run.dt_max;
  dt["limited_by"] = run.limited_by;
  dt["limited_share"] = run.limited_share;
  dt["limit_reason"] = run.limit_reason;
  j["dt"] = std::move(dt);
  Json wall = Json::object();
  wall["mechanics"] = run.wall.mechanics;
  wall["water"] = run.wall.water;
  wall["audit"] = run.wall.audit;
  wall["output"] = run.wall.output;
  wall["other"] = run.wall.other();
  wall["total"] = run.wall.total;
  j["wall_seconds"] = std::move(wall);
  j["particle_steps_per_second"] = run.particle_steps_per_second;
  j["peak_memory_bytes"] = run.peak_memory;
  Json particles = Json::object();
  particles["solid"] = run.solid_particles;
  particles["water"] = run.water_particles;
  j["particles"] = std::move(particles);
  Json cells = Json::object();
  cells["active"] = run.active_cells;
  cells["pressure"] = run.pressure_cells;
  j["cells"] = std::move(cells);
  Json conservation = Json::object();
  conservation["solid_mass"] = run.balances.solid_mass;
  conservation["water_mass"] = run.balances.water_mass;
  conservation["momentum"] = run.balances.momentum;
  conservation["energy"] = run.balances.energy;
  j["conservation"] = std::move(conservation);
  Json roughness = Json::object();
  roughness["last"] = run.roughness_last;
  roughness["largest"] = run.roughness_largest;
  j["pressure_roughness"] = std::move(roughness);
  Json measures = Json::object();
  for (const ComparedMeasure& m : c.measures)
    if (!m.measure.is_profile()) measures[m.measure.name] = m.last[i];
  j["measures"] = std::move(measures);
  Json expectations = Json::array();
  for (const ExpectationResult& e : run.expectations) expectations.push_back(expectation_json(e));
  j["expectations"] = std::move(expectations);
  return j;
}

Json family_json(const FamilyError& e) {
  if (!e.known()) return Json();
  Json j = Json::object();
  j["members"] = e.members;
  j["order"] = e.order;
  j["converges"] = e.converges;
  j["l2"] = e.l2;
  j["max"] = e.max;
  return j;
}

const char* kind_text(coupling::Measure::Kind kind) {
  using Kind = coupling::Measure::Kind;
  switch (kind) {
    case Kind::particle:
      return "particle";
    case Kind::cell:
      return "cell";
    case Kind::history:
      return "history";
    case Kind::body:
      return "body";
    case Kind::particles:
      return "particles";
    case Kind::cells:
      return "cells";
    case Kind::stability:
      return "stability";
  }
  return "";
}

Json measure_json(const ComparedMeasure& m) {
  Json j = Json::object();
  j["name"] = m.measure.name;
  j["kind"] = kind_text(m.measure.kind);
  j["quantity"] = m.measure.quantity;
  j["unit"] = m.unit;
  j["asked"] = m.asked;
  if (m.measure.is_profile()) j["times"] = Json::array_of(m.times);
  j["scale"] = m.scale;
  Json errors = Json::array();
  for (const DiscretisationError& e : m.errors) {
    Json item = Json::object();
    item["run"] = e.run;
    item["known"] = e.known();
    item["cell"] = family_json(e.cells);
    item["step"] = family_json(e.steps);
    item["l2"] = e.l2();
    item["max"] = e.max();
    errors.push_back(std::move(item));
  }
  j["errors"] = std::move(errors);
  Json differences = Json::array();
  for (const VariantDifference& d : m.differences) {
    Json item = Json::object();
    item["first"] = d.first;
    item["second"] = d.second;
    item["l2"] = d.difference.l2;
    item["max"] = d.difference.max;
    item["max_at"] = d.difference.max_at;
    item["error_l2"] = d.error_l2;
    item["error_max"] = d.error_max;
    item["beyond"] = verdict_text(d.verdict);
    item["cells"] = Json::array_of(d.by_cell);
    item["l2_of_cells"] = Json::array_of(d.l2_by_cell);
    differences.push_back(std::move(item));
  }
  j["differences"] = std::move(differences);
  return j;
}

}  // namespace

std::string compare_json(const Comparison& c, const std::filesystem::path& folder) {
  Json root = Json::object();
  root["case"] = c.case_file;
  root["title"] = c.title;
  root["variants"] = Json::array_of(c.variants);
  Json runs = Json::array(), measures = Json::array();
  for (std::size_t i = 0; i < c.runs.size(); ++i) runs.push_back(run_json(c, i, folder));
  for (const ComparedMeasure& m : c.measures) measures.push_back(measure_json(m));
  root["runs"] = std::move(runs);
  root["measures"] = std::move(measures);
  return root.text();
}

}  // namespace polder::app
