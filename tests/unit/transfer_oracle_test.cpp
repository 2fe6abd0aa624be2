// The particle kernels against plain double loops (transfer_oracle.hpp): positions, velocities, stress and
// volume of random particles after several steps, for every dimension, shape and scheme, walls included.
#include "transfer_oracle.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdint>
#include <string>

#include "tests/verify/mpm_scene.hpp"

using namespace polder;
using namespace polder::verify;

namespace {

class Random {
 public:
  double operator()(double lo, double hi) {
    state_ = state_ * 6364136223846793005ull + 1442695040888963407ull;
    return lo + (hi - lo) * static_cast<double>(state_ >> 11) * 0x1p-53;
  }

 private:
  std::uint64_t state_ = 12345;
};

struct Scheme {
  ShapeKind shape;
  bool musl;
  AffineKind affine;
  Space space;
};

// Largest difference of kernels and oracle over all particles, each quantity relative to its own largest
// value.
template <int D>
double difference(const Scheme& scheme, const Index<D>& cells, int per_axis) {
  constexpr double kSpacing = 0.1, kYoung = 1e6, kDensity = 1500;
  Point<D> origin;
  for (int d = 0; d < D; ++d)
    origin[d] = scheme.space == Space::axisymmetric && d == 0 ? 0.0 : -0.35 + 0.2 * d;
  const Grid<D> grid(origin, cells, kSpacing);
  SkeletonOptions options;
  options.shape = scheme.shape, options.musl = scheme.musl, options.affine = scheme.affine,
  options.space = scheme.space;
  options.flip = 0.97;
  options.cell_average = false;
  Scene<D> scene(grid, options, all_sides<D>(BoundaryKind::roller));
  scene.gravity[D - 1] = -9.81, scene.gravity[0] = 1.7;
  // The body touches every side of the grid.
  ParticleSet<D>& set = scene.add(elastic(kDensity, kYoung, 0.3), grid.origin(), grid.upper(), per_axis, 0.8);
  Random random;
  for (int p = 0; p < set.slots(); ++p) {
    for (int d = 0; d < D; ++d) set.velocity[d][p] = random(-1, 1), set.half_size[d][p] *= random(0.7, 1.4);
    for (int k = 0; k < ParticleSet<D>::kStress; ++k) set.stress[k][p] = random(-2e4, 2e4);
    set.volume[p] *= random(0.8, 1.2);
    if (scheme.affine != AffineKind::none)
      for (Reals& a : set.affine) a[p] = random(-2, 2);
  }

  oracle::Model<D> model;
  model.kind = scheme.shape, model.musl = scheme.musl, model.affine = scheme.affine,
  model.flip = options.flip;
  model.axisymmetric = scheme.space == Space::axisymmetric;
  model.h = kSpacing, model.origin = grid.origin(), model.cells = cells, model.gravity = scene.gravity;
  model.lame = scene.materials[0].lame_lambda(), model.shear = scene.materials[0].shear_modulus();
  constexpr int kPair[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {2, 0}};
  for (int p = 0; p < set.slots(); ++p) {
    oracle::Particle<D> q;
    for (int d = 0; d < D; ++d)
      q.x[d] = set.position[d][p], q.v[d] = set.velocity[d][p], q.half[d] = set.half_size[d][p];
    q.mass = set.mass[p], q.volume = set.volume[p];
    for (int k = 0; k < ParticleSet<D>::kStress; ++k)
      q.stress[kPair[k][0]][kPair[k][1]] = q.stress[kPair[k][1]][kPair[k][0]] = set.stress[k][p];
    if (scheme.affine != AffineKind::none)
      for (int i = 0; i < D; ++i)
        for (int j = 0; j < D; ++j) q.c[i][j] = set.affine[i * D + j][p];
    model.particles.push_back(q);
  }

  const double dt = scene.wave_step(0.2);
  for (int i = 0; i < 5; ++i) {
    scene.step(dt);
    model.step(dt);
  }
  double worst = 0;
  const auto compare = [&](auto kernel, auto plain) {  // of one quantity: f(slot), f(particle)
    double largest = 0, gap = 0;
    for (int p = 0; p < set.slots(); ++p)
      if (set.id[p] >= 0) {
        const double a = kernel(p), b = plain(model.particles[set.id[p]]);
        largest = std::max(largest, std::abs(b)), gap = std::max(gap, std::abs(a - b));
        if (!(std::abs(a - b) < 1e300)) gap = 1e300;
      }
    worst = std::max(worst, largest > 0 ? gap / largest : gap);
  };
  for (int d = 0; d < D; ++d) {
    compare([&](int p) { return set.position[d][p]; }, [&](const auto& q) { return q.x[d]; });
    compare([&](int p) { return set.velocity[d][p]; }, [&](const auto& q) { return q.v[d]; });
    compare([&](int p) { return set.half_size[d][p]; }, [&](const auto& q) { return q.half[d]; });
  }
  compare([&](int p) { return set.volume[p]; }, [&](const auto& q) { return q.volume; });
  for (int k = 0; k < ParticleSet<D>::kStress; ++k)
    compare([&](int p) { return set.stress[k][p]; },
            [&](const auto& q) { return q.stress[kPair[k][0]][kPair[k][1]]; });
  return worst;
}

const char* name_of(ShapeKind s) {
  return s == ShapeKind::linear ? "linear" : s == ShapeKind::gimp ? "GIMP" : "B-spline";
}

}  // namespace

TEST_CASE("five steps of random particles equal plain double loops") {
  for (const ShapeKind shape : {ShapeKind::linear, ShapeKind::gimp, ShapeKind::quadratic_bspline})
    for (const auto& [musl, affine] :
         {std::pair{true, AffineKind::none}, std::pair{false, AffineKind::none},
          std::pair{false, AffineKind::apic}, std::pair{false, AffineKind::tpic}})
      for (const Space space : {Space::plane_strain, Space::axisymmetric, Space::three_d}) {
        CAPTURE(name_of(shape));
        CAPTURE(musl);
        CAPTURE(static_cast<int>(affine));
        CAPTURE(static_cast<int>(space));
        const Scheme scheme{shape, musl, affine, space};
        const double gap = space == Space::three_d ? difference<3>(scheme, {5, 3, 6}, 2)
                                                   : difference<2>(scheme, {11, 17}, 2);
        CHECK(gap < 2e-13);
      }
}
