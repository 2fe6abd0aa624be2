// Factors of safety that a case asks for ([[measure]] with kind = "stability"): each is searched for once, at
// the end of its stage or of the run (coupling/strength_reduction.hpp). The search leaves the simulation as
// it was, to the bit; it costs about ten relaxations.
//
// stability_NAME.csv has one row: the time [s], the factor and its bracket [-] (0: no factor stands; inf:
// none fails), the number of trials and of their steps.
#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "coupling/simulation.hpp"
#include "io/run_folder.hpp"

namespace polder::app {

class StabilityMeasures {
 public:
  // restart: what the folder has already is kept.
  StabilityMeasures(const coupling::Simulation& simulation, const RunFolder& folder, bool restart);

  // After every step, and once before the first: searches for what is due. `goes_on` is asked after each
  // trial; false ends the search without a result, which is due again when the run goes on from here. Returns
  // whether nothing is left to do at this moment.
  bool see(coupling::Simulation& simulation, const std::function<bool()>& goes_on);

  // Results of a time that the run will come to again.
  void drop_after(double time);

  static std::filesystem::path file(const RunFolder& folder, const coupling::Measure& measure);

 private:
  struct One {
    coupling::Measure measure;
    std::filesystem::path file;
    int stage;  // at whose end
    bool done = false;
  };

  std::vector<One> all_;
};

}  // namespace polder::app
