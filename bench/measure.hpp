// What the speed benchmarks measure with: clocks, resident memory, the machine's name, processes of their
// own, and the files with the table.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace polder::bench {

double wall_clock();       // [s]
double processor_clock();  // of this process, all its threads [s]
double resident_memory();  // of this process at present [bytes]

// Least time of a piece of work over many short windows: what other programs on the machine take falls out
// as long as some windows are quiet.
class BestWindow {
 public:
  // Repeats `work` until `seconds` have gone by (of wall clock), at least three times.
  void look(double seconds, const std::function<void()>& work);
  double wall() const { return wall_; }            // [s]
  double processor() const { return processor_; }  // of all threads [s]

 private:
  double wall_ = 1e300, processor_ = 1e300;
};

// Runs `work` in a child process and returns its numbers: memory that another piece of work has touched, and
// its threads, are not there. Throws std::runtime_error when the child fails.
std::vector<double> in_child(const std::function<std::vector<double>()>& work);

// Processor, number of cores, vector level, version and commit, one line of text each.
std::vector<std::string> machine_lines();

// A table as Markdown (with the machine above) on the screen and in FOLDER/NAME.md, and as FOLDER/NAME.csv.
class ResultTable {
 public:
  ResultTable(std::string name, std::string title, std::vector<std::string> columns);
  void add(std::vector<std::string> row);
  void write(const std::string& folder) const;
  void write_files(const std::string& folder) const;  // and nothing on the screen

 private:
  std::string markdown() const;
  std::string name_, title_;
  std::vector<std::string> columns_;
  std::vector<std::vector<std::string>> rows_;
};

std::string digits(double value, int places);

// Words of a command line, "--name value ..." with the names given, and flags without a value; --help and
// errors end the program with `usage`.
class Options {
 public:
  Options(int count, char** words, std::vector<std::string> names, const char* usage,
          std::vector<std::string> flags = {});
  double number(const std::string& name, double otherwise) const;
  std::string text(const std::string& name, const std::string& otherwise) const;
  std::vector<std::string> all(const std::string& name) const;  // in the order given
  bool flag(const std::string& name) const;

 private:
  std::vector<std::pair<std::string, std::string>> given_;
  const char* usage_;
};

}  // namespace polder::bench
