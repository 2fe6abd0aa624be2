// A program outside Polder: fills a scene by hand, steps it and asks for results on the way.
//
// Terzaghi's consolidation: a saturated elastic column of height H, drained at the top, carries its own
// weight in equilibrium when the load q arrives. Excess pore pressure at the base and settlement are compared
// with the series of Terzaghi (1923) in dimensionless time T = c_v t / H^2. SI units, pore pressure positive
// in compression.
#include <cmath>
#include <cstdio>
#include <numbers>

#include "core/error.hpp"
#include "coupling/simulation.hpp"

namespace {

using polder::Space;
using polder::coupling::Body;
using polder::coupling::Boundary;
using polder::coupling::InitialStress;
using polder::coupling::Scene;
using polder::coupling::Stage;

constexpr double kHeight = 1.0;         // H [m]
constexpr double kLoad = 1e4;           // q [Pa]
constexpr double kConductivity = 1e-3;  // k [m/s]

polder::mpm::MaterialParameters sand() {
  polder::mpm::MaterialParameters m;
  m.name = "sand";
  m.density_solid = 2650;
  m.porosity = 0.4;
  m.young = 1e7;
  m.poisson = 0.2;
  m.hydraulic_conductivity = kConductivity;
  return m;
}

Boundary on_side(const char* name, Boundary::Kind kind, int side) {
  Boundary b;
  b.name = name;
  b.kind = kind;
  b.side = side;
  return b;
}

Scene column() {
  Scene scene;
  scene.title = "Terzaghi's column";
  scene.formulation = "one-layer";
  scene.grid = {Space::plane_strain, {0, 0, 0}, {0.2, 1.2, 0}, 0.1, polder::mpm::ShapeKind::gimp};
  scene.materials.push_back(sand());

  Body body;
  body.name = "column";
  body.box = {{{0, 0, 0}, {0.2, kHeight, 0}}};
  body.stress.kind = InitialStress::Kind::k0;
  body.stress.k0 = {0.25};  // nu / (1 - nu): what an elastic column has under its own weight
  scene.bodies.push_back(body);

  scene.boundaries.push_back(on_side("left", Boundary::Kind::roller, 0));
  scene.boundaries.push_back(on_side("right", Boundary::Kind::roller, 1));
  scene.boundaries.push_back(on_side("base", Boundary::Kind::fixed, 2));
  Boundary load;
  load.name = "load";
  load.kind = Boundary::Kind::pressure;
  load.segment = {{{0.2, kHeight, 0}, {0, kHeight, 0}}};  // the soil lies to the left
  load.pressure = {{0.0}, {kLoad}};
  scene.boundaries.push_back(load);

  Stage stage;
  stage.name = "consolidation";
  stage.duration = 0.5;
  scene.stages.push_back(stage);
  return scene;
}

// Excess pressure over q at the depth z below the drained top.
double excess_pressure(double z, double time_factor) {
  double sum = 0;
  for (int n = 0; n < 200; ++n) {
    const double m = std::numbers::pi * (2 * n + 1) / 2;
    sum += 2 / m * std::sin(m * z / kHeight) * std::exp(-m * m * time_factor);
  }
  return sum;
}

// Settlement of the depth z over q H / M: the effective stress gained below it, integrated down to the base.
double settlement(double z, double time_factor) {
  double sum = (kHeight - z) / kHeight;
  for (int n = 0; n < 200; ++n) {
    const double m = std::numbers::pi * (2 * n + 1) / 2;
    sum -= 2 / (m * m) * std::cos(m * z / kHeight) * std::exp(-m * m * time_factor);
  }
  return sum;
}

}  // namespace

int main() try {
  const Scene scene = column();
  const polder::mpm::MaterialParameters& soil = scene.materials[0];
  const double unit_weight = scene.water.density * 9.81;
  const double consolidation = kConductivity * soil.wave_modulus() / unit_weight;  // c_v [m2/s]

  polder::coupling::Simulation simulation(scene);
  const polder::coupling::Vector3 base{0.15, 0.05, 0};
  const int top = simulation.probe_particle({0.1, kHeight, 0});
  const double depth = kHeight - simulation.particle_quantity(top, "position_y");
  const double hydrostatic = simulation.cell_quantity(base, "pore_pressure");

  std::printf("%ld particles, %ld pressure cells, step limit %.3g s (%s)\n", simulation.particles(),
              simulation.pressure_cells(), simulation.step_limit().dt,
              simulation.step_limit().reason.c_str());
  std::printf("%6s %21s %21s\n%6s %10s %10s %10s %10s\n", "", "excess pressure / q", "settlement M / (q H)",
              "T", "Polder", "exact", "Polder", "exact");
  bool agrees = true;
  for (const double target : {0.05, 0.1, 0.2, 0.4}) {
    while (simulation.time() * consolidation / (kHeight * kHeight) < target) simulation.step();
    const double t = simulation.time() * consolidation / (kHeight * kHeight);
    const double p = (simulation.cell_quantity(base, "pore_pressure") - hydrostatic) / kLoad;
    const double s =
        -simulation.particle_quantity(top, "displacement_y") * soil.wave_modulus() / (kLoad * kHeight);
    const double p_exact = excess_pressure(kHeight - base[1], t), s_exact = settlement(depth, t);
    std::printf("%6.3f %10.4f %10.4f %10.4f %10.4f\n", t, p, p_exact, s, s_exact);
    agrees = agrees && std::abs(p - p_exact) < 0.005 && std::abs(s - s_exact) < 0.005;
  }
  std::printf("%s after %ld steps\n", agrees ? "agrees" : "DOES NOT AGREE", simulation.steps());
  return agrees ? 0 : 1;
} catch (const polder::InputError& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return static_cast<int>(polder::ExitCode::bad_input);
}
