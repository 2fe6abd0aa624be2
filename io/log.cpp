#include "io/log.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstring>
#include <ctime>

#include "io/atomic_file.hpp"

namespace polder {
namespace {

// Weight of the newest interval in speed and remaining time: they follow a change within a few lines and do
// not jump.
constexpr double kSmoothing = 0.3;

double steady_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

template <class... Values>
std::string format(const char* pattern, Values... values) {
  char text[256];
  const int length = std::snprintf(text, sizeof text, pattern, values...);
  return std::string(text,
                     static_cast<std::size_t>(std::clamp(length, 0, static_cast<int>(sizeof text) - 1)));
}

std::size_t terminal_width(std::FILE* terminal) {
  winsize size{};
  if (ioctl(fileno(terminal), TIOCGWINSZ, &size) == 0 && size.ws_col > 0) return size.ws_col;
  return 80;
}

std::string local_time() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  localtime_r(&now, &parts);
  char text[64];
  text[std::strftime(text, sizeof text, "%Y-%m-%d %H:%M:%S %z", &parts)] = '\0';
  return text;
}

}  // namespace

std::string duration_text(double seconds) {
  if (!std::isfinite(seconds)) return "?";
  if (seconds < 0) return "-" + duration_text(-seconds);
  if (seconds < 59.95) return format("%.3g s", seconds);
  const auto whole = static_cast<long long>(std::min(std::llround(seconds), 8640000000ll));
  if (whole < 3600) return format("%lld min %02lld s", whole / 60, whole % 60);
  if (whole < 86400) return format("%lld h %02lld min", whole / 3600, whole % 3600 / 60);
  return format("%lld d %02lld h", whole / 86400, whole % 86400 / 3600);
}

std::string count_text(double count) {
  const char* prefix = "";
  for (const char* next : {" k", " M", " G", " T"}) {
    if (count < 999.5) break;
    count /= 1000;
    prefix = next;
  }
  // 45.6 k and 789 k, never 4.56e+01
  const int decimals = *prefix == '\0' && count == std::floor(count) ? 0
                       : count < 9.995                               ? 2
                       : count < 99.95                               ? 1
                                                                     : 0;
  return format("%.*f%s", decimals, count, prefix);
}

Log::Log(Options options) : options_(std::move(options)) {
  if (!options_.clock) options_.clock = steady_seconds;
  terminal_ = options_.is_terminal.value_or(isatty(fileno(options_.terminal)) == 1);
  if (!options_.file.empty()) {
    file_ = std::fopen(options_.file.c_str(), options_.append ? "ae" : "we");
    if (file_ == nullptr) throw_file_error(options_.file, "cannot be written", errno);
  }
  const double now = options_.clock();
  next_terminal_ = now + options_.terminal_interval;
  next_plain_ = now + options_.plain_interval;
}

Log::~Log() {
  finish();
  if (file_ != nullptr) std::fclose(file_);
}

void Log::heading(std::string_view version, std::string_view build, int threads) {
  std::string text = "Polder " + std::string(version);
  if (!build.empty()) text += " (" + std::string(build) + ")";
  text += format(", %d thread%s, ", threads, threads == 1 ? "" : "s") + local_time();
  line(text);
}

void Log::line(std::string_view text) {
  to_file(text);
  if (!options_.quiet && !options_.progress_only) to_terminal(text);
}

void Log::warning(std::string_view text) {
  line("warning: " + std::string(text));
}

void Log::error(std::string_view text) {
  const std::string all = "error: " + std::string(text);
  to_file(all);
  to_terminal(all);
}

void Log::warn_once(std::string_view key, std::string_view text) {
  auto found = repeated_.find(key);
  if (found == repeated_.end()) {
    found = repeated_.emplace(std::string(key), Repeated{0, std::string(text)}).first;
    warning(text);
  }
  ++found->second.count;
}

std::int64_t Log::warnings(std::string_view key) const {
  const auto found = repeated_.find(key);
  return found == repeated_.end() ? 0 : found->second.count;
}

bool Log::progress_due() {
  const double now = options_.clock();
  return now >= next_plain_ || (terminal_ && !options_.quiet && now >= next_terminal_);
}

void Log::progress(const Progress& progress) {
  const double now = options_.clock();
  if (!mark_ || stage_ != progress.stage) {  // the speed of another stage says nothing about this one
    stage_ = progress.stage;
    mark_ = Mark{now, progress.time, progress.step};
    particle_steps_per_second_ = simulated_per_second_ = 0.0;
  }
  const bool plain = now >= next_plain_;
  const bool rewrite = terminal_ && !options_.quiet && now >= next_terminal_;
  if (!plain && !rewrite) return;

  std::string text = progress_text(progress, now);
  if (plain) {
    next_plain_ = now + options_.plain_interval;
    to_file(text);
    if (!terminal_ && !options_.quiet) to_terminal(text);
  }
  if (rewrite) {
    next_terminal_ = now + options_.terminal_interval;
    // A line as wide as the terminal would wrap and could not be rewritten.
    text.resize(std::min(text.size(), terminal_width(options_.terminal) - 1));
    std::fprintf(options_.terminal, "\r%s\x1b[K", text.c_str());
    std::fflush(options_.terminal);
    progress_shown_ = true;
  }
}

std::string Log::progress_text(const Progress& progress, double now) {
  const double wall = now - mark_->wall;
  if (wall > 0 && progress.step > mark_->step) {
    const double steps = static_cast<double>(progress.step - mark_->step);
    const double speed = steps * static_cast<double>(progress.particles) / wall;
    const double simulated = (progress.time - mark_->time) / wall;
    const bool first = simulated_per_second_ == 0.0;
    particle_steps_per_second_ += (first ? 1.0 : kSmoothing) * (speed - particle_steps_per_second_);
    simulated_per_second_ += (first ? 1.0 : kSmoothing) * (simulated - simulated_per_second_);
    mark_ = Mark{now, progress.time, progress.step};
  }
  const double left = std::max(progress.end - progress.time, 0.0);
  const std::string remaining = simulated_per_second_ > 0 ? duration_text(left / simulated_per_second_) : "?";
  const double percent = progress.end > 0 ? 100.0 * progress.time / progress.end : 0.0;
  // duration_text drops digits that matter for a stage of a few seconds
  const auto simulated_text = [](double seconds) {
    return seconds < 1000 ? format("%.4g s", seconds) : duration_text(seconds);
  };
  return std::string(progress.stage) + "  " + simulated_text(progress.time) + " / " +
         simulated_text(progress.end) +
         format(" (%.0f %%)  step %lld  dt %.3g s", percent, static_cast<long long>(progress.step),
                progress.dt) +
         " (" + std::string(progress.dt_limit) + ")  " + count_text(static_cast<double>(progress.particles)) +
         " particles  " + count_text(particle_steps_per_second_) + " particle-steps/s  " + remaining +
         " left";
}

void Log::finish() {
  if (finished_) return;
  finished_ = true;
  clear_progress();
  for (const auto& [key, warned] : repeated_) {
    if (warned.count > 1) {
      line(format("warning, %lld times in all: ", static_cast<long long>(warned.count)) + warned.text);
    }
  }
}

void Log::to_file(std::string_view text) {
  if (file_ == nullptr || file_failed_) return;
  std::fwrite(text.data(), 1, text.size(), file_);
  std::fputc('\n', file_);
  // At once: the last lines are what is wanted after a crash.
  if (std::fflush(file_) == 0) return;
  file_failed_ = true;
  to_terminal("warning: " + options_.file.string() + ": cannot be written: " + std::strerror(errno));
}

void Log::to_terminal(std::string_view text) {
  clear_progress();
  std::fwrite(text.data(), 1, text.size(), options_.terminal);
  std::fputc('\n', options_.terminal);
  std::fflush(options_.terminal);
}

void Log::clear_progress() {
  if (!progress_shown_) return;
  std::fputs("\r\x1b[K", options_.terminal);
  std::fflush(options_.terminal);
  progress_shown_ = false;
}

}  // namespace polder
