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
// Angle and Cohesion are double where they are constants of the material, Pack where they differ between
// particles.
#pragma once

#include "mpm/material/elastic.hpp"

namespace polder::POLDER_SIMD_NAMESPACE {

template <class Angle, class Cohesion>
struct StrengthState {
  Angle sin_friction, cos_friction, sin_dilation;
  Cohesion cohesion;
  double cutoff;  // of tension; the apex c cot phi may lie below it

  POLDER_INLINE auto twice_cohesion() const { return 2 * cohesion * cos_friction; }
  POLDER_INLINE Mask in_tension(Pack first) const {
    return (first > cutoff) | (first * sin_friction > cohesion * cos_friction);
  }
};

template <class Angle>
struct ReturnCoefficients {
  Angle first, middle, last;  // stress change for a unit of flow on the plane: -first, +middle, +last
  Angle up, down;             // 1 + sin phi, 1 - sin phi
  Angle plane;                // inverse stiffness of the plane's multiplier

  POLDER_INLINE ReturnCoefficients(const Elasticity& e, Angle sin_friction, Angle sin_dilation) {
    const double bulk = e.bulk, shear = e.shear;
    first = 2 * shear * (1 + sin_dilation * (1. / 3)) + 2 * bulk * sin_dilation;
    middle = (4 * shear / 3 - 2 * bulk) * sin_dilation;
    last = 2 * shear * (1 - sin_dilation * (1. / 3)) - 2 * bulk * sin_dilation;
    up = 1 + sin_friction;
    down = 1 - sin_friction;
    plane = 1 / (first * up + last * down);
  }
};

// sqrt(2/3 de_p : de_p) of the plastic strain increment that took the stress from `trial` to `s`.
POLDER_INLINE Pack plastic_increment(const Elasticity& e, const Pack (&trial)[3], const Pack (&s)[3]) {
  const Pack a = trial[0] - s[0], b = trial[1] - s[1], c = trial[2] - s[2];
  const Pack d = a - b, f = b - c, g = c - a;
  return sqrt((d * d + f * f + g * g) * (2. / 9)) * (1 / (2 * e.shear));
}

// Regions in which at least one tension plane acts. Only lanes of `act` are changed.
template <class Angle, class Cohesion>
[[gnu::noinline]] void return_in_tension(const Elasticity& e, const StrengthState<Angle, Cohesion>& m,
                                         const ReturnCoefficients<Angle>& k, const Pack (&t)[3], Mask act,
                                         Pack (&s)[3]) {
  const double axial = e.bulk + 4 * e.shear / 3, lateral = e.lame;
  const Pack sine = m.sin_friction - Pack{}, cohesion = m.cohesion * m.cos_friction - Pack{};
  const Pack apex = cohesion / select(sine > 0, sine, broadcast(1.0));
  const Pack tension = select(sine > 0, min(apex, m.cutoff), broadcast(m.cutoff));
  // s3 where the plane s1 = T meets the Mohr-Coulomb plane
  const Pack lowest = min((tension * k.up - 2 * cohesion) / k.down, tension);
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
  const Angle stiffness = k.first * lateral + axial * k.last;
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
template <class Angle, class Cohesion>
POLDER_INLINE void return_to_surface(const Elasticity& e, const StrengthState<Angle, Cohesion>& m,
                                     const ReturnCoefficients<Angle>& k, const Pack (&t)[3], Pack (&s)[3]) {
  const Pack f = t[0] * k.up - t[2] * k.down - m.twice_cohesion();
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
    const Pack fall = select(right, k.first - Pack{}, 0.5 * (k.first - k.middle) - Pack{});
    const Pack rise = select(right, 0.5 * (k.middle + k.last) - Pack{}, k.last - Pack{});
    flow = (high * k.up - low * k.down - m.twice_cohesion()) / (fall * k.up + rise * k.down);
    const Pack e0 = high - fall * flow, e2 = low + rise * flow;
    s[0] = select(on_plane, s[0], e0);
    s[1] = select(on_plane, s[1], select(right, e2, e0));
    s[2] = select(on_plane, s[2], e2);
  }
  for (int i = 0; i < 3; ++i) s[i] = select(yields, s[i], t[i]);
  const Mask in_tension = m.in_tension(s[0]);
  if (any(in_tension)) return_in_tension(e, m, k, t, in_tension, s);
}

}  // namespace polder::POLDER_SIMD_NAMESPACE
