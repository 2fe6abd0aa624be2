#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>

#include "core/error.hpp"
#include "io/atomic_file.hpp"
#include "io/csv.hpp"

namespace polder {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kFlushBytes = 1 << 16;  // flush earlier if this much is waiting

double now_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

void append_number(std::string& out, double value) {
  char digits[32];
  const int length = std::snprintf(digits, sizeof digits, "%.10g", value);
  out.append(digits, static_cast<std::size_t>(length));
}

void append_word(std::string& out, std::string_view word) {
  if (word.find_first_of(",\"\r\n") == std::string_view::npos) {
    out += word;
    return;
  }
  out += '"';
  for (const char c : word) {
    if (c == '"') out += '"';
    out += c;
  }
  out += '"';
}

// Position after the line that starts at `from`, npos if it has no end.
std::size_t after_line(const std::string& text, std::size_t from) {
  const std::size_t end = text.find('\n', from);
  return end == std::string::npos ? end : end + 1;
}

}  // namespace

CsvWriter::CsvWriter(fs::path path, std::vector<std::string> columns, Mode mode, double flush_seconds)
    : path_(std::move(path)),
      columns_(std::move(columns)),
      flush_seconds_(flush_seconds),
      last_flush_(now_seconds()) {
  if (columns_.empty()) throw std::invalid_argument("CSV: a table without columns");
  std::string header;
  for (const std::string& column : columns_) {
    if (!header.empty()) header += ',';
    append_word(header, column);
  }
  header += '\n';

  bool needs_header = true;
  if (mode == Mode::append && fs::exists(path_)) {
    const std::string present = read_file(path_);
    needs_header = after_line(present, 0) == std::string::npos;  // killed before the header was complete
    if (!needs_header && !present.starts_with(header)) {
      throw EnvironmentError(path_.string() + ": has other columns than this run writes; it starts with " +
                             present.substr(0, present.find('\n')));
    }
  }
  const int start_over = needs_header ? O_TRUNC : 0;
  descriptor_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC | start_over, 0666);
  if (descriptor_ < 0) throw_file_error(path_, "cannot be written", errno);
  if (!needs_header) return;
  buffer_ = header;
  try {
    flush();
  } catch (...) {
    ::close(descriptor_);
    throw;
  }
}

CsvWriter::~CsvWriter() {
  try {
    flush();
  } catch (const EnvironmentError& error) {
    std::fprintf(stderr, "warning: %s\n", error.what());  // a destructor cannot do more
  }
  ::close(descriptor_);
}

void CsvWriter::drop_after(double last) {
  flush();
  std::string rounded;
  append_number(rounded, last);
  last = std::strtod(rounded.c_str(), nullptr);
  const std::string content = read_file(path_);
  std::size_t keep = after_line(content, 0);
  for (std::size_t next; (next = after_line(content, keep)) != std::string::npos; keep = next) {
    if (std::strtod(content.c_str() + keep, nullptr) > last) break;
  }
  if (keep == content.size()) return;
  if (::ftruncate(descriptor_, static_cast<off_t>(keep)) != 0)
    throw_file_error(path_, "cannot be cut", errno);
}

void CsvWriter::row(std::span<const CsvCell> cells) {
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (i > 0) buffer_ += ',';
    if (const auto* number = std::get_if<double>(&cells[i]))
      append_number(buffer_, *number);
    else if (const auto* count = std::get_if<std::int64_t>(&cells[i]))
      buffer_ += std::to_string(*count);
    else
      append_word(buffer_, std::get<std::string_view>(cells[i]));
  }
  end_row(cells.size());
}

void CsvWriter::row(std::span<const double> numbers) {
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (i > 0) buffer_ += ',';
    append_number(buffer_, numbers[i]);
  }
  end_row(numbers.size());
}

void CsvWriter::end_row(std::size_t cells) {
  if (cells != columns_.size()) {
    throw std::invalid_argument("CSV: " + path_.string() + ": a row of " + std::to_string(cells) +
                                " cells for " + std::to_string(columns_.size()) + " columns");
  }
  buffer_ += '\n';
  if (buffer_.size() >= kFlushBytes || now_seconds() - last_flush_ >= flush_seconds_) flush();
}

void CsvWriter::flush() {
  last_flush_ = now_seconds();
  if (buffer_.empty()) return;
  const int error = write_fully(descriptor_, buffer_.data(), buffer_.size());
  buffer_.clear();
  if (error != 0) throw_file_error(path_, "cannot be written", error);
}

void CsvWriter::sync() {
  flush();
  if (::fsync(descriptor_) != 0 && errno != EINVAL && errno != EROFS) {  // EINVAL: a pipe or the like
    throw_file_error(path_, "cannot be written", errno);
  }
}

}  // namespace polder
