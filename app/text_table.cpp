#include "app/text_table.hpp"

#include <algorithm>

namespace polder::app {
namespace {

// What a cell takes on the screen: characters of UTF-8, not bytes.
std::size_t width_of(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

std::vector<std::size_t> column_widths(const TextRows& rows) {
  std::vector<std::size_t> widths;
  for (const auto& row : rows)
    for (std::size_t i = 0; i < row.size(); ++i) {
      if (i == widths.size()) widths.push_back(0);
      widths[i] = std::max(widths[i], width_of(row[i]));
    }
  return widths;
}

std::string padded(const std::string& text, std::size_t width) {
  return text + std::string(width - std::min(width, width_of(text)), ' ');
}

}  // namespace

std::string aligned_table(const TextRows& rows) {
  const std::vector<std::size_t> widths = column_widths(rows);
  std::string text;
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) line += padded(row[i], widths[i]) + "  ";
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + '\n';
  }
  return text;
}

std::string markdown_table(const TextRows& rows) {
  TextRows escaped = rows;
  for (auto& row : escaped)
    for (std::string& cell : row)
      for (std::size_t at = 0; (at = cell.find('|', at)) != std::string::npos; at += 2) cell.insert(at, "\\");
  std::vector<std::size_t> widths = column_widths(escaped);
  for (std::size_t& w : widths) w = std::max<std::size_t>(w, 3);  // the least that a rule may have
  std::string text;
  for (std::size_t r = 0; r < escaped.size(); ++r) {
    for (std::size_t i = 0; i < widths.size(); ++i)
      text += "| " + padded(i < escaped[r].size() ? escaped[r][i] : "", widths[i]) + " ";
    text += "|\n";
    if (r > 0) continue;
    for (const std::size_t w : widths) text += "|" + std::string(w + 2, '-');
    text += "|\n";
  }
  return text;
}

}  // namespace polder::app
