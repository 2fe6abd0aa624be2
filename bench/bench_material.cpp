// Time of the constitutive laws alone: nanoseconds for one particle's update, data in the first cache.
//
// Beside the numbers stand those of a prototype measured on a faster machine, for Mohr-Coulomb with a
// cohesion that lags one step (no implicit plastic strain): 8 lanes.
#include <cstdio>

#include "bench/material_kernel.hpp"

int main() {
  using namespace polder;
  std::printf("constitutive laws, vector level %s, ns per particle and update\n",
              to_string(simd_level()).c_str());
  std::printf("%-46s %10s %10s   %s\n", "law and packs", "2D", "3D", "prototype 2D / 3D");
  for (const bench::MaterialCase& c : bench::material_cases()) {
    const double plane = POLDER_SIMD_CALL(time_material, c, 2), space = POLDER_SIMD_CALL(time_material, c, 3);
    std::printf("%-46s %10.2f %10.2f   %s\n", c.name.c_str(), plane, space, c.prototype.c_str());
  }
  return 0;
}
