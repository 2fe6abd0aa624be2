// Hughes-Winget rotation of stress under large rotations.
#include <doctest/doctest.h>

#include <cmath>
#include <initializer_list>
#include <numbers>

#include "mpm/material/rotation.hpp"

using namespace polder::simd_native;

namespace {

struct Matrix {
  double m[3][3];
};

Matrix product(const Matrix& a, const Matrix& b) {
  Matrix r{};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k) r.m[i][j] += a.m[i][k] * b.m[k][j];
  return r;
}

Matrix transposed(const Matrix& a) {
  Matrix r{};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) r.m[i][j] = a.m[j][i];
  return r;
}

// Rodrigues
Matrix rotation(double x, double y, double z, double angle) {
  const double n = std::sqrt(x * x + y * y + z * z);
  const Matrix k{{{0, -z / n, y / n}, {z / n, 0, -x / n}, {-y / n, x / n, 0}}};
  const Matrix k2 = product(k, k);
  Matrix r{};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      r.m[i][j] = (i == j) + std::sin(angle) * k.m[i][j] + (1 - std::cos(angle)) * k2.m[i][j];
  return r;
}

Matrix tensor(const Pack (&s)[6], int lane) {
  return {{{s[0][lane], s[3][lane], s[5][lane]},
           {s[3][lane], s[1][lane], s[4][lane]},
           {s[5][lane], s[4][lane], s[2][lane]}}};
}

}  // namespace

TEST_CASE("a rigid rotation by any angle in one step is exact in 3D") {
  Pack stress[6], gradient[9];
  Matrix expected[kLanes];
  for (int lane = 0; lane < kLanes; ++lane) {
    const double angle = 0.3 + 2.7 * lane / kLanes;  // up to 162 degrees
    const Matrix q = rotation(1.0 + lane, -2.0, 0.7 * lane, angle);
    for (int c = 0; c < 6; ++c) stress[c][lane] = std::cos(1.7 * c + lane) * (c < 3 ? 5 : 2);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) gradient[3 * i + j][lane] = q.m[i][j] - (i == j);
    expected[lane] = product(product(q, tensor(stress, lane)), transposed(q));
  }
  midpoint_gradient(gradient);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)  // the midpoint gradient of a rigid rotation has no strain
      CHECK(std::abs((gradient[3 * i + j] + gradient[3 * j + i])[0]) < 1e-12);
  rotate_stress(gradient, stress);
  for (int lane = 0; lane < kLanes; ++lane) {
    const Matrix got = tensor(stress, lane);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) CHECK(std::abs(got.m[i][j] - expected[lane].m[i][j]) < 1e-12);
  }
}

TEST_CASE("a rigid rotation by any angle in one step is exact in 2D, and the out-of-plane stress stays") {
  for (double angle : {-3.0, -1.0, 1e-8, 0.5, 2.9}) {
    const double c = std::cos(angle), s = std::sin(angle);
    Pack g[4] = {broadcast(c - 1), broadcast(-s), broadcast(s), broadcast(c - 1)};
    Pack stress[4] = {broadcast(-3.0), broadcast(-7.0), broadcast(-4.0), broadcast(1.5)};
    midpoint_gradient(g);
    rotate_stress(g, stress);
    CHECK(stress[0][0] == doctest::Approx(c * c * -3 + s * s * -7 - 2 * s * c * 1.5).epsilon(1e-12));
    CHECK(stress[1][0] == doctest::Approx(s * s * -3 + c * c * -7 + 2 * s * c * 1.5).epsilon(1e-12));
    CHECK(std::abs(stress[3][0] - (s * c * (-3 + 7) + (c * c - s * s) * 1.5)) < 1e-12);
    CHECK(stress[2][0] == -4.0);
  }
}

TEST_CASE("2D and 3D rotate alike, and a full turn in small steps brings the stress back") {
  Pack plane[4] = {broadcast(-3.0), broadcast(-7.0), broadcast(-4.0), broadcast(1.5)};
  Pack space[6] = {plane[0], plane[1], plane[2], plane[3], broadcast(0.0), broadcast(0.0)};
  const int steps = 1000;
  const double half_angle = std::numbers::pi / steps;
  const Pack w = broadcast(2 * std::tan(half_angle)),
             o = broadcast(0.0);  // midpoint gradient of 360 degrees / steps
  for (int i = 0; i < steps; ++i) {
    const Pack turn2[4] = {o, -w, w, o}, turn3[9] = {o, -w, o, w, o, o, o, o, o};
    rotate_stress(turn2, plane);
    rotate_stress(turn3, space);
  }
  const double initial[] = {-3.0, -7.0, -4.0, 1.5};
  for (int c = 0; c < 4; ++c) {
    CHECK(std::abs(plane[c][0] - initial[c]) < 1e-10);
    CHECK(std::abs(space[c][0] - initial[c]) < 1e-10);
  }
}

TEST_CASE("large simple shear follows the Jaumann rate, tau = G sin gamma, to second order in the step") {
  const double shear_modulus = 2.0, gamma = 4.0;
  double error[3];
  for (int level = 0; level < 3; ++level) {
    const int steps = 100 << level;
    const double dg = gamma / steps;
    const Pack o = broadcast(0.0);
    Pack s[4] = {o, o, o, o};
    for (int i = 0; i < steps; ++i) {  // the strain increment acts half before and half after the turn
      s[3] += shear_modulus * dg / 2;
      const Pack g[4] = {o, broadcast(dg), o, o};
      rotate_stress(g, s);
      s[3] += shear_modulus * dg / 2;
    }
    error[level] = std::abs(s[3][0] - shear_modulus * std::sin(gamma)) +
                   std::abs(s[0][0] - shear_modulus * (1 - std::cos(gamma)));
  }
  MESSAGE("errors of tau and sigma_xx at gamma = 4 in 100, 200, 400 steps: " << error[0] << " " << error[1]
                                                                             << " " << error[2]);
  CHECK(error[2] < 1e-4);
  CHECK(std::log2(error[0] / error[1]) > 1.9);
  CHECK(std::log2(error[1] / error[2]) > 1.9);
}
