// A running simulation: stages, time control, and everything an observer may ask. The dimension is chosen
// once, inside.
//
//   Simulation s(scene);
//   while (!s.finished()) s.step();
//
// Step by step use from another program is the same loop with calls in between; docs/example shows one.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/aligned.hpp"
#include "coupling/scene.hpp"

namespace polder::coupling {

// The largest stable time step.
struct StepLimit {
  double dt = 0;       // [s]
  std::string reason;  // which wave in which soil
};

// One column of the history.
struct Column {
  std::string name;  // with its unit, "kinetic_energy[J]"
  double value = 0;
};

// A named array over the points of one body, or over cells or nodes, `components` values each.
struct FieldView {
  std::string name;
  int components = 1;
  std::vector<double> values;
};

// Points of all bodies in the order of their numbers (body by body), for output.
struct PointFrame {
  std::vector<double> positions;  // three values a point
  std::vector<FieldView> fields;
  std::size_t count() const { return positions.size() / 3; }
};

// Active water cells: quadrilaterals or hexahedra.
struct CellFrame {
  std::vector<double> vertices;       // three values a vertex
  std::vector<std::int64_t> corners;  // 4 (2D) or 8 (3D) vertex numbers a cell, in VTK's order
  int corners_per_cell = 4;
  std::vector<FieldView> fields;  // over cells
};

// Values of a profile measure and the coordinates they belong to, in the order of the points or cells.
struct Profile {
  std::vector<double> coordinate, value;
};

// Water that leaves the soil through a face of the cells.
struct FlowExit {
  Vector3 place{};      // of the face [m]
  Vector3 direction{};  // its outward normal, along an axis
  int boundary = -1;    // number of the water boundary, -1: the soil's surface without a name
  double gradient = 0;  // loss of head over the distance from the cell's centre to the face [-]
  double critical = 0;  // gradient of upward flow that would lift the soil there [-]
  bool is_upward() const { return direction[1] > 0; }
  double heave_factor() const { return critical / gradient; }
};

// Where the phreatic line leaves the soil: the upper end of a seepage face (fdm/phreatic_exit.hpp).
struct SeepageEnd {
  Vector3 place{};      // [m]
  double slope = 0;     // of the face against the horizontal [rad]
  int boundary = -1;    // number of the water boundary, -1: the soil's surface without a name
  bool within = false;  // to a part of a cell; else the highest cell that lets water out
};

// What a plane flow through the cells amounts to at present (fdm/flow_results.hpp).
struct FlowNet {
  // Stream function at the nodes, x, y [m] and psi [m2/s] each (axisymmetric: [m3/s] per radian).
  std::vector<std::array<double, 3>> stream_function;
  double lowest = 0, highest = 0;  // of it
  double defect = 0;  // largest disagreement of two ways around a cell over the range: 0 in steady flow
  std::vector<FlowExit> exits;
  std::vector<SeepageEnd> seepage_ends;
};

// Reads or writes every number that decides what comes next. Implemented by checkpoints.
class StateVisitor {
 public:
  virtual ~StateVisitor() = default;
  virtual bool reading() const = 0;
  virtual void reals(const std::string& name, Reals& values) = 0;
  virtual void integers(const std::string& name, std::vector<int>& values) = 0;
  virtual void number(const std::string& name, double& value) = 0;
  virtual void count(const std::string& name, std::int64_t& value) = 0;
};

struct StageReport {
  std::string name, mode;
  long steps = 0;
  double time = 0;       // simulated [s]
  std::string ended_by;  // "duration", "equilibrium", "failure", "steady", "" while running
};

// Something that happened in a quasi-static stage (Stage::failure_displacement).
struct Event {
  enum class Kind { local_failure, failure } kind = Kind::local_failure;
  std::string stage;
  double time = 0;          // [s]
  Vector3 place{};          // where the point that has moved farthest was when the stage began [m]
  double displacement = 0;  // its displacement [m]
  double share = 0;         // of the soil's volume that has moved as far as a failure
  double force_ratio = 0;   // out-of-balance force ratio that the search for equilibrium was left with
  bool is_failure() const { return kind == Kind::failure; }
  std::string text() const;
};

struct StabilityOptions;  // strength_reduction.hpp
struct StabilityTrial;

// Wall time by part of the step [s].
struct Timing {
  double mechanics = 0, water = 0, audit = 0, total = 0;
};

// What a run has not had to do; Simulation::skipped() tells why.
struct Savings {
  long stored_cells = 0, all_cells = 0;  // of the grid
  long pressure_cells = 0;               // in the pressure system
  // Of this program's run, restarts apart: pressure systems solved, structures of their matrix analysed,
  // Cholesky factors computed.
  std::int64_t systems = 0, structures = 0, factors = 0;
  // Sleeping soil (mpm/sleep.hpp): points asleep now; particle-steps not made; blocks put to sleep, and
  // woken.
  long sleeping_points = 0;
  std::int64_t skipped_particle_steps = 0, blocks_asleep = 0, blocks_woken = 0;
};

class Simulation {
 public:
  // Builds the world. Throws InputError for a scene that cannot be built.
  explicit Simulation(const Scene& scene);
  ~Simulation();
  Simulation(Simulation&&) noexcept;

  const Scene& scene() const;
  bool finished() const;
  // One step of the present stage. Throws NumericalError when the computation breaks down.
  void step();
  // Change a water boundary's or a load's value while running is done by setting scene tables before; see
  // docs/example.

  double time() const;      // [s], over all stages
  double end_time() const;  // sum of the stages' durations [s]
  long steps() const;
  int stage() const;  // index, number of stages when finished
  const std::vector<StageReport>& stages() const;
  const std::vector<Event>& events() const;  // in the order of time
  // The last step ended a stage or at the time of an expectation: what is looked at then must be recorded.
  bool at_mark() const;
  double last_step() const;                // dt [s]
  const std::string& step_reason() const;  // what limited it
  double smallest_step() const;
  double largest_step() const;
  // Chosen for a stage from the state at present: courant times cell over wave speed, less where the water
  // limits the step [s].
  double automatic_step(int stage = 0) const;
  StepLimit step_limit() const;  // of the soils at the start (step_limit.hpp); the first call takes a moment
  // A stage's step that is longer than stable, from what is known at present; 0 if there is none [s]. (An
  // automatic one that follows the filling of pores is not, though the limit, which is of saturated soil, may
  // be shorter.)
  double step_beyond_limit() const;
  double equilibrium_force_ratio() const;
  double equilibrium_energy_ratio() const;

  long particles() const;
  long cells() const;                        // stored
  long pressure_cells() const;               // active
  std::vector<std::string> skipped() const;  // what this scene does not need
  const char* pressure_solver() const;       // "" without pore water

  // Balances and measures now. Names are the same in every row.
  std::vector<Column> history() const;
  // A named particle quantity of the point nearest to a place in the initial state (quantities.hpp).
  int probe_particle(const Vector3& at) const;  // number over all bodies
  double particle_quantity(int number, const std::string& quantity) const;
  double cell_quantity(const Vector3& at, const std::string& quantity) const;        // NaN where no water is
  double body_quantity(const std::string& body, const std::string& quantity) const;  // mean over its mass
  Profile profile(const Measure& measure) const;
  std::vector<std::pair<double, double>> phreatic_line() const;  // (x, height) of the water surface, 2D

  FlowNet flow_net() const;  // empty in 3D and without pore water

  PointFrame points(const std::vector<std::string>& fields) const;
  // Points of water with velocity, pore_pressure, volume and id; empty where it has none of its own.
  PointFrame water_points() const;
  CellFrame water_cells() const;
  Timing timing() const;
  Savings savings() const;

  void visit(StateVisitor& visitor);

  // Leaves its stage and relaxes the present state with its strength divided by the factor
  // (strength_reduction.hpp, which saves the state before and brings it back).
  StabilityTrial try_reduced_strength(double factor, const StabilityOptions& options);

 private:
  struct Base;
  template <int D>
  struct Run;
  std::unique_ptr<Base> run_;
};

}  // namespace polder::coupling
