// What `polder bench precision` is made of: benchmarks, each a list of trials – a setting with a cell and a
// step – that give an error and the processor time of the loop over the steps.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace polder::bench {

// Where the benchmarks write, and with how many threads they run.
struct Place {
  std::filesystem::path output;  // results, fine solutions, and a folder for the run of the moment
  int threads = 1;
};

struct Outcome {
  std::vector<double> errors;  // relative, one for each of Benchmark::errors; NaN: the run broke down
  double seconds = 0;          // processor time of all steps, output aside [s]
  double steps = 0, points = 0;

  double error() const;  // root mean square of the errors
};

struct Trial {
  std::string setting;      // "two-layer, bspline"
  bool is_default = false;  // what a case gets that says nothing but its formulation
  double cell = 0;          // [m]
  std::string step;         // "courant 0.5", "60 s"
  bool quick = false;       // among the few of --quick
  std::function<Outcome()> run;
};

struct Benchmark {
  std::string name, title;
  std::string reference;            // what the errors are differences to
  std::vector<std::string> errors;  // of which quantities
  bool only_if_asked = false;       // takes long
  std::function<void()> prepare;    // computes a fine solution unless it lies there; may be empty
  std::vector<Trial> trials;        // those of a setting one after the other, from coarse to fine
};

// Case files of cases/, with changes.
std::vector<Benchmark> case_benchmarks(const Place& place);
// Scenes of the verification tests: waves in saturated columns, infiltration; a manufactured solution.
std::vector<Benchmark> scene_benchmarks(const Place& place);
Benchmark manufactured_benchmark(const Place& place);

// The outcome of `run` in a process of its own. What takes a fraction of a second is run several times, and
// the least time counts; a run that breaks down (NumericalError) has no errors, NaN for each of `errors`.
Outcome in_own_process(const Place& place, std::size_t errors, const std::function<Outcome()>& run);

}  // namespace polder::bench
