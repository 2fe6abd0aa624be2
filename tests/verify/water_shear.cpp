#include "tests/verify/water_shear.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace polder::verify {

using coupling::Boundary;
using coupling::PointFrame;
using coupling::WaterBoundary;

namespace {

constexpr double kDensity = 1000;

// Velocity along the plates: the steady profile and what is left of the start, a Fourier series.
double exact(const PlateFlow& f, double y, double time) {
  constexpr double pi = std::numbers::pi;
  const double nu = f.viscosity / kDensity;
  const bool pressed = f.drive == PlateFlow::Drive::pressure;
  double u = pressed ? 4 * f.speed * y * (1 - y) : f.speed * y;
  for (int k = 1; k < 200; ++k) {
    const double decay = std::exp(-k * k * pi * pi * nu * time);
    if (pressed)
      u -= k % 2 ? 32 * f.speed / std::pow(k * pi, 3) * std::sin(k * pi * y) * decay : 0.0;
    else
      u += (k % 2 ? -1 : 1) * 2 * f.speed / (k * pi) * std::sin(k * pi * y) * decay;
  }
  return u;
}

}  // namespace

PlateProfile plate_flow(const Choice& c, const PlateFlow& flow) {
  const double h = c.cell, length = 4 * h;
  Scene s = wet_scene(c, length, 1, flow.duration);
  s.gravity = {};
  s.numerics.time_step = flow.time_step;
  s.numerics.water_flip = flow.flip;
  if (flow.affine) s.numerics.water_transfer = coupling::Transfer::apic;
  s.water.initial = coupling::WaterSpec::Initial::zero;
  s.water.viscous = true;
  s.water.viscosity = flow.viscosity;
  s.water_bodies = {box(0, 0, length, 1, c)};
  const auto contact = flow.slips ? Boundary::WaterContact::slip : Boundary::WaterContact::no_slip;
  for (const int side : {2, 3}) {
    Boundary b;
    b.name = side == 2 ? "lower" : "upper";
    b.kind = Boundary::Kind::fixed;
    b.side = side;
    b.water = contact;
    if (side == 3 && flow.drive == PlateFlow::Drive::upper_plate) {
      b.kind = Boundary::Kind::velocity;
      b.velocity[0] = coupling::TimeTable{{0.0}, {flow.speed}};
      b.velocity[1] = coupling::TimeTable{};
    }
    s.boundaries.push_back(b);
  }
  for (const int side : {0, 1}) {
    WaterBoundary b;
    b.name = side == 0 ? "inlet" : "outlet";
    b.kind = WaterBoundary::Kind::pressure;
    b.side = side;
    b.value.value = {side == 0 && flow.drive == PlateFlow::Drive::pressure
                         ? 8 * flow.viscosity * flow.speed * length
                         : 0.0};
    s.water_boundaries.push_back(b);
  }
  Simulation sim(s);
  while (!sim.finished()) sim.step();
  PlateProfile r;
  const PointFrame f = sim.water_points();
  double square = 0, error = 0, most = 0, volume = 0;
  for (std::size_t p = 0; p < f.count(); ++p) {
    const double u = exact(flow, f.positions[3 * p + 1], sim.time()), v = f.fields[2].values[p];
    const double along = f.fields[0].values[3 * p], across = f.fields[0].values[3 * p + 1];
    most = std::max(most, std::abs(u));
    square += v * u * u, error += v * (along - u) * (along - u);
    r.largest = std::max(r.largest, std::abs(along - u));
    r.across = std::max(r.across, std::abs(across));
    r.speed += v * along, volume += v;
  }
  r.error = std::sqrt(error / square);
  r.largest /= most, r.across /= most, r.speed /= volume;
  double all = 0;
  constexpr int kStrips = 1000;
  for (int i = 0; i < kStrips; ++i) all += exact(flow, (i + 0.5) / kStrips, sim.time()) / kStrips;
  r.discharge = column_of(sim, "discharge:outlet[m3/s]") / all;
  r.water_error = column_of(sim, "water_mass_error[-]");
  r.steps = sim.steps();
  return r;
}

}  // namespace polder::verify
