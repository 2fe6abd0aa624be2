// `polder compare`: one case with several formulations, cells and steps, or runs made earlier, side by side.
#pragma once

#include "app/command_line.hpp"

namespace polder::app {

Command compare_command();

}  // namespace polder::app
