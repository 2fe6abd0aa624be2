// The simulation behind its interface, for one dimension. Private to coupling/.
#pragma once

#include <optional>

#include "coupling/audit.hpp"
#include "coupling/relaxation.hpp"
#include "coupling/simulation.hpp"
#include "coupling/world.hpp"

namespace polder::coupling {

struct Simulation::Base {
  virtual ~Base() = default;
  virtual void step() = 0;
  virtual double automatic_step(int of_stage) const = 0;
  virtual std::vector<Column> history() const = 0;
  virtual long particles() const = 0;
  virtual long cells() const = 0;
  virtual long pressure_cells() const = 0;
  virtual const char* pressure_solver() const = 0;
  virtual int probe_particle(const Vector3& at) const = 0;
  virtual double particle_quantity(int number, const std::string& quantity) const = 0;
  virtual double cell_quantity(const Vector3& at, const std::string& quantity) const = 0;
  virtual double body_quantity(const std::string& body, const std::string& quantity) const = 0;
  virtual Profile profile(const Measure& measure) const = 0;
  virtual std::vector<std::pair<double, double>> phreatic_line() const = 0;
  virtual FlowNet flow_net() const = 0;
  virtual PointFrame points(const std::vector<std::string>& fields) const = 0;
  virtual PointFrame water_points() const = 0;
  virtual CellFrame water_cells() const = 0;
  virtual Savings savings() const = 0;
  virtual void visit(StateVisitor& visitor) = 0;
  virtual StabilityTrial try_reduced_strength(double factor, const StabilityOptions& options) = 0;

  Scene scene;
  // Time control; all of it is part of a checkpoint.
  double time = 0, stage_start = 0;
  std::int64_t steps = 0, stage_steps = 0;
  int stage = 0;
  double dt = 0, smallest = 0, largest = 0;
  double wave_speed = 0, speed = 0;  // [m/s], of the state the step is chosen from
  double force_ratio = 0, energy_ratio = 0;
  bool laws_set = false;  // the present stage has begun
  bool marked = false;    // the last step ended a stage or where an expectation looks
  std::vector<StageReport> reports;
  std::string reason;
  // Seepage and quasi-static stages: the water's next step [s] (0: the stage's first), the change of pressure
  // after which equilibrium is sought [Pa], what relaxation has done so far.
  double water_step = 0, relax_change = 0, relaxation_water = 0;
  std::int64_t relaxations = 0, relaxation_steps = 0, unbalanced_relaxations = 0;
  bool locally_failed = false;
  std::vector<Event> events;
  std::optional<StepLimit> limit;  // found when first asked for
  Timing timing;

  bool finished() const { return stage >= static_cast<int>(scene.stages.size()); }
  const Stage& present() const { return scene.stages[stage]; }
  // Equilibrium without damping of its own: by relaxation, not by damped dynamic steps.
  bool relaxes() const { return !finished() && present().relaxes(); }
};

template <int D>
struct Simulation::Run final : Simulation::Base {
  std::unique_ptr<World<D>> world;
  std::unique_ptr<Audit<D>> audit;
  std::unique_ptr<Relaxation<D>> relaxation;  // of an equilibrium stage that has begun
  double initial_solid_mass = 0, initial_water_volume = 0;
  // Quasi-static stages: pressure of the cells when equilibrium was last sought, and where the points were
  // when the stage began (by body, number and axis).
  Reals relaxed_pressure;
  std::vector<Reals> stage_position;

  explicit Run(const Scene& s);
  void step() override;
  double courant_share(int of_stage) const;
  // Share of the limits that the step is chosen from, and what sets it (explicit_water.hpp).
  std::pair<double, const char*> chosen_step(int of_stage, double wave) const;
  double automatic_step(int of_stage) const override;
  double fastest_wave() const;
  std::vector<Column> history() const override;
  long particles() const override;
  long cells() const override { return world->skeleton.grid().slots(); }
  long pressure_cells() const override { return world->pore_water ? world->pore_water->cells.count() : 0; }
  const char* pressure_solver() const override {
    return world->pore_water ? world->pore_water->solver_name() : "";
  }
  int probe_particle(const Vector3& at) const override;
  double particle_quantity(int number, const std::string& quantity) const override;
  double cell_quantity(const Vector3& at, const std::string& quantity) const override;
  double body_quantity(const std::string& body, const std::string& quantity) const override;
  Profile profile(const Measure& measure) const override;
  std::vector<std::pair<double, double>> phreatic_line() const override;
  FlowNet flow_net() const override;
  PointFrame points(const std::vector<std::string>& fields) const override;
  PointFrame water_points() const override;
  CellFrame water_cells() const override;
  Savings savings() const override;
  void visit(StateVisitor& visitor) override;
  StabilityTrial try_reduced_strength(double factor, const StabilityOptions& options) override;

 private:
  void look_at_cells() const;  // before cells are read: those of points that carry the pressure are found
  void begin_stage();
  void step_motion();
  void visit_sleep(StateVisitor& visitor);
  void visit_water(StateVisitor& visitor);
  void visit_points(StateVisitor& visitor, const std::string& prefix, ParticleSet<D>& set);
  void visit_water_stage(StateVisitor& visitor);
  // Stages in which the water sets the pace (seepage_stage.cpp).
  struct Displaced {
    double largest = 0;  // displacement of any point since the stage began [m]
    double share = 0;    // of the soil's volume that has moved farther than the limit
    Vector3 place{};     // where the point that has moved farthest was when the stage began [m]
  };
  void step_water();
  double flow(double left);
  bool is_steady(const Reals& before, double step_size) const;
  void begin_water_stage();
  bool is_relaxation_due() const;
  bool follow();
  void fail();
  Displaced displaced_soil(double limit) const;
  double next_mark(double stage_end) const;
  void end_stage(const std::string& by);
  void begin_relaxation();
  void relax_step();
  void visit_relaxation(StateVisitor& visitor);
  [[noreturn]] void throw_unrest(const std::string& advice) const;  // no equilibrium within the stage
  bool at_rest();  // equilibrium stages: both ratios below their tolerances
  // Body and slot of a point by its number over all bodies.
  std::pair<const ParticleSet<D>*, int> locate(int number) const;
  double particle_value(const ParticleSet<D>& set, int p, const std::string& quantity) const;
  double quantity_of(const ParticleSet<D>& set, int p, const std::string& quantity, int component) const;
};

}  // namespace polder::coupling
