// The profiles of a run: profile_NAME.csv for every measure of many points or cells, one row for each of them
// and each time looked at: time, coordinate, value.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "app/ticker.hpp"
#include "coupling/simulation.hpp"
#include "io/csv.hpp"
#include "io/run_folder.hpp"

namespace polder::app {

class CheckpointVisitor;

class Profiles {
 public:
  Profiles(const coupling::Simulation& simulation, const RunFolder& folder, CsvWriter::Mode mode);

  // After every step, and once before the first: writes what is due, at marks all.
  void see(const coupling::Simulation& simulation);
  // The last state, unless it has been written already.
  void finish(const coupling::Simulation& simulation);

  void drop_after(double time);
  void sync();
  void visit(CheckpointVisitor& visitor);

  static std::filesystem::path file(const RunFolder& folder, const coupling::Measure& measure);

 private:
  struct One {
    coupling::Measure measure;
    Ticker tick;
    double last = -1;  // [s], of the last rows
    std::unique_ptr<CsvWriter> table;
  };

  static void write(One& one, const coupling::Simulation& simulation);

  std::vector<One> all_;
};

}  // namespace polder::app
