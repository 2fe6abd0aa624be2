// von Mises with linear softening of the undrained shear strength, sqrt(J2) <= su:
//   su = max(peak + H kappa, min(peak, residual)),    H <= 0, kappa = sum sqrt(2/3 de_p : de_p).
// Radial return (Wilkins 1964): sqrt(J2) falls by sqrt(3) G for a unit of kappa, so the increment is closed
// form with the strength at the end of the step. Where softening is as steep as elastic unloading or steeper
// (H <= -sqrt(3) G) the stress drops to the residual at constant strain.
#pragma once

#include "mpm/material/strength.hpp"

namespace polder::POLDER_SIMD_NAMESPACE {

template <int D>
class VonMisesLaw final : public Law<D> {
 public:
  VonMisesLaw(const mpm::MaterialParameters& m, int peak_index)
      : elasticity_(m), strength_(m, peak_index), softening_(m.softening_modulus) {}

  void update(StressBatch<D>& batch) const override {
    constexpr int kStress = StressBatch<D>::kStress;
    const Elasticity elasticity = elasticity_;
    const UndrainedStrength strength = strength_;
    const double elastic_slope = 1.7320508075688772 * elasticity.shear, slope = elastic_slope + softening_;
    for (int p = 0; p < batch.packs; ++p) {
      Pack(&s)[kStress] = batch.stress[p];
      elasticity.add_increment(batch.strain[p], s);
      const auto particle = strength.particle(batch.state[p]);
      const Pack mean = (s[0] + s[1] + s[2]) * (1. / 3);
      const Pack x = s[0] - mean, y = s[1] - mean, z = s[2] - mean;
      Pack shear = s[3] * s[3];
      for (int i = 4; i < kStress; ++i) shear += s[i] * s[i];
      const Pack root = sqrt(0.5 * (x * x + y * y + z * z) + shear);
      const Pack now = strength.shear_strength(particle, Pack{});
      const Mask yields = root > now;
      if (!any(yields)) continue;
      const Pack to_residual = (root - particle.residual) / elastic_slope;
      Pack plastic = to_residual;
      if (slope > 0) {
        // on the falling branch; a particle already at its residual has a flat one. The first root is the
        // smaller increment, and each branch holds only where its strength is the larger of the two.
        const Pack falling = (root - now) / slope;
        plastic = select(now > particle.residual, min(falling, to_residual), to_residual);
      }
      // the residual is reached where the falling branch would undercut it
      const Pack after = strength.shear_strength(particle, plastic);
      const Pack scale = after / max(root, 1e-60);
      s[0] = select(yields, mean + scale * x, s[0]);
      s[1] = select(yields, mean + scale * y, s[1]);
      s[2] = select(yields, mean + scale * z, s[2]);
      for (int i = 3; i < kStress; ++i) s[i] = select(yields, scale * s[i], s[i]);
      batch.state[p][0] = select(yields, batch.state[p][0] + plastic, batch.state[p][0]);
    }
  }

 private:
  Elasticity elasticity_;
  UndrainedStrength strength_;
  double softening_;
};

}  // namespace polder::POLDER_SIMD_NAMESPACE
