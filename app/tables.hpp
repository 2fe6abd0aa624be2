// The tables of a run: history.csv (balances of the whole), probes.csv (the case's measures) and
// phreatic.csv.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/ticker.hpp"
#include "coupling/simulation.hpp"
#include "io/csv.hpp"
#include "io/run_folder.hpp"

namespace polder::app {

class CheckpointVisitor;

class Tables {
 public:
  Tables(const coupling::Simulation& simulation, const RunFolder& folder, CsvWriter::Mode mode);

  // After every step, and once before the first: writes what is due.
  void see(const coupling::Simulation& simulation);
  // The last state, unless it has been written already.
  void finish(const coupling::Simulation& simulation);

  // A restart repeats what came after its checkpoint: later rows go.
  void drop_after(double time);
  void sync();
  void visit(CheckpointVisitor& visitor);

 private:
  struct ProbeColumn {
    std::string name;      // "toe:ux[m]"
    std::string quantity;  // "displacement_x"
    int measure;           // index of the measure
  };

  void add_probe_columns(const coupling::Simulation& simulation);
  void write_history(const coupling::Simulation& simulation);
  void write_probes(const coupling::Simulation& simulation);
  void write_phreatic(const coupling::Simulation& simulation);

  int stage_ = 0;
  double usual_interval_;  // between lines of the history, in stages that do not say [s]
  Ticker history_tick_, probe_tick_, phreatic_tick_;
  double last_history_ = -1, last_probes_ = -1;
  std::vector<int> probe_numbers_;  // particle followed by each measure, -1: none
  std::vector<ProbeColumn> probe_columns_;
  std::optional<CsvWriter> history_, probes_, phreatic_;
};

// The column of history.csv or probes.csv that holds a measure; `in_history` says which of the two.
std::string measure_column(const coupling::Measure& measure, bool& in_history);

}  // namespace polder::app
