// What `polder compare` leaves: compare.json for programs, with stable keys; compare.csv (a row for each
// run), compare_differences.csv and compare_errors.csv for spreadsheets; compare.md for people.
#pragma once

#include <filesystem>
#include <string>

#include "app/comparison.hpp"

namespace polder::app {

std::string compare_text(const Comparison& comparison);  // Markdown, which reads as plain text

// folder: where it will lie; folders of runs are named from there.
std::string compare_json(const Comparison& comparison, const std::filesystem::path& folder);

void write_comparison(const Comparison& comparison, const std::filesystem::path& folder);

}  // namespace polder::app
