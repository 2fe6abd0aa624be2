// The program: finds the command, runs it, and turns every failure into one message and an exit code.
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

namespace polder::app {

// words: the command line without the program's name. Returns the exit code (core/error.hpp).
int run_program(const std::vector<std::string>& words, std::ostream& out, std::ostream& err);

}  // namespace polder::app
