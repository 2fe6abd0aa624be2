// What a scene does not need and a run therefore does not do, and what that has saved.
#include <algorithm>
#include <cstdio>

#include "coupling/quantities.hpp"
#include "coupling/simulation_run.hpp"
#include "coupling/sleep.hpp"

namespace polder::coupling {
namespace {

std::string rounded(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

std::string sleep_text(const Scene& scene) {
  if (const char* why = keeps_awake(scene)) return std::string("sleep: soil stays awake, ") + why;
  if (!scene.numerics.sleep)
    return "sleep: off, soil at rest is computed on in dynamic stages (numerics.sleep = true puts it to "
           "sleep)";
  const mpm::SleepOptions o = sleep_options(scene);
  return "soil at rest: asleep in dynamic stages where it has been slower than " + rounded(o.velocity) +
         " m/s for " + rounded(o.delay) + " s, until forces beyond " + rounded(100 * o.force) +
         " % of the weight wake it";
}

void add_water(const Scene& scene, long stored, long pressure, std::vector<std::string>& list) {
  const WaterCarrier carrier = find_formulation(scene.formulation)->carrier;
  if (carrier == WaterCarrier::none) {
    list.push_back(
        "pore water: the formulation has none, so no pressure cells, no solver, no porosity fields");
    return;
  }
  if (carrier == WaterCarrier::cells)
    list.push_back("points of water: the formulation has none, so the soil's alone are mapped and moved");
  if (!scene.unsaturated()) {
    list.push_back(
        "retention curves: no material has one, so no curve is evaluated and suction does not change");
    if (scene.water.phreatic.empty() || scene.water.suction_above == 0)
      list.push_back("suction: the scene has none");
  }
  if (const long empty = stored - pressure; empty > 0)
    list.push_back("pressure in " + std::to_string(empty) + " stored cells without " +
                   (scene.unsaturated() ? "porous" : "saturated") + " soil: not in the system");
  const bool moves =
      std::any_of(scene.stages.begin(), scene.stages.end(), [](const Stage& t) { return t.moves(); });
  if (!moves) list.push_back("motion: no stage has any, so nothing is transferred between points and nodes");
  if (scene.compressible())
    list.push_back(
        "linear systems: pressure is explicit where soil moves; solver_tolerance counts in stages of seepage "
        "and quasi-static ones only");
  else
    list.push_back(
        "structure of the pressure system: analysed again only where the set of its cells changes; Cholesky "
        "factors are kept while the values stand");
  if (!scene.water.outside_level && !scene.layered())
    list.push_back("open water on the surface: the scene has none");
}

}  // namespace

template <int D>
Savings Simulation::Run<D>::savings() const {
  Savings s;
  s.stored_cells = cells();
  s.all_cells = 1;
  for (int n : world->skeleton.grid().cells()) s.all_cells *= n;
  s.pressure_cells = pressure_cells();
  if (world->pore_water) {
    const fdm::SolverCounts c = world->pore_water->solver_counts();
    s.systems = c.systems, s.structures = c.structures, s.factors = c.factors;
  }
  if (const mpm::Sleep<D>* sleep = world->skeleton.sleep()) {
    s.sleeping_points = sleep->points();
    s.skipped_particle_steps = sleep->skipped();
    s.blocks_asleep = sleep->times_asleep(), s.blocks_woken = sleep->times_woken();
  }
  return s;
}

Savings Simulation::savings() const {
  return run_->savings();
}

std::vector<std::string> Simulation::skipped() const {
  const Scene& scene = run_->scene;
  const Savings s = run_->savings();
  std::vector<std::string> list;
  add_water(scene, s.stored_cells, s.pressure_cells, list);
  list.push_back("discrete elements: the scene has none, so LIGGGHTS and MPI are not loaded");
  list.push_back("blocks without particles: neither stored nor visited; " + std::to_string(s.stored_cells) +
                 " cells are, of " + std::to_string(s.all_cells) + " in the grid");
  if (!scene.bodies.empty()) list.push_back(sleep_text(scene));
  if (scene.numerics.transfer == Transfer::flip)
    list.push_back("affine particle velocities: the transfer is FLIP");
  if (const std::size_t all = frame_quantities().size(); scene.output.fields.size() < all)
    list.push_back("fields of frames: " + std::to_string(scene.output.fields.size()) + " of " +
                   std::to_string(all) + " are asked for, others are not computed");
  return list;
}

template Savings Simulation::Run<2>::savings() const;
template Savings Simulation::Run<3>::savings() const;

}  // namespace polder::coupling
