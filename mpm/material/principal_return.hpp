// Exact return to the Mohr-Coulomb surface with Rankine's tension planes, in principal stresses, at given
// strength.
//
// Tension positive, s1 >= s2 >= s3:
//   yield      f  = (s1 - s3) + (s1 + s3) sin phi - 2 c cos phi        and   s_i - T <= 0
//   flow       dg = (s1 - s3) + (s1 + s3) sin psi, associated on the tension planes
//   T = min(tension cut-off, c cot phi), so that the apex is the corner of the three tension planes and needs
//   no rule of its own: flow there is possible for every dilation angle, also for phi = 0 (where T is the
//   cut-off, or infinite).
// The stress leaves the trial along the flow direction with Hooke's law: plane, two edges and eight regions
// of tension are all linear in closed form (Koiter 1953; after de Souza Neto, Peric & Owen 2008, chapter 8,
// here reduced to single multipliers). On an edge, two planes share the flow; the sum of their multipliers is
// that of one plane between the distinct principal stress and the mean of the two equal ones.
//
// Real = double where all strengths are constants of the material, Pack where they differ between particles.
#pragma once

#include "mpm/material/elastic.hpp"

namespace polder::POLDER_SIMD_NAMESPACE {

template <class Real>
struct StrengthState {
  Real sin_friction, cos_friction, cohesion, sin_dilation;
  Real tension;  // min(cut-off, c cot phi)
};

template <class Real>
struct ReturnCoefficients {
  Real twice_cohesion;       // 2 c cos phi
  Real first, middle, last;  // stress change for a unit of flow on the plane: -first, +middle, +last
  Real plane, right, left;   // inverse stiffness of the multipliers
  Real lowest;               // s3 where the plane s1 = T meets the Mohr-Coulomb plane

  POLDER_INLINE ReturnCoefficients(const Elasticity& e, const StrengthState<Real>& m) {
    const double bulk = e.bulk, shear = e.shear;
    const Real sp = m.sin_friction, sq = m.sin_dilation;
    twice_cohesion = 2 * m.cohesion * m.cos_friction;
    first = 2 * shear * (1 + sq * (1. / 3)) + 2 * bulk * sq;
    middle = (4 * shear / 3 - 2 * bulk) * sq;
    last = 2 * shear * (1 - sq * (1. / 3)) - 2 * bulk * sq;
    plane = 1 / (first * (1 + sp) + last * (1 - sp));
    right = 1 / (first * (1 + sp) + 0.5 * (middle + last) * (1 - sp));
    left = 1 / (0.5 * (first - middle) * (1 + sp) + last * (1 - sp));
    lowest = (m.tension * (1 + sp) - twice_cohesion) / (1 - sp);
  }
};

// sqrt(2/3 de_p : de_p) of the plastic strain increment that took the stress from `trial` to `s`.
POLDER_INLINE Pack plastic_increment(const Elasticity& e, const Pack (&trial)[3], const Pack (&s)[3]) {
  const Pack a = trial[0] - s[0], b = trial[1] - s[1], c = trial[2] - s[2];
  const Pack d = a - b, f = b - c, g = c - a;
  return sqrt((d * d + f * f + g * g) * (2. / 9)) * (1 / (2 * e.shear));
}

// Regions in which at least one tension plane acts. Only lanes of `act` are changed.
template <class Real>
[[gnu::noinline]] void return_in_tension(const Elasticity& e, const StrengthState<Real>& m,
                                         const ReturnCoefficients<Real>& k, const Pack (&t)[3], Mask act,
                                         Pack (&s)[3]) {
  const double axial = e.bulk + 4 * e.shear / 3, lateral = e.lame;
  const Pack tension = m.tension - Pack{}, lowest = min(k.lowest - Pack{}, tension);
  // one plane: s1 = T
  const Pack one = (t[0] - tension) / axial;
  const Pack one2 = t[1] - lateral * one, one3 = t[2] - lateral * one;
  const Mask is_one = (one2 <= tension) & (one3 >= lowest);
  // two planes: s1 = s2 = T
  const Pack two = (t[0] + t[1] - 2 * tension) / (axial + lateral), two3 = t[2] - lateral * two;
  const Mask is_two = (t[1] - lateral * one >= tension) & (two3 <= tension) & (two3 >= lowest);
  // three planes: the multiplier of the third is not negative
  const Pack three = (t[0] + t[1] + t[2] - 3 * tension) / (3 * e.bulk);
  const Mask is_three = t[2] - tension >= lateral * three;
  // s1 = T and the Mohr-Coulomb plane: s3 is known, s2 moves between its neighbours (at the ends: corners)
  const Real stiffness = k.first * lateral + axial * k.last;
  const Pack over = t[0] - tension, under = lowest - t[2];
  const Pack shear_flow = (over * lateral + axial * under) / stiffness;
  const Pack tension_flow = (k.last * over - k.first * under) / stiffness;
  const Pack mixed2 = min(max(t[1] + k.middle * shear_flow - lateral * tension_flow, lowest), tension);

  const Pack r1 = select(is_one, one2, select(is_two | is_three, tension, mixed2));
  const Pack r2 = select(is_one, one3, select(is_two, two3, select(is_three, tension, lowest)));
  s[0] = select(act, tension, s[0]);
  s[1] = select(act, r1, s[1]);
  s[2] = select(act, r2, s[2]);
}

// Ordered trial stresses t to s. Lanes inside the surface come back as they are.
template <class Real>
POLDER_INLINE void return_to_surface(const Elasticity& e, const StrengthState<Real>& m,
                                     const ReturnCoefficients<Real>& k, const Pack (&t)[3], Pack (&s)[3]) {
  const Real up = 1 + m.sin_friction, down = 1 - m.sin_friction;
  const Pack f = t[0] * up - t[2] * down - k.twice_cohesion;
  const Mask yields = f > 0;
  Pack flow = f * k.plane;
  s[0] = t[0] - k.first * flow, s[1] = t[1] + k.middle * flow, s[2] = t[2] + k.last * flow;
  const Mask on_plane = (s[0] >= s[1]) & (s[1] >= s[2]);
  if (any(yields & ~on_plane)) {
    // which neighbour does the middle stress meet first: the last one (right edge, s2 = s3) or the first
    // (left, s1 = s2)?
    const Mask right = (1 - m.sin_dilation) * (t[0] - t[1]) > (1 + m.sin_dilation) * (t[1] - t[2]);
    const Pack pair = 0.5 * (t[1] + select(right, t[2], t[0]));
    const Pack high = select(right, t[0], pair), low = select(right, pair, t[2]);
    flow = (high * up - low * down - k.twice_cohesion) * select(right, k.right - Pack{}, k.left - Pack{});
    const Pack e0 = high - select(right, k.first - Pack{}, 0.5 * (k.first - k.middle) - Pack{}) * flow;
    const Pack e2 = low + select(right, 0.5 * (k.middle + k.last) - Pack{}, k.last - Pack{}) * flow;
    s[0] = select(on_plane, s[0], e0);
    s[1] = select(on_plane, s[1], select(right, e2, e0));
    s[2] = select(on_plane, s[2], e2);
  }
  for (int i = 0; i < 3; ++i) s[i] = select(yields, s[i], t[i]);
  const Mask in_tension = s[0] > m.tension;
  if (any(in_tension)) return_in_tension(e, m, k, t, in_tension, s);
}

}  // namespace polder::POLDER_SIMD_NAMESPACE
