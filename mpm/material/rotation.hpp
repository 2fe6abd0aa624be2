// Objective stress update: the incremental rotation of Hughes and Winget (1980), for packs of particles.
//
// With the displacement gradient of the step taken at the midpoint configuration, G = d(du)/dx_{n+1/2}, and
// its skew part W = (G - G^T)/2, the rotation of the step is the Cayley transform
//   Q = (I - W/2)^{-1} (I + W/2),      stress <- Q stress Q^T.
// Q is a proper rotation for every W. What is exact:
//   * A rigid rotation by any angle below 180 degrees in one step, given the midpoint gradient, W = 2
//   tan(angle/2) [axis]:
//     stress turns by exactly that angle. The gradient with respect to the start of the step is turned into
//     the midpoint's by midpoint_gradient(): G_mid = G (I + G/2)^{-1}.
//   * A gradient dt * L with a constant spin L = [omega] turns the stress by 2 atan(omega dt / 2) instead of
//   omega dt: an
//     error of (omega dt)^3/12 a step, second order in time.
//   * Together with the increment D : sym(G) the update integrates the Jaumann rate, to second order in the
//   step: in large
//     simple shear a hypoelastic solid follows tau = G sin(gamma), which is the known answer of that rate.
//
// Invariants (principal values) of the stress are kept to rounding.
#pragma once

#include "core/simd.hpp"

namespace polder::POLDER_SIMD_NAMESPACE {

// G_mid = G (I + G/2)^{-1} from the gradient with respect to the configuration at the start of the step.
POLDER_INLINE void midpoint_gradient(Pack (&g)[4]) {
  // multiplied out with the adjugate: no difference of near-equal numbers for a small G
  const Pack a = 1 + 0.5 * g[0], b = 0.5 * g[1], c = 0.5 * g[2], d = 1 + 0.5 * g[3];
  const Pack inv = 1 / (a * d - b * c);
  const Pack xx = g[0] * d - g[1] * c, xy = g[1] * a - g[0] * b;
  const Pack yx = g[2] * d - g[3] * c, yy = g[3] * a - g[2] * b;
  g[0] = xx * inv, g[1] = xy * inv, g[2] = yx * inv, g[3] = yy * inv;
}

POLDER_INLINE void midpoint_gradient(Pack (&g)[9]) {
  Pack m[9], adj[9], r[9];
  for (int i = 0; i < 9; ++i) m[i] = 0.5 * g[i];
  m[0] += 1, m[4] += 1, m[8] += 1;
  adj[0] = m[4] * m[8] - m[5] * m[7], adj[1] = m[2] * m[7] - m[1] * m[8], adj[2] = m[1] * m[5] - m[2] * m[4];
  adj[3] = m[5] * m[6] - m[3] * m[8], adj[4] = m[0] * m[8] - m[2] * m[6], adj[5] = m[2] * m[3] - m[0] * m[5];
  adj[6] = m[3] * m[7] - m[4] * m[6], adj[7] = m[1] * m[6] - m[0] * m[7], adj[8] = m[0] * m[4] - m[1] * m[3];
  const Pack inv = 1 / (m[0] * adj[0] + m[1] * adj[3] + m[2] * adj[6]);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      r[3 * i + j] = (g[3 * i] * adj[j] + g[3 * i + 1] * adj[3 + j] + g[3 * i + 2] * adj[6 + j]) * inv;
  for (int i = 0; i < 9; ++i) g[i] = r[i];
}

// Plane: stress = {xx, yy, zz, xy}; zz does not turn. With t = tan(angle/2) = (G_yx - G_xy)/4.
POLDER_INLINE void rotate_stress(const Pack (&g)[4], Pack (&s)[4]) {
  const Pack t = 0.25 * (g[2] - g[1]);
  const Pack inv = 1 / (1 + t * t);
  const Pack cosine = (1 - t * t) * inv, sine = 2 * t * inv;
  // double angle: the stress deviator in the plane turns by twice the angle
  const Pack c2 = cosine * cosine - sine * sine, s2 = 2 * sine * cosine;
  const Pack mean = 0.5 * (s[0] + s[1]), half = 0.5 * (s[0] - s[1]);
  const Pack turned = c2 * half - s2 * s[3];
  s[3] = s2 * half + c2 * s[3];
  s[0] = mean + turned;
  s[1] = mean - turned;
}

// Space: stress = {xx, yy, zz, xy, yz, zx}. With A = W/2 = [a]: Q = I + 2 (A + A^2)/(1 + |a|^2).
POLDER_INLINE void rotate_stress(const Pack (&g)[9], Pack (&s)[6]) {
  const Pack x = 0.25 * (g[7] - g[5]), y = 0.25 * (g[2] - g[6]), z = 0.25 * (g[3] - g[1]);
  const Pack f = 2 / (1 + x * x + y * y + z * z);
  const Pack q00 = 1 - f * (y * y + z * z), q01 = f * (x * y - z), q02 = f * (z * x + y);
  const Pack q10 = f * (x * y + z), q11 = 1 - f * (x * x + z * z), q12 = f * (y * z - x);
  const Pack q20 = f * (z * x - y), q21 = f * (y * z + x), q22 = 1 - f * (x * x + y * y);
  const Pack q[3][3] = {{q00, q01, q02}, {q10, q11, q12}, {q20, q21, q22}};
  Pack r[3][3];  // Q stress
  for (int i = 0; i < 3; ++i) {
    r[i][0] = q[i][0] * s[0] + q[i][1] * s[3] + q[i][2] * s[5];
    r[i][1] = q[i][0] * s[3] + q[i][1] * s[1] + q[i][2] * s[4];
    r[i][2] = q[i][0] * s[5] + q[i][1] * s[4] + q[i][2] * s[2];
  }
  const auto dot = [&](int i, int j) { return r[i][0] * q[j][0] + r[i][1] * q[j][1] + r[i][2] * q[j][2]; };
  s[0] = dot(0, 0), s[1] = dot(1, 1), s[2] = dot(2, 2);
  s[3] = dot(0, 1), s[4] = dot(1, 2), s[5] = dot(2, 0);
}

}  // namespace polder::POLDER_SIMD_NAMESPACE
