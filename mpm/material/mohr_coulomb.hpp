// Mohr-Coulomb (and, with phi = 0, Tresca): elastic increment, exact return in principal stresses, strength
// at the end of the step. Packs in which no particle can yield at its lowest strength are left after a few
// operations.
//
// The plastic strain counts every irreversible deviatoric strain, that of the tension planes included.
#pragma once

#include "mpm/material/plastic_corrector.hpp"
#include "mpm/material/principal.hpp"

namespace polder::POLDER_SIMD_NAMESPACE {

template <int D, class Strength>
class MohrCoulombLaw final : public Law<D> {
 public:
  template <class... Arguments>
  explicit MohrCoulombLaw(const mpm::MaterialParameters& m, Arguments... arguments)
      : elasticity_(m), strength_(m, arguments...) {}

  void update(StressBatch<D>& batch) const override {
    // a copy: the compiler knows that nothing written to the batch changes it
    const Elasticity elasticity = elasticity_;
    for (int p = 0; p < batch.packs; ++p) {
      elasticity.add_increment(batch.strain[p], batch.stress[p]);
      correct(elasticity, strength_, batch.stress[p], batch.state[p]);
    }
  }

 private:
  static constexpr int kStress = StressBatch<D>::kStress;
  using Angle = typename Strength::Angle;

  POLDER_INLINE static void correct(const Elasticity& elasticity, const Strength& strength,
                                    Pack (&stress)[kStress], Pack* state) {
    const auto particle = strength.particle(state);
    Principal<D> principal;
    if (!can_yield(strength.bounds(), strength.lowest_cohesion(particle), stress, principal)) return;
    const Pack(&trial)[3] = principal.value;
    const auto m = strength.at(particle, Pack{});
    const ReturnCoefficients<Angle> k(elasticity, m.sin_friction, m.sin_dilation);
    const Mask yields = (trial[0] * k.up - trial[2] * k.down > m.twice_cohesion()) | m.in_tension(trial[0]);
    if (!any(yields)) return;
    Pack s[3], r[kStress];
    const PlasticCorrector<Strength> corrector(elasticity, strength, k);
    const Pack plastic = corrector.correct(particle, m, trial, yields, s);
    for (int i = 0; i < kStress; ++i) r[i] = stress[i];
    principal.recompose(s, r);
    for (int i = 0; i < kStress; ++i) stress[i] = select(yields, r[i], stress[i]);
    state[0] = select(yields, state[0] + plastic, state[0]);
  }

  // Conservative: false only where no strength the material can ever have lets a lane yield. Leaves the
  // principal values.
  template <class Cohesion>
  POLDER_INLINE static bool can_yield(const StrengthBounds& b, Cohesion cohesion,
                                      const Pack (&stress)[kStress], Principal<D>& principal) {
    if constexpr (D == 2) {
      principal.decompose(stress);
      const Pack difference = principal.value[0] - principal.value[2],
                 sum = principal.value[0] + principal.value[2];
      return any((difference + max(sum * b.sin_lowest, sum * b.sin_highest) > 2 * b.cos_lowest * cohesion) |
                 (principal.value[0] > b.tension));
    } else {
      // the inscribed Drucker-Prager cone, and a sphere for the largest principal stress
      principal.invariants(stress);
      const double inscribed = std::sqrt(3 * (3 + b.sin_highest * b.sin_highest));
      const Pack first_invariant = 3 * principal.mean;
      const Pack drive = principal.root_j2 * inscribed +
                         max(first_invariant * b.sin_lowest, first_invariant * b.sin_highest);
      if (!any((drive > 3 * b.cos_lowest * cohesion) |
               (principal.mean + 1.1547005383792517 * principal.root_j2 > b.tension)))
        return false;
      principal.decompose();
      return true;
    }
  }

  Elasticity elasticity_;
  Strength strength_;
};

}  // namespace polder::POLDER_SIMD_NAMESPACE
