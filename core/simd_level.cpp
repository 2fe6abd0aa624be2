#include "core/simd_level.hpp"

#include <cstdlib>

#include "core/error.hpp"

namespace polder {
namespace {

SimdLevel choose() {
#if defined(POLDER_SIMD_NATIVE)
  return SimdLevel::native;
#else
  SimdLevel best = SimdLevel::baseline;
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) best = SimdLevel::avx2;
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw") &&
      __builtin_cpu_supports("avx512cd"))
    best = SimdLevel::avx512;
  const char* wish = std::getenv("POLDER_SIMD_LEVEL");
  if (wish == nullptr) return best;
  for (SimdLevel level : {SimdLevel::baseline, SimdLevel::avx2, SimdLevel::avx512})
    if (to_string(level) == wish) {
      if (level <= best) return level;
      throw EnvironmentError("POLDER_SIMD_LEVEL=" + std::string(wish) + ": this processor reaches only " +
                             to_string(best));
    }
  throw EnvironmentError("POLDER_SIMD_LEVEL=" + std::string(wish) +
                         " is unknown; allowed: baseline, avx2, avx512");
#endif
}

}  // namespace

SimdLevel simd_level() {
  static const SimdLevel level = choose();
  return level;
}

std::string to_string(SimdLevel level) {
  switch (level) {
    case SimdLevel::baseline:
      return "baseline";
    case SimdLevel::avx2:
      return "avx2";
    case SimdLevel::avx512:
      return "avx512";
    case SimdLevel::native:
      return "native";
  }
  return "?";
}

}  // namespace polder
