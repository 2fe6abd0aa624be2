// Tables of text for terminals and Markdown files.
#pragma once

#include <string>
#include <vector>

namespace polder::app {

using TextRows = std::vector<std::vector<std::string>>;

// Columns as wide as their widest cell, two blanks between them; rows may be of different lengths.
std::string aligned_table(const TextRows& rows);

// The same as a Markdown table whose first row is its head: aligned, so that it reads well as plain text too.
std::string markdown_table(const TextRows& rows);

}  // namespace polder::app
