// The exact return against an oracle: every combination of active planes is tried by brute force.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "mpm/material/array_law.hpp"
#include "mpm/material/element_path.hpp"
#include "mpm/material/material.hpp"

using namespace polder::mpm;

namespace {

constexpr double kDegree = std::numbers::pi / 180;
using Vector = std::array<double, 3>;

double dot(const Vector& a, const Vector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

struct Plane {
  Vector normal;  // yield: normal . s <= limit
  Vector fall;    // stress change for a unit of plastic flow: C : (flow direction)
  double limit;
};

// All six Mohr-Coulomb planes and the three tension planes; no ordering of the stresses is used.
std::vector<Plane> planes(const MaterialParameters& m) {
  const double sp = std::sin(m.friction.value[0]), cp = std::cos(m.friction.value[0]),
               sq = std::sin(m.dilation.value[0]);
  const auto stiffness = [&](const Vector& e) {
    const double volume = m.lame_lambda() * (e[0] + e[1] + e[2]);
    return Vector{volume + 2 * m.shear_modulus() * e[0], volume + 2 * m.shear_modulus() * e[1],
                  volume + 2 * m.shear_modulus() * e[2]};
  };
  std::vector<Plane> all;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      if (i == j) continue;
      Vector n{}, flow{};
      n[i] = 1 + sp, n[j] = -(1 - sp), flow[i] = 1 + sq, flow[j] = -(1 - sq);
      all.push_back({n, stiffness(flow), 2 * m.cohesion.value[0] * cp});
    }
  const double tension = std::min(m.tension_cutoff, m.cohesion.value[0] * cp / sp);
  for (int i = 0; i < 3; ++i) {
    Vector n{};
    n[i] = 1;
    all.push_back({n, stiffness(n), tension});
  }
  return all;
}

// Solves the small system by Cramer's rule; false if it is singular.
bool solve(int n, double (&a)[3][3], const double (&b)[3], double (&x)[3]) {
  for (int i = n; i < 3; ++i)
    for (int j = 0; j < 3; ++j) a[i][j] = a[j][i] = i == j;
  const auto det = [](const double(&m)[3][3]) {
    return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
           m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
           m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
  };
  const double d = det(a);
  double scale = 1;
  for (int i = 0; i < n; ++i) scale *= std::abs(a[i][i]);
  if (std::abs(d) < 1e-9 * scale) return false;
  for (int k = 0; k < n; ++k) {
    double c[3][3];
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) c[i][j] = j == k ? (i < n ? b[i] : 0) : a[i][j];
    x[k] = det(c) / d;
  }
  return true;
}

// Distance from `got` to the nearest stress that satisfies all of: yield, flow along active planes with
// multipliers >= 0.
double distance_to_a_solution(const std::vector<Plane>& all, const Vector& trial, const Vector& got,
                              double size) {
  const double tolerance = 1e-9 * size;
  double nearest = 1e300;
  const auto consider = [&](const std::vector<int>& active) {
    double a[3][3], b[3] = {}, x[3];
    const int n = static_cast<int>(active.size());
    for (int i = 0; i < n; ++i) {
      b[i] = dot(all[active[i]].normal, trial) - all[active[i]].limit;
      for (int j = 0; j < n; ++j) a[i][j] = dot(all[active[i]].normal, all[active[j]].fall);
    }
    if (n > 0 && !solve(n, a, b, x)) return;
    Vector s = trial;
    for (int i = 0; i < n; ++i) {
      if (x[i] < -1e-9 * std::abs(b[i] / a[i][i])) return;
      for (int c = 0; c < 3; ++c) s[c] -= x[i] * all[active[i]].fall[c];
    }
    for (const Plane& p : all)
      if (dot(p.normal, s) - p.limit > tolerance) return;
    nearest = std::min(nearest,
                       std::max({std::abs(s[0] - got[0]), std::abs(s[1] - got[1]), std::abs(s[2] - got[2])}));
  };
  const int n = static_cast<int>(all.size());
  consider({});
  for (int i = 0; i < n; ++i) {
    consider({i});
    for (int j = i + 1; j < n; ++j) {
      consider({i, j});
      for (int k = j + 1; k < n; ++k) consider({i, j, k});
    }
  }
  return nearest;
}

}  // namespace

TEST_CASE(
    "the return is a solution of Koiter's conditions on plane, edges, apex, tension planes and all corners") {
  std::mt19937_64 engine(5);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine);
  };
  double worst = 0;
  int regions[4] = {};  // elastic, shear only, tension (s1 = T) with and without s3 on the Mohr-Coulomb plane
  for (int material = 0; material < 300; ++material) {
    MaterialParameters m;
    m.model = MaterialModel::mohr_coulomb;
    m.young = 1e6, m.poisson = between(0, 0.45);
    m.friction.value = {between(2, 50) * kDegree};
    m.dilation.value = {between(0, 1) * m.friction.value[0]};
    m.cohesion.value = {1000};
    const double apex = 1000 / std::tan(m.friction.value[0]);
    if (material % 3 > 0) m.tension_cutoff = between(0, 1.2) * apex;
    const std::vector<Plane> all = planes(m);
    const int count = 40;
    std::vector<double> stress(6 * count), strain(6 * count), state(count);
    for (int c = 0; c < 3; ++c)
      for (int i = 0; i < count; ++i) stress[c * count + i] = between(-3, 2) * std::min(apex, 5000.0);
    const std::vector<double> trial = stress;
    make_array_law(m, 3)->update(count, stress.data(), strain.data(), nullptr, state.data());
    for (int i = 0; i < count; ++i) {
      const Vector t{trial[i], trial[count + i], trial[2 * count + i]};
      const Vector got{stress[i], stress[count + i], stress[2 * count + i]};
      const double size = std::max({std::abs(t[0]), std::abs(t[1]), std::abs(t[2]), 1000.0});
      worst = std::max(worst, distance_to_a_solution(all, t, got, size) / size);
      const double first = std::max({got[0], got[1], got[2]}), last = std::min({got[0], got[1], got[2]});
      const bool in_tension = first > all.back().limit - 1e-6 * size;
      const double sp = std::sin(m.friction.value[0]);
      const bool on_shear = first * (1 + sp) - last * (1 - sp) > all[0].limit - 1e-6 * size;
      ++regions[got == t ? 0 : !in_tension ? 1 : on_shear ? 2 : 3];
    }
  }
  MESSAGE("12000 returns: " << regions[0] << " elastic, " << regions[1] << " shear, " << regions[2]
                            << " tension and shear, " << regions[3]
                            << " tension; farthest from a solution, relative: " << worst);
  for (int n : regions) CHECK(n > 100);
  CHECK(worst < 1e-8);
}

TEST_CASE(
    "beyond the apex the stress returns to it for every dilation, and to the tension cut-off below it") {
  for (double dilation : {-5.0, 0.0, 20.0})
    for (double cutoff : {1e300, 700.0}) {
      MaterialParameters m;
      m.model = MaterialModel::mohr_coulomb;
      m.young = 1e6, m.poisson = 0.3;
      m.friction.value = {30 * kDegree}, m.dilation.value = {dilation * kDegree}, m.cohesion.value = {1000};
      m.tension_cutoff = cutoff;
      ElementPoint point(m);
      point.apply_strain({0.01, 0.0101, 0.0099, 1e-5, 0, 2e-5});
      const double expected = std::min(cutoff, 1000 / std::tan(30 * kDegree));
      for (int c = 0; c < 3; ++c) CHECK(point.stress[c] == doctest::Approx(expected).epsilon(1e-12));
      for (int c = 3; c < 6; ++c) CHECK(std::abs(point.stress[c]) < 1e-8);
    }
}

TEST_CASE("soil without friction and cohesion carries no shear, and no tension beyond its cut-off") {
  MaterialParameters m;
  m.model = MaterialModel::mohr_coulomb;
  m.young = 1e6, m.poisson = 0.3;
  m.tension_cutoff = 0;
  ElementPoint point(m);
  point.apply_strain({-0.01, -0.02, -0.005, 0.003, 0, 0});
  for (int c = 0; c < 3; ++c) CHECK(point.stress[c] == doctest::Approx(-0.035 * m.bulk_modulus()));
  CHECK(std::abs(point.stress[3]) < 1e-8);
  point.apply_strain({0.1, 0.1, 0.1, 0, 0, 0});
  for (int c = 0; c < 6; ++c) CHECK(std::abs(point.stress[c]) < 1e-8);
}

TEST_CASE("a contraction that the elastic stiffness cannot follow is refused") {
  MaterialParameters m;
  m.model = MaterialModel::mohr_coulomb;
  m.young = 1e7, m.poisson = 0.49;
  m.friction.value = {35 * kDegree}, m.dilation.value = {-10 * kDegree};
  REQUIRE(check_parameters(m).size() == 1);
  CHECK(check_parameters(m)[0].key == "dilation");
  m.poisson = 0.3;
  CHECK(check_parameters(m).empty());
}
