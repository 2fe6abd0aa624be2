#include "tests/verify/one_layer_limit.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "coupling/memory_state.hpp"

namespace polder::verify {
namespace {

constexpr double kGrowth = 1e3;   // of the energy between the first third and the end
constexpr double kSpeed = 1e-10;  // of the initial velocities over the wave speed
constexpr double kBracket = 1.02;

Scene scene_of(const Block& b) {
  const Choice& c = b.choice;
  const double h = c.cell, height = (b.cells[1] + c.offset) * h;
  Scene s = wet_scene(c, b.cells[0] * h, height + 2 * h, 1e9);
  if (c.conductivity == 0) s.formulation = "dry";
  s.gravity = {};
  s.materials = {elastic_soil(1e7, 0.2, 0.4, c.conductivity)};
  if (c.conductivity == 0) s.materials[0].density_solid = 2650;
  const double width = b.free_side ? (b.cells[0] - 2 + c.offset) * h : b.cells[0] * h;
  s.bodies = {box(0, 0, width, height, c)};
  s.water.initial = coupling::WaterSpec::Initial::zero;
  return s;
}

double energy(const Simulation& s) {
  return column_of(s, "kinetic_energy[J]") + column_of(s, "elastic_energy[J]");
}

}  // namespace

bool grows(const Block& block, double dt, int steps) {
  Scene scene = scene_of(block);
  scene.numerics.time_step = dt;
  Simulation simulation(scene);
  coupling::MemoryState state;
  state.save(simulation);
  const double speed = kSpeed * block.choice.cell / wave_step(block);
  std::uint64_t random = 1;
  for (const char* name : {"body_0/velocity_x", "body_0/velocity_y"})
    for (double& v : state.arrays.at(name)) {
      random = random * 6364136223846793005ull + 1442695040888963407ull;
      v = speed * (static_cast<double>(random >> 11) * 0x1p-52 - 1);
    }
  state.load(simulation);
  double early = 0;
  for (int i = 0; i < steps; ++i) {
    simulation.step();
    if (i % 10 != 9) continue;
    const double now = energy(simulation);
    if (i < steps / 3)
      early = std::max(early, now);
    else if (!(now < kGrowth * early))
      return true;
    if (now > 1e-4) return true;  // before displacements matter: the start is below 1e-13 J
  }
  return false;
}

double first_unstable_step(const Block& block) {
  double low = 0.5 * predicted_step(block), high = low;
  while (!grows(block, high)) low = high, high *= 1.3;
  while (high == low) {  // half the prediction grew
    low /= 1.3;
    if (grows(block, low)) high = low;
  }
  while (high > kBracket * low) {
    const double middle = std::sqrt(low * high);
    (grows(block, middle) ? high : low) = middle;
  }
  return high;
}

double predicted_step(const Block& block) {
  return Simulation(scene_of(block)).step_limit().dt;
}

double wave_step(const Block& block) {
  Scene scene = scene_of(block);
  scene.numerics.courant = 1;
  return Simulation(scene).automatic_step();
}

}  // namespace polder::verify
