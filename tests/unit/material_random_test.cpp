// A million random strain increments: every law ends on or inside its yield surface, produces no NaN and no
// negative plastic work, and gives a particle the same bits whatever its lane and its neighbours.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "mpm/material/array_law.hpp"
#include "mpm/material/material.hpp"

using namespace polder::mpm;

namespace {

constexpr double kDegree = std::numbers::pi / 180;

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double between(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }
  double magnitude(double low, double high) { return std::exp(between(std::log(low), std::log(high))); }
  bool chance(double probability) { return between(0, 1) < probability; }

 private:
  std::mt19937_64 engine_;
};

Mobilised random_curve(Random& r, double low, double high) {
  Mobilised m;
  m.value = {r.between(low, high)};
  if (r.chance(0.3)) {
    m.kind = Mobilised::Kind::exponential;
    m.peak = r.between(low, high), m.residual = r.between(low, high), m.rate = r.magnitude(1, 3000);
  } else if (r.chance(0.4)) {
    m.kind = Mobilised::Kind::piecewise_linear;
    m.strain = {r.between(0, 0.01), r.between(0.01, 0.05), r.between(0.06, 0.2)};
    m.value = {r.between(low, high), r.between(low, high), r.between(low, high)};
  }
  return m;
}

MaterialParameters random_material(Random& r, MaterialModel model) {
  MaterialParameters m;
  m.name = "random";
  m.model = model;
  m.young = r.magnitude(1e5, 1e9);
  m.poisson = r.between(0, 0.45);
  if (model == MaterialModel::mohr_coulomb) {
    const double friction = r.chance(0.1) ? 0 : r.between(1, 50);
    m.friction = r.chance(0.1) ? Mobilised{}
                               : random_curve(r, friction * kDegree, std::min(55.0, friction + 15) * kDegree);
    m.dilation = random_curve(r, 0, range_of(m.friction).lowest);
    m.cohesion = r.chance(0.2) ? Mobilised{} : random_curve(r, 0, r.magnitude(10, 1e6));
    if (r.chance(0.3)) m.capillary_cohesion = random_curve(r, 0, 5e3);
    if (r.chance(0.3)) {
      m.scatter.cohesion = r.chance(0.5);
      m.scatter.friction = !m.scatter.cohesion || r.chance(0.5);
      m.scatter.lowest_friction = r.between(0.3, 1);
      m.scatter.highest_friction = r.between(1, 3);
    }
    if (r.chance(0.5)) m.tension_cutoff = r.chance(0.3) ? 0 : r.magnitude(1, 1e5);
  } else {
    m.shear_strength = r.magnitude(1e2, 1e6);
    m.residual_strength = r.between(0, 1.2) * m.shear_strength;
    m.softening_modulus = r.chance(0.3) ? 0 : -r.magnitude(1e-3, 1e1) * m.young;
  }
  return m;
}

struct Batch {
  int dimension, count, n;
  std::vector<double> stress, strain, state;

  Batch(const MaterialParameters& m, int d, int particles, Random& r)
      : dimension(d),
        count(particles),
        n(d == 2 ? 4 : 6),
        stress(n * count),
        strain(n * count),
        state(state_layout(m, d).count() * count) {
    const StateLayout layout = state_layout(m, d);
    const double strength = std::max({range_of(m.cohesion).highest, m.shear_strength, 1e3});
    for (int i = 0; i < count; ++i) {
      const double p = r.chance(0.1) ? 0 : -r.magnitude(1, 1e6), size = r.magnitude(1e-7, 0.1);
      const bool aligned = r.chance(0.2), isotropic = r.chance(0.1), triaxial = r.chance(0.2);
      for (int c = 0; c < n; ++c) {
        stress[c * count + i] = c < 3 ? p : 0;
        if (!isotropic && !(aligned && c >= 3)) stress[c * count + i] += strength * r.between(-0.3, 0.3);
        strain[c * count + i] = aligned && c >= 3 ? 0 : size * r.between(-1, 1);
      }
      if (triaxial && aligned) {
        stress[count + i] = stress[i];
        strain[count + i] = strain[i];
      }
      for (int v = 0; v < layout.count(); ++v) state[v * count + i] = layout.variables[v].initial;
      state[i] = r.chance(0.5) ? 0 : r.magnitude(1e-5, 1);
      if (layout.capillary_factor >= 0)
        state[layout.capillary_factor * count + i] = r.chance(0.5) ? 0 : r.between(0, 1);
      if (layout.cohesion_factor >= 0) state[layout.cohesion_factor * count + i] = r.between(0.1, 5);
      if (layout.friction_factor >= 0)
        state[layout.friction_factor * count + i] =
            r.between(m.scatter.lowest_friction, m.scatter.highest_friction);
      if (layout.peak_strength >= 0)
        state[layout.peak_strength * count + i] = m.shear_strength * r.between(0.5, 2);
    }
  }

  std::vector<double> stress_of(int i) const {
    std::vector<double> s(n);
    for (int c = 0; c < n; ++c) s[c] = stress[c * count + i];
    return s;
  }
  std::vector<double> state_of(int i) const {
    std::vector<double> s(state.size() / count);
    for (std::size_t v = 0; v < s.size(); ++v) s[v] = state[v * count + i];
    return s;
  }
};

struct Findings {
  long updates = 0, plastic = 0, tensile = 0, not_finite = 0, negative_work = 0, shrinking = 0;
  double outside = 0;  // largest yield function relative to the size of the stress
  double inside = 0;   // how far below 0 it is after a plastic step
};

// How far outside of the strength at the end of the step, relative to the stresses involved.
double excess(const MaterialParameters& m, const StateLayout& layout, const std::vector<double>& stress,
              const std::vector<double>& state, double size) {
  const Strength k = strength_of(m, layout, state);
  if (m.model == MaterialModel::von_mises) {
    const double p = (stress[0] + stress[1] + stress[2]) / 3;
    double j2 = 0;
    for (std::size_t c = 0; c < stress.size(); ++c)
      j2 += c < 3 ? 0.5 * (stress[c] - p) * (stress[c] - p) : stress[c] * stress[c];
    return (std::sqrt(j2) - k.cohesion) / size;
  }
  const Principal s = principal_stresses(stress);
  double f = (s.first - s.third) + (s.first + s.third) * std::sin(k.friction) -
             2 * k.cohesion * std::cos(k.friction);
  if (m.model == MaterialModel::mohr_coulomb) f = std::max(f, s.first - m.tension_cutoff);
  return f / size;
}

void run(const MaterialParameters& m, int dimension, int count, Random& r, Findings& found) {
  Batch b(m, dimension, count, r);
  const Batch before = b;
  const StateLayout layout = state_layout(m, dimension);
  make_array_law(m, dimension)->update(count, b.stress.data(), b.strain.data(), nullptr, b.state.data());
  for (int i = 0; i < count; ++i, ++found.updates) {
    const std::vector<double> s = b.stress_of(i), x = b.state_of(i);
    double trial[6], size = 0, work = 0;
    const double volume = before.strain[i] + before.strain[count + i] + before.strain[2 * count + i];
    for (int c = 0; c < b.n; ++c) {
      trial[c] = before.stress[c * count + i] + 2 * m.shear_modulus() * before.strain[c * count + i] +
                 (c < 3 ? m.lame_lambda() * volume : 0);
      size = std::max(size, std::abs(trial[c]));
    }
    bool finite = std::isfinite(x[0]);
    for (double v : s) finite &= std::isfinite(v);
    if (!finite) {
      ++found.not_finite;
      continue;
    }
    // stress times plastic strain = stress times elastic compliance times what the return took away
    double taken[6], mean = 0;
    for (int c = 0; c < b.n; ++c) taken[c] = trial[c] - s[c];
    mean = (taken[0] + taken[1] + taken[2]) / 3;
    for (int c = 0; c < b.n; ++c) {
      const double plastic = c < 3
                                 ? (taken[c] - mean) / (2 * m.shear_modulus()) + mean / (3 * m.bulk_modulus())
                                 : taken[c] / (2 * m.shear_modulus());
      work += (c < 3 ? 1 : 2) * s[c] * plastic;
    }
    found.negative_work += work < -1e-12 * size * size / m.shear_modulus();
    found.shrinking += x[0] < before.state[i];
    found.plastic += x[0] > before.state[i];
    found.tensile += trial[0] + trial[1] + trial[2] > 0;
    const double f = excess(m, layout, s, x, std::max(size, 1.0));
    found.outside = std::max(found.outside, f);
    if (x[0] > before.state[i]) found.inside = std::max(found.inside, -f);
  }
}

}  // namespace

TEST_CASE(
    "a million random strain increments end on or inside the yield surface, without NaN or negative work") {
  Random r(2024);
  Findings found;
  const int materials = 4000, particles = 250;
  for (int i = 0; i < materials; ++i) {
    const MaterialModel model = i % 10 == 0   ? MaterialModel::von_mises
                                : i % 10 == 1 ? MaterialModel::tresca
                                              : MaterialModel::mohr_coulomb;
    const MaterialParameters m = random_material(r, model);
    if (!check_parameters(m).empty()) {  // a dilation curve may cross its friction curve
      --i;
      continue;
    }
    run(m, 2 + (i / 10) % 2, particles, r, found);
  }
  MESSAGE(found.updates << " updates, " << found.plastic << " plastic, " << found.tensile
                        << " with tensile mean stress; largest yield function, relative: " << found.outside
                        << ", after plastic steps at least " << -found.inside);
  CHECK(found.updates == 1000000);
  CHECK(found.plastic > found.updates / 4);
  CHECK(found.tensile > found.updates / 10);
  CHECK(found.not_finite == 0);
  CHECK(found.negative_work == 0);
  CHECK(found.shrinking == 0);
  CHECK(found.outside < 1e-9);
  CHECK(found.inside < 1e-9);
}

TEST_CASE("a particle's result has the same bits in every lane and beside every neighbour") {
  Random r(99);
  for (int round = 0; round < 300; ++round) {
    const MaterialModel model = round % 5 == 0   ? MaterialModel::von_mises
                                : round % 5 == 1 ? MaterialModel::tresca
                                                 : MaterialModel::mohr_coulomb;
    const MaterialParameters m = random_material(r, model);
    if (!check_parameters(m).empty()) continue;
    const int dimension = 2 + round % 2, count = 67;
    Batch b(m, dimension, count, r);
    const Batch before = b;
    const auto law = make_array_law(m, dimension);
    law->update(count, b.stress.data(), b.strain.data(), nullptr, b.state.data());
    for (int i = 0; i < count; ++i) {
      std::vector<double> stress = before.stress_of(i), state = before.state_of(i), strain(b.n);
      for (int c = 0; c < b.n; ++c) strain[c] = before.strain[c * count + i];
      law->update(1, stress.data(), strain.data(), nullptr, state.data());
      const std::vector<double> s = b.stress_of(i), x = b.state_of(i);
      REQUIRE(std::memcmp(stress.data(), s.data(), s.size() * sizeof(double)) == 0);
      REQUIRE(std::memcmp(state.data(), x.data(), x.size() * sizeof(double)) == 0);
    }
  }
}
