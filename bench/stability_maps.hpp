// The maps of `polder bench stability`: two properties of a small block of saturated soil varied against each
// other, for several schemes.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "bench/stability_probe.hpp"

namespace polder::bench {

struct Axis {
  std::string name;
  bool logarithmic = false;
  std::vector<double> values;
  std::vector<std::string> words;                      // of the values; empty: the numbers
  std::function<void(Specimen&, double value)> apply;  // empty: the step over the chosen one
};

struct Panel {
  std::string name;
  Specimen specimen;
};

struct Map {
  std::string name, title;
  Axis x, y;
  std::vector<Panel> panels;
  bool varies_step() const { return !y.apply; }
};

std::vector<Map> stability_maps();

}  // namespace polder::bench
