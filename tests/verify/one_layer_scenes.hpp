// Scenes of the one-layer formulation with known answers, and what is measured in them. Used by the tests and
// by the program that prints the tables of docs/validation/one_layer.md. SI units.
#pragma once

#include <functional>
#include <map>
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
  double cell = 0.1;
  ShapeKind shape = ShapeKind::gimp;
  bool musl = true;
  double courant = 0.5;
  double conductivity = 1e-3;
  double bulk_modulus = 2.2e9;  // of the water
  double offset = 0;            // of the surface above a node, as a share of a cell
  int per_axis = 2;             // particles in a cell along each axis
  coupling::LockingCure locking = coupling::LockingCure::automatic;
};

mpm::MaterialParameters elastic_soil(double young, double poisson, double porosity, double conductivity,
                                     double density_solid = 2650);

// An empty one-layer scene on cells x cells with one dynamic stage.
Scene wet_scene(const Choice& choice, double width, double height, double duration);

// Sum over a history of a named column, NaN if there is none.
double column_of(const Simulation& simulation, const std::string& name);

// ---- consolidation under a surface load, loaded undrained at the start

struct Consolidation {
  std::vector<double> pressure_error;  // L2 norm over the load at each of the given times [-]
  double settlement_ratio = 0;         // settlement over the reference's at the last time [-]
  long steps = 0;
  double step = 0;  // largest [s]
  double seconds = 0;
};

// Terzaghi's column, H = 1 m, M = 11.1 MPa, 10 kPa; errors at the given time factors, ascending.
Consolidation terzaghi(const Choice& choice, const std::vector<double>& time_factors);

// Layer 1 over layer 2 on a closed base (Gray 1945; Schiffman & Stein 1970), compared with columns of a table
// of p [Pa] over depth z [m]: value(i, z) for the i-th of the times. Time runs `faster` times as fast as in
// the table, with conductivities as many times as large.
struct TwoLayer {
  double thickness[2], modulus[2], conductivity[2];
  double load = 0;
};
Consolidation two_layer(const Choice& choice, const TwoLayer& soil, const std::vector<double>& times,
                        const std::function<double(int, double)>& pressure, double settlement, double faster);

// Finite strain under a load and self weight (Gibson, England & Hussey 1967) with Cauchy stress M ln J; the
// excess pressure u over the initial depth a.
struct LargeStrain {
  double height, young, poisson, porosity, conductivity, load, buoyant_weight;
};
Consolidation large_strain(const Choice& choice, const LargeStrain& soil, const std::vector<double>& times,
                           const std::function<double(int, double)>& excess, double settlement,
                           double faster);

// ---- states of rest and small scenes

struct Rest {
  double pressure_error = 0;  // RMS over gamma_w H [-]
  double stress_error = 0;    // RMS of the vertical effective stress over its largest value [-]
  double speed = 0;           // largest at the end [m/s]
};
// Column 10 cells high plus the offset, switched on in equilibrium, then left alone.
Rest hydrostatic(const Choice& choice, double duration);
// Upward flow at `share` of the critical gradient, brought to steady state.
Rest upward_seepage(const Choice& choice, double share);

struct Strip {
  double roughness = 0;       // RMS of the (pi, pi) part of the pressure over the load [-]
  double middle = 0;          // pressure at mid-depth below the load over the load [-]
  double pressure_cells = 0;  // active at the end
};
// Strip load on a block 2 m x 1 m; returns after `duration` s.
Scene strip_scene(const Choice& choice, double duration, double jitter = 0);
Strip strip_load(const Choice& choice, double duration, double jitter = 0);

// Amplitude of a checkerboard of pressure, 1 Pa at the start, after `steps` steps.
double checkerboard_left(const Choice& choice, int steps);

struct Slump {
  double height = 0, runout = 0;      // [m]
  double volume = 0;                  // over the initial volume [-]
  double roughness = 0;               // over gamma_w times the height [-]
  double largest_speed = 0;           // over the whole run [m/s]
  double water_error = 0, steps = 0;  // relative error of the water's mass
};
Scene slump_scene(const Choice& choice, double duration);
Slump slump(const Choice& choice, double duration);

// ---- state of a simulation in memory

class MemoryState final : public coupling::StateVisitor {
 public:
  bool reading() const override { return reading_; }
  void reals(const std::string& name, Reals& values) override;
  void integers(const std::string& name, std::vector<int>& values) override;
  void number(const std::string& name, double& value) override;
  void count(const std::string& name, std::int64_t& value) override;

  void save(Simulation& simulation);
  void load(Simulation& simulation);
  // Names of what differs, bit by bit.
  std::vector<std::string> differences(const MemoryState& other) const;

  std::map<std::string, Reals> arrays;
  std::map<std::string, std::vector<int>> lists;
  std::map<std::string, double> numbers;
  std::map<std::string, std::int64_t> counts;

 private:
  bool reading_ = false;
};

}  // namespace polder::verify
