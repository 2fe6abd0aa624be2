// What bench_material times: a material and the packs it is given.
#pragma once

#include <string>
#include <vector>

#include "core/simd_level.hpp"
#include "mpm/material/parameters.hpp"

namespace polder::bench {

enum class Loading { elastic, plane, edge_and_apex };

struct MaterialCase {
  std::string name, prototype;
  mpm::MaterialParameters material;
  Loading loading;
};

std::vector<MaterialCase> material_cases();

}  // namespace polder::bench

namespace polder {
// ns per particle
POLDER_SIMD_DECLARE(double, time_material, const bench::MaterialCase&, int)
}  // namespace polder
