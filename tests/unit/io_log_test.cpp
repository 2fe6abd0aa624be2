// The log: file and terminal, progress on both, repeated warnings.
#include <doctest/doctest.h>

#include <cstdio>
#include <limits>

#include "core/error.hpp"
#include "io/atomic_file.hpp"
#include "io/log.hpp"
#include "tests/unit/io_support.hpp"

using namespace polder;
using polder::test::TemporaryFolder;

namespace {

// A log that writes into files, with a clock that the test moves.
struct Bench {
  explicit Bench(bool is_terminal, bool quiet = false, bool progress_only = false)
      : screen(std::fopen((folder / "screen").c_str(), "w")) {
    Log::Options options;
    options.file = folder / "log.txt";
    options.quiet = quiet;
    options.progress_only = progress_only;
    options.terminal = screen;
    options.is_terminal = is_terminal;
    options.clock = [this] { return now; };
    log.emplace(options);
  }
  ~Bench() {
    log.reset();
    std::fclose(screen);
  }
  std::string shown() const { return read_file(folder / "screen"); }
  std::string logged() const { return read_file(folder / "log.txt"); }

  TemporaryFolder folder;
  std::FILE* screen;
  double now = 100.0;
  std::optional<Log> log;
};

Progress at(double time, std::int64_t step) {
  return {"flood", time, 10.0, step, 1e-3, "skeleton wave", 2000};
}

// Runs for `seconds` of wall clock at 100 steps and 0.1 simulated seconds a second.
void run(Bench& bench, double seconds) {
  for (int i = 0; i <= 100 * seconds; ++i) {
    if (i % 100 == 0 || bench.log->progress_due()) bench.log->progress(at(0.001 * i, i));
    bench.now += 0.01;
  }
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (std::size_t i = text.find(part); i != std::string::npos; i = text.find(part, i + 1)) ++n;
  return n;
}

}  // namespace

TEST_CASE("lines go to the file and the screen, errors even when quiet") {
  Bench bench(false, true);
  bench.log->line("two\nlines");
  bench.log->warning("careful");
  bench.log->error("broken");
  CHECK(bench.logged() == "two\nlines\nwarning: careful\nerror: broken\n");
  CHECK(bench.shown() == "error: broken\n");
}

TEST_CASE("progress off a terminal is a plain line every ten seconds") {
  Bench bench(false);
  run(bench, 25.0);
  CHECK(count(bench.shown(), "\n") == 2);
  CHECK(bench.shown() == bench.logged());
  CHECK(bench.shown().find('\r') == std::string::npos);
  CHECK(bench.shown().starts_with(
      "flood  1 s / 10 s (10 %)  step 1000  dt 0.001 s (skeleton wave)  2.00 k particles  "
      "200 k particle-steps/s  1 min 30 s left\n"));
}

TEST_CASE("progress on a terminal is rewritten every second and gives way to messages") {
  Bench bench(true);
  run(bench, 3.5);
  CHECK(count(bench.shown(), "\rflood") == 3);
  CHECK(count(bench.shown(), "\n") == 0);
  CHECK(bench.logged().empty());
  bench.log->line("stage done");
  CHECK(bench.shown().ends_with("\r\x1b[Kstage done\n"));
  CHECK(bench.logged() == "stage done\n");
}

TEST_CASE("a quiet run still has its progress in the file") {
  Bench bench(true, true);
  run(bench, 12.0);
  CHECK(bench.shown().empty());
  CHECK(count(bench.logged(), "flood") == 1);
}

TEST_CASE("with progress only, the screen has that and errors, the file everything") {
  Bench bench(false, false, true);
  bench.log->line("settings");
  run(bench, 12.0);
  bench.log->error("broken");
  CHECK(count(bench.shown(), "flood") == 1);
  CHECK(bench.shown().find("settings") == std::string::npos);
  CHECK(bench.shown().ends_with("error: broken\n"));
  CHECK(bench.logged().starts_with("settings\nflood"));
}

TEST_CASE("another stage starts with speeds of its own") {
  Bench bench(false);
  run(bench, 11.0);
  Progress next{"failure", 0.0, 1.0, 1100, 1e-4, "skeleton wave", 2000};
  bench.now += 20.0;
  bench.log->progress(next);
  CHECK(bench.shown().find(
            "failure  0 s / 1 s (0 %)  step 1100  dt 0.0001 s (skeleton wave)  2.00 k particles  "
            "0 particle-steps/s  ? left") != std::string::npos);
}

TEST_CASE("a repeated warning is printed once and counted") {
  Bench bench(false);
  for (int i = 0; i < 500; ++i)
    bench.log->warn_once("tension", "particle " + std::to_string(i) + " is in tension");
  bench.log->warn_once("single", "this happened");
  CHECK(bench.log->warnings("tension") == 500);
  CHECK(bench.log->warnings("none") == 0);
  bench.log->finish();
  CHECK(bench.logged() ==
        "warning: particle 0 is in tension\nwarning: this happened\n"
        "warning, 500 times in all: particle 0 is in tension\n");
}

TEST_CASE("the heading and a file that goes on after a restart") {
  const TemporaryFolder folder;
  for (const bool append : {false, true}) {
    Log::Options options;
    options.file = folder / "log.txt";
    options.append = append;
    options.quiet = true;
    Log(options).heading("0.1.0", "Release, native", 2);
  }
  CHECK(count(read_file(folder / "log.txt"), "Polder 0.1.0 (Release, native), 2 threads, 20") == 2);
}

TEST_CASE("a log that cannot be opened is an environment error, one that cannot grow does not stop the run") {
  const TemporaryFolder folder;
  Log::Options options;
  options.file = folder / "no/log.txt";
  CHECK(test::message_of<EnvironmentError>([&] { Log log(options); }) ==
        (folder / "no/log.txt").string() + ": cannot be written: No such file or directory");
  std::FILE* screen = std::fopen((folder / "screen").c_str(), "w");
  options.file = "/dev/full";  // opens, and refuses every byte
  options.terminal = screen;
  {
    Log log(options);
    for (int i = 0; i < 3; ++i) log.line("on we go");
  }
  std::fclose(screen);
  CHECK(read_file(folder / "screen") ==
        "warning: /dev/full: cannot be written: No space left on device\non we go\non we go\non we go\n");
}

TEST_CASE("durations and counts") {
  CHECK(duration_text(0.0) == "0 s");
  CHECK(duration_text(1.25) == "1.25 s");
  CHECK(duration_text(59.99) == "1 min 00 s");
  CHECK(duration_text(200) == "3 min 20 s");
  CHECK(duration_text(13 * 3600 + 5 * 60) == "13 h 05 min");
  CHECK(duration_text(100 * 3600) == "4 d 04 h");
  CHECK(duration_text(std::numeric_limits<double>::infinity()) == "?");
  CHECK(count_text(0) == "0");
  CHECK(count_text(789) == "789");
  CHECK(count_text(999.7) == "1.00 k");
  CHECK(count_text(45600) == "45.6 k");
  CHECK(count_text(1.234e6) == "1.23 M");
}
