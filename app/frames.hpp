// The frames of a run: soil_*.hdf with the material points and fluid_*.hdf with the cells that hold water.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/ticker.hpp"
#include "coupling/simulation.hpp"
#include "io/run_folder.hpp"
#include "io/vtkhdf.hpp"

namespace polder::app {

class CheckpointVisitor;

class Frames {
 public:
  // keep_until: frames of a run that is restarted from this time stay, later ones go.
  Frames(const coupling::Simulation& simulation, const RunFolder& folder, std::optional<double> keep_until);

  void see(const coupling::Simulation& simulation);     // after every step, and once before the first
  void finish(const coupling::Simulation& simulation);  // the last state, unless it has been written already
  void visit(CheckpointVisitor& visitor);

 private:
  void write(const coupling::Simulation& simulation);

  Ticker tick_;
  int stage_;  // when last seen
  double last_ = -1;
  std::vector<std::string> fields_;
  std::optional<FrameSeries> soil_, fluid_, water_;
};

}  // namespace polder::app
