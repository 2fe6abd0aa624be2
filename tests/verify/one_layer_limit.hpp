// The largest stable step of a body many cells across, measured step by step, beside the one that the program
// predicts from a small patch (coupling/step_limit.hpp). SI units.
#pragma once

#include <vector>

#include "tests/verify/one_layer_scenes.hpp"

namespace polder::verify {

// A weightless elastic block of cells.x by cells.y cells between walls at the left, right and bottom, its
// surface `offset` of a cell above a node. A conductivity of 0 means dry.
struct Block {
  int cells[2] = {32, 16};
  Choice choice;
  bool free_side = false;  // no wall at the right: a corner, both surfaces at the offset
};

// Does the energy of random velocities, small enough to leave every position as it is, grow with this step
// [s]?
bool grows(const Block& block, double dt, int steps = 400);

// Smallest growing step between two that differ by 2 %, of the block at this offset [s].
double first_unstable_step(const Block& block);

// What `polder explain` prints for the block [s].
double predicted_step(const Block& block);

// The automatic step of the block at courant 1: h / c_d, or with an explicit pressure the formula's limit
// [s].
double wave_step(const Block& block);

}  // namespace polder::verify
