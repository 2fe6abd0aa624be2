// The commands of the program.
#pragma once

#include <vector>

#include "app/command_line.hpp"

namespace polder::app {

const std::vector<Command>& commands();

// Options that several commands share.
Option set_option();
Option threads_option();

}  // namespace polder::app
