// Runs made earlier, to be compared: which of them are one family, and what each is called.
#pragma once

#include <string>
#include <vector>

#include "app/comparison.hpp"

namespace polder::app {

// Reads the runs in these folders; a folder of a comparison stands for the runs in it. Runs of the same scene
// but for cells and steps are one variant; a second one with the same cells and steps, of another version of
// the program perhaps, begins another. Variants are called after their formulation where that tells them
// apart, else after their folders. InputError if there are fewer than two.
std::vector<ComparedRun> read_runs(const std::vector<std::string>& folders);

}  // namespace polder::app
