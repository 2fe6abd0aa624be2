#include "app/profiles.hpp"

#include "app/checkpoint_state.hpp"
#include "coupling/quantities.hpp"

namespace polder::app {
namespace {

std::string unit_of(const coupling::Measure& m) {
  for (const coupling::Quantity& q : m.kind == coupling::Measure::Kind::cells
                                         ? coupling::cell_quantities()
                                         : coupling::particle_quantities())
    if (q.name == m.quantity) return q.unit;
  return "-";
}

}  // namespace

std::filesystem::path Profiles::file(const RunFolder& folder, const coupling::Measure& m) {
  return folder.path() / ("profile_" + m.name + ".csv");
}

Profiles::Profiles(const coupling::Simulation& s, const RunFolder& folder, CsvWriter::Mode mode) {
  for (const coupling::Measure& m : s.scene().measures)
    if (m.is_profile())
      all_.push_back(
          {m, Ticker(m.every), -1,
           std::make_unique<CsvWriter>(
               file(folder, m),
               std::vector<std::string>{"time[s]", m.along + "[m]", m.quantity + "[" + unit_of(m) + "]"},
               mode)});
}

void Profiles::write(One& one, const coupling::Simulation& s) {
  const coupling::Profile profile = s.profile(one.measure);
  for (std::size_t i = 0; i < profile.value.size(); ++i)
    one.table->row({s.time(), profile.coordinate[i], profile.value[i]});
  one.last = s.time();
}

void Profiles::see(const coupling::Simulation& s) {
  for (One& one : all_)
    if (one.tick.due(s.time()) || s.at_mark()) write(one, s);
}

void Profiles::finish(const coupling::Simulation& s) {
  for (One& one : all_)
    if (one.last < s.time()) write(one, s);
  sync();
}

void Profiles::drop_after(double time) {
  for (One& one : all_) one.table->drop_after(time);
}

void Profiles::sync() {
  for (One& one : all_) one.table->sync();
}

void Profiles::visit(CheckpointVisitor& v) {
  for (One& one : all_) {
    v.number("output/profile_" + one.measure.name, one.tick.count());
    v.number("output/last_profile_" + one.measure.name, one.last);
  }
}

}  // namespace polder::app
