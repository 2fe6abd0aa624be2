// Numbers for people: rounded to a few digits.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <string>

#include "core/units.hpp"

namespace polder::app {

// `n` significant digits, without zeros at the end: 7200, 0.05, 1.2e-05.
inline std::string digits(double value, int n) {
  char text[40];
  std::snprintf(text, sizeof text, "%.*e", n - 1, value);
  return format_number(std::strtod(text, nullptr));
}

}  // namespace polder::app
