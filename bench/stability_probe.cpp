#include "bench/stability_probe.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/error.hpp"
#include "coupling/memory_state.hpp"
#include "coupling/simulation.hpp"
#include "tests/verify/higo_scenes.hpp"
#include "tests/verify/point_water_scenes.hpp"
#include "tests/verify/two_layer_waves.hpp"

namespace polder::bench {

using coupling::Scene;
using coupling::Simulation;

namespace {

constexpr int kCells[] = {8, 6};
constexpr int kSteps = 240;
constexpr double kSpeed = 1e-10;   // of the random velocities over the wave speed
constexpr double kRunaway = 1e12;  // growth at any time, before positions change
constexpr double kGravity = 9.81;
constexpr double kCohesion = 1e3;  // of soil that yields: far above what random velocities stress it by [Pa]
constexpr double kAlpha = 2, kPower = 2;  // van Genuchten

double height_of(const Specimen& s) {
  return (kCells[1] + static_cast<double>(s.per_axis / 2) / s.per_axis) * Specimen::kCell;
}

double load_of(const Specimen& s) {
  return s.friction > 0 ? Specimen::kFailingLoad : Specimen::kLoad;
}

double wave_modulus() {
  constexpr double nu = Specimen::kPoisson;
  return Specimen::kYoung * (1 - nu) / (1 + nu) / (1 - 2 * nu);
}

verify::Choice choice_of(const Specimen& s) {
  verify::Choice c;
  c.formulation = s.formulation, c.cell = Specimen::kCell, c.shape = s.shape, c.musl = s.musl;
  c.conductivity = s.conductivity, c.bulk_modulus = s.bulk_modulus, c.per_axis = s.per_axis;
  c.pressure = s.pressure, c.drag = s.drag;
  return c;
}

Scene scene_of(const Specimen& s, bool loaded) {
  const verify::Choice c = choice_of(s);
  const double h = c.cell, width = kCells[0] * h, height = height_of(s);
  Scene scene = verify::wet_scene(c, width, height + 2 * h, 1e9);
  scene.numerics.flip = scene.numerics.water_flip = s.flip;
  coupling::Material soil = verify::elastic_soil(Specimen::kYoung, Specimen::kPoisson, s.porosity,
                                                 s.conductivity, s.density_ratio * Specimen::kWater);
  if (s.saturation < 1) {
    soil.retention.model = fdm::Retention::Model::van_genuchten;
    soil.retention.alpha = kAlpha, soil.retention.n = kPower;
    scene.water.initial_saturation = s.saturation;
  }
  if (s.friction > 0) {
    soil.model = mpm::MaterialModel::mohr_coulomb;
    soil.friction.value = {s.friction}, soil.dilation.value = {s.dilation}, soil.cohesion.value = {kCohesion};
  }
  scene.materials = {soil};
  scene.bodies = {verify::box(0, 0, width, height, c)};
  if (s.random) scene.bodies[0].jitter = 0.8;  // to either side of the middle
  if (!loaded) {
    scene.gravity = {};
    if (s.saturation >= 1) scene.water.initial = coupling::WaterSpec::Initial::zero;
    return scene;
  }
  scene.gravity = {0, -kGravity, 0};
  scene.bodies[0].stress.kind = coupling::InitialStress::Kind::k0;
  scene.bodies[0].stress.k0 = {s.friction > 0 ? 1 - std::sin(s.friction)
                                              : Specimen::kPoisson / (1 - Specimen::kPoisson)};
  scene.boundaries = {verify::load(0.5 * width, 0, height, load_of(s))};
  return scene;
}

double random_growth(const Specimen& s, double step) {
  Scene scene = scene_of(s, false);
  scene.numerics.time_step = step;
  Simulation simulation(scene);
  coupling::MemoryState state;
  state.save(simulation);
  const double modulus =
      Specimen::kYoung * (1 - Specimen::kPoisson) / (1 + Specimen::kPoisson) / (1 - 2 * Specimen::kPoisson);
  const double speed = kSpeed * std::sqrt(modulus / s.density());
  std::uint64_t random = 1;
  for (auto& [name, values] : state.arrays)
    if (name.find("/velocity_x") != std::string::npos || name.find("/velocity_y") != std::string::npos)
      for (double& v : values) {
        random = random * 6364136223846793005ull + 1442695040888963407ull;
        v = speed * (static_cast<double>(random >> 11) * 0x1p-52 - 1);
      }
  state.load(simulation);
  const double start = verify::column_of(simulation, "kinetic_energy[J]");
  double early = 0, late = 0;
  try {
    for (int i = 0; i < kSteps; ++i) {
      simulation.step();
      const double now = verify::column_of(simulation, "kinetic_energy[J]");
      if (!(now < kRunaway * start)) return kRunaway;
      (i < kSteps / 3 ? early : late) = std::max(i < kSteps / 3 ? early : late, now);
    }
  } catch (const NumericalError&) {
    return kRunaway;
  }
  return late / early;
}

}  // namespace

bool Specimen::is_explicit() const {
  return formulation == "higo" || formulation == "v-w" || formulation == "u-p" ||
         (formulation == "two-layer" && pressure == coupling::PressureMethod::compressible);
}

double chosen_step(const Specimen& s) {
  return Simulation(scene_of(s, false)).automatic_step();
}

double printed_limit(const Specimen& s) {
  return Simulation(scene_of(s, false)).step_limit().dt;
}

// docs/theory/time-step.md: the drained wave with the help of undrained water, and the shear wave, which has
// none; of layers the wave of the grains alone.
double theoretical_limit(const Specimen& s) {
  const verify::Choice c = choice_of(s);
  const double grains = s.density_ratio * Specimen::kWater;
  if (s.saturation < 1 && s.is_explicit()) return std::nan("");  // air in the pores, no formula
  if (s.formulation == "v-w" || s.formulation == "u-p") {
    const double limit = verify::analysed_point_limit(c, s.porosity, grains);
    // The search of the analysis ends at 1e-12 s, drag in the tightest soils limits below that.
    const bool dragged = s.formulation == "v-w" && s.drag == coupling::DragStep::by_last_velocities;
    return dragged ? std::min(limit, verify::formula_limits(c, s.porosity, grains).drag) : limit;
  }
  if (s.has_points_of_water() && s.is_explicit())
    return verify::analysed_mixture_limit(c, s.porosity, grains);
  const double shear = Specimen::kYoung / (2 * (1 + Specimen::kPoisson));
  const double modulus = wave_modulus(), h = Specimen::kCell;
  if (s.formulation == "two-layer") return h / std::sqrt(modulus / s.dry_density());
  if (s.formulation == "two-layer-darcy")
    return h / std::sqrt(modulus / ((1 - s.porosity) * (grains - Specimen::kWater)));
  const double speed = std::sqrt(modulus / s.density());
  if (s.formulation == "higo") {
    // The largest a of a (1 - 3/4 a), or of a (1 + 3/4 a), is 1/3 or 7/4.
    const double skeleton = h / speed * std::sqrt(s.musl ? 3 : 4.0 / 7);
    return 1 / std::hypot(1 / verify::analysed_limit(c, s.porosity, s.density()), 1 / skeleton);
  }
  const double b = Specimen::kWater * kGravity * h / (4 * s.density() * s.conductivity * speed);
  return std::min(h / speed * (b + std::sqrt(1 + b * b)), h / std::sqrt(shear / s.density()));
}

const char* to_string(Mark mark) {
  constexpr const char* kNames[] = {"stable", "drift", "noise", "grows", "broke down"};
  return kNames[static_cast<int>(mark)];
}

Mark Verdict::mark() const {
  if (broke_down) return Mark::broke_down;
  if (growth > kGrowth) return Mark::grows;
  if (noise > kNoise) return Mark::noise;
  if (std::abs(water) > kWaterDrift || gain > kGain) return Mark::drift;
  return Mark::stable;
}

Verdict probe(const Specimen& s, double step) {
  Verdict v;
  v.growth = random_growth(s, step);
  const double modulus = wave_modulus(), load = load_of(s);
  // Of soil that the load strikes without any help from the water.
  const double struck = load / std::sqrt(modulus * s.dry_density());
  const double stored = 0.5 * load * load / modulus * 0.5 * kCells[0] * Specimen::kCell * height_of(s);
  // Soil that yields moves on for good: for the same time with every step.
  const int steps = s.friction > 0
                        ? std::clamp(static_cast<int>(kSteps * chosen_step(s) / step), kSteps / 4, 4 * kSteps)
                        : kSteps;
  try {
    Scene scene = scene_of(s, true);
    scene.numerics.time_step = step;
    Simulation simulation(scene);
    for (int i = 0; i < steps; ++i) {
      simulation.step();
      // Many times that, what the load alone makes of the grains of the block, and the flow that it drives
      // out.
      constexpr double kTooFast = 30;
      const double thrown = load / (s.dry_density() * height_of(s)) + kGravity;
      const double flow = s.has_points_of_water() ? s.conductivity / s.porosity * load /
                                                        (Specimen::kWater * kGravity * 0.5 * Specimen::kCell)
                                                  : 0.0;
      const double speed = verify::column_of(simulation, "max_speed[m/s]");
      if (!(speed < kTooFast * struck + 2 * thrown * simulation.time() + 2 * flow)) {
        v.broke_down = true, v.reason = "speed";
        return v;
      }
      if (i >= steps / 2)
        v.noise = std::max(v.noise, verify::column_of(simulation, "pressure_roughness[Pa]") / load);
    }
    v.water = verify::column_of(simulation, "water_mass_error[-]");
    v.gain = -verify::column_of(simulation, "transfer_loss[J]") / stored;
  } catch (const NumericalError& e) {
    v.broke_down = true, v.reason = e.what();
  }
  return v;
}

}  // namespace polder::bench
