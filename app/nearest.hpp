// The valid name a mistyped one most likely stands for.
#pragma once

#include <string>
#include <vector>

namespace polder::app {

// Number of insertions, deletions, replacements and swaps of neighbouring letters between two words,
// regardless of case and of "-" against "_" (Damerau 1964, restricted to one edit of a place).
int edit_distance(const std::string& a, const std::string& b);

// The nearest of `names`; empty if none is near enough to be meant.
std::string nearest_name(const std::string& word, const std::vector<std::string>& names);

// `, did you mean "porosity"?`, or nothing.
std::string did_you_mean(const std::string& word, const std::vector<std::string>& names);

std::string join(const std::vector<std::string>& words, const std::string& separator = ", ");

}  // namespace polder::app
