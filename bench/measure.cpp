#include "bench/measure.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>
#include <stdexcept>
#include <thread>

#include "app/version.hpp"
#include "core/simd_level.hpp"

namespace polder::bench {

double wall_clock() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double processor_clock() {
  timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

double resident_memory() {
  std::ifstream in("/proc/self/statm");
  double size = 0, resident = 0;
  in >> size >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE));
}

void BestWindow::look(double seconds, const std::function<void()>& work) {
  const double end = wall_clock() + seconds;
  for (int i = 0; i < 3 || wall_clock() < end; ++i) {
    const double w = wall_clock(), p = processor_clock();
    work();
    wall_ = std::min(wall_, wall_clock() - w);
    processor_ = std::min(processor_, processor_clock() - p);
  }
}

std::vector<double> in_child(const std::function<std::vector<double>()>& work) {
  int ends[2];
  if (pipe(ends) != 0) throw std::runtime_error("no pipe to a child process");
  std::cout.flush();
  std::fflush(stdout);
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("no child process");
  if (child == 0) {
    close(ends[0]);
    int status = 1;
    try {
      const std::vector<double> numbers = work();
      const auto bytes = static_cast<ssize_t>(numbers.size() * sizeof(double));
      status = write(ends[1], numbers.data(), static_cast<std::size_t>(bytes)) == bytes ? 0 : 1;
    } catch (const std::exception& e) {
      std::fprintf(stderr, "%s\n", e.what());
    }
    _exit(status);
  }
  close(ends[1]);
  std::vector<double> numbers;
  double x;
  while (read(ends[0], &x, sizeof x) == static_cast<ssize_t>(sizeof x)) numbers.push_back(x);
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) throw std::runtime_error("the child process failed");
  return numbers;
}

std::vector<std::string> machine_lines() {
  std::string processor = "unknown processor", line;
  std::ifstream in("/proc/cpuinfo");
  while (std::getline(in, line))
    if (line.starts_with("model name")) {
      processor = line.substr(line.find(':') + 2);
      break;
    }
  const std::string commit = app::kCommit;
  return {"processor: " + processor + ", " + std::to_string(std::thread::hardware_concurrency()) + " cores",
          "vector level: " + to_string(simd_level()) + ", build " + app::kBuildType,
          std::string("version: ") + app::kVersion + (commit.empty() ? "" : ", commit " + commit)};
}

namespace {

// Quoted where it has to be (RFC 4180).
std::string csv_cell(const std::string& text) {
  if (text.find_first_of(",\"") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + '"';
}

}  // namespace

ResultTable::ResultTable(std::string name, std::string title, std::vector<std::string> columns)
    : name_(std::move(name)), title_(std::move(title)), columns_(std::move(columns)) {}

void ResultTable::add(std::vector<std::string> row) {
  rows_.push_back(std::move(row));
}

std::string ResultTable::markdown() const {
  std::ostringstream out;
  out << "# " << title_ << "\n\n";
  for (const std::string& line : machine_lines()) out << "* " << line << "\n";
  out << "\n";
  const auto put = [&](const std::vector<std::string>& cells) {
    for (const std::string& cell : cells) out << "| " << cell << " ";
    out << "|\n";
  };
  put(columns_);
  for (std::size_t i = 0; i < columns_.size(); ++i) out << "|---";
  out << "|\n";
  for (const auto& row : rows_) put(row);
  return out.str();
}

void ResultTable::write(const std::string& folder) const {
  std::cout << markdown();
  write_files(folder);
}

void ResultTable::write_files(const std::string& folder) const {
  std::filesystem::create_directories(folder);
  std::ofstream(folder + "/" + name_ + ".md") << markdown();
  std::ofstream csv(folder + "/" + name_ + ".csv");
  for (const std::string& line : machine_lines()) csv << "# " << line << "\n";
  const auto put = [&](const std::vector<std::string>& cells) {
    for (std::size_t i = 0; i < cells.size(); ++i) csv << (i > 0 ? "," : "") << csv_cell(cells[i]);
    csv << "\n";
  };
  put(columns_);
  for (const auto& row : rows_) put(row);
  if (!csv) throw std::runtime_error("cannot write to " + folder);
}

std::string digits(double value, int places) {
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", places, value);
  return text;
}

Options::Options(int count, char** words, std::vector<std::string> names, const char* usage,
                 std::vector<std::string> flags)
    : usage_(usage) {
  for (int i = 1; i < count; ++i) {
    const std::string name = words[i];
    if (name == "--help" || name == "-h") {
      std::cout << usage;
      std::exit(0);
    }
    if (std::find(flags.begin(), flags.end(), name) != flags.end()) {
      given_.emplace_back(name, "");
      continue;
    }
    if (std::find(names.begin(), names.end(), name) == names.end() || i + 1 == count) {
      std::cerr << "error: " << name << "\n" << usage;
      std::exit(2);
    }
    given_.emplace_back(name, words[++i]);
  }
}

double Options::number(const std::string& name, double otherwise) const {
  const std::string word = text(name, "");
  if (word.empty()) return otherwise;
  char* end = nullptr;
  const double value = std::strtod(word.c_str(), &end);
  if (*end != '\0' || !(value > 0)) {
    std::cerr << "error: " << name << " " << word << " is no positive number\n" << usage_;
    std::exit(2);
  }
  return value;
}

std::string Options::text(const std::string& name, const std::string& otherwise) const {
  for (const auto& [n, value] : given_)
    if (n == name) return value;
  return otherwise;
}

std::vector<std::string> Options::all(const std::string& name) const {
  std::vector<std::string> values;
  for (const auto& [n, value] : given_)
    if (n == name) values.push_back(value);
  return values;
}

bool Options::flag(const std::string& name) const {
  return !all(name).empty();
}

}  // namespace polder::bench
