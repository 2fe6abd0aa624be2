// Every number that decides what comes next, to a checkpoint and back.
#include <algorithm>

#include "coupling/explicit_water.hpp"
#include "coupling/one_layer.hpp"
#include "coupling/point_water.hpp"
#include "coupling/simulation_run.hpp"

namespace polder::coupling {
namespace {

// How a stage ended, as a checkpoint keeps it.
const std::vector<std::string>& endings() {
  static const std::vector<std::string> list{"", "duration", "equilibrium", "failure", "steady"};
  return list;
}

}  // namespace

template <int D>
void Simulation::Run<D>::visit_points(StateVisitor& v, const std::string& prefix, ParticleSet<D>& set) {
  std::int64_t points = set.next_id();
  v.count(prefix + "points", points);
  v.integers(prefix + "id", set.id);
  std::vector<int> ranges;
  for (const auto& r : set.ranges) ranges.push_back(r.first), ranges.push_back(r.count);
  v.integers(prefix + "ranges", ranges);
  for (ParticleField& f : set.fields()) v.reals(prefix + f.name, *f.values);
  if (!v.reading()) return;
  set.ranges.assign(ranges.size() / 2, {});
  for (std::size_t r = 0; r < set.ranges.size(); ++r) set.ranges[r] = {ranges[2 * r], ranges[2 * r + 1]};
  set.restore(static_cast<int>(points));
}

template <int D>
void Simulation::Run<D>::visit(StateVisitor& v) {
  const auto integer = [&](const char* name, auto& value) {
    std::int64_t n = value;
    v.count(name, n);
    value = static_cast<std::remove_reference_t<decltype(value)>>(n);
  };
  v.number("time", time), v.number("stage_start", stage_start), v.number("dt", dt);
  v.number("smallest_step", smallest), v.number("largest_step", largest);
  v.number("wave_speed", wave_speed), v.number("speed", speed);
  v.number("force_ratio", force_ratio), v.number("energy_ratio", energy_ratio);
  v.number("initial_solid_mass", initial_solid_mass), v.number("initial_water_volume", initial_water_volume);
  integer("steps", steps), integer("stage_steps", stage_steps), integer("stage", stage);
  for (std::size_t s = 0; s < reports.size(); ++s) {
    const std::string n = "stage_" + std::to_string(s);
    std::int64_t count = reports[s].steps;
    std::int64_t ended =
        std::find(endings().begin(), endings().end(), reports[s].ended_by) - endings().begin();
    v.count(n + "_steps", count), v.number(n + "_time", reports[s].time), v.count(n + "_ended", ended);
    reports[s].steps = count, reports[s].ended_by = endings().at(ended);
  }
  visit_water_stage(v);
  int i = 0;
  for (double* x : audit->state()) v.number("audit_" + std::to_string(i++), *x);

  mpm::Skeleton<D>& skeleton = world->skeleton;
  double travelled = skeleton.travelled(), floor = skeleton.mass_floor();
  std::vector<int> blocks;
  for (int b = 0; b < skeleton.grid().occupied_blocks(); ++b)
    blocks.push_back(skeleton.grid().block_number(skeleton.grid().block_origin(b)));
  v.number("travelled", travelled), v.number("mass_floor", floor), v.integers("blocks", blocks);
  if (v.reading()) skeleton.restore(travelled, floor, blocks);
  for (std::size_t b = 0; b < skeleton.bodies().size(); ++b)
    visit_points(v, "body_" + std::to_string(b) + "/", *skeleton.bodies()[b]);
  for (std::size_t l = 0; l < skeleton.loads().size(); ++l) {
    std::vector<Point<D>>& vertices = skeleton.loads()[l].vertices();
    Reals coordinates;
    for (const Point<D>& x : vertices) coordinates.insert(coordinates.end(), x.begin(), x.end());
    v.reals("load_" + std::to_string(l), coordinates);
    if (v.reading())
      for (std::size_t k = 0; k < vertices.size(); ++k)
        std::copy_n(coordinates.begin() + static_cast<std::ptrdiff_t>(k * D), D, vertices[k].begin());
  }
  visit_sleep(v);  // before the water, whose cells are found from points awake and asleep
  if (world->pore_water) visit_water(v);
  visit_relaxation(v);
  if (v.reading()) laws_set = false;
}

template <int D>
void Simulation::Run<D>::visit_sleep(StateVisitor& v) {
  mpm::Sleep<D>* sleep = world->skeleton.sleep();
  if (sleep == nullptr) return;
  typename mpm::Sleep<D>::State s = sleep->state();
  v.integers("asleep", s.asleep), v.integers("falling_asleep", s.falling), v.reals("quiet", s.quiet),
      v.reals("rest_means", s.means), v.number("since_look", s.since_look);
  v.count("sleep_steps", s.steps), v.count("sleep_skipped", s.skipped);
  v.count("times_asleep", s.times_asleep), v.count("times_woken", s.times_woken);
  if (v.reading()) sleep->restore(s);
}

template <int D>
void Simulation::Run<D>::visit_water(StateVisitor& v) {
  PoreWater<D>& water = *world->pore_water;
  Reals owed;
  if (water.layer) {
    WaterLayer<D>& layer = *water.layer;
    visit_points(v, "water/", layer.fluid.points());
    owed = layer.owed;
    v.reals("water_owed", owed);
    for (std::size_t b = 0; b < layer.fluidised.size(); ++b)
      v.reals("fluidised_" + std::to_string(b), layer.fluidised[b]);
    v.number("water_added", layer.added), v.number("water_removed", layer.removed);
    if (v.reading()) layer.fluid.follow_grid();
  }
  if (water.points) {  // the points' own fields say all; cells follow from them
    v.number("outflow", water.outflow), v.number("storage", water.storage);
    v.number("explicit_limit", water.explicit_limit.dt);
    if (!v.reading()) return;
    water.pressure.carry();
    water.points->cells_found = false;
    find_cells_of_points(*world, time);
    return;
  }
  UnsaturatedWater<D>* unsaturated = water.unsaturated.get();
  Reals pressure = water.pore_pressure(), saturation, points, active, travel;
  std::vector<int> cells =
      unsaturated ? unsaturated->field.pressure_cells() : water.pressure.pressure_cells();
  v.reals("pore_pressure", pressure), v.integers("pressure_cells", cells);
  v.number("outflow", water.outflow), v.number("storage", water.storage);
  VolumeFeedback feedback = water.feedback;
  v.reals("feedback_compressibility", feedback.compressibility);
  v.reals("feedback_foreseen", feedback.foreseen), v.reals("feedback_owed", feedback.owed);
  if (water.compressible) {
    std::int64_t darcy = water.explicit_limit.darcy;
    v.number("explicit_limit", water.explicit_limit.dt), v.count("explicit_limit_darcy", darcy);
    water.explicit_limit.darcy = darcy != 0;
  }
  if (unsaturated) {
    saturation = unsaturated->field.saturation();
    points = unsaturated->point_saturation, active = unsaturated->was_active, travel = unsaturated->travel;
    v.reals("saturation", saturation), v.reals("point_saturation", points), v.reals("was_active", active);
    v.reals("travel", travel);
  }
  if (!v.reading()) return;
  carry_water(*world);
  if (water.layer) water.layer->owed = owed;  // in the order of the slots already
  water.feedback = feedback;                  // likewise
  if (unsaturated) {
    // The cells follow the points when the next step begins, as they would have.
    unsaturated->field.restore(pressure, saturation, cells);
    unsaturated->point_saturation = points, unsaturated->was_active = active, unsaturated->travel = travel;
    unsaturated->mapped = true;
    unsaturated->soil_revision = 0;
    update_water_cells(*world, time);
    unsaturated->field.restore(pressure, saturation, cells);
    unsaturated->point_saturation = points, unsaturated->was_active = active, unsaturated->travel = travel;
  } else {
    update_water_cells(*world, time);
    water.pressure.restore(pressure, cells);
  }
}

#define POLDER_INSTANTIATE(D) template void Simulation::Run<D>::visit(StateVisitor&);
POLDER_INSTANTIATE(2)
POLDER_INSTANTIATE(3)

}  // namespace polder::coupling
