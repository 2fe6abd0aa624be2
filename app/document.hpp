// Reading TOML into a tree of values that remembers the line and column of every key and value.
#pragma once

#include <string>
#include <vector>

#include "app/node.hpp"
#include "core/error.hpp"

namespace polder::app {

// Text as TOML; `file` names it in messages. A text that is not TOML adds one diagnostic and gives an empty
// table.
Node parse_toml(const std::string& text, const std::string& file, std::vector<Diagnostic>& diagnostics);

// The text of a file; throws InputError if it is missing, a folder, unreadable or absurdly large.
std::string read_text_file(const std::string& path);

// Applies one "key=value" of the command line. The key is a dotted path; elements of lists are named by their
// number counted from 1 or by their name ("stage.2.duration", "stage.flood.duration"). The value is TOML; a
// value that is not, such as 20 MPa without its quotes, is taken as text. Tables that are missing are made.
void apply_setting(Node& document, const std::string& setting, std::vector<Diagnostic>& diagnostics);

}  // namespace polder::app
