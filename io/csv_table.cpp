#include <algorithm>
#include <charconv>
#include <limits>

#include "core/error.hpp"
#include "io/atomic_file.hpp"
#include "io/csv.hpp"

namespace polder {
namespace {

[[noreturn]] void refuse(const std::string& file, int line, const std::string& key,
                         const std::string& problem, const std::string& allowed = {}) {
  throw InputError({Diagnostic{file, line, 0, key, problem, allowed}});
}

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

// Takes one record off the front of `text`: cells up to the end of the line, quotes respected. Counts the
// lines it spans in `line`.
std::vector<std::string> take_record(std::string_view& text, const std::string& file, int& line) {
  std::vector<std::string> cells(1);
  const int first_line = line;
  bool quoted = false, was_quoted = false;
  std::size_t at = 0;
  const auto finish_cell = [&] {
    if (!was_quoted) cells.back() = std::string(trimmed(cells.back()));
    was_quoted = false;
  };
  for (; at < text.size(); ++at) {
    const char c = text[at];
    if (quoted) {
      if (c == '\n') ++line;
      if (c != '"')
        cells.back() += c;
      else if (at + 1 < text.size() && text[at + 1] == '"')
        cells.back() += text[++at];
      else
        quoted = false;
    } else if (c == '"' && trimmed(cells.back()).empty()) {
      cells.back().clear();
      quoted = was_quoted = true;
    } else if (c == ',') {
      finish_cell();
      cells.emplace_back();
    } else if (c == '\n') {
      break;
    } else if (was_quoted && (c == ' ' || c == '\t')) {
      continue;  // between a closing quote and the comma
    } else if (c != '\r' || (at + 1 < text.size() && text[at + 1] != '\n')) {
      cells.back() += c;
    }
  }
  if (quoted) refuse(file, first_line, "", "a quote is not closed");
  finish_cell();
  text.remove_prefix(std::min(at + 1, text.size()));
  ++line;
  return cells;
}

// A number in the C notation, also inf and nan; the whole cell must be one.
bool parse_number(std::string_view cell, double& value) {
  if (cell.empty()) {
    value = std::numeric_limits<double>::quiet_NaN();
    return true;
  }
  if (cell.front() == '+') cell.remove_prefix(1);
  const auto [end, status] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (status == std::errc::result_out_of_range) {  // 1e-400: as near as a double gets
    value = cell.find("e-") == std::string_view::npos && cell.find("E-") == std::string_view::npos
                ? std::numeric_limits<double>::infinity()
                : 0.0;
    if (cell.front() == '-') value = -value;
    return end == cell.data() + cell.size();
  }
  return status == std::errc{} && end == cell.data() + cell.size();
}

}  // namespace

CsvTable::CsvTable(const std::filesystem::path& path, const std::vector<std::string>& text_columns)
    : file_(path.string()) {
  const std::string content = read_file(path);
  std::string_view text = content;
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);  // byte-order mark of spreadsheets
  int line = 1;

  while (text.starts_with('#')) {
    const std::size_t end = text.find('\n');
    comments_.emplace_back(trimmed(text.substr(1, end == std::string_view::npos ? end : end - 1)));
    if (comments_.back().ends_with('\r')) comments_.back().pop_back();
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    ++line;
  }
  const int header_line = line;
  columns_ = take_record(text, file_, line);
  if (columns_.size() == 1 && columns_[0].empty())
    refuse(file_, header_line, "", "no header line with column names");
  std::vector<std::vector<double>*> numbers(columns_.size(), nullptr);
  std::vector<std::vector<std::string>*> words(columns_.size(), nullptr);
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    if (columns_[i].empty())
      refuse(file_, header_line, "", "column " + std::to_string(i + 1) + " has no name");
    if (numbers_.contains(columns_[i]) || words_.contains(columns_[i])) {
      refuse(file_, header_line, columns_[i], "two columns have this name");
    }
    const bool is_text =
        std::find(text_columns.begin(), text_columns.end(), columns_[i]) != text_columns.end();
    if (is_text)
      words[i] = &words_[columns_[i]];
    else
      numbers[i] = &numbers_[columns_[i]];
  }

  while (!text.empty()) {
    const int row_line = line;
    if (text.starts_with('#')) {
      text.remove_prefix(std::min(text.find('\n'), text.size() - 1) + 1);
      ++line;
      continue;
    }
    const std::vector<std::string> cells = take_record(text, file_, line);
    if (cells.size() == 1 && cells[0].empty()) continue;  // an empty line
    if (cells.size() != columns_.size()) {
      refuse(file_, row_line, "",
             std::to_string(cells.size()) + " cells, the header has " + std::to_string(columns_.size()));
    }
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (words[i] != nullptr) {
        words[i]->push_back(cells[i]);
        continue;
      }
      double value = 0.0;
      if (!parse_number(cells[i], value))
        refuse(file_, row_line, columns_[i], "'" + cells[i] + "' is not a number");
      numbers[i]->push_back(value);
    }
    ++rows_;
  }
}

bool CsvTable::has(std::string_view column) const {
  return numbers_.find(column) != numbers_.end() || words_.find(column) != words_.end();
}

std::span<const double> CsvTable::column(std::string_view name) const {
  const auto found = numbers_.find(name);
  if (found != numbers_.end()) return found->second;
  std::string all;
  for (const auto& [column, values] : numbers_) all += (all.empty() ? "" : ", ") + column;
  refuse(file_, 0, std::string(name), "there is no such column of numbers", all);
}

const std::vector<std::string>& CsvTable::text(std::string_view name) const {
  const auto found = words_.find(name);
  if (found == words_.end()) refuse(file_, 0, std::string(name), "was not read as a column of words");
  return found->second;
}

}  // namespace polder
