// For tests of commands: a folder of their own, and the program as a function.
#pragma once

#include <unistd.h>

#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "app/program.hpp"

namespace polder::app::test {

// Empty at first, gone at the end.
struct Scratch {
  std::filesystem::path path;
  explicit Scratch(const std::string& name)
      : path(std::filesystem::temp_directory_path() / ("polder_" + name + "_" + std::to_string(::getpid()))) {
    std::filesystem::remove_all(path);
  }
  ~Scratch() { std::filesystem::remove_all(path); }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
};

// Its exit code; what it says to the error stream, if asked for.
inline int polder_program(const std::vector<std::string>& words, std::string* err = nullptr) {
  std::ostringstream out, errors;
  const int code = run_program(words, out, errors);
  if (err != nullptr) *err = errors.str();
  return code;
}

}  // namespace polder::app::test
