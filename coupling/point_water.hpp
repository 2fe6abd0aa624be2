// Soil and its pore water on one set of material points, pore pressure at the points: formulations v-w and
// u-p. Saturated, explicit.
//
// v-w (Verruijt 2010; Jassim, Stolle & Vermeer 2013) keeps all inertia; points carry the velocities v of the
// grains and w of the water, and nodes solve
//   M_w dw/dt = n F_p + M_w g - B (w - v),   M_s dv/dt = F_sigma' + (1 - n) F_p + M_s g + B (w - v),
// with F_p = sum V p grad N, B = n^2 gamma_w / k of the soil at the node. u-p (Zhang et al. 2009; Zabala &
// Alonso 2011) moves the mixture, M dv/dt = F_sigma' + F_p + M g, and finds the flow at the nodes from
// Darcy's law, q = k / gamma_w (F_p / V + rho_w (g - dv/dt)). In both the water at a point follows
//   dp = -(K_w / n) (div v + div q) dt,   q = n (w - v) in v-w.
// The force sum V p grad N contains the condition p = 0 at free surfaces. Units SI, pressure positive in
// compression; equations and sources in docs/theory/point-water.md.
#pragma once

#include "coupling/explicit_water.hpp"
#include "coupling/one_layer.hpp"

namespace polder::coupling {

// Arrays of a world whose formulation has its water on the skeleton's points, after its bodies are there.
template <int D>
void add_point_water(World<D>& world);

// Pressure of the points at the start, and the velocity of their water.
template <int D>
void set_point_water(World<D>& world);

// Acceleration of the nodes by the pressure of the points into world.pore_water->acceleration [slots * 4];
// part of push_by_pressure().
template <int D>
void push_by_points(World<D>& world);

// Soil holds the water in its pores, and the water rests: for relaxation, see HeldWater.
template <int D>
void hold_point_water(World<D>& world, bool held);

template <int D>
mpm::MoveResult step_point_water(World<D>& world, const StepInput& in, long step);

// Cells and their pressure from the points as they are, for those who look at cells; no step needs them.
template <int D>
void find_cells_of_points(World<D>& world, double time);

// Longest step by the analysis of a uniform grid, and what sets it (point_water_limit.cpp).
struct PointWaterSoil {
  double modulus = 0;  // drained, of the P wave [Pa]
  double porosity = 0;
  double density = 0;       // of the grains [kg/m3]
  double conductivity = 0;  // [m/s]
};
MotionLimit point_water_limit(const Scene& scene, const PointWaterSoil& soil, double unit_weight);
// The least over all points, as they were at most 64 steps ago.
template <int D>
MotionLimit point_water_limit(World<D>& world);

}  // namespace polder::coupling
