// The commands of the program.
#pragma once

#include <iosfwd>
#include <vector>

#include "app/command_line.hpp"

namespace polder::app {

const std::vector<Command>& commands();

int explain_command(const Arguments& arguments, std::ostream& out, std::ostream& err);
int verify_command(const Arguments& arguments, std::ostream& out, std::ostream& err);

inline constexpr int kMostThreads = 1024;

}  // namespace polder::app
