// The plastic step with strength taken at its end: find the increment x of plastic deviatoric strain for
// which the return to the surface of strength(kappa + x) produces just that plastic strain,
//   h(x) = k(x) - x = 0,      k(x) = sqrt(2/3 e_p : e_p) of the exact return at strength(kappa + x).
//
// k is continuous, k(0) >= 0, and k(x) < `bound` because no return increases a difference of principal
// stresses. So a root exists for every strength law, however brittle. Where softening is slower than elastic
// unloading (k' < 1) it is the only one. Where it is steeper (k' > 1, snap-back: no equilibrium path under
// strain control), the stress drops at constant strain until the strength law lets it rest again: the first
// root that plastic strain growing from zero meets. To find that one with piecewise linear strength, knots
// are visited in ascending order first; between knots (and for an exponential, whose k is concave) there is
// one root with k(0) > 0.
//
// Bracketed secant iteration, from where the root would be if the return were to a plane: there k grows in
// proportion to the yield function of the trial stress, hence linearly as the cohesion falls, and the root
// for small increments is found without another return. A lane freezes when it has converged, so its bits do
// not depend on its neighbours. The final stress lies on the surface of strength(kappa + x) to rounding
// whatever the accuracy of x.
#pragma once

#include "mpm/material/strength.hpp"

namespace polder::POLDER_SIMD_NAMESPACE {

template <class Strength>
class PlasticCorrector {
 public:
  using Angle = typename Strength::Angle;
  using State = StrengthState<Angle, typename Strength::Cohesion>;
  using Particle = typename Strength::Particle;

  // coefficients: at the beginning of the step; those of constant angles serve all evaluations
  POLDER_INLINE PlasticCorrector(const Elasticity& elasticity, const Strength& strength,
                                 const ReturnCoefficients<Angle>& coefficients)
      : elasticity_(elasticity), strength_(strength), coefficients_(coefficients) {}

  // trial: ordered principal stresses. start: strength at the beginning of the step. Lanes not in `yields`
  // may come out as anything. Returns the increment of plastic deviatoric strain.
  POLDER_INLINE Pack correct(const Particle& particle, const State& start, const Pack (&trial)[3],
                             Mask yields, Pack (&s)[3]) const {
    return_to_surface(elasticity_, start, coefficients_, trial, s);
    const Pack first = plastic_increment(elasticity_, trial, s);
    if (!strength_.varies()) return first;
    Pack x = first;
    iterate(particle, trial, yields, x, s);
    return x;
  }

 private:
  // k(x) - x, and the stress that belongs to it.
  [[gnu::noinline]] Pack residual(const Particle& particle, const Pack (&trial)[3], Pack x,
                                  Pack (&s)[3]) const {
    const State m = strength_.at(particle, x);
    if constexpr (std::is_same_v<Angle, double>)
      return_to_surface(elasticity_, m, coefficients_, trial, s);
    else
      return_to_surface(elasticity_, m, {elasticity_, m.sin_friction, m.sin_dilation}, trial, s);
    return plastic_increment(elasticity_, trial, s) - x;
  }

  // On entry x = k(0).
  [[gnu::noinline]] void iterate(const Particle& particle, const Pack (&trial)[3], Mask active, Pack& x,
                                 Pack (&s)[3]) const {
    const double shear = elasticity_.shear;
    const Pack size = abs(trial[0]) + abs(trial[1]) + abs(trial[2]);
    const Pack noise = size * (4 * std::numeric_limits<double>::epsilon() / shear);  // rounding of k
    Pack low = Pack{}, at_low = x;                                                   // h(low) > 0
    Pack high = (trial[0] - trial[2]) * (1 / shear) + noise;                         // h(high) <= 0
    active &= x > noise;

    for (int j = 0; j < strength_.knots(); ++j) {
      const Pack at = strength_.knot(j, particle);
      const Mask visit = active & (at > low) & (at < high);
      if (!any(visit)) continue;
      const Pack h = residual(particle, trial, at, s);
      const Mask beyond = visit & (h <= 0), before = visit & (h > 0);
      high = select(beyond, at, high);
      low = select(before, at, low);
      at_low = select(before, h, at_low);
    }

    Pack last = low, at_last = at_low;
    const Guess guess = root_on_plane(particle, trial, low, at_low);
    x = select(active, min(guess.root, high), x);
    Pack width = high - low, last_slope = guess.slope;
    bool moved = true;  // the stress belongs to an earlier x
    for (int i = 1; i <= kMaxIterations && any(active); ++i) {
      const Pack h = residual(particle, trial, x, s);
      const Mask above = active & (h > 0), below = active & ~above;
      low = select(above, x, low);
      high = select(below, x, high);
      const Pack slope = (h - at_last) / select(x == last, broadcast(1.0), x - last);
      Pack next = x - h / select(slope == 0, broadcast(-1.0), slope);
      const Mask secant = (next > low) & (next < high) & (slope < 0);
      const Mask done = (abs(h) <= noise) | (high - low <= 4e-16 * high);
      // The error of a secant step is the step times the relative change of slope: where that is negligible,
      // take the step and stop, which saves the evaluation that would confirm it.
      const Mask last_step =
          secant & ~done & (abs((next - x) * (slope - last_slope)) <= 1e-10 * x * abs(slope));
      Mask bisect = ~secant;
      if (i % 3 == 0) {  // the bracket must have halved since the last time
        bisect |= high - low > 0.5 * width;
        width = high - low;
      }
      next = select(bisect & ~last_step, 0.5 * (low + high), next);
      last = select(active, x, last);
      at_last = select(active, h, at_last);
      last_slope = select(active, slope, last_slope);
      x = select(active & ~done, next, x);
      moved = any(active & ~done);
      active &= ~(done | last_step);
    }
    if (moved) residual(particle, trial, x, s);
  }

  struct Guess {
    Pack root, slope;  // slope of h at the start
  };

  // Two Newton steps from `low`, where h is `at_low`, with the h of a return to the Mohr-Coulomb plane.
  POLDER_INLINE Guess root_on_plane(const Particle& particle, const Pack (&trial)[3], Pack low,
                                    Pack at_low) const {
    const State m = strength_.at(particle, low);
    const Pack cohesion = m.cohesion - Pack{};
    const Pack excess = trial[0] * coefficients_.up - trial[2] * coefficients_.down - m.twice_cohesion();
    const Mask yields = excess > 0;
    // growth of k with a loss of cohesion
    const Pack growth =
        select(yields, (at_low + low) * 2 * m.cos_friction / select(yields, excess, broadcast(1.0)), Pack{});
    const auto slope_at = [&](Pack x) __attribute__((always_inline)) {
      const Pack slope = -growth * strength_.cohesion_slope(particle, x) - 1.0;
      return select(slope < -0.1, slope, broadcast(-1.0));  // near snap-back: no model
    };
    const Pack slope = slope_at(low), x = low - at_low / slope;
    const Pack lost = cohesion - strength_.at(particle, x).cohesion;
    const Pack h = (at_low + low) + growth * lost - x;
    const Pack root = x - h / slope_at(x);
    return {select(root > low, root, x), slope};
  }

  static constexpr int kMaxIterations =
      120;  // bisection alone would need 3 * 53 at worst; secant steps need 2 to 4

  const Elasticity& elasticity_;
  const Strength& strength_;
  ReturnCoefficients<Angle> coefficients_;
};

}  // namespace polder::POLDER_SIMD_NAMESPACE
