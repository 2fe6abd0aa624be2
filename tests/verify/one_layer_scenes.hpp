// Scenes of water in cells (formulations one-layer and higo) with known answers, what they are built from.
// Used by the tests and by the program that prints the tables of docs/validation/one_layer.md. SI units.
#pragma once

#include <string>
#include <vector>

#include "coupling/simulation.hpp"

namespace polder::verify {

using coupling::Scene;
using coupling::Simulation;
using mpm::ShapeKind;

inline constexpr double kGravity = 9.81;
inline constexpr double kUnitWeight = 9810;  // of water [N/m3]

// What all scenes choose from.
struct Choice {
  std::string formulation = "one-layer";
  double cell = 0.1;
  ShapeKind shape = ShapeKind::gimp;
  bool musl = true;
  double courant = 0.5;
  double conductivity = 1e-3;
  double bulk_modulus = 2.2e9;  // of the water
  double offset = 0;            // of the surface above a node, as a share of a cell
  int per_axis = 2;             // particles in a cell along each axis
  double rhie_chow = 0.05;      // chi
  coupling::LockingCure locking = coupling::LockingCure::automatic;
  coupling::PressureMethod pressure = coupling::PressureMethod::projected;  // of water with its own points
  // Water on the soil's points.
  coupling::DragStep drag = coupling::DragStep::implicit;
  coupling::PointPressure point_pressure = coupling::PointPressure::cell_mean;
  bool smooth_rates = false;
};

mpm::MaterialParameters elastic_soil(double young, double poisson, double porosity, double conductivity,
                                     double density_solid = 2650);

// An empty scene on cells x cells with one dynamic stage.
Scene wet_scene(const Choice& choice, double width, double height, double duration);

// Sum over a history of a named column, NaN if there is none.
double column_of(const Simulation& simulation, const std::string& name);

// Soil in a rectangle, with the scene's material of that number.
coupling::Body box(double x0, double y0, double x1, double y1, const Choice& choice, int material = 0);
// Pressure on the level surface between two places [Pa], compression positive.
coupling::Boundary load(double from_x, double to_x, double height, double pressure);
// Highest point of the soil now [m].
double top_of(const Simulation& simulation);

}  // namespace polder::verify
