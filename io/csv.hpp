// Tables as CSV: histories and probes that a run appends to, and references that tests and expectations read.
//
// One header line of column names with their units, `time[s],kinetic_energy[J]`, then rows; numbers with ten
// significant digits. Cells with commas, quotes or line ends are quoted (RFC 4180). Lines that start with '#'
// before the header are comments.
#pragma once

#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

namespace polder {

// One cell of a row: a number or a word such as the name of what limits the step.
using CsvCell = std::variant<double, std::int64_t, std::string_view>;

// Appends rows to a file. Rows go to the operating system when `flush_seconds` of wall clock have passed
// since the last time, at flush() and at the end; so a table can be watched while it grows, at little cost.
class CsvWriter {
 public:
  enum class Mode { fresh, append };

  // fresh: a new file with this header. append: the file goes on; a header other than this one is an
  // EnvironmentError, a missing file is started. Call drop_after() before the first row when a restart
  // repeats part of the run.
  CsvWriter(std::filesystem::path path, std::vector<std::string> columns, Mode mode,
            double flush_seconds = 1.0);
  ~CsvWriter();
  CsvWriter(const CsvWriter&) = delete;
  CsvWriter& operator=(const CsvWriter&) = delete;

  // Removes the rows from the first one on whose first column is above `last` (which is rounded like the
  // numbers in the file), and what a killed run left of an incomplete row.
  void drop_after(double last);

  // As many cells as columns. EnvironmentError if the disk refuses.
  void row(std::span<const CsvCell> cells);
  void row(std::initializer_list<CsvCell> cells) { row(std::span(cells.begin(), cells.size())); }
  void row(std::span<const double> numbers);

  void flush();  // to the operating system
  void sync();   // and to the disk, as before a checkpoint

 private:
  void end_row(std::size_t cells);
  std::filesystem::path path_;
  std::vector<std::string> columns_;
  double flush_seconds_;
  double last_flush_;
  int descriptor_ = -1;
  std::string buffer_;
};

// A table read from a file: columns of numbers by name. Empty cells are NaN.
class CsvTable {
 public:
  // text_columns: columns whose cells are words; any other cell that is not a number is an InputError with
  // file:line, as is a row of the wrong length. A file that cannot be read is an EnvironmentError.
  explicit CsvTable(const std::filesystem::path& path, const std::vector<std::string>& text_columns = {});

  const std::vector<std::string>& columns() const { return columns_; }
  const std::vector<std::string>& comments() const {
    return comments_;
  }  // without '#' and the blank after it
  std::size_t rows() const { return rows_; }
  bool has(std::string_view column) const;
  // InputError that lists the columns if there is no such one (or if it holds words).
  std::span<const double> column(std::string_view name) const;
  std::span<const double> column(std::size_t number) const { return column(columns_.at(number)); }
  const std::vector<std::string>& text(std::string_view name) const;

 private:
  std::string file_;
  std::vector<std::string> columns_, comments_;
  std::size_t rows_ = 0;
  std::map<std::string, std::vector<double>, std::less<>> numbers_;
  std::map<std::string, std::vector<std::string>, std::less<>> words_;
};

}  // namespace polder
