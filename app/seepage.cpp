// `polder seepage`: a case with a rigid skeleton, and what a seepage engineer reads from its end.
//
// Written beside the results of every run: flow.json, stream_function.csv, exit_gradients.csv (plane and
// axisymmetric cases). Discharges [m3/s], positive out of the soil, per metre of thickness in plane strain,
// per radian in axisymmetric cases; gradients [-]; definitions in fdm/flow_results.hpp.
#include "app/seepage.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>

#include "app/case.hpp"
#include "app/commands.hpp"
#include "app/digits.hpp"
#include "app/run.hpp"
#include "core/error.hpp"
#include "core/threads.hpp"
#include "coupling/quantities.hpp"
#include "coupling/simulation.hpp"
#include "io/atomic_file.hpp"
#include "io/csv.hpp"
#include "io/json.hpp"

namespace polder::app {
namespace {

namespace fs = std::filesystem;
using coupling::FlowExit;
using coupling::FlowNet;
using coupling::Measure;
using coupling::Scene;
using coupling::SeepageEnd;
using coupling::Simulation;
using coupling::Stage;
using coupling::TimeTable;

// A steady state of a case without stages of its own, in times that water takes to pass: through a cell for
// the first step, through the whole domain for the end, which is never near.
constexpr double kFirstStep = 0.1;
constexpr double kLatest = 1e4;
// The head changes by less than this share of what the least permeable soil lets through under its weight:
// what is still stored is then as small a share of the discharge.
constexpr double kSteadyShare = 1e-6;

// ---- the scene
// ------------------------------------------------------------------------------------------------------

bool is_water_stage(const Stage& s) {
  return s.mode == Stage::Mode::seepage || s.mode == Stage::Mode::quasi_static;
}

Stage rigid(const Stage& given) {
  Stage s;
  s.name = given.name;
  s.mode = Stage::Mode::seepage;
  s.until = given.until == Stage::Until::steady ? Stage::Until::steady : Stage::Until::duration;
  s.duration = given.duration;
  s.output_every = given.output_every;
  s.history_every = given.history_every;
  s.first_step = given.first_step;
  s.largest_step = given.largest_step;
  s.steady_rate = given.steady_rate;
  return s;
}

Stage steady_stage(const Scene& scene) {
  double least = std::numeric_limits<double>::infinity(), most = 0;
  for (const coupling::Material& m : scene.materials) {
    if (!(m.porosity > 0)) continue;
    least = std::min(least, m.hydraulic_conductivity);
    most = std::max(most, m.hydraulic_conductivity);
  }
  const double extent = *std::max_element(scene.grid.size.begin(), scene.grid.size.end());
  Stage s;
  s.name = "steady";
  s.mode = Stage::Mode::seepage;
  s.until = Stage::Until::steady;
  s.first_step = kFirstStep * scene.grid.cell / most;
  s.duration = kLatest * extent / least;
  s.history_every = s.first_step;  // every step: they grow as fast as they can
  s.steady_rate = kSteadyShare * least;
  return s;
}

void hold(TimeTable& table) {
  table = TimeTable{{0.0}, {table.at(0)}};
}

// Conditions of time 0 for all times.
void hold_conditions(Scene& scene) {
  for (coupling::WaterBoundary& w : scene.water_boundaries) hold(w.value);
  for (coupling::WaterLine& l : scene.water_lines) hold(l.rate);
  if (scene.water.outside_level) hold(*scene.water.outside_level);
}

std::string list_of(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& n : names) text += (text.empty() ? "" : ", ") + n;
  return text;
}

// Columns of the history that only other stages have.
void drop_measures(Scene& scene, std::vector<std::string>& remarks) {
  const std::vector<coupling::Quantity> columns = coupling::history_quantities(scene);
  std::vector<std::string> gone;
  std::erase_if(scene.measures, [&](const Measure& m) {
    const bool known = m.kind != Measure::Kind::history ||
                       std::any_of(columns.begin(), columns.end(),
                                   [&](const coupling::Quantity& q) { return q.name == m.quantity; });
    if (!known) gone.push_back(m.name);
    return !known;
  });
  if (!gone.empty()) remarks.push_back("left out     measures of moving soil: " + list_of(gone));
}

// ---- results
// --------------------------------------------------------------------------------------------------------

std::string name_of(const Scene& scene, int boundary) {
  return boundary < 0 ? "surface" : scene.water_boundaries[static_cast<std::size_t>(boundary)].name;
}

// Named discharges of the history's present row, without the prefix and the unit.
std::vector<std::pair<std::string, double>> discharges(const Simulation& s) {
  const std::string prefix = "discharge:";
  std::vector<std::pair<std::string, double>> list;
  for (const coupling::Column& c : s.history())
    if (c.name.starts_with(prefix))
      list.emplace_back(c.name.substr(prefix.size(), c.name.find('[') - prefix.size()), c.value);
  return list;
}

Json place_of(const coupling::Vector3& x) {
  Json place = Json::array();
  place.push_back(x[0]);
  place.push_back(x[1]);
  return place;
}

Json json_of(const FlowExit& e, const Scene& scene) {
  Json j = Json::object();
  j["gradient"] = e.gradient;
  j["place"] = place_of(e.place);
  j["direction"] = place_of(e.direction);
  j["boundary"] = name_of(scene, e.boundary);
  if (!e.is_upward()) return j;
  j["critical_gradient"] = e.critical;
  j["heave_factor"] = e.heave_factor();
  return j;
}

struct Exits {
  const FlowExit* steepest = nullptr;  // in any direction
  const FlowExit* heave = nullptr;     // the upward one with the least factor against heave
};

Json json_of(const SeepageEnd& e, const Scene& scene) {
  Json j = Json::object();
  j["place"] = place_of(e.place);
  j["slope"] = e.slope;
  j["boundary"] = name_of(scene, e.boundary);
  j["within_cell"] = e.within;
  return j;
}

Exits find(const FlowNet& net) {
  Exits found;
  for (const FlowExit& e : net.exits) {
    if (!found.steepest || e.gradient > found.steepest->gradient) found.steepest = &e;
    if (e.is_upward() && (!found.heave || e.heave_factor() < found.heave->heave_factor())) found.heave = &e;
  }
  return found;
}

Json flow_json(const Simulation& s, const std::string& case_file, const FlowNet& net, const Exits& exits) {
  const Scene& scene = s.scene();
  Json root = Json::object();
  root["case"] = case_file;
  root["title"] = scene.title;
  root["time"] = s.time();
  root["steady"] = s.stages().back().ended_by == "steady";
  Json named = Json::object();
  double in = 0, out = 0;
  for (const auto& [name, q] : discharges(s)) {
    named[name] = q;
    (q < 0 ? in : out) += std::abs(q);
  }
  root["discharge"] = std::move(named);
  root["inflow"] = in;
  root["outflow"] = out;
  if (scene.dimension() == 3) return root;
  Json psi = Json::object();
  psi["lowest"] = net.lowest;
  psi["highest"] = net.highest;
  psi["defect"] = net.defect;
  root["stream_function"] = std::move(psi);
  root["largest_exit_gradient"] = exits.steepest ? json_of(*exits.steepest, scene) : Json();
  Json ends = Json::array();
  for (const SeepageEnd& e : net.seepage_ends) ends.push_back(json_of(e, scene));
  root["phreatic_exits"] = std::move(ends);
  root["heave"] = exits.heave ? json_of(*exits.heave, scene) : Json();
  return root;
}

void write_tables(const RunFolder& folder, const Scene& scene, const FlowNet& net) {
  CsvWriter psi(folder.path() / "stream_function.csv", {"x[m]", "y[m]", "stream_function[m2/s]"},
                CsvWriter::Mode::fresh);
  for (const auto& node : net.stream_function) psi.row({node[0], node[1], node[2]});
  CsvWriter exits(
      folder.path() / "exit_gradients.csv",
      {"x[m]", "y[m]", "direction_x", "direction_y", "boundary", "gradient[-]", "critical_gradient[-]"},
      CsvWriter::Mode::fresh);
  for (const FlowExit& e : net.exits)
    exits.row({e.place[0], e.place[1], e.direction[0], e.direction[1],
               std::string_view(name_of(scene, e.boundary)), e.gradient, e.critical});
}

std::string at(const coupling::Vector3& place) {
  return " at (" + digits(place[0], 4) + ", " + digits(place[1], 4) + ") m";
}

void tell(const Simulation& s, const FlowNet& net, const Exits& exits, Log& log) {
  const char* unit = s.scene().dimension() == 3                    ? " m3/s"
                     : s.scene().grid.space == Space::axisymmetric ? " m3/s per radian"
                                                                   : " m2/s";
  for (const auto& [name, q] : discharges(s))
    log.line("discharge    " + name + ": " + digits(std::abs(q), 5) + unit +
             (q < 0   ? " into the soil"
              : q > 0 ? " out of the soil"
                      : ""));
  if (s.scene().dimension() == 3) return;
  log.line("flow net     stream function from " + digits(net.lowest, 5) + " to " + digits(net.highest, 5) +
           unit + ", ways around a cell differ by " + digits(net.defect, 2) + " of the range");
  for (const SeepageEnd& e : net.seepage_ends)
    log.line("phreatic     line leaves the soil" + at(e.place) + ", " + name_of(s.scene(), e.boundary) +
             (e.within ? "" : ", to a cell"));
  if (exits.steepest)
    log.line("exit         largest gradient " + digits(exits.steepest->gradient, 4) +
             at(exits.steepest->place) + ", " + name_of(s.scene(), exits.steepest->boundary));
  if (exits.heave)
    log.line("heave        factor " + digits(exits.heave->heave_factor(), 4) + at(exits.heave->place) +
             ": gradient " + digits(exits.heave->gradient, 4) + ", critical " +
             digits(exits.heave->critical, 4));
  else
    log.line("heave        no water rises out of the soil");
}

void write_flow(const std::string& case_file, const Simulation& s, const RunFolder& folder, Log& log) {
  const FlowNet net = s.flow_net();
  const Exits exits = find(net);
  if (s.scene().dimension() == 2) write_tables(folder, s.scene(), net);
  write_file_atomically(folder.path() / "flow.json", flow_json(s, case_file, net, exits).text());
  tell(s, net, exits, log);
}

int seepage(const Arguments& a, std::ostream&, std::ostream&) {
  RunOptions o;
  o.case_file = a.words.front();
  o.settings = a.all("--set");
  o.folder = a.value("--output").value_or(default_folder(o.case_file).string() + "-seepage");
  o.overwrite = a.has("--overwrite");
  o.quiet = a.has("--quiet");
  o.threads = a.integer("--threads", 1, kMostThreads).value_or(0);
  Scene scene = seepage_scene(read_case(o.case_file, o.settings), o.remarks);
  o.at_end = [&](const Simulation& s, const RunFolder& folder, Log& log) {
    write_flow(o.case_file, s, folder, log);
  };
  return static_cast<int>(run_scene(o, std::move(scene)).code);
}

}  // namespace

Scene seepage_scene(const Scene& given, std::vector<std::string>& remarks) {
  const coupling::Formulation* f = coupling::find_formulation(given.formulation);
  if (!f || f->carrier != coupling::WaterCarrier::cells)
    throw InputError("polder seepage: formulation \"" + given.formulation +
                     "\" has no water that flows through cells; allowed: a case with formulation = "
                     "\"one-layer\"");
  Scene scene = given;
  scene.stages.clear();
  scene.numerics.sleep = false;  // nothing moves
  std::vector<std::string> gone;
  bool changed = false;
  for (const Stage& s : given.stages) {
    if (is_water_stage(s))
      scene.stages.push_back(rigid(s));
    else
      gone.push_back(s.name);
    changed = changed || s.mode != Stage::Mode::seepage;
  }
  if (!gone.empty()) remarks.push_back("left out     stages of moving soil: " + list_of(gone));
  if (scene.stages.empty()) {
    hold_conditions(scene);
    scene.stages.push_back(steady_stage(scene));
    if (scene.unsaturated()) {
      scene.water.initial = coupling::WaterSpec::Initial::steady;
      scene.numerics.cell_means = true;
      remarks.push_back("free surface within cells: retention curves are means over their height");
    }
    scene.output.every = scene.output.history_every = 0;
    for (Measure& m : scene.measures) m.every = 0;
    remarks.push_back("steady flow  under the conditions of time 0");
  }
  drop_measures(scene, remarks);
  if (changed && !scene.expectations.empty()) {
    // They are about the run of the case, and may look at times and stages that are gone.
    scene.expectations.clear();
    remarks.push_back("left out     expectations, which are about moving soil");
  }
  scene.output.fields = {"pore_pressure", "saturation"};
  return scene;
}

Command seepage_command() {
  return {"seepage",
          "CASE",
          1,
          1,
          "The water of a case alone, through a rigid skeleton: heads, discharges, phreatic line, flow net, "
          "exit "
          "gradients, factor against heave. Stages of seepage and quasi-static ones are computed; without "
          "any, steady "
          "flow under the conditions of time 0.",
          {{"--output", "-o", "DIR", "Folder of the results, default results/NAME-seepage.", false},
           {"--set", "", "KEY=VALUE",
            "Replace a key of the case, e.g. --set grid.cell=0.05; KEY= removes it.", true},
           {"--threads", "", "N", "Number of threads; the results do not depend on it.", false},
           {"--quiet", "", "", "Say nothing but errors.", false},
           {"--overwrite", "", "", "Replace results that are in the folder.", false}},
          seepage};
}

}  // namespace polder::app
