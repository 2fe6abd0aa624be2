// What a free body keeps over a thousand steps: mass exactly, momentum to rounding, and with the affine
// transfer angular momentum too. And the same bits for any number of threads, through re-sorts.
#include <doctest/doctest.h>

#include <cstring>

#include "core/threads.hpp"
#include "tests/verify/mpm_scene.hpp"

using namespace polder;
using namespace polder::verify;

namespace {

// A soft disk or ball that spins, stretches and flies through several blocks.
template <int D>
std::unique_ptr<Scene<D>> tumbling_body(const SkeletonOptions& options, double speed) {
  constexpr double kRadius = 0.3;
  Index<D> cells;
  cells.fill(D == 2 ? 40 : 30);
  auto scene =
      std::make_unique<Scene<D>>(Grid<D>(Point<D>{}, cells, 0.1), options, std::vector<BoundarySpec<D>>{});
  Point<D> centre, lower, upper;
  for (int d = 0; d < D; ++d)
    centre[d] = 1.21 + 0.13 * d, lower[d] = centre[d] - kRadius, upper[d] = centre[d] + kRadius;
  ParticleSet<D>& set = scene->add(elastic(1000, 1e5, 0.3), lower, upper, 2, 0.3, [&](const Point<D>& x) {
    double r = 0;
    for (int d = 0; d < D; ++d) r += (x[d] - centre[d]) * (x[d] - centre[d]);
    return r < kRadius * kRadius;
  });
  for (int p = 0; p < set.slots(); ++p) {
    const double x = set.position[0][p] - centre[0], y = set.position[1][p] - centre[1];
    set.velocity[0][p] = speed - 4 * y + 1.0 * x;
    set.velocity[1][p] = 0.7 * speed + 4 * x - 2.0 * y;
    if (D == 3) set.velocity[D - 1][p] = 0.4 * speed + 1.5 * y;
    if (options.affine != AffineKind::none) {
      set.affine[0][p] = 1, set.affine[1][p] = -4, set.affine[D][p] = 4, set.affine[D + 1][p] = -2;
      if (D == 3) set.affine[2 * D + 1][p] = 1.5;
    }
  }
  return scene;
}

template <int D>
struct Moments {
  double mass = 0;
  Point<D> momentum{};
  std::array<double, 3> angular{};
  double momentum_scale = 0, angular_scale = 0;  // sums of absolute values
};

// Angular momentum about the origin, with that of the affine field: m D (C_ji - C_ij), D = h^2/4 for the
// B-spline.
template <int D>
Moments<D> moments(const Scene<D>& scene) {
  Moments<D> m;
  const double second = std::pow(scene.skeleton.grid().spacing(), 2) / 4;
  const bool affine = scene.skeleton.options().affine != AffineKind::none;
  scene.each([&](const ParticleSet<D>& s, int p) {
    m.mass += s.mass[p];
    for (int d = 0; d < D; ++d) {
      m.momentum[d] += s.mass[p] * s.velocity[d][p];
      m.momentum_scale += s.mass[p] * std::abs(s.velocity[d][p]);
    }
    for (int k = 0; k < (D == 3 ? 3 : 1); ++k) {
      const int i = D == 3 ? (k + 1) % 3 : 0, j = D == 3 ? (k + 2) % 3 : 1;
      double l = s.position[i][p] * s.velocity[j][p] - s.position[j][p] * s.velocity[i][p];
      if (affine) l += second * (s.affine[j * D + i][p] - s.affine[i * D + j][p]);
      m.angular[k] += s.mass[p] * l, m.angular_scale += s.mass[p] * std::abs(l);
    }
  });
  return m;
}

SkeletonOptions options_of(ShapeKind shape, bool musl, AffineKind affine) {
  SkeletonOptions o;
  o.shape = shape, o.musl = musl, o.affine = affine;
  return o;
}

template <int D>
void check_conservation(const SkeletonOptions& options, bool angular) {
  const auto body = tumbling_body<D>(options, 0.5);
  Scene<D>& scene = *body;
  const Moments<D> before = moments(scene);
  const double dt = scene.wave_step(0.3);
  int sorts = 0;
  for (int i = 0; i < 1000; ++i) {
    sorts += scene.skeleton.travelled() > kSkin;
    scene.step(dt);
  }
  REQUIRE(sorts >= 3);
  const Moments<D> after = moments(scene);
  double nodal_mass = 0;
  for (int i = 0; i < scene.skeleton.grid().slots(); ++i) nodal_mass += scene.skeleton.sums()[i * 8];
  CHECK(after.mass == doctest::Approx(before.mass).epsilon(1e-14));
  CHECK(nodal_mass == doctest::Approx(before.mass).epsilon(1e-12));
  for (int d = 0; d < D; ++d)
    CHECK(std::abs(after.momentum[d] - before.momentum[d]) < 1e-12 * before.momentum_scale);
  if (angular)
    for (int k = 0; k < 3; ++k)
      CHECK(std::abs(after.angular[k] - before.angular[k]) < 1e-11 * before.angular_scale);
}

// All bits of the points' state, in the order of their ids.
template <int D>
std::vector<double> state_of(Scene<D>& scene) {
  std::vector<double> all;
  for (const auto& body : scene.skeleton.bodies())
    for (const ParticleField& f : body->fields())
      for (int i = 0; i < body->count(); ++i) all.push_back((*f.values)[body->find(i)]);
  return all;
}

template <int D>
void check_threads(const SkeletonOptions& options) {
  std::vector<double> reference;
  for (const int n : {1, 2, 4}) {
    set_threads(n);
    const auto body = tumbling_body<D>(options, 3.0);
    Scene<D>& scene = *body;
    const double dt = scene.wave_step(0.5);
    int sorts = 0;
    for (int i = 0; i < (D == 2 ? 150 : 60); ++i) {
      sorts += scene.skeleton.travelled() > kSkin;
      scene.step(dt);
    }
    CHECK(sorts >= 4);
    const std::vector<double> state = state_of(scene);
    if (n == 1) reference = state;
    REQUIRE(state.size() == reference.size());
    CHECK(std::memcmp(state.data(), reference.data(), state.size() * sizeof(double)) == 0);
  }
  set_threads(1);
}

}  // namespace

TEST_CASE("a free body keeps its mass and momentum over a thousand steps") {
  set_threads(1);
  SUBCASE("2D GIMP, MUSL") {
    check_conservation<2>(options_of(ShapeKind::gimp, true, AffineKind::none), false);
  }
  SUBCASE("2D B-spline, USL") {
    check_conservation<2>(options_of(ShapeKind::quadratic_bspline, false, AffineKind::none), false);
  }
  SUBCASE("2D GIMP, TPIC") {
    check_conservation<2>(options_of(ShapeKind::gimp, false, AffineKind::tpic), false);
  }
  SUBCASE("3D B-spline, MUSL") {
    check_conservation<3>(options_of(ShapeKind::quadratic_bspline, true, AffineKind::none), false);
  }
}

TEST_CASE("the affine transfer keeps angular momentum over a thousand steps") {
  set_threads(1);
  SUBCASE("2D") {
    check_conservation<2>(options_of(ShapeKind::quadratic_bspline, false, AffineKind::apic), true);
  }
  SUBCASE("3D") {
    check_conservation<3>(options_of(ShapeKind::quadratic_bspline, false, AffineKind::apic), true);
  }
}

TEST_CASE("the same bits with 1, 2 and 4 threads") {
  SUBCASE("2D MUSL") {
    check_threads<2>(options_of(ShapeKind::gimp, true, AffineKind::none));
  }
  SUBCASE("2D APIC") {
    check_threads<2>(options_of(ShapeKind::quadratic_bspline, false, AffineKind::apic));
  }
  SUBCASE("3D MUSL") {
    check_threads<3>(options_of(ShapeKind::quadratic_bspline, true, AffineKind::none));
  }
}
