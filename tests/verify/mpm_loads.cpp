#include "tests/verify/mpm_loads.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <numbers>

namespace polder::verify {
namespace {

constexpr double kGravity = 9.81;
double radians(double degrees) {
  return degrees * std::numbers::pi / 180;
}

Scheme scheme_of(ShapeKind shape) {
  return {"", shape, true, 0.99, AffineKind::none};
}

}  // namespace

SlideResult slide_block(ShapeKind shape, double angle, double coefficient, double speed, double duration) {
  constexpr double kSpacing = 0.05, kHeight = 0.2, kLength = 0.4, kDensity = 2000;
  const double reach = std::abs(speed) * duration + 0.5 * kGravity * duration * duration;
  auto sides = all_sides<2>(BoundaryKind::roller);
  sides[2].kind = BoundaryKind::friction;
  sides[2].coefficient = coefficient;
  SkeletonOptions options = scheme_of(shape).options();
  Scene<2> scene(Grid<2>({0, 0}, {static_cast<int>((kLength + reach) / kSpacing) + 12, 8}, kSpacing), options,
                 sides);
  ParticleSet<2>& set = scene.add(elastic(kDensity, 1e6, 0.2), {0.2, 0}, {0.2 + kLength, kHeight});
  const double sine = std::sin(radians(angle)), cosine = std::cos(radians(angle));
  scene.gravity = {kGravity * sine, -kGravity * cosine};
  for (int p = 0; p < set.slots(); ++p) {
    set.stress[1][p] = -kDensity * kGravity * cosine * (kHeight - set.position[1][p]);
  }
  // At rest and stuck first: a block that is let go with a jolt hops.
  const long steps = static_cast<long>(std::ceil(duration / scene.wave_step(0.5)));
  const double dt = duration / static_cast<double>(steps);
  scene.skeleton.boundaries().set_sticking(true);
  scene.damping = 0.7;
  scene.relax(dt, 1e-4, 2000);
  scene.skeleton.boundaries().set_sticking(false);
  scene.damping = 0;
  double start = 0;
  for (int p = 0; p < set.slots(); ++p) {
    set.velocity[0][p] = speed, set.velocity[1][p] = 0;
    if (set.id[p] >= 0) start += set.position[0][p] / set.count();
  }
  for (long i = 0; i < steps; ++i) scene.step(dt);
  SlideResult r;
  r.distance = -start;
  scene.each([&](const ParticleSet<2>& q, int p) {
    r.distance += q.position[0][p] / q.count();
    r.velocity += q.velocity[0][p] / q.count();
  });
  return r;
}

SegmentResult slide_on_segment(ShapeKind shape, double angle, double spacing) {
  constexpr double kDensity = 2000, kDuration = 0.3;
  const double c = std::cos(radians(angle)), s = std::sin(radians(angle));
  BoundarySpec<2>
      slope;  // descends to the right; the soil lies above, to the left seen from its lower right end
  slope.kind = BoundaryKind::roller;
  slope.has_segment = true;
  const Point<2> top{0.2, 2.0};
  slope.from = {top[0], top[1]};
  slope.to = {top[0] + 3 * c, top[1] - 3 * s};
  Scene<2> scene(Grid<2>({0, 0}, {static_cast<int>(3.2 / spacing), static_cast<int>(3.2 / spacing)}, spacing),
                 scheme_of(shape).options(), {slope});
  // A block on the slope: points of a box whose coordinates along and across the slope are inside.
  ParticleSet<2>& set =
      scene.add(elastic(kDensity, 1e6, 0.2), {0, 0.8}, {1.6, 2.8}, 2, 0, [&](const Point<2>& x) {
        const double along = (x[0] - top[0]) * c - (x[1] - top[1]) * s,
                     up = (x[0] - top[0]) * s + (x[1] - top[1]) * c;
        return along > 0.3 && along < 0.9 && up > 0 && up < 0.3;
      });
  scene.gravity = {0, -kGravity};
  const long steps = static_cast<long>(std::ceil(kDuration / scene.wave_step(0.5)));
  for (long i = 0; i < steps; ++i) scene.step(kDuration / static_cast<double>(steps));
  SegmentResult r;
  scene.each([&](const ParticleSet<2>& q, int p) {
    r.acceleration += (q.velocity[0][p] * c - q.velocity[1][p] * s) / q.count() / (kGravity * s * kDuration);
    const double up = (q.position[0][p] - top[0]) * s + (q.position[1][p] - top[1]) * c;
    r.depth = std::max(r.depth, -up / spacing);
    r.lift += ((q.position[0][p] - q.initial_position[0][p]) * s +
               (q.position[1][p] - q.initial_position[1][p]) * c) /
              spacing / q.count();
  });
  (void)set;
  r.acceleration -= 1;
  return r;
}

double press_block(ShapeKind shape, TopLoad load, double top_offset) {
  constexpr double kSpacing = 0.1, kPressure = 1e3, kYoung = 1e7, kPoisson = 0.3, kStart = -2e2;
  const double height = 1.0 + top_offset * kSpacing;  // of the surface
  const MaterialParameters m = elastic(2000, kYoung, kPoisson);
  auto sides = all_sides<2>(BoundaryKind::roller);
  const bool held = load == TopLoad::velocity;
  const double ramp = 0.2, strain = kPressure / m.wave_modulus();
  if (held) {
    sides[3].kind = BoundaryKind::velocity;
    sides[3].prescribed = {false, true};
    sides[3].velocity[1] = [=](double t) {
      return t < ramp ? -strain * height / ramp * (1 - std::cos(2 * std::numbers::pi * t / ramp)) : 0.0;
    };
  }
  Scene<2> scene(Grid<2>({0, 0}, {5, held ? 10 : 14}, kSpacing), scheme_of(shape).options(), sides);
  ParticleSet<2>& set = scene.add(m, {0, 0}, {0.5, height});
  for (int p = 0; p < set.slots(); ++p)
    set.stress[1][p] = held ? kStart : 0;  // any uniform start is at rest between plates
  if (!held) {
    SurfaceLoad<2> surface =
        line_load("top", {0.5, height}, {0, height}, 0.5 * kSpacing, Space::plane_strain);
    const auto rise = [=](double t) { return kPressure * std::min(1.0, t / ramp); };
    if (load == TopLoad::pressure)
      surface.pressure = rise;
    else
      surface.traction[1] = [=](double t) { return -rise(t); };
    scene.skeleton.loads().push_back(surface);
  }
  scene.damping = 0.3;
  const double dt = scene.wave_step(0.5);
  while (scene.time < 3 * ramp) scene.step(dt);
  double square = 0;
  scene.each([&](const ParticleSet<2>& q, int p) {
    const double exact = (held ? kStart : 0) - kPressure;
    square += std::pow(q.stress[1][p] / exact - 1, 2);
  });
  return std::sqrt(square / set.count());
}

CylinderResult press_cylinder(ShapeKind shape, bool cell_average, double spacing) {
  constexpr double kInner = 1, kOuter = 2, kPressure = 1e3, kYoung = 1e7, kPoisson = 0.3;
  SkeletonOptions options = scheme_of(shape).options();
  options.space = Space::axisymmetric;
  options.cell_average = cell_average;
  const int across = static_cast<int>(std::lround(2.4 / spacing));
  Scene<2> scene(Grid<2>({0, 0}, {across, 4}, spacing), options, all_sides<2>(BoundaryKind::roller));
  ParticleSet<2>& set = scene.add(elastic(2000, kYoung, kPoisson), {kInner, 0}, {kOuter, 4 * spacing});
  SurfaceLoad<2> inside =
      line_load("inside", {kInner, 4 * spacing}, {kInner, 0}, 0.5 * spacing, Space::axisymmetric);
  inside.pressure = [](double t) { return kPressure * std::min(1.0, t / 0.2); };
  scene.skeleton.loads().push_back(inside);
  scene.damping = 0.3;
  const double dt = scene.wave_step(0.5);

  while (scene.time < 3) scene.step(dt);

  const double k = kPressure * kInner * kInner / (kOuter * kOuter - kInner * kInner);
  CylinderResult r;
  const double inner_displacement =
      (1 + kPoisson) / kYoung * k * ((1 - 2 * kPoisson) * kInner + kOuter * kOuter / kInner);
  scene.each([&](const ParticleSet<2>& q, int p) {
    const double x = q.initial_position[0][p], ratio = kOuter * kOuter / (x * x);
    const double u = (1 + kPoisson) / kYoung * k * ((1 - 2 * kPoisson) * x + kOuter * kOuter / x);
    r.radial += std::pow((q.stress[0][p] - k * (1 - ratio)) / kPressure, 2);
    r.hoop += std::pow((q.stress[2][p] - k * (1 + ratio)) / kPressure, 2);
    r.axial += std::pow((q.stress[1][p] - 2 * kPoisson * k) / kPressure, 2);
    r.displacement += std::pow((q.position[0][p] - x - u) / inner_displacement, 2);
  });
  for (double* e : {&r.radial, &r.hoop, &r.axial, &r.displacement}) *e = std::sqrt(*e / set.count());
  return r;
}

FootingResult push_footing(const FootingOptions& o) {
  constexpr double kStrength = 1e4, kWidth = 5, kDepth = 2.5;
  const double h = 1 / (o.cells + 0.5), top = std::ceil(kDepth / h) * h;
  SkeletonOptions options = scheme_of(o.shape).options();
  options.cell_average = o.cell_average;
  auto sides = all_sides<2>(BoundaryKind::roller);
  sides[2].kind = BoundaryKind::fixed;
  sides[3].kind = BoundaryKind::free;
  BoundarySpec<2> footing;
  footing.kind = BoundaryKind::velocity;
  footing.has_segment = true;
  footing.from = {1, top}, footing.to = {-h, top};
  footing.prescribed = {false, true};
  const double end = o.settlement / o.speed;
  footing.velocity[1] = [&](double t) { return -o.speed * std::min(1.0, t / (0.1 * end)); };
  sides.push_back(footing);
  Scene<2> scene(
      Grid<2>({0, 0}, {static_cast<int>(std::ceil(kWidth / h)), static_cast<int>(std::lround(top / h)) + 4},
              h),
      options, sides);
  MaterialParameters m = elastic(2000, o.rigidity * kStrength, o.poisson);
  m.model = MaterialModel::tresca;
  m.shear_strength = m.residual_strength = kStrength;
  ParticleSet<2>& set = scene.add(m, {0, 0}, {std::ceil(kWidth / h) * h, top});
  scene.damping = 0.2;

  FootingResult r;
  const auto start = std::chrono::steady_clock::now();
  const double dt = scene.wave_step(0.5);
  struct Sample {
    double settlement, factor;
  };
  std::vector<Sample> curve;
  double pushed = 0;
  while (scene.time < end) {
    scene.step(dt);
    pushed += dt * -footing.velocity[1](scene.time);
    curve.push_back({pushed, -scene.skeleton.boundaries().reaction(4)[1] / kStrength});
  }
  r.wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  r.steps = scene.steps;
  const auto mean = [&](double from, double to) {
    Sample m{0, 0};
    int n = 0;
    for (std::size_t i = static_cast<std::size_t>(from * curve.size()); i < to * curve.size(); ++i, ++n)
      m.settlement += curve[i].settlement, m.factor += curve[i].factor;
    return Sample{m.settlement / n, m.factor / n};
  };
  r.factor = mean(0.9, 1).factor;
  const Sample a = mean(0.1, 0.15), b = mean(0.15, 0.2), c = mean(0.65, 0.7), d = mean(0.95, 1);
  r.initial_slope = (b.factor - a.factor) / (b.settlement - a.settlement);
  r.last_slope = (d.factor - c.factor) / (d.settlement - c.settlement);
  struct Cell {
    double sum = 0, square = 0;
    int n = 0;
  };
  std::map<std::pair<int, int>, Cell> cells;
  scene.each([&](const ParticleSet<2>& q, int p) {
    Cell& cell = cells[{static_cast<int>(q.position[0][p] / h), static_cast<int>(q.position[1][p] / h)}];
    const double mean_stress = (q.stress[0][p] + q.stress[1][p] + q.stress[2][p]) / 3;
    cell.sum += mean_stress, cell.square += mean_stress * mean_stress, ++cell.n;
  });
  double variance = 0;
  for (const auto& [key, cell] : cells) variance += std::max(0.0, cell.square - cell.sum * cell.sum / cell.n);
  r.roughness = std::sqrt(variance / set.count()) / kStrength;
  return r;
}

}  // namespace polder::verify
