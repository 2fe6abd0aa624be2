// A run that is cut and gone on with from its state, in another simulation, must end in the same bits.
#pragma once

#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "coupling/memory_state.hpp"
#include "coupling/simulation.hpp"

namespace polder::verify {

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

}  // namespace polder::verify
