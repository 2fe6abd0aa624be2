// The three kinds of failure a user can meet, each with its exit code (docs: exit codes).
//   InputError        the case file or the command line is wrong      2   nothing has been started
//   NumericalError    the computation broke down                      3   the last good checkpoint is kept
//   EnvironmentError  disk, permissions, a missing program            4
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace polder {

enum class ExitCode {
  done = 0,
  expectation_missed = 1,
  bad_input = 2,
  numerical_failure = 3,
  environment = 4,
  interrupted = 130
};

// One thing that is wrong in an input file. line and column count from 1; 0 = unknown.
struct Diagnostic {
  std::string file;
  int line = 0;
  int column = 0;
  std::string key;      // dotted path, e.g. "material.sand.porosity"
  std::string problem;  // what was found
  std::string allowed;  // what is allowed, may be empty

  std::string text() const;  // file:line:column: key: problem; allowed: ...
};

class InputError : public std::runtime_error {
 public:
  explicit InputError(std::vector<Diagnostic> diagnostics);
  explicit InputError(const std::string& message);
  const std::vector<Diagnostic>& diagnostics() const { return diagnostics_; }

 private:
  std::vector<Diagnostic> diagnostics_;
};

// Where and why a run broke down. The message names particle or cell, place, time and the likely cause.
class NumericalError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class EnvironmentError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace polder
