// Named soils with retention curve, porosity and saturated conductivity, each with its source. To start from
// where nothing is measured; textural classes are means over many samples with a wide scatter.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "fdm/retention.hpp"

namespace polder::fdm {

struct CatalogueSoil {
  std::string name;
  std::string source;
  Retention retention;
  double porosity;      // saturated volumetric water content where the source has no other [-]
  double conductivity;  // saturated hydraulic conductivity [m/s]
};

const std::vector<CatalogueSoil>& soil_catalogue();
// nullptr if there is none of that name.
const CatalogueSoil* find_soil(std::string_view name);
// All names in the order of the catalogue, separated by ", ": for messages.
std::string soil_names();

}  // namespace polder::fdm
