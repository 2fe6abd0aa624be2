// A run that is cut and gone on with from its state, in another simulation, must end in the same bits.
#pragma once

#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "core/threads.hpp"
#include "coupling/memory_state.hpp"
#include "coupling/simulation.hpp"

namespace polder::verify {

struct WholeRun {
  coupling::MemoryState state;
  long steps = 0;
  int sorts = 0;                  // the points were put in order again
  std::string first_stage_ended;  // by what
};

// The whole run in one go.
inline WholeRun run_whole(const coupling::Scene& scene) {
  coupling::Simulation s(scene);
  WholeRun e;
  double travelled = 1e9;
  while (!s.finished()) {
    s.step();
    e.state.save(s);
    e.sorts += e.state.numbers.at("travelled") < travelled;
    travelled = e.state.numbers.at("travelled");
  }
  e.steps = s.steps();
  e.first_stage_ended = s.stages()[0].ended_by;
  return e;
}

// Tells the first difference.
inline void check_same_bits(const coupling::MemoryState& state, const coupling::MemoryState& expected) {
  const std::vector<std::string> different = state.differences(expected);
  if (!different.empty()) MESSAGE("first difference: " << different.front());
  CHECK(different.empty());
}

// Cut after `at` steps; `end` is the state in which the whole run ends, after `steps`.
inline void check_cut_run(const coupling::Scene& scene, long at, const coupling::MemoryState& end,
                          long steps) {
  CAPTURE(at);
  coupling::MemoryState state, again;
  {
    coupling::Simulation first(scene);
    while (first.steps() < at) first.step();
    state.save(first);
  }
  coupling::Simulation second(scene);
  state.load(second);
  again.save(second);
  check_same_bits(again, state);
  while (!second.finished()) second.step();
  again.save(second);
  check_same_bits(again, end);
  CHECK(second.steps() == steps);
}

// Cut in the middle, and with one thread and four; array: one whose sum is not zero where the scene does what
// it is meant to.
inline void check_cut_and_threads(const coupling::Scene& scene, const std::string& array) {
  set_threads(1);
  const WholeRun whole = run_whole(scene);
  double sum = 0;
  for (const double x : whole.state.arrays.at(array)) sum += x;
  CHECK(sum > 0);
  check_cut_run(scene, whole.steps / 2, whole.state, whole.steps);
  set_threads(4);
  check_same_bits(run_whole(scene).state, whole.state);
  set_threads(1);
}

}  // namespace polder::verify
