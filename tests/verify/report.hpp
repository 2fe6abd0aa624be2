// Front of the programs that print the tables of the validation book.
#pragma once

#include <cstdio>
#include <functional>
#include <map>
#include <string>

#include "core/threads.hpp"

namespace polder::verify {

// Prints the tables that are named on the command line, on one thread. Returns the exit code: 2 if none is
// named or one is unknown.
inline int print_tables(const char* program, const std::map<std::string, std::function<void()>>& tables,
                        int count, char** names) {
  set_threads(1);
  int status = count > 1 ? 0 : 2;
  for (int i = 1; i < count; ++i) {
    const auto table = tables.find(names[i]);
    if (table != tables.end())
      table->second();
    else
      status = 2;
  }
  if (status != 0) {
    std::fprintf(stderr, "usage: %s TABLE ...   tables:", program);
    for (const auto& [name, f] : tables) std::fprintf(stderr, " %s", name.c_str());
    std::fprintf(stderr, "\n");
  }
  return status;
}

}  // namespace polder::verify
