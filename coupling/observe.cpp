// What observers ask of a running simulation: history, probes, frames.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/error.hpp"
#include "coupling/between_centres.hpp"
#include "coupling/fluidisation.hpp"
#include "coupling/point_water.hpp"
#include "coupling/quantities.hpp"
#include "coupling/simulation_run.hpp"
#include "mpm/point_stencil.hpp"
#include "mpm/stress_recovery.hpp"

namespace polder::coupling {
namespace {

const char* const kAxis[] = {"x", "y", "z"};

int axis_of(const std::string& quantity) {
  const char c = quantity.back();
  return c >= 'x' && c <= 'z' && quantity[quantity.size() - 2] == '_' ? c - 'x' : -1;
}

}  // namespace

template <int D>
void Simulation::Run<D>::look_at_cells() const {
  if (world->pore_water && world->pore_water->points) find_cells_of_points(*world, time);
}

template <int D>
long Simulation::Run<D>::particles() const {
  long n = 0;
  for (const auto& body : world->skeleton.bodies()) n += body->count();
  if (world->pore_water && world->pore_water->layer) n += world->pore_water->layer->fluid.points().count();
  return n;
}

template <int D>
std::vector<Column> Simulation::Run<D>::history() const {
  const Totals t = audit->totals(*world);
  const Work& w = audit->work();
  const mpm::Skeleton<D>& skeleton = world->skeleton;
  std::vector<Column> c;
  const auto add = [&](const std::string& name, double value) { c.push_back({name, value}); };
  add("time[s]", time);
  add("step", static_cast<double>(steps));
  add("stage", stage);
  add("dt[s]", dt);
  add("kinetic_energy[J]", t.kinetic_energy);
  add("elastic_energy[J]", t.elastic_energy);
  add("work_gravity[J]", w.gravity);
  add("work_stress[J]", w.stress);
  add("work_water[J]", w.water);
  add("work_damping[J]", w.damping);
  add("work_boundary[J]", w.boundary);
  add("transfer_loss[J]", audit->energy_loss(t));
  add("unbalanced_force_ratio[-]",
      skeleton.load_norm() > 0 ? skeleton.unbalanced_force() / skeleton.load_norm() : 0.0);
  for (int d = 0; d < D; ++d) add(std::string("momentum_") + kAxis[d] + "[kg m/s]", t.momentum[d]);
  add("momentum_error[-]", audit->impulse_error(t));
  add("solid_mass_error[-]",
      initial_solid_mass > 0 ? (t.solid_mass - initial_solid_mass) / initial_solid_mass : 0.0);
  add("max_speed[m/s]", t.largest_speed);
  const bool soil = !scene.bodies.empty();
  add("runout[m]", soil ? t.runout : 0.0);
  add("height[m]", soil ? t.height : 0.0);
  for (std::size_t b = 0; b < skeleton.boundaries().specs().size(); ++b) {
    const auto& spec = skeleton.boundaries().specs()[b];
    if (spec.name.rfind("side-", 0) == 0) continue;  // unnamed sides
    for (int d = 0; d < D; ++d)
      add("reaction:" + spec.name + "_" + kAxis[d] + "[N]",
          skeleton.boundaries().reaction(static_cast<int>(b))[d]);
  }
  if (skeleton.sleep() != nullptr) add("sleeping_points", static_cast<double>(skeleton.sleep()->points()));
  if (world->pore_water) {
    look_at_cells();
    PoreWater<D>& water = *world->pore_water;
    // Points of water keep their volume whatever the pressure; what compression takes up is not among it.
    const double storage = water.layer ? 0.0 : water.storage;
    const double change = t.water_volume - initial_water_volume + water.outflow + storage;
    add("water_mass_error[-]", initial_water_volume > 0 ? change / initial_water_volume : 0.0);
    add("water_outflow[m3]", water.outflow);
    double largest = 0;
    for (const auto& cell : water.cells.cells())
      largest = std::max(largest, water.pore_pressure()[cell.slot]);
    add("max_pore_pressure[Pa]", largest);
    add("pressure_roughness[Pa]", pressure_roughness(water));
    const fdm::Discharge& q = water.discharge();
    add("discharge:surface[m3/s]", q.surface);
    for (std::size_t b = 0; b < scene.water_boundaries.size(); ++b)
      add("discharge:" + scene.water_boundaries[b].name + "[m3/s]",
          b < q.boundary.size() ? q.boundary[b] : 0.0);
    std::size_t wells = 0, drains = 0;
    for (const WaterLine& line : scene.water_lines) {
      if (line.kind == WaterLine::Kind::sheet) continue;
      const std::vector<double>& flows = line.kind == WaterLine::Kind::well ? q.well : q.drain;
      const std::size_t n = line.kind == WaterLine::Kind::well ? wells++ : drains++;
      add("discharge:" + line.name + "[m3/s]", n < flows.size() ? flows[n] : 0.0);
    }
    add("pressure_cells", static_cast<double>(water.cells.count()));
    if (water.layer) {
      add("water_points", water.layer->fluid.points().count());
      add("water_runout[m]", t.water_runout);
      add("water_height[m]", t.water_height);
      if (scene.fluidises()) add("fluidised[-]", fluidised_share(*world));
    }
    if (has_quasi_static_stage(scene)) {
      add("relaxations", static_cast<double>(relaxations));
      add("relaxation_steps", static_cast<double>(relaxation_steps));
      add("unbalanced_relaxations", static_cast<double>(unbalanced_relaxations));
      add("relaxation_water[m3]", relaxation_water);
    }
  }
  return c;
}

template <int D>
int Simulation::Run<D>::probe_particle(const Vector3& at) const {
  int number = 0, best = -1;
  double nearest = std::numeric_limits<double>::infinity();
  for (const auto& body : world->skeleton.bodies()) {
    for (int id = 0; id < body->count(); ++id, ++number) {
      const int p = body->find(id);
      double r = 0;
      for (int d = 0; d < D; ++d)
        r += (body->initial_position[d][p] - at[d]) * (body->initial_position[d][p] - at[d]);
      if (r < nearest) nearest = r, best = number;
    }
  }
  return best;
}

template <int D>
std::pair<const ParticleSet<D>*, int> Simulation::Run<D>::locate(int number) const {
  for (const auto& body : world->skeleton.bodies()) {
    if (number < body->count()) return {body.get(), body->find(number)};
    number -= body->count();
  }
  throw std::out_of_range("particle number");
}

// `quantity` without its component suffix; component -1 asks for a scalar (or the magnitude of a vector).
template <int D>
double Simulation::Run<D>::quantity_of(const ParticleSet<D>& set, int p, const std::string& q,
                                       int component) const {
  const auto vector = [&](auto&& value) {
    if (component >= 0) return component < D ? value(component) : 0.0;
    double s = 0;
    for (int d = 0; d < D; ++d) s += value(d) * value(d);
    return std::sqrt(s);
  };
  const auto stress = [&](int k) { return k < ParticleSet<D>::kStress ? set.stress[k][p] : 0.0; };
  const double mean = (stress(0) + stress(1) + stress(2)) / 3;
  if (q == "displacement")
    return vector([&](int d) { return set.position[d][p] - set.initial_position[d][p]; });
  if (q == "position") return vector([&](int d) { return set.position[d][p]; });
  if (q == "velocity") return vector([&](int d) { return set.velocity[d][p]; });
  if (q == "effective_stress") return stress(component);
  if (q == "mean_effective_stress") return -mean;
  if (q == "deviatoric_stress") {
    double j2 = 0;
    for (int k = 0; k < 3; ++k) j2 += 0.5 * (stress(k) - mean) * (stress(k) - mean);
    for (int k = 3; k < ParticleSet<D>::kStress; ++k) j2 += stress(k) * stress(k);
    return std::sqrt(3 * j2);
  }
  if (q == "deviatoric_strain") {
    const int k = world->layouts[set.material].plastic_strain;
    return k >= 0 ? set.state[k][p] : 0.0;
  }
  if (q == "pore_pressure") {
    if (!world->pore_water || set.wet.empty()) return 0.0;
    if (world->pore_water->points && set.wet[p] > 0) return set.pore_pressure[p];
    if (set.wet[p] == 0)
      return !set.suction_stress.empty() && set.suction_stress[p] > 0 ? -scene.water.suction_above : 0.0;
    // Cell value plus the gradient's share, from the four (eight) cells around the point that hold water.
    Vector3 x{};
    for (int d = 0; d < D; ++d) x[d] = set.position[d][p];
    return cell_quantity(x, "pore_pressure_interpolated");
  }
  if (q == "porosity") return 1 - set.mass[p] / (set.density_solid * set.volume[p]);
  if (q == "saturation") {
    const double own = set.pore_water.empty() ? 0.0 : set.pore_water[p] / scene.water.density;
    if (world->pore_water && world->pore_water->points && !set.wet.empty() && set.wet[p] > 0) return 1.0;
    if (!world->pore_water || !world->pore_water->layer || set.wet.empty()) return own;
    // In two layers the pores hold what the points of water around bring, besides what the grains retain.
    const double pores = set.volume[p] - set.mass[p] / set.density_solid;
    const double retained = set.retained_water.empty()
                                ? 0.0
                                : std::min(1.0, set.retained_water[p] / (scene.water.density * pores));
    const WaterLayer<D>& layer = *world->pore_water->layer;
    const int slot = world->skeleton.grid().slot(set.cell_of(world->skeleton.grid(), p));
    if (slot < 0 || !(layer.soil_fill[slot] > 0)) return retained;
    return retained + (1 - retained) * std::min(1.0, world->pore_water->fill[slot] / layer.soil_fill[slot]);
  }
  if (q == "cohesion" || q == "friction_angle") {
    const mpm::StateLayout& layout = world->layouts[set.material];
    std::vector<double> state(layout.count());
    for (int k = 0; k < layout.count(); ++k) state[k] = set.state[k][p];
    const mpm::Strength strength = mpm::strength_of(scene.materials[set.material], layout, state);
    if (q == "cohesion") return std::isfinite(strength.cohesion) ? strength.cohesion : 0.0;
    return strength.friction * 180 / std::numbers::pi;
  }
  if (q == "water_velocity")
    return vector([&](int d) { return set.water_velocity[d].empty() ? 0.0 : set.water_velocity[d][p]; });
  if (q == "conductivity") return set.conductivity.empty() ? 0.0 : set.conductivity[p];
  if (q == "volume") return set.volume[p];
  if (q == "material") return set.material;
  if (q == "id") return set.id[p];
  throw InputError("quantity '" + q + "' is unknown");
}

template <int D>
double Simulation::Run<D>::particle_value(const ParticleSet<D>& set, int p,
                                          const std::string& quantity) const {
  if (quantity == "vertical_stress") return quantity_of(set, p, "effective_stress", D == 2 ? 1 : 2);
  if (quantity.rfind("stress_", 0) == 0) {
    static const char* const names[] = {"xx", "yy", "zz", "xy", "yz", "zx"};
    for (int k = 0; k < 6; ++k)
      if (quantity == std::string("stress_") + names[k]) return quantity_of(set, p, "effective_stress", k);
  }
  const int axis = axis_of(quantity);
  return quantity_of(set, p, axis >= 0 ? quantity.substr(0, quantity.size() - 2) : quantity, axis);
}

template <int D>
double Simulation::Run<D>::particle_quantity(int number, const std::string& quantity) const {
  const auto [set, p] = locate(number);
  return particle_value(*set, p, quantity);
}

template <int D>
double Simulation::Run<D>::body_quantity(const std::string& name, const std::string& quantity) const {
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    if (scene.bodies[b].name != name) continue;
    const ParticleSet<D>& set = *world->skeleton.bodies()[b];
    double sum = 0, mass = 0;
    for (int id = 0; id < set.count(); ++id) {  // by number: the sum must not depend on the order in cells
      const int p = set.find(id);
      sum += set.mass[p] * particle_value(set, p, quantity), mass += set.mass[p];
    }
    return sum / mass;
  }
  throw InputError("there is no body \"" + name + "\"");
}

template <int D>
Profile Simulation::Run<D>::profile(const Measure& m) const {
  Profile result;
  const bool initial = m.along.starts_with("initial_");
  const int axis = m.along.back() - 'x';
  const auto add = [&](const Point<D>& at, auto&& value) {
    for (int d = 0; m.within && d < D; ++d)
      if (at[d] < (*m.within)[0][d] || at[d] > (*m.within)[1][d]) return;
    result.coordinate.push_back(at[axis]);
    result.value.push_back(value());
  };
  if (m.kind == Measure::Kind::cells) {
    if (!world->pore_water) return result;
    look_at_cells();
    const PoreWater<D>& water = *world->pore_water;
    for (const auto& cell : water.cells.cells()) {
      const Point<D> centre = water.cells.centre(cell.index);
      add(centre, [&] {
        const double p = water.pore_pressure()[cell.slot];
        return m.quantity == "head" ? p / world->unit_weight() + centre[D - 1] : p;
      });
    }
    return result;
  }
  for (const auto& body : world->skeleton.bodies()) {
    const auto& position = initial ? body->initial_position : body->position;
    for (int id = 0; id < body->count(); ++id) {
      const int p = body->find(id);
      Point<D> at;
      for (int d = 0; d < D; ++d) at[d] = position[d][p];
      add(at, [&] { return particle_value(*body, p, m.quantity); });
    }
  }
  return result;
}

template <int D>
double Simulation::Run<D>::cell_quantity(const Vector3& at, const std::string& quantity) const {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  if (!world->pore_water) return kNone;
  look_at_cells();
  const PoreWater<D>& water = *world->pore_water;
  const Grid<D>& grid = world->skeleton.grid();
  if (quantity == "pore_pressure_interpolated") {
    Point<D> x;
    for (int d = 0; d < D; ++d) x[d] = at[d];
    return BetweenCentres<D>(water.cells, x).value(water.pore_pressure());
  }
  Index<D> cell;
  for (int d = 0; d < D; ++d)
    cell[d] = static_cast<int>(std::floor((at[d] - grid.origin()[d]) / grid.spacing()));
  const int slot = grid.is_cell(cell) ? grid.slot(cell) : -1;
  if (slot < 0 || !water.cells.active(slot)) return kNone;
  const double p = water.pore_pressure()[slot];
  if (quantity == "pore_pressure") return p;
  if (quantity == "head") return p / world->unit_weight() + water.cells.centre(cell)[D - 1];
  throw InputError("cell quantity '" + quantity + "' is unknown");
}

template <int D>
PointFrame Simulation::Run<D>::points(const std::vector<std::string>& fields) const {
  PointFrame f;
  for (const std::string& name : fields) {
    FieldView v;
    v.name = name;
    const bool stress = name == "effective_stress" || name == "recovered_stress";
    v.components = name == "displacement" || name == "velocity" || name == "water_velocity" ? 3
                   : stress                                                                 ? 6
                                                                                            : 1;
    f.fields.push_back(std::move(v));
  }
  int number = 0;
  const bool recover = std::find(fields.begin(), fields.end(), "recovered_stress") != fields.end();
  for (const auto& body : world->skeleton.bodies()) {
    std::array<Reals, ParticleSet<D>::kStress> recovered;
    if (recover) recovered = mpm::recover_stress<D>(world->skeleton.grid(), *body);
    for (int id = 0; id < body->count(); ++id) {
      const int p = body->find(id);
      for (int d = 0; d < 3; ++d) f.positions.push_back(d < D ? body->position[d < D ? d : 0][p] : 0.0);
      for (FieldView& v : f.fields) {
        if (v.name == "body") {
          v.values.push_back(number);
          continue;
        }
        if (v.name == "recovered_stress") {
          for (int k = 0; k < 6; ++k)
            v.values.push_back(k < ParticleSet<D>::kStress ? recovered[static_cast<std::size_t>(k)][p] : 0.0);
          continue;
        }
        for (int c = 0; c < v.components; ++c)
          v.values.push_back(quantity_of(*body, p, v.name, v.components > 1 ? c : -1));
      }
    }
    ++number;
  }
  return f;
}

template <int D>
PointFrame Simulation::Run<D>::water_points() const {
  PointFrame f;
  if (!world->pore_water || !world->pore_water->layer) return f;
  f.fields = {{"velocity", 3, {}}, {"pore_pressure", 1, {}}, {"volume", 1, {}}, {"id", 1, {}}};
  const ParticleSet<D>& set = world->pore_water->layer->fluid.points();
  for (int id = 0; id < set.next_id(); ++id) {
    const int p = set.find(id);
    if (p < 0) continue;
    Vector3 x{};
    for (int d = 0; d < D; ++d) x[d] = set.position[d][p];
    for (int d = 0; d < 3; ++d) {
      f.positions.push_back(x[d]);
      f.fields[0].values.push_back(d < D ? set.velocity[d < D ? d : 0][p] : 0.0);
    }
    f.fields[1].values.push_back(cell_quantity(x, "pore_pressure_interpolated"));
    f.fields[2].values.push_back(set.volume[p]);
    f.fields[3].values.push_back(id);
  }
  return f;
}

#define POLDER_INSTANTIATE(D)                                                                      \
  template void Simulation::Run<D>::look_at_cells() const;                                         \
  template long Simulation::Run<D>::particles() const;                                             \
  template std::vector<Column> Simulation::Run<D>::history() const;                                \
  template int Simulation::Run<D>::probe_particle(const Vector3&) const;                           \
  template double Simulation::Run<D>::particle_quantity(int, const std::string&) const;            \
  template double Simulation::Run<D>::cell_quantity(const Vector3&, const std::string&) const;     \
  template double Simulation::Run<D>::body_quantity(const std::string&, const std::string&) const; \
  template Profile Simulation::Run<D>::profile(const Measure&) const;                              \
  template PointFrame Simulation::Run<D>::points(const std::vector<std::string>&) const;           \
  template PointFrame Simulation::Run<D>::water_points() const;
POLDER_INSTANTIATE(2)
POLDER_INSTANTIATE(3)

}  // namespace polder::coupling
