// A case file as a whole: text to scene, scene to text, and its reference. Everything comes from the
// declarations in case_keys.hpp.
#pragma once

#include <string>
#include <vector>

#include "core/error.hpp"
#include "coupling/scene.hpp"

namespace polder::app {

// Reads and checks a case. settings: "key=value" of the command line, applied over the file. Throws
// InputError with all that is wrong, in the order of the file.
coupling::Scene read_case(const std::string& path, const std::vector<std::string>& settings = {});

// The same for a text; `file` names it in messages and says where files mentioned in it are looked for.
coupling::Scene read_case_text(const std::string& text, const std::string& file,
                               const std::vector<std::string>& settings = {});

// The resolved case as TOML: every default, SI numbers and degrees. Reading it gives the same scene.
// References of expectations stay relative to the original case file.
std::string write_case(const coupling::Scene& scene);

std::string case_reference();    // all keys, as Markdown
std::string case_json_schema();  // JSON Schema, draft 2020-12

}  // namespace polder::app
