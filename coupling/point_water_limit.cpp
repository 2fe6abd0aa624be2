// The longest stable step of water on the skeleton's points, explicitly. See point_water.hpp.
//
// A plane wave that changes its sign from step to step, a(x) = sin^2(theta/2) = 1, is where the leap-frog of
// velocities and stresses loses its stability. With stiffnesses K, masses M and drag C of grains and water,
//   K = {{E + (1-n)^2 Q, n (1-n) Q}, {n (1-n) Q, n^2 Q}},  Q = K_w / n,  M = diag((1-n) rho_s, n rho_w),
//   C = beta {{1, -1}, {-1, 1}},  beta = n^2 gamma_w / k,
// the step is stable while (dt/h)^2 K + dt C / 2 < M (drag by the velocities of the last step) or
// (dt/h)^2 K < M + dt C / 2 (by those of this one), as matrices: at K = 0 the first gives dt = 2 / r. In u-p
// the wave and Darcy flow at the old pressure give (dt/dt_w)^2 + dt/dt_k = 1, dt_w = h / c_u,
// dt_k = h^2 gamma_w / (2 k Q).
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "core/error.hpp"
#include "coupling/point_water.hpp"

namespace polder::coupling {
namespace {

// See kUslFactor in explicit_water.cpp.
constexpr double kUslFactor = 2;

struct Pencil {
  double stiffness[3], drag, mass[2];  // k00, k01, k11 over h^2; beta; of grains and water

  // Least eigenvalue of M -+ dt C / 2 - dt^2 K is not negative.
  bool stable(double dt, bool implicit_drag) const {
    const double c = (implicit_drag ? 0.5 : -0.5) * dt * drag, s = dt * dt;
    const double a = mass[0] + c - s * stiffness[0], b = -c - s * stiffness[1],
                 d = mass[1] + c - s * stiffness[2];
    return a > 0 && d > 0 && a * d > b * b;
  }
  double limit(bool implicit_drag) const {
    double low = 0, high = std::sqrt(mass[0] / stiffness[0]);
    while (stable(high, implicit_drag) && high < 1e9) low = high, high *= 2;
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (low + high);
      (stable(middle, implicit_drag) ? low : high) = middle;
    }
    return low;
  }
};

}  // namespace

MotionLimit point_water_limit(const Scene& scene, const PointWaterSoil& soil, double unit_weight) {
  const bool kept = find_formulation(scene.formulation)->inertia == RelativeInertia::kept;
  const bool musl = scene.numerics.order == StressOrder::musl && scene.numerics.transfer == Transfer::flip;
  const double h = scene.grid.cell, factor = musl ? 1 : kUslFactor;
  const double n = soil.porosity, q = scene.water.bulk_modulus / n, water = scene.water.density;
  const double rho = (1 - n) * soil.density + n * water;
  const double wave = h * std::sqrt(rho / (factor * (soil.modulus + q)));
  MotionLimit limit{wave, "water wave"};
  if (kept) {
    const bool implicit_drag = scene.numerics.drag == DragStep::implicit;
    Pencil p;
    p.stiffness[0] = soil.modulus + (1 - n) * (1 - n) * q, p.stiffness[1] = n * (1 - n) * q;
    p.stiffness[2] = n * n * q;
    for (double& k : p.stiffness) k *= factor / (h * h);
    p.mass[0] = (1 - n) * soil.density, p.mass[1] = n * water;
    p.drag = n * n * unit_weight / soil.conductivity;
    limit.dt = p.limit(implicit_drag);
    const double rate = p.drag * (1 / p.mass[0] + 1 / p.mass[1]);
    if (!implicit_drag && limit.dt * rate > 1) limit.reason = "drag";
  } else {
    const double darcy = h * h * unit_weight / (2 * soil.conductivity * q);
    // (dt / wave)^2 + dt / darcy = 1
    const double b = 0.5 * wave / darcy;
    limit.dt = wave / (b + std::sqrt(b * b + 1));
    if (limit.dt < 0.7 * wave) limit.reason = "Darcy flow";
  }
  return limit;
}

namespace {

template <int D>
MotionLimit find_limit(const World<D>& world) {
  MotionLimit least{std::numeric_limits<double>::infinity(), "water wave"};
  const bool follows_porosity = world.scene.kozeny_carman();
  for (const auto& body : world.skeleton.bodies()) {
    const ParticleSet<D>& set = *body;
    const mpm::MaterialParameters& m = world.materials[set.material];
    if (set.pore_pressure.empty()) {
      const double dry = world.scene.grid.cell / std::sqrt(m.wave_modulus() / m.dry_density());
      if (dry < least.dt) least = {dry, "skeleton wave"};
      continue;
    }
    // The extremes of porosity and conductivity, each way.
    constexpr double kFar = std::numeric_limits<double>::infinity();
    double n[2] = {kFar, 0}, k[2] = {kFar, 0};
    for (int p = 0; p < set.slots(); ++p) {
      if (set.id[p] < 0) continue;
      const double pores = 1 - set.mass[p] / (set.density_solid * set.volume[p]);
      const double conductivity = set.conductivity[p] * (follows_porosity ? kozeny_carman(pores) : 1);
      n[0] = std::min(n[0], pores), n[1] = std::max(n[1], pores);
      k[0] = std::min(k[0], conductivity), k[1] = std::max(k[1], conductivity);
    }
    if (!(n[0] > 0 && n[1] < 1))
      throw NumericalError("body '" + set.name + "': the porosity of its points runs from " +
                           std::to_string(n[0]) + " to " + std::to_string(n[1]));
    for (const double pores : n)
      for (const double conductivity : k) {
        const PointWaterSoil soil{m.wave_modulus(), pores, set.density_solid, conductivity};
        const MotionLimit limit = point_water_limit(world.scene, soil, world.unit_weight());
        if (limit.dt < least.dt) least = limit;
      }
  }
  return least;
}

}  // namespace

template <int D>
MotionLimit point_water_limit(World<D>& world) {
  PoreWater<D>& water = *world.pore_water;
  PointWater<D>& points = *water.points;
  if (!(water.explicit_limit.dt > 0)) {
    const MotionLimit found = find_limit(world);
    water.explicit_limit.dt = found.dt;
    points.limit_reason = found.reason;
  }
  return {water.explicit_limit.dt, points.limit_reason};
}

template MotionLimit point_water_limit<2>(World<2>&);
template MotionLimit point_water_limit<3>(World<3>&);

}  // namespace polder::coupling
