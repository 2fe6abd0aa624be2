// What a run says: lines to log.txt and, unless quiet, to the terminal; and its progress.
//
// On a terminal the progress is one line, rewritten about every second; in log.txt, pipes and batch systems
// it is a plain line every ten seconds. Everything goes to stderr: standard output belongs to results. A log
// never stops a run: if its disk fills up it says so once and goes on.
//
// For one thread; parallel loops do not log.
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace polder {

struct Progress {
  std::string_view stage;
  double time = 0.0;          // simulated time in the stage [s]
  double end = 0.0;           // of the stage [s]
  std::int64_t step = 0;      // since the run began
  double dt = 0.0;            // [s]
  std::string_view dt_limit;  // what limits dt
  std::int64_t particles = 0;
};

// "1.25 s", "3 min 20 s", "13 h 05 min", "2 d 04 h"
std::string duration_text(double seconds);
// Three digits and a prefix: "1.23 M", "45.6 k", "789"
std::string count_text(double count);

class Log {
 public:
  struct Options {
    std::filesystem::path file;  // empty: no file
    bool append = false;         // a restart goes on in the same file
    bool quiet = false;          // nothing on the terminal but errors
    bool progress_only = false;  // nothing on the terminal but progress and errors
    std::FILE* terminal = stderr;
    std::optional<bool> is_terminal;  // default: asked from the system
    std::function<double()> clock;    // wall clock [s], default: the steady clock
    double terminal_interval = 1.0;   // between progress lines on a terminal [s]
    double plain_interval = 10.0;     // and elsewhere
  };

  // EnvironmentError if the file cannot be opened.
  explicit Log(Options options);
  ~Log();
  Log(const Log&) = delete;
  Log& operator=(const Log&) = delete;

  // First lines: program and version, how it was built, threads; and when.
  void heading(std::string_view version, std::string_view build, int threads);

  void line(std::string_view text);     // may hold several lines
  void warning(std::string_view text);  // "warning: ..."
  void error(std::string_view text);    // "error: ...", also when quiet
  // The first warning of each key is printed; later ones are counted, and finish() states the total.
  void warn_once(std::string_view key, std::string_view text);
  std::int64_t warnings(std::string_view key) const;

  // Cheap enough for every step: true if progress() would print something now.
  bool progress_due();
  void progress(const Progress& progress);

  // Totals of the repeated warnings. Called by the destructor if it was not called before.
  void finish();

 private:
  struct Repeated {
    std::int64_t count = 0;
    std::string text;
  };
  // Speed and remaining time from what happened since an earlier moment of the same stage.
  struct Mark {
    double wall = 0.0, time = 0.0;
    std::int64_t step = 0;
  };

  void to_file(std::string_view text);
  void to_terminal(std::string_view text);
  void clear_progress();
  std::string progress_text(const Progress& progress, double now);

  Options options_;
  bool terminal_;
  std::FILE* file_ = nullptr;
  bool file_failed_ = false;
  bool progress_shown_ = false;
  bool finished_ = false;
  double next_terminal_ = 0.0, next_plain_ = 0.0;
  std::map<std::string, Repeated, std::less<>> repeated_;
  std::string stage_;
  std::optional<Mark> mark_;
  double particle_steps_per_second_ = 0.0, simulated_per_second_ = 0.0;
};

}  // namespace polder
