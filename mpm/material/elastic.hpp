// Isotropic linear elasticity in rate form: stress += lambda tr(strain) I + 2 G strain.
#pragma once

#include "mpm/material/law.hpp"
#include "mpm/material/parameters.hpp"

namespace polder::POLDER_SIMD_NAMESPACE {

struct Elasticity {
  double bulk, shear, lame;  // K, G, lambda [Pa]

  explicit Elasticity(const mpm::MaterialParameters& m)
      : bulk(m.bulk_modulus()), shear(m.shear_modulus()), lame(m.lame_lambda()) {}

  // Components 0..2 are the diagonal, the others shear (tensor components).
  template <int N>
  POLDER_INLINE void add_increment(const Pack (&strain)[N], Pack (&stress)[N]) const {
    const Pack volumetric = lame * (strain[0] + strain[1] + strain[2]);
    for (int i = 0; i < 3; ++i) stress[i] += volumetric + 2 * shear * strain[i];
    for (int i = 3; i < N; ++i) stress[i] += 2 * shear * strain[i];
  }
};

template <int D>
class LinearElastic final : public Law<D> {
 public:
  explicit LinearElastic(const mpm::MaterialParameters& m) : elasticity_(m) {}
  void update(StressBatch<D>& batch) const override {
    for (int p = 0; p < batch.packs; ++p) elasticity_.add_increment(batch.strain[p], batch.stress[p]);
  }

 private:
  Elasticity elasticity_;
};

}  // namespace polder::POLDER_SIMD_NAMESPACE
