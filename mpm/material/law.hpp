// A constitutive law as the particle kernels see it: a batch of packs of particles, nothing else.
//
// Signs: stress and strain are positive in tension. stress is the effective stress sigma' [Pa]. Components
//   2D: xx, yy, zz, xy        3D: xx, yy, zz, xy, yz, zx
// zz is out of plane (plane strain) or the hoop direction (axisymmetric). strain holds the increment of this
// step as tensor components (shear = half the engineering shear).
//
// The kernel has already rotated the stress with the material (Hughes & Winget 1980), so a law adds its own
// increment and returns to the yield surface; it never sees spin. Laws that follow the deformation gradient
// instead use `gradient`, the displacement gradient increment dt * L, and overwrite stress.
//
// A particle's result must not depend on which particles share its pack: blend, never branch on a lane of
// another.
#pragma once

#include "core/simd.hpp"

namespace polder::POLDER_SIMD_NAMESPACE {

inline constexpr int kMaxState = 9;    // state variables of one particle at most
inline constexpr int kBatchPacks = 4;  // packs in a batch

template <int D>
struct StressBatch {
  static constexpr int kStress = D == 2 ? 4 : 6;
  int packs = 0;
  Pack stress[kBatchPacks][kStress];
  Pack strain[kBatchPacks][kStress];
  Pack gradient[kBatchPacks]
               [D * D];  // dt dv_i/dx_j at [i * D + j]; the hoop strain of axisymmetry is strain[..][2]
  Pack state[kBatchPacks][kMaxState];
};

template <int D>
class Law {
 public:
  virtual ~Law() = default;
  virtual void update(StressBatch<D>& batch) const = 0;
};

}  // namespace polder::POLDER_SIMD_NAMESPACE
