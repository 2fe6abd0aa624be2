// A scene: everything a simulation needs to know before it starts, in SI units and radians, typed and
// complete. The case file is read into it (app/), programs that link Polder can fill it by hand. A scene
// holds no state.
//
// Points have three components; 2D scenes (plane strain, axisymmetric) use the first two. The last used axis
// points up: y in 2D, z in 3D. In axisymmetric scenes x is the radius.
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "core/grid.hpp"
#include "fdm/retention.hpp"
#include "mpm/material/parameters.hpp"
#include "mpm/shape_kind.hpp"

namespace polder::coupling {

using Vector3 = std::array<double, 3>;

// A quantity in time: piecewise linear, constant outside; one entry = constant.
struct TimeTable {
  std::vector<double> time{0.0};  // [s]
  std::vector<double> value{0.0};
  double at(double t) const;
  bool operator==(const TimeTable&) const = default;
};

// ---- formulation: the four switches of the table in the manual
// ------------------------------------------------------

enum class WaterCarrier { none, cells, skeleton, particles };
enum class RelativeInertia { neglected, kept };
enum class PressureMethod { projected, compressible };
enum class SaturationKind { saturated, unsaturated, three_phase };

struct Formulation {
  std::string name = "dry";
  WaterCarrier carrier = WaterCarrier::none;
  RelativeInertia inertia = RelativeInertia::neglected;
  PressureMethod pressure = PressureMethod::projected;
  SaturationKind saturation = SaturationKind::saturated;
  bool available = false;  // built into this version
  std::string source;      // author, year
  bool dispersed = false;  // solids are grains in the water that touch where they are dense, no skeleton
  // `pressure` is that of the preset unless NumericsSpec::pressure says otherwise.
  bool chooses_pressure() const {
    return carrier == WaterCarrier::particles && inertia == RelativeInertia::kept;
  }
  bool operator==(const Formulation&) const = default;
};

// All presets of the design's table, in its order; available ones can be run.
const std::vector<Formulation>& formulations();
const Formulation* find_formulation(const std::string& name);

// ---- grid and numerics
// ----------------------------------------------------------------------------------------------

struct GridSpec {
  Space space = Space::plane_strain;
  Vector3 origin{};
  Vector3 size{};   // a whole number of cells along each axis
  double cell = 0;  // [m]
  mpm::ShapeKind shape = mpm::ShapeKind::gimp;
  bool operator==(const GridSpec&) const = default;
};

enum class StressOrder { musl, usl };  // stresses from re-mapped momenta, or from the updated grid velocity
enum class Transfer {
  flip,
  apic,
  tpic
};  // particle velocity: FLIP/PIC blend, affine, Taylor (velocity gradient)
enum class LockingCure { automatic, none, cell_average };
// Drag between grains and water by the velocities of the last step, or implicitly by those of this one.
enum class DragStep { implicit, by_last_velocities };
// Points of one cell share their mean head; or each has its own pressure; or full cells are integrated at
// their centre (point_quadrature.hpp).
enum class PointPressure { cell_mean, points, mixed };

struct NumericsSpec {
  StressOrder order = StressOrder::musl;
  Transfer transfer = Transfer::flip;
  double flip = 0.99;  // share of FLIP in the blend [-]
  // Points of water: a blend with this share of FLIP, as the soil's, or affine velocities (apic) for water
  // that splashes by itself. Affine water in soil under MUSL feeds energy to undrained motion: the soil's
  // nodal velocities lag behind what drag has made equal, the water's do not (docs/theory/two-layer.md).
  Transfer water_transfer = Transfer::flip;
  double water_flip = 0.99;
  LockingCure locking = LockingCure::automatic;
  // Of formulations whose water has points of its own and keeps its relative inertia; others have one way.
  PressureMethod pressure = PressureMethod::projected;
  DragStep drag = DragStep::implicit;  // where points carry soil and water with velocities of their own
  PointPressure point_pressure = PointPressure::cell_mean;  // where it is at the points
  bool smooth_rates = false;        // the change of volume that it follows is smoothed over the nodes
  double courant = 0.5;             // step as a share of the limit of the skeleton wave [-]
  std::optional<double> time_step;  // fixed step [s]; warned about or refused beyond the limit
  double rhie_chow = 0.05;          // chi [-]
  double solver_tolerance = 1e-7;   // relative, pressure
  // Retention curves and flows through upright faces as means over the height of a cell: free surfaces within
  // cells. Rigid skeleton only.
  bool cell_means = false;
  // Soil at rest sleeps in dynamic stages (mpm/sleep.hpp). 0: after the size of a cell, see
  // coupling/sleep.hpp.
  bool sleep = false;
  double sleep_velocity = 0;  // [m/s]
  double sleep_delay = 0;     // [s]
  double sleep_force = 0.1;   // out of balance over weight [-]
  bool operator==(const NumericsSpec&) const = default;
};

// ---- materials
// ------------------------------------------------------------------------------------------------------

// Share of the suction that acts as effective stress, chi in sigma' = sigma - (1 - chi) u_a - chi u_w (Bishop
// 1959): the effective degree of saturation (S - S_r)/(1 - S_r) (Lu, Godt & Wu 2010; chi s stays bounded as
// soil dries), the whole one, or nothing of it.
enum class BishopFactor { saturation, effective_saturation, none };

// What water that moves relative to the grains feels, see drag_law.hpp.
enum class DragLaw { darcy, forchheimer, ergun, gidaspow, di_felice };

// The skeleton's law (mpm) and what water finds in its pores (fdm).
struct Material : mpm::MaterialParameters {
  Material() = default;
  Material(mpm::MaterialParameters skeleton) : mpm::MaterialParameters(std::move(skeleton)) {}  // implicit

  fdm::Retention retention;        // saturated at any pressure unless given
  std::vector<double> anisotropy;  // factors on the conductivity along the axes; empty: 1
  bool kozeny_carman = false;      // conductivity follows the porosity, n^3 / (1 - n)^2
  DragLaw drag_law = DragLaw::darcy;
  double forchheimer = 0;     // b in i = q / k + b q^2 [s2/m2]
  double grain_diameter = 0;  // of drag laws that know grains [m]
  // Porosity above which grains without effective stress (dispersed ones: any) have no contact, see
  // fluidisation.hpp; 0: always some
  double fluidisation_porosity = 0;
  BishopFactor bishop = BishopFactor::effective_saturation;
  double capillary_suction = 0;  // suction at which the capillary cohesion is all there [Pa]
  // Laws that know grains find the conductivity themselves.
  bool drag_of_grains() const { return drag_law != DragLaw::darcy && drag_law != DragLaw::forchheimer; }
  bool retains() const { return retention.model != fdm::Retention::Model::saturated; }
  bool operator==(const Material&) const = default;
};

// Kozeny (1927), Carman (1937): conductivity goes with n^3 / (1 - n)^2 of the porosity n.
inline double kozeny_carman(double porosity) {
  return porosity * porosity * porosity / ((1 - porosity) * (1 - porosity));
}

// ---- water
// ----------------------------------------------------------------------------------------------------------

struct WaterSpec {
  double density = 1000;        // [kg/m3]
  double bulk_modulus = 2.2e9;  // [Pa], may be infinite
  double viscosity = 1e-3;  // dynamic [Pa s]; of drag laws, intrinsic permeabilities, and shear if viscous
  bool viscous = false;     // water with points of its own resists shear
  // Polyline, soil below it is saturated; empty = all soil of porous materials is. In 3D the first two
  // components of its points are x and z, and it is the same at every y.
  std::vector<Vector3> phreatic;
  double saturation_above = 0;  // degree of saturation above it [-]
  double suction_above = 0;     // suction above it [Pa]
  // With retention curves: degree of saturation above the phreatic line, or everywhere where there is none.
  std::optional<double> initial_saturation;
  // Pore pressure below it at the start: none, at rest, steady flow under the conditions of time 0, or the
  // given field (undrained loading before the first stage, for example).
  enum class Initial { zero, hydrostatic, steady, field } initial = Initial::hydrostatic;
  // field: pressure = initial_pressure + initial_gradient * (height - initial_datum) [Pa], [Pa/m], [m]
  double initial_pressure = 0, initial_gradient = 0, initial_datum = 0;
  std::optional<TimeTable> outside_level;  // level of open water standing over the soil's surface [m]
  bool operator==(const WaterSpec&) const = default;
};

// Where water may enter or leave: a part of a side of the grid, or of the soil's own surface. Everywhere else
// the sides are impermeable, and the soil's surface lets water out where it stands under pressure.
struct WaterBoundary {
  std::string name;
  enum class Kind {
    head,      // hydrostatic below the water level; above it a seepage face (unsaturated) or impermeable
    pressure,  // one pore pressure
    impermeable,
    surface,      // of a side: the soil ends there as at its free surface
    flux,         // water enters at a given rate whatever the soil can take
    rain,         // the same as long as the soil can take it; what it cannot runs off. Acts on plan area
    evaporation,  // water leaves at a given rate until the soil is as dry as the air
    seepage_face  // water leaves where its pressure would be positive; none enters
  } kind = Kind::head;
  int side = 0;                     // 2 * axis + (0 lower, 1 upper); kOnSurface: the soil's free surface
  std::optional<Vector3> from, to;  // part of the side or of the surface, all of it if absent
  TimeTable value;                  // head: level [m]; pressure: [Pa]; flux, rain, evaporation: [m/s]
  double limit_suction = 0;         // evaporation [Pa]
  static constexpr int kOnSurface = -1;
  bool operator==(const WaterBoundary&) const = default;
};

// Lines inside the grid at which water is taken or given, or which it cannot cross; 2D only.
struct WaterLine {
  std::string name;
  enum class Kind {
    well,   // gives (rate > 0) or takes (rate < 0) water along its length
    drain,  // takes water where its pressure exceeds that of the drain
    sheet   // impermeable
  } kind = Kind::drain;
  std::vector<Vector3> line;  // corners of the polyline
  TimeTable rate;             // well [m2/s, per metre of thickness]
  // Well: pressure in it at which it takes or gives no more, none: no limit; drain: its pressure, else 0
  // [Pa].
  std::optional<double> limit_pressure;
  bool operator==(const WaterLine&) const = default;
};

// ---- bodies
// ---------------------------------------------------------------------------------------------------------

struct InitialStress {
  enum class Kind { none, k0, field } kind = Kind::none;
  std::vector<double> k0;  // horizontal to vertical effective stress, one for each layer from the top
  std::vector<double> layer_depth;  // lower boundary of each layer but the last, below the body's surface [m]
  // field: effective stress {xx, yy, zz, xy, yz, zx} = value + gradient * (height - datum) [Pa], [Pa/m], [m]
  std::array<double, 6> value{}, gradient{};
  double datum = 0;
  bool operator==(const InitialStress&) const = default;
};

// A property of a body that scatters in space (random_field.hpp): the material's value times a random field
// of mean 1. cohesion: all of the cohesion curve; friction: the tangent of the friction angle;
// shear_strength: the peak undrained strength; conductivity: the hydraulic conductivity.
struct RandomProperty {
  enum class Property { cohesion, friction, shear_strength, conductivity } property = Property::cohesion;
  enum class Distribution { lognormal, normal } distribution = Distribution::lognormal;
  enum class Correlation { exponential, gaussian } correlation = Correlation::exponential;
  double coefficient_of_variation = 0;  // standard deviation over mean [-]
  Vector3 correlation_length{};         // along each axis [m]
  int seed = 1;
  bool operator==(const RandomProperty&) const = default;
};

struct Body {
  std::string name;
  int material = 0;  // index into Scene::materials
  // Exactly one shape: polygon, box, disk (2D) or ball (3D). In 3D a polygon is the section of a prism across
  // y: the first two components of its points are x and z.
  std::vector<Vector3> polygon;
  std::optional<std::array<double, 2>> extrude;  // of the prism along y [m]; absent: through the whole grid
  std::optional<std::array<Vector3, 2>> box;     // lower and upper corner
  std::optional<Vector3> centre;                 // of a disk or ball
  double radius = 0;
  int particles_per_axis = 2;  // particles in a cell along each axis
  double jitter = 0;           // random displacement as a share of the particle spacing [0, 0.9]
  int seed = 1;
  Vector3 velocity{};  // [m/s]
  double spin = 0;     // 2D: angular velocity about the body's centroid [rad/s], counter-clockwise
  InitialStress stress;
  std::vector<RandomProperty> random;
  bool operator==(const Body&) const = default;
};

// ---- mechanical boundaries
// ------------------------------------------------------------------------------------------

struct Boundary {
  std::string name;
  // tied: this side and the one across move alike, an endless row of equal columns; for motion small against
  // a cell
  enum class Kind { fixed, roller, friction, velocity, free, tied, traction, pressure } kind = Kind::roller;
  // A side of the grid (2 * axis + (0 lower, 1 upper)), a segment from -> to (2D) or a plane polygon (3D).
  // The soil lies to the left of the segment, seen from `from` to `to`, and on the side of the polygon from
  // which its corners run counter-clockwise; loads act on the material surface that lies there.
  std::optional<int> side;
  std::optional<std::array<Vector3, 2>> segment;  // also restricts a side to a part of it when both are given
  std::vector<Vector3> polygon;
  // What walls do to water with points of its own: it slips along them, or sticks to them and moves as they
  // do.
  enum class WaterContact { slip, no_slip } water = WaterContact::slip;
  double coefficient = 0;                            // friction: tan of the friction angle [-]
  std::array<std::optional<TimeTable>, 3> velocity;  // velocity: prescribed components [m/s], others free
  std::array<TimeTable, 3> traction;                 // traction: force per area [Pa] on the surface
  TimeTable pressure;                                // pressure: normal compression [Pa]; acts into the soil
  bool loads() const { return kind == Kind::traction || kind == Kind::pressure; }
  bool is_wall() const { return !loads() && kind != Kind::free && kind != Kind::tied; }
  bool operator==(const Boundary&) const = default;
};

// ---- stages, measures, output
// ---------------------------------------------------------------------------------------

struct Stage {
  std::string name;
  // seepage: the skeleton is rigid; quasi_static: it follows in equilibrium while water flows
  enum class Mode { equilibrium, seepage, quasi_static, dynamic } mode = Mode::dynamic;
  enum class Until { duration, failure, steady } until = Until::duration;
  double duration = 0;             // simulated time [s]; with equilibrium or an event: at most
  double damping = 0;              // local damping alpha [0, 1); equilibrium with 0: relaxation
  bool plastic = true;             // false: materials respond elastically in this stage
  bool sticking = false;           // true: friction boundaries hold without slip in this stage
  bool water_flows = true;         // false: pore pressure stays as it is
  double gravity_ramp = 0;         // time over which gravity grows from 0 to its value [s]
  double force_tolerance = 1e-3;   // equilibrium, quasi_static: out-of-balance force ratio
  double energy_tolerance = 1e-3;  // equilibrium: kinetic energy ratio
  bool reset_displacement =
      false;  // at the end of the stage displacements (and plastic strains) start from zero
  bool reset_velocity = false;
  double output_every = 0, history_every = 0;  // frames and lines of the history [s]; 0: as OutputSpec
  // seepage, quasi_static: steps of the water [s]
  double first_step = 0;      // 0: a hundred-thousandth of the duration
  double largest_step = 0;    // 0: a hundredth of the duration, on the way to a steady state no limit
  double steady_rate = 1e-9;  // seepage: change of the head with time that counts as none [m/s]
  // quasi_static: equilibrium is sought whenever the pressure has changed by this much anywhere since the
  // last time [Pa]; 0: two hundredths of the hydrostatic pressure over the height of the soil
  double relax_change = 0;
  // quasi_static: a point that has moved farther than this since the stage began is a local failure, and
  // failure is when this share of the soil's volume has. 0: half a cell [m].
  double failure_displacement = 0;
  double failure_share = 0.01;
  int relaxation_steps = 1500;  // quasi_static: most steps of one search for equilibrium
  bool moves() const { return mode == Mode::equilibrium || mode == Mode::dynamic; }
  bool relaxes() const { return mode == Mode::equilibrium && damping == 0; }
  bool operator==(const Stage&) const = default;
};

struct Measure {
  std::string name;
  // particle: the material point nearest to `at` in the initial state is followed; cell: the water in the
  // cell at `at`; history: the column `quantity` of the history; body: the mean over a body's mass.
  // Profiles, many values at a time: particles: of all points; cells: of all cells with water. stability: the
  // factor of safety at one moment, one number for a run.
  enum class Kind { particle, cell, history, body, particles, cells, stability } kind = Kind::particle;
  std::string quantity;
  Vector3 at{};
  std::string body;   // body: which
  std::string stage;  // stability: at the end of which; empty: of the run
  std::string along;  // profiles: the coordinate, x, y or z at present, initial_x ... at the start
  std::optional<std::array<Vector3, 2>> within;  // profiles: only inside this box, of the same coordinates
  double every = 0;                              // [s], 0 = every history line; profiles: only where expected
  bool is_profile() const { return kind == Kind::particles || kind == Kind::cells; }
  bool operator==(const Measure&) const = default;
};

// Exactly one of a reference, a value, or one or two bounds.
struct Expectation {
  std::string measure;
  std::string reference;        // CSV file, path relative to the case file
  std::string column;           // of the reference; default: its second
  std::optional<double> value;  // of the norms that give one number
  std::optional<double> at_least, at_most;
  std::string norm = "l2";     // l2 | max | last | largest | smallest | magnitude | mean
  std::string from_stage;      // times count from the start of this stage; empty: from 0
  std::optional<double> time;  // up to which the measure counts [s]; a step ends there
  // With a reference or a value: relative where that is not 0, absolute otherwise.
  std::optional<double> tolerance;
  bool has_bounds() const { return at_least || at_most; }
  bool operator==(const Expectation&) const = default;
};

struct OutputSpec {
  // of the soil's frames, names of frame_quantities() in quantities.hpp
  std::vector<std::string> fields{"displacement", "velocity", "effective_stress", "pore_pressure",
                                  "deviatoric_strain"};
  double every = 0;               // frames [s]; 0: first and last only
  double history_every = 0;       // [s]; 0: duration / 1000
  double checkpoint_every = 600;  // wall clock [s]
  bool operator==(const OutputSpec&) const = default;
};

// How long a case takes, for those who run many.
enum class Effort { quick, normal, extensive };  // seconds; up to a minute; more

struct Scene {
  std::string title;
  Effort effort = Effort::normal;
  std::string formulation = "dry";
  Vector3 gravity{0, -9.81, 0};
  GridSpec grid;
  NumericsSpec numerics;
  WaterSpec water;
  std::vector<Material> materials;
  std::vector<Body> bodies;
  // Where water stands by itself, in formulations in which it has points of its own: shape, points and motion
  // of a body; soil keeps its place where the two overlap.
  std::vector<Body> water_bodies;
  std::vector<Boundary> boundaries;
  std::vector<WaterBoundary> water_boundaries;
  std::vector<WaterLine> water_lines;
  std::vector<Stage> stages;
  std::vector<Measure> measures;
  std::vector<Expectation> expectations;
  OutputSpec output;

  int dimension() const { return grid.space == Space::three_d ? 3 : 2; }
  // Some material has a retention curve: water in cells is computed as unsaturated flow.
  bool unsaturated() const;
  bool layered() const;            // water has points of its own
  bool compressible() const;       // pressure follows from the compression of the water
  bool dispersed() const;          // grains, see Formulation
  bool fluidises() const;          // some material may lose contact between its grains
  bool drag_follows_flow() const;  // some drag law depends on more than the soil
  bool on_points() const;          // water is on the skeleton's points, with its pressure
  bool retains_water() const;      // two layers: soil above the phreatic line keeps water of its own
  bool kozeny_carman() const;  // conductivities follow the porosity, those of all porous materials or of none
  std::vector<mpm::MaterialParameters> skeleton_materials() const;
  bool operator==(const Scene&) const = default;
};

}  // namespace polder::coupling
