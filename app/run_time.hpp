// How long a case would take, from short trials of its stages: each kind of stage is begun anew from the
// case's initial state, so that a stage with flowing water is not judged by the relaxation before it.
//
// What a trial cannot know: how many steps water takes (its steps follow its iterations), how many searches
// for equilibrium a quasi-static stage makes, how much faster points move later than a step allows for.
#pragma once

#include <string>
#include <vector>

#include "coupling/scene.hpp"

namespace polder::app {

struct StageTime {
  // Most steps of an equilibrium, about as many as of other motion, fewest of water; 0: not known.
  double steps = 0;
  double seconds_per_step = 0;  // wall clock; NaN: the trial broke down
  double seconds() const { return steps * seconds_per_step; }
};

// For each stage; step: the time step of its motion [s].
std::vector<StageTime> estimate_run_time(const coupling::Scene& scene, const std::vector<double>& step);

}  // namespace polder::app
