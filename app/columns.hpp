// Names of table columns, "displacement[m]", and the same without the unit.
#pragma once

#include <string>
#include <vector>

namespace polder::app {

// The column of this name, given with or without its unit; empty if there is none.
inline std::string find_column(const std::vector<std::string>& columns, const std::string& name) {
  for (const std::string& c : columns)
    if (c == name) return c;
  for (const std::string& c : columns)
    if (c.substr(0, c.find('[')) == name) return c;
  return {};
}

}  // namespace polder::app
