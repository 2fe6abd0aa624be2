// Compressible neo-Hookean solid, first Piola-Kirchhoff stress P = lambda ln J F^-T + mu (F - F^-T), as
// Cauchy stress
//   sigma = P F^T / J = (lambda ln J I + mu (F F^T - I)) / J.
// The deformation gradient is a state variable and follows the step, F <- (I + dt L) F; out of the plane
// (plane strain: none; axisymmetry: hoop) F_zz <- (1 + strain_zz / 2) / (1 - strain_zz / 2) F_zz. The stress
// follows from F alone: what the kernel carried or rotated before does not matter. A particle turned inside
// out (J <= 0) gets NaN.
#pragma once

#include "mpm/material/law.hpp"
#include "mpm/material/pack_math.hpp"
#include "mpm/material/parameters.hpp"

namespace polder::POLDER_SIMD_NAMESPACE {

template <int D>
class NeoHookean final : public Law<D> {
 public:
  explicit NeoHookean(const mpm::MaterialParameters& m) : lame_(m.lame_lambda()), shear_(m.shear_modulus()) {}

  void update(StressBatch<D>& batch) const override {
    for (int p = 0; p < batch.packs; ++p) {
      Pack(&f)[kMaxState] = batch.state[p];
      advance(batch.gradient[p], f);
      Pack(&s)[StressBatch<D>::kStress] = batch.stress[p];
      if constexpr (D == 2) {
        // strain refers to the midpoint of the step
        f[4] *= (1 + 0.5 * batch.strain[p][2]) / (1 - 0.5 * batch.strain[p][2]);
        const Pack j = (f[0] * f[3] - f[1] * f[2]) * f[4], volumetric = lame_ * log(j) - shear_, inv = 1 / j;
        s[0] = (volumetric + shear_ * (f[0] * f[0] + f[1] * f[1])) * inv;
        s[1] = (volumetric + shear_ * (f[2] * f[2] + f[3] * f[3])) * inv;
        s[2] = (volumetric + shear_ * f[4] * f[4]) * inv;
        s[3] = shear_ * (f[0] * f[2] + f[1] * f[3]) * inv;
      } else {
        const Pack j = f[0] * (f[4] * f[8] - f[5] * f[7]) - f[1] * (f[3] * f[8] - f[5] * f[6]) +
                       f[2] * (f[3] * f[7] - f[4] * f[6]);
        const Pack volumetric = lame_ * log(j) - shear_, inv = 1 / j;
        const auto dot = [&](int a, int b) {
          return f[3 * a] * f[3 * b] + f[3 * a + 1] * f[3 * b + 1] + f[3 * a + 2] * f[3 * b + 2];
        };
        for (int i = 0; i < 3; ++i) s[i] = (volumetric + shear_ * dot(i, i)) * inv;
        s[3] = shear_ * dot(0, 1) * inv;
        s[4] = shear_ * dot(1, 2) * inv;
        s[5] = shear_ * dot(2, 0) * inv;
      }
    }
  }

 private:
  // f[0 .. D*D) <- (I + g) f
  POLDER_INLINE static void advance(const Pack (&g)[D * D], Pack (&f)[kMaxState]) {
    Pack r[D * D];
    for (int i = 0; i < D; ++i)
      for (int j = 0; j < D; ++j) {
        r[i * D + j] = f[i * D + j];
        for (int k = 0; k < D; ++k) r[i * D + j] += g[i * D + k] * f[k * D + j];
      }
    for (int i = 0; i < D * D; ++i) f[i] = r[i];
  }

  double lame_, shear_;
};

}  // namespace polder::POLDER_SIMD_NAMESPACE
