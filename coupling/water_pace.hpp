// The pace of stages in which water sets it: how steps begin, grow and end (seepage_stage.cpp). Times [s].
#pragma once

#include <algorithm>

#include "coupling/scene.hpp"

namespace polder::coupling {

struct WaterPace {
  double first = 0, smallest = 0, largest = 0;  // steps
  double growth = 1;                            // of the step after an easy one
  int easy = 0;                                 // iterations of such a step, at most
};

// What the stage says, else shares of its duration. On the way to a steady state the path does not matter,
// only that the iteration gets along.
inline WaterPace water_pace(const Stage& stage) {
  constexpr double kFirstShare = 1e-5, kLargestShare = 1e-2;
  constexpr double kSmallestShare = 1e-5;  // of the first step
  constexpr double kGrowth = 1.5, kSteadyGrowth = 4;
  constexpr int kEasy = 5, kEasySteady = 10;
  const bool steady = stage.until == Stage::Until::steady;
  WaterPace pace;
  pace.largest = stage.largest_step > 0 ? stage.largest_step
                 : steady               ? stage.duration
                                        : kLargestShare * stage.duration;
  pace.first = stage.first_step > 0 ? stage.first_step : kFirstShare * stage.duration;
  pace.smallest = kSmallestShare * std::min(pace.first, kFirstShare * stage.duration);
  pace.growth = steady ? kSteadyGrowth : kGrowth;
  pace.easy = steady ? kEasySteady : kEasy;
  return pace;
}

}  // namespace polder::coupling
