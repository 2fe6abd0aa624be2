#include "tests/verify/mpm_motion.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <numbers>

namespace polder::verify {
namespace {
using std::numbers::pi;
}

SpinResult spin_disk(const Scheme& scheme, int cells_in_radius, double courant) {
  constexpr double kRadius = 0.5, kSpin = 2.0, kCentre = 1.0;
  const double h = kRadius / cells_in_radius;
  const int cells = static_cast<int>(std::lround(2 * kCentre / h));
  Scene<2> scene(Grid<2>({0, 0}, {cells, cells}, h), scheme.options(), {});
  const MaterialParameters m = elastic(1000, 1e6, 0.3);
  ParticleSet<2>& set =
      scene.add(m, {kCentre - kRadius, kCentre - kRadius}, {kCentre + kRadius, kCentre + kRadius}, 2, 0,
                [&](const Point<2>& x) { return std::hypot(x[0] - kCentre, x[1] - kCentre) < kRadius; });
  const double end = 2 * pi / kSpin;
  SpinResult r;
  r.steps = static_cast<long>(std::ceil(end / scene.wave_step(courant)));
  const double dt = end / static_cast<double>(r.steps);
  // Velocities live half a step before positions. A field of velocities that turns by a whole angle in a
  // step, instead of cutting across the arc, keeps the radius: v = (R(w dt) - 1) x / dt.
  const double c = (std::cos(kSpin * dt) - 1) / dt, s = std::sin(kSpin * dt) / dt;
  for (int p = 0; p < set.slots(); ++p) {
    const double x = set.position[0][p] - kCentre, y = set.position[1][p] - kCentre;
    // half a step earlier: turned back by the angle of a step
    const double cb = std::cos(kSpin * dt), sb = std::sin(kSpin * dt);
    const double u = c * x - s * y, v = s * x + c * y;
    set.velocity[0][p] = cb * u + sb * v, set.velocity[1][p] = -sb * u + cb * v;
    if (scheme.affine != AffineKind::none) {
      set.affine[0][p] = cb * c + sb * s, set.affine[1][p] = -cb * s + sb * c;
      set.affine[2][p] = -sb * c + cb * s, set.affine[3][p] = sb * s + cb * c;
    }
  }
  const double second = h * h / 4;  // of the B-spline; about that of GIMP
  const auto energy = [&] {
    double e = scene.kinetic_energy();
    scene.each([&](const ParticleSet<2>& q, int p) {
      e += q.volume[p] * elastic_energy_density<2>(m, q, p);
      if (scheme.affine != AffineKind::none)
        for (const Reals& a : q.affine) e += 0.5 * q.mass[p] * second * a[p] * a[p];
    });
    return e;
  };
  const auto angular = [&] {
    double l = 0;
    scene.each([&](const ParticleSet<2>& q, int p) {
      l += q.mass[p] * ((q.position[0][p] - kCentre) * q.velocity[1][p] -
                        (q.position[1][p] - kCentre) * q.velocity[0][p]);
      if (scheme.affine != AffineKind::none) l += q.mass[p] * second * (q.affine[2][p] - q.affine[1][p]);
    });
    return l;
  };
  const double energy_before = energy(), angular_before = angular();
  for (long i = 0; i < r.steps; ++i) scene.step(dt);
  r.energy = energy() / energy_before - 1;
  r.angular = angular() / angular_before - 1;

  // Best rotation and uniform stretch of the start onto the end: complex least squares sum conj(X) x / sum
  // |X|^2.
  double re = 0, im = 0, square = 0, mean[2] = {0, 0};
  scene.each([&](const ParticleSet<2>& q, int p) {
    for (int d = 0; d < 2; ++d) mean[d] += (q.position[d][p] - kCentre) / q.count();
  });
  scene.each([&](const ParticleSet<2>& q, int p) {
    const double x0 = q.initial_position[0][p] - kCentre, y0 = q.initial_position[1][p] - kCentre;
    const double x = q.position[0][p] - kCentre - mean[0], y = q.position[1][p] - kCentre - mean[1];
    re += x0 * x + y0 * y, im += x0 * y - y0 * x, square += x0 * x0 + y0 * y0;
  });
  r.area = std::hypot(re, im) / square - 1;
  r.angle = std::atan2(im, re) * 180 / pi;
  const double cs = re / std::hypot(re, im), sn = im / std::hypot(re, im);
  double distance = 0;
  scene.each([&](const ParticleSet<2>& q, int p) {
    const double x0 = q.initial_position[0][p] - kCentre, y0 = q.initial_position[1][p] - kCentre;
    const double x = q.position[0][p] - kCentre - mean[0], y = q.position[1][p] - kCentre - mean[1];
    distance += std::pow(x - (cs * x0 - sn * y0), 2) + std::pow(y - (sn * x0 + cs * y0), 2);
  });
  r.shape = std::sqrt(distance / set.count()) / kRadius;
  return r;
}

double energy_growth(const Scheme& scheme, bool cell_average, double offset, int steps) {
  constexpr double kSpacing = 0.1;
  SkeletonOptions options = scheme.options();
  options.cell_average = cell_average;
  Scene<2> scene(Grid<2>({0, 0}, {16, 16}, kSpacing), options, {});
  const MaterialParameters m = elastic(1000, 1e6, 0.49);
  const double lower = (3 + offset) * kSpacing;
  ParticleSet<2>& set = scene.add(m, {lower, lower}, {lower + 8 * kSpacing, lower + 8 * kSpacing});
  for (int p = 0; p < set.slots(); ++p) {
    const double x = (set.position[0][p] - lower) / (8 * kSpacing),
                 y = (set.position[1][p] - lower) / (8 * kSpacing);
    set.velocity[0][p] = 0.01 * std::cos(3 * pi * x) * std::cos(pi * y);
    set.velocity[1][p] = 0.01 * std::cos(2 * pi * x) * std::cos(4 * pi * y);
  }
  const auto energy = [&] {
    double e = scene.kinetic_energy();
    scene.each(
        [&](const ParticleSet<2>& q, int p) { e += q.volume[p] * elastic_energy_density<2>(m, q, p); });
    return e;
  };
  const double before = energy(), dt = scene.wave_step(0.4);
  double largest = before;
  for (int i = 0; i < steps; ++i) {
    scene.step(dt);
    largest = std::max(largest, energy());
  }
  return largest / before;
}

MotionError vibrate_bar(const Scheme& scheme, int cells, double courant) {
  constexpr double kLength = 25, kYoung = 100, kDensity = 1, kSpeed = 1e-3;
  const double h = kLength / cells, b = pi / (2 * kLength), w = b * std::sqrt(kYoung / kDensity);
  Scene<2> scene(Grid<2>({0, 0}, {cells + 3, 3}, h), scheme.options(), all_sides<2>(BoundaryKind::roller));
  ParticleSet<2>& set = scene.add(elastic(kDensity, kYoung, 0), {0, 0}, {kLength, 3 * h});
  const double end = 2 * pi / w;
  const long steps = static_cast<long>(std::ceil(end / scene.wave_step(courant)));
  const double dt = end / static_cast<double>(steps);
  for (int p = 0; p < set.slots(); ++p) {  // velocities live half a step before positions
    const double x = set.position[0][p], v = kSpeed * std::cos(-0.5 * w * dt);
    set.velocity[0][p] = v * std::sin(b * x);
    if (scheme.affine != AffineKind::none) set.affine[0][p] = v * b * std::cos(b * x);
  }
  const double before = scene.kinetic_energy();
  MotionError e;
  for (long i = 0; i < steps; ++i) {
    scene.step(dt);
    double square = 0;
    scene.each([&](const ParticleSet<2>& q, int p) {
      const double x = q.initial_position[0][p];
      square += std::pow(q.position[0][p] - x - kSpeed / w * std::sin(w * scene.time) * std::sin(b * x), 2);
    });
    e.displacement = std::max(e.displacement, std::sqrt(square / set.count()) / (kSpeed / w));
  }
  e.energy = 1 - scene.kinetic_energy() / before;
  return e;
}

double Manufactured::displacement(double x, double t) const {
  return amplitude * std::sin(2 * pi * x) * std::sin(2 * pi * speed * t + phase);
}
double Manufactured::velocity(double x, double t) const {
  return amplitude * 2 * pi * speed * std::sin(2 * pi * x) * std::cos(2 * pi * speed * t + phase);
}
double Manufactured::stretch(double x, double t) const {
  return 1 + amplitude * 2 * pi * std::cos(2 * pi * x) * std::sin(2 * pi * speed * t + phase);
}
// k^2 u [mu/rho - c^2 - (lambda (ln J - 1) - mu) / (rho F^2)], k = 2 pi.
double Manufactured::body_force(double x, double t, double stretch_across) const {
  const double f = stretch(x, t);
  return 4 * pi * pi * displacement(x, t) *
         (shear / density - speed * speed -
          (lame * (std::log(f * stretch_across) - 1) - shear) / (density * f * f));
}

Manufactured manufactured_axis(int axis, double amplitude) {
  constexpr double kYoung = 1e7, kPoisson = 0.3, kDensity = 1000;
  const double lame = kYoung * kPoisson / ((1 + kPoisson) * (1 - 2 * kPoisson)),
               shear = kYoung / (2 * (1 + kPoisson));
  return {lame, shear, kDensity, std::sqrt((lame + 2 * shear) / kDensity), amplitude, axis == 0 ? 0 : pi};
}

MotionError manufactured(const Scheme& scheme, int cells, double courant, double amplitude, int per_axis) {
  const Manufactured axis[2] = {manufactured_axis(0, amplitude), manufactured_axis(1, amplitude)};
  const double h = 1.0 / cells;
  Scene<2> scene(Grid<2>({0, 0}, {cells, cells}, h), scheme.options(), all_sides<2>(BoundaryKind::roller));
  MaterialParameters m = elastic(1000, 1e7, 0.3);
  m.model = MaterialModel::neo_hookean;
  ParticleSet<2>& set = scene.add(m, {0, 0}, {1, 1}, per_axis);
  for (Reals& b : set.body_acceleration) b.assign(set.slots(), 0.0);
  const double end = 1 / axis[0].speed;  // one period: w = 2 pi c
  const long steps = static_cast<long>(std::ceil(end / scene.wave_step(courant)));
  const double dt = end / static_cast<double>(steps);
  for (int p = 0; p < set.slots(); ++p)
    for (int d = 0; d < 2; ++d) {
      const double x = set.position[d][p];
      set.velocity[d][p] = axis[d].velocity(x, -0.5 * dt);
      if (scheme.affine != AffineKind::none)
        set.affine[d * 2 + d][p] = (axis[d].stretch(x, 0.5 * dt) - axis[d].stretch(x, -0.5 * dt)) / dt;
    }
  MotionError e;
  for (long i = 0; i < steps; ++i) {
    scene.each([&](const ParticleSet<2>&, int p) {
      for (int d = 0; d < 2; ++d)
        set.body_acceleration[d][p] =
            axis[d].body_force(set.initial_position[d][p], scene.time,
                               axis[1 - d].stretch(set.initial_position[1 - d][p], scene.time));
    });
    const std::clock_t before = std::clock();
    scene.step(dt);
    e.seconds += static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC;
    double square = 0;
    scene.each([&](const ParticleSet<2>& q, int p) {
      for (int d = 0; d < 2; ++d) {
        const double x = q.initial_position[d][p];
        square += std::pow(q.position[d][p] - x - axis[d].displacement(x, scene.time), 2);
      }
    });
    e.displacement = std::max(e.displacement, std::sqrt(square / set.count()) / amplitude);
  }
  e.steps = steps;
  return e;
}

}  // namespace polder::verify
