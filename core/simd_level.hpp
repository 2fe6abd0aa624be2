// Which vector level the hot kernels run at. Chosen once, when the program starts: the best one that was
// built and that this processor has, or the one named by the environment variable POLDER_SIMD_LEVEL
// (baseline, avx2, avx512).
#pragma once

#include <string>

namespace polder {

enum class SimdLevel { baseline, avx2, avx512, native };

SimdLevel simd_level();
std::string to_string(SimdLevel level);

}  // namespace polder

// Dispatch: POLDER_SIMD_CALL(f, args...) calls f in the namespace of the chosen level. The declarations of f
// for every level come from POLDER_SIMD_DECLARE(return_type, f, parameter types...), written at namespace
// polder.
#if defined(POLDER_SIMD_NATIVE)
#define POLDER_SIMD_DECLARE(R, f, ...) \
  namespace simd_native {              \
  R f(__VA_ARGS__);                    \
  }
#define POLDER_SIMD_CALL(f, ...) ::polder::simd_native::f(__VA_ARGS__)
#else
#define POLDER_SIMD_DECLARE(R, f, ...) \
  namespace simd_baseline {            \
  R f(__VA_ARGS__);                    \
  }                                    \
  namespace simd_avx2 {                \
  R f(__VA_ARGS__);                    \
  }                                    \
  namespace simd_avx512 {              \
  R f(__VA_ARGS__);                    \
  }
#define POLDER_SIMD_CALL(f, ...)                                                                 \
  (::polder::simd_level() == ::polder::SimdLevel::avx512 ? ::polder::simd_avx512::f(__VA_ARGS__) \
   : ::polder::simd_level() == ::polder::SimdLevel::avx2 ? ::polder::simd_avx2::f(__VA_ARGS__)   \
                                                         : ::polder::simd_baseline::f(__VA_ARGS__))
#endif
