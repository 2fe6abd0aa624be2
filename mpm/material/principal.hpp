// Principal stresses of packs, and the way back for an isotropic change of them. No trigonometry, no
// eigenvectors.
//
// decompose() gives the principal stresses in descending order; recompose() builds the tensor with the same
// axes and new principal values `to`, which must keep the order and must not increase any difference (every
// return to a convex isotropic yield surface does): 0 <= (to_i - to_j)/(from_i - from_j) <= 1.
//
// Plane: Mohr's circle and the out-of-plane stress.
// Space: of the deviator's eigenvalues the isolated one, lambda_a = 2 sqrt(J2/3) cos(theta), solves
//   4 c^3 - 3 c = |J3| / (2 (J2/3)^(3/2)),     c in [sqrt(3)/2, 1],
// by Newton's method from a quadratic start. The other two are -lambda_a/2 +- w with
//   w = sqrt(D) / (2 (3 lambda_a^2 - J2)),     D = 6 J2 |t_perp|^2 (the discriminant),
// where t_perp is the part of dev(s^2) orthogonal to s: the Gram determinant of (I, s, s^2). Unlike sqrt(1 -
// c^2) this keeps full accuracy for nearly equal eigenvalues (triaxial states). The result is the isotropic
// tensor function in Newton's divided-difference form, f(s) = t0 + f01 (s - l0) + f012 (s - l0)(s - l1).
#pragma once

#include "core/simd.hpp"

namespace polder::POLDER_SIMD_NAMESPACE {

template <int D>
struct Principal;

template <>
struct Principal<2> {
  Pack value[3];      // descending
  Pack half, radius;  // (xx - yy)/2, radius of Mohr's circle in the plane
  Mask out_is_first,
      out_is_last;  // place of the out-of-plane stress among the values (else it is the middle one)

  POLDER_INLINE void decompose(const Pack (&s)[4]) {
    const Pack mean = 0.5 * (s[0] + s[1]);
    half = 0.5 * (s[0] - s[1]);
    radius = sqrt(half * half + s[3] * s[3]);
    const Pack upper = mean + radius, lower = mean - radius, out = s[2];
    out_is_first = out >= upper;
    out_is_last = (out <= lower) & ~out_is_first;
    value[0] = max(upper, out);
    value[1] = select(out_is_first, upper, select(out_is_last, lower, out));
    value[2] = min(lower, out);
  }

  POLDER_INLINE void recompose(const Pack (&to)[3], Pack (&s)[4]) const {
    const Pack upper = select(out_is_first, to[1], to[0]);
    const Pack lower = select(out_is_last, to[1], to[2]);
    const Pack mean = 0.5 * (upper + lower);
    const Pack scale = 0.5 * (upper - lower) / max(radius, 1e-60);
    s[0] = mean + scale * half;
    s[1] = mean - scale * half;
    s[2] = select(out_is_first, to[0], select(out_is_last, to[2], to[1]));
    s[3] = scale * s[3];
  }
};

template <>
struct Principal<3> {
  Pack value[3];   // descending
  Pack mean;       // (xx + yy + zz)/3
  Pack root_j2;    // sqrt(J2)
  Pack dev[6];     // deviator s
  Pack square[6];  // s^2
  Pack eigen[3];   // eigenvalues of the deviator, descending

  // The invariants alone, for a test that spares the rest.
  POLDER_INLINE void invariants(const Pack (&s)[6]) {
    mean = (s[0] + s[1] + s[2]) * (1. / 3);
    for (int i = 0; i < 3; ++i) dev[i] = s[i] - mean;
    for (int i = 3; i < 6; ++i) dev[i] = s[i];
    root_j2 = sqrt(0.5 * (dev[0] * dev[0] + dev[1] * dev[1] + dev[2] * dev[2]) +
                   (dev[3] * dev[3] + dev[4] * dev[4] + dev[5] * dev[5]));
  }

  // After invariants().
  POLDER_INLINE void decompose() {
    const Pack x = dev[0], y = dev[1], z = dev[2], a = dev[3], b = dev[4], d = dev[5];
    square[0] = x * x + a * a + d * d, square[1] = a * a + y * y + b * b, square[2] = d * d + b * b + z * z;
    square[3] = x * a + a * y + d * b, square[4] = a * d + y * b + b * z, square[5] = x * d + a * b + d * z;
    // 1e-60 Pa stands for no deviator at all: it keeps the divisions below finite
    const Pack q = max(root_j2 * 0.57735026918962576, 1e-60), j2 = 3 * q * q;
    const Pack j3 = (1. / 3) * (x * square[0] + y * square[1] + z * square[2] +
                                2 * (a * square[3] + b * square[4] + d * square[5]));
    const Pack r = min(abs(j3) / (2 * q * q * q), 1.0);
    Pack c = 0.8660254037844386 + r * (1. / 6 - r * 0.0326920704511053);
    for (int i = 0; i < 3; ++i) c -= (c * (4 * c * c - 3) - r) / (12 * c * c - 3);
    const Mask negative = j3 < 0;
    const Pack isolated = select(negative, -2 * q * c, 2 * q * c);
    const Pack along = 1.5 * j3 / j2, third = (2. / 3) * j2;
    Pack perp = Pack{};
    for (int i = 0; i < 3; ++i) {
      const Pack t = square[i] - third - along * dev[i], o = square[i + 3] - along * dev[i + 3];
      perp += t * t + 2 * (o * o);
    }
    const Pack split = sqrt(6 * j2 * perp) / (2 * (3 * isolated * isolated - j2));
    const Pack centre = -0.5 * isolated;
    eigen[0] = select(negative, centre + split, isolated);
    eigen[1] = select(negative, centre - split, centre + split);
    eigen[2] = select(negative, isolated, centre - split);
    for (int i = 0; i < 3; ++i) value[i] = mean + eigen[i];
  }

  POLDER_INLINE void recompose(const Pack (&to)[3], Pack (&s)[6]) const {
    const Pack tiny = max(root_j2 * 1e-14, 1e-60);
    const Pack f01 = clamp((to[0] - to[1]) / max(eigen[0] - eigen[1], tiny), 0, 1);
    const Pack f12 = clamp((to[1] - to[2]) / max(eigen[1] - eigen[2], tiny), 0, 1);
    const Pack f012 = (f01 - f12) / max(eigen[0] - eigen[2], tiny);
    const Pack a1 = f01 + f012 * eigen[2];  // -(l0 + l1) = l2
    const Pack a0 = to[0] - f01 * eigen[0] + f012 * eigen[0] * eigen[1];
    for (int i = 0; i < 3; ++i) {
      s[i] = a0 + a1 * dev[i] + f012 * square[i];
      s[i + 3] = a1 * dev[i + 3] + f012 * square[i + 3];
    }
  }
};

}  // namespace polder::POLDER_SIMD_NAMESPACE
