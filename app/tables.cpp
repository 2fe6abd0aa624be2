#include "app/tables.hpp"

#include <algorithm>

#include "app/checkpoint_state.hpp"
#include "app/columns.hpp"
#include "app/nearest.hpp"
#include "core/error.hpp"
#include "coupling/quantities.hpp"

namespace polder::app {
namespace {

using coupling::Measure;
using coupling::Scene;
using coupling::Simulation;

constexpr int kHistoryLines = 1000;  // unless the case says how often

struct Standard {
  const char* name;
  const char* unit;
  const char* quantity;
  bool only_3d = false;
  bool only_wet = false;
};

// What every followed particle records, whatever its measure asks for.
constexpr Standard kStandard[] = {
    {"x", "m", "position_x"},
    {"y", "m", "position_y"},
    {"z", "m", "position_z", true},
    {"ux", "m", "displacement_x"},
    {"uy", "m", "displacement_y"},
    {"uz", "m", "displacement_z", true},
    {"vx", "m/s", "velocity_x"},
    {"vy", "m/s", "velocity_y"},
    {"vz", "m/s", "velocity_z", true},
    {"pore_pressure", "Pa", "pore_pressure", false, true},
    {"sxx", "Pa", "stress_xx"},
    {"syy", "Pa", "stress_yy"},
    {"szz", "Pa", "stress_zz"},
    {"sxy", "Pa", "stress_xy"},
    {"syz", "Pa", "stress_yz", true},
    {"szx", "Pa", "stress_zx", true},
    {"p", "Pa", "mean_effective_stress"},
    {"q", "Pa", "deviatoric_stress"},
    {"deviatoric_strain", "-", "deviatoric_strain"},
};

bool is_wet(const Scene& scene) {
  return coupling::find_formulation(scene.formulation)->carrier != coupling::WaterCarrier::none;
}

// Where no stage says otherwise.
double usual_interval(const Simulation& s) {
  const double every = s.scene().output.history_every;
  return every > 0 ? every : s.end_time() / kHistoryLines;
}

double history_interval(const Simulation& s, double usual) {
  const double own = s.finished() ? 0 : s.scene().stages[static_cast<std::size_t>(s.stage())].history_every;
  return own > 0 ? own : usual;
}

// The shortest interval any measure asks for; measures that ask for none follow the history.
double probe_interval(const Simulation& s, double usual) {
  double interval = history_interval(s, usual);
  for (const Measure& m : s.scene().measures)
    if (m.every > 0 && m.kind != Measure::Kind::history && !m.is_profile())
      interval = std::min(interval, m.every);
  return interval;
}

std::vector<std::string> history_columns(const Simulation& s) {
  std::vector<std::string> names;
  for (const coupling::Column& c : s.history()) {
    names.push_back(c.name);
    if (c.name == "dt[s]") names.push_back("dt_limit");
  }
  return names;
}

}  // namespace

std::string measure_column(const Measure& m, bool& in_history) {
  in_history = m.kind == Measure::Kind::history;
  if (in_history) return m.quantity;
  if (m.kind == Measure::Kind::particle)
    for (const Standard& s : kStandard)
      if (m.quantity == s.quantity) return m.name + ":" + s.name;
  return m.name + ":" + m.quantity;
}

Tables::Tables(const Simulation& s, const RunFolder& folder, CsvWriter::Mode mode)
    : usual_interval_(usual_interval(s)),
      history_tick_(history_interval(s, usual_interval_)),
      probe_tick_(probe_interval(s, usual_interval_)),
      phreatic_tick_(history_interval(s, usual_interval_)) {
  const Scene& scene = s.scene();
  const std::vector<std::string> columns = history_columns(s);
  for (const Measure& m : scene.measures)
    probe_numbers_.push_back(m.kind == Measure::Kind::particle ? s.probe_particle(m.at) : -1);
  history_.emplace(folder.history(), columns, mode);
  add_probe_columns(s);
  if (!probe_columns_.empty()) {
    std::vector<std::string> names{"time[s]"};
    for (const ProbeColumn& c : probe_columns_) names.push_back(c.name);
    probes_.emplace(folder.probes(), names, mode);
  }
  if (is_wet(scene) && scene.dimension() == 2)
    phreatic_.emplace(folder.phreatic(), std::vector<std::string>{"time[s]", "x[m]", "y[m]"}, mode);
}

void Tables::add_probe_columns(const Simulation& s) {
  const Scene& scene = s.scene();
  for (std::size_t i = 0; i < scene.measures.size(); ++i) {
    const Measure& m = scene.measures[i];
    const int number = static_cast<int>(i);
    const auto add = [&](const std::string& name, const std::string& unit, const std::string& quantity) {
      probe_columns_.push_back({m.name + ":" + name + "[" + unit + "]", quantity, number});
    };
    if (m.kind == Measure::Kind::cell)
      for (const coupling::Quantity& q : coupling::cell_quantities()) add(q.name, q.unit, q.name);
    if (m.kind == Measure::Kind::body)
      for (const coupling::Quantity& q : coupling::particle_quantities())
        if (q.name == m.quantity) add(q.name, q.unit, q.name);
    if (m.kind != Measure::Kind::particle) continue;
    bool standard = false;
    for (const Standard& c : kStandard) {
      if ((c.only_3d && scene.dimension() == 2) || (c.only_wet && !is_wet(scene))) continue;
      standard = standard || m.quantity == c.quantity;
      add(c.name, c.unit, c.quantity);
    }
    for (const coupling::Quantity& q : coupling::particle_quantities())
      if (!standard && q.name == m.quantity) add(q.name, q.unit, q.name);
  }
}

void Tables::see(const Simulation& s) {
  // A row where an expectation looks, besides those that are due.
  if (history_tick_.due(s.time()) || s.at_mark()) write_history(s);
  if (probe_tick_.due(s.time()) || s.at_mark()) write_probes(s);
  if (phreatic_tick_.due(s.time())) write_phreatic(s);
  if (s.stage() == stage_) return;
  stage_ = s.stage();
  history_tick_.set_interval(history_interval(s, usual_interval_), s.time());
  probe_tick_.set_interval(probe_interval(s, usual_interval_), s.time());
  phreatic_tick_.set_interval(history_interval(s, usual_interval_), s.time());
}

void Tables::finish(const Simulation& s) {
  if (last_history_ < s.time()) {
    write_history(s);
    write_phreatic(s);
  }
  if (last_probes_ < s.time()) write_probes(s);
  sync();
}

void Tables::write_history(const Simulation& s) {
  std::vector<CsvCell> row;
  for (const coupling::Column& c : s.history()) {
    if (c.name == "step" || c.name == "stage")
      row.emplace_back(static_cast<std::int64_t>(c.value));
    else
      row.emplace_back(c.value);
    if (c.name == "dt[s]") row.emplace_back(std::string_view(s.step_reason()));
  }
  history_->row(row);
  last_history_ = s.time();
}

void Tables::write_probes(const Simulation& s) {
  if (!probes_) return;
  std::vector<double> row{s.time()};
  for (const ProbeColumn& c : probe_columns_) {
    const auto i = static_cast<std::size_t>(c.measure);
    const Measure& m = s.scene().measures[i];
    row.push_back(m.kind == Measure::Kind::cell   ? s.cell_quantity(m.at, c.quantity)
                  : m.kind == Measure::Kind::body ? s.body_quantity(m.body, c.quantity)
                                                  : s.particle_quantity(probe_numbers_[i], c.quantity));
  }
  probes_->row(row);
  last_probes_ = s.time();
}

void Tables::write_phreatic(const Simulation& s) {
  if (!phreatic_) return;
  for (const auto& [x, y] : s.phreatic_line()) phreatic_->row({s.time(), x, y});
}

void Tables::drop_after(double time) {
  for (std::optional<CsvWriter>* t : {&history_, &probes_, &phreatic_})
    if (*t) (*t)->drop_after(time);
}

void Tables::sync() {
  for (std::optional<CsvWriter>* t : {&history_, &probes_, &phreatic_})
    if (*t) (*t)->sync();
}

void Tables::visit(CheckpointVisitor& v) {
  v.number("output/history", history_tick_.count());
  v.number("output/probes", probe_tick_.count());
  v.number("output/phreatic", phreatic_tick_.count());
  v.number("output/last_history", last_history_);
  v.number("output/last_probes", last_probes_);
  // Measures follow the particle nearest to a place in the very first state; a stage may have moved the
  // origin of displacements since.
  v.integers("output/probe_numbers", probe_numbers_);
}

}  // namespace polder::app
