// The frames of a run: soil_*.hdf with the material points and fluid_*.hdf with the cells that hold water.
// Their values are copied from the simulation at once; files are made of them in the background.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/ticker.hpp"
#include "coupling/simulation.hpp"
#include "io/background_writer.hpp"
#include "io/run_folder.hpp"
#include "io/vtkhdf.hpp"

namespace polder::app {

class CheckpointVisitor;

class Frames {
 public:
  // keep_until: frames of a run that is restarted from this time stay, later ones go.
  // writer: must be at rest or gone before this is gone.
  Frames(const coupling::Simulation& simulation, const RunFolder& folder, std::optional<double> keep_until,
         BackgroundWriter& writer);

  void see(const coupling::Simulation& simulation);     // after every step, and once before the first
  void finish(const coupling::Simulation& simulation);  // the last state, unless it has been written already
  void visit(CheckpointVisitor& visitor);

 private:
  void write(const coupling::Simulation& simulation);

  BackgroundWriter& writer_;
  Ticker tick_;
  int stage_;  // when last seen
  double last_ = -1;
  std::vector<std::string> fields_;
  std::optional<FrameSeries> soil_, fluid_, water_;  // for jobs of the writer only
};

}  // namespace polder::app
