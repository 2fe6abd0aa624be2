// `polder stability`: the factor of safety of a case at a moment of its run, and the slip surface.
#pragma once

#include <iosfwd>

#include "app/command_line.hpp"

namespace polder::app {

Command stability_command();

}  // namespace polder::app
