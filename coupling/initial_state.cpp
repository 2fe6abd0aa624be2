#include "coupling/initial_state.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "core/error.hpp"
#include "core/threads.hpp"
#include "coupling/body_shape.hpp"
#include "coupling/mean_share.hpp"
#include "coupling/unsaturated.hpp"

namespace polder::coupling {
namespace {

constexpr double kNowhere = -1e300;  // a level below everything
constexpr double kOnEdge = 1e-6;     // cells that a place may lie beside a part of the surface

template <int D>
Vector3 at(const ParticleSet<D>& set, int p) {
  Vector3 v{};
  for (int d = 0; d < D; ++d) v[d] = set.position[d][p];
  return v;
}

// Height of the water table over x where the scene draws one.
double water_table(const WaterSpec& water, const Vector3& x) {
  return height_at(water.phreatic, x[0]);
}

// Total vertical stress at x, compression positive, from the weight above. saturation: degree of it at a
// place, where pores may hold air; else pores are full below the phreatic line.
double overburden(const Scene& scene, const std::vector<BodyShape>& shapes,
                  const std::vector<BodyShape>& waters, const Vector3& x, int up, bool wet,
                  const std::function<double(const Vector3&)>& saturation) {
  double g = 0;
  for (int d = 0; d < 3; ++d) g += scene.gravity[d] * scene.gravity[d];
  g = std::sqrt(g);
  double stress = 0;
  for (std::size_t b = 0; b < shapes.size(); ++b) {
    const mpm::MaterialParameters& m = scene.materials[scene.bodies[b].material];
    for (auto [low, high] : shapes[b].vertical_intervals(x)) {
      low = std::max(low, x[up]);
      if (high <= low) continue;
      const double dry = m.dry_density(), pores = m.porosity * scene.water.density;
      double density = dry * (high - low);
      if (wet && m.porosity > 0 && saturation) {
        const int pieces = static_cast<int>(std::ceil(2 * (high - low) / scene.grid.cell));
        const double length = (high - low) / pieces;
        Vector3 at = x;
        for (int i = 0; i < pieces; ++i) {
          at[up] = low + (i + 0.5) * length;
          density += pores * length * saturation(at);
        }
      } else if (wet && m.porosity > 0) {
        const double table =
            scene.water.phreatic.empty() ? high : std::clamp(water_table(scene.water, x), low, high);
        density += pores * ((table - low) + scene.water.saturation_above * (high - table));
      }
      stress += density * g;
    }
  }
  for (const BodyShape& water : waters)  // what stands free above; the soil's own water is counted already
    for (auto [low, high] : water.vertical_intervals(x)) {
      low = std::max(low, x[up]);
      double depth = std::max(0.0, high - low);
      for (const BodyShape& soil : shapes)
        for (const auto& [bottom, top] : soil.vertical_intervals(x))
          depth -= std::max(0.0, std::min(top, high) - std::max(bottom, low));
      stress += std::max(0.0, depth) * scene.water.density * g;
    }
  return stress;
}

// Highest soil over x.
double ground_over(const std::vector<BodyShape>& shapes, const Vector3& x) {
  double top = kNowhere;
  for (const BodyShape& shape : shapes)
    for (const auto& [low, high] : shape.vertical_intervals(x)) top = std::max(top, high);
  return top;
}

// Level at the start of the open water that stands on the soil over x, whose surface lies at `ground` there:
// the level outside, or that of a head or a pressure on the soil's surface.
double pond_level(const Scene& scene, Vector3 x, double ground, double unit_weight) {
  double level = scene.water.outside_level ? scene.water.outside_level->at(0) : kNowhere;
  const std::size_t dimension = static_cast<std::size_t>(scene.dimension());
  x[dimension - 1] = ground;
  for (const WaterBoundary& w : scene.water_boundaries) {
    using Kind = WaterBoundary::Kind;
    if (w.side != WaterBoundary::kOnSurface || (w.kind != Kind::head && w.kind != Kind::pressure)) continue;
    bool covers = true;
    for (std::size_t d = 0; w.from && w.to && d < dimension; ++d)
      covers = covers && x[d] >= std::min((*w.from)[d], (*w.to)[d]) - kOnEdge * scene.grid.cell &&
               x[d] <= std::max((*w.from)[d], (*w.to)[d]) + kOnEdge * scene.grid.cell;
    if (!covers) continue;
    const double value = w.value.at(0);
    level = std::max(level, w.kind == Kind::head ? value : ground + value / unit_weight);
  }
  return level > ground ? level : kNowhere;
}

// Top of the saturated soil above x, or of the open water on it: where a hydrostatic pore pressure is zero.
double pressure_datum(const Scene& scene, const std::vector<BodyShape>& shapes,
                      const std::vector<BodyShape>& waters, const Vector3& x, double unit_weight) {
  double top = kNowhere;
  for (std::size_t b = 0; b < shapes.size(); ++b)
    if (scene.materials[scene.bodies[b].material].porosity > 0)
      for (const auto& [low, high] : shapes[b].vertical_intervals(x)) top = std::max(top, high);
  if (!scene.water.phreatic.empty()) top = std::min(top, water_table(scene.water, x));
  for (const BodyShape& water : waters)
    for (const auto& [low, high] : water.vertical_intervals(x)) top = std::max(top, high);
  return std::max(top, pond_level(scene, x, ground_over(shapes, x), unit_weight));
}

double k0_at(const InitialStress& s, double depth) {
  std::size_t layer = 0;
  while (layer < s.layer_depth.size() && layer + 1 < s.k0.size() && depth > s.layer_depth[layer]) ++layer;
  return s.k0[layer];
}

std::vector<BodyShape> shapes_of(const std::vector<Body>& bodies, const GridSpec& grid) {
  std::vector<BodyShape> shapes;
  for (const Body& b : bodies) shapes.emplace_back(b, grid);
  return shapes;
}

}  // namespace

template <int D>
void set_saturation(World<D>& world) {
  const WaterSpec& water = world.scene.water;
  for (auto& body : world.skeleton.bodies()) {
    ParticleSet<D>& set = *body;
    const Material& m = world.scene.materials[set.material];
    if (m.porosity <= 0) continue;
    const int capillary = world.layouts[set.material].capillary_factor;
    const int n = set.slots();
    // In two layers the soil's own points hold only the water that stays with the grains above the phreatic
    // line.
    const bool layered = world.pore_water->layer != nullptr;
    set.pore_water.assign(n, layered ? 0.0 : water.density);
    set.wet.assign(n, 1.0);
    if (set.conductivity.empty())
      set.conductivity.assign(n, m.hydraulic_conductivity);  // else a random field
    if (m.kozeny_carman)
      for (double& k : set.conductivity) k /= kozeny_carman(m.porosity);
    if (capillary >= 0) std::fill(set.state[capillary].begin(), set.state[capillary].end(), 0.0);
    if (world.pore_water->unsaturated) {  // set_unsaturated_state() fills it in
      set.suction_stress.assign(n, 0.0);
      continue;
    }
    if (water.phreatic.empty()) continue;
    if (water.suction_above != 0) set.suction_stress.assign(n, 0.0);
    if (world.scene.retains_water()) set.retained_water.assign(n, 0.0);
    for (int p = 0; p < n; ++p) {
      if (set.id[p] >= 0 && world.scene.retains_water()) {
        Point<D> x, sides;
        for (int d = 0; d < D; ++d) x[d] = set.position[d][p], sides[d] = 2 * set.half_size[d][p];
        // Of a point that the line cuts, the part above it: the points of water begin at the line too.
        const double above = mean_share<D>(
            x, sides, [&](const Vector3& y) { return y[D - 1] > water_table(water, y) ? 1.0 : 0.0; });
        set.retained_water[p] = above * water.saturation_above * water.density *
                                (set.volume[p] - set.mass[p] / set.density_solid);
      }
      if (set.position[D - 1][p] <= water_table(water, at(set, p))) continue;
      if (!layered) {
        set.wet[p] = 0;
        set.pore_water[p] = water.saturation_above * water.density;
      }
      if (!set.suction_stress.empty()) set.suction_stress[p] = water.saturation_above * water.suction_above;
      if (capillary >= 0) set.state[capillary][p] = 1;
    }
  }
}

template <int D>
void set_initial_stress(World<D>& world) {
  const Scene& scene = world.scene;
  const std::vector<BodyShape> shapes = shapes_of(scene.bodies, scene.grid);
  const std::vector<BodyShape> waters = shapes_of(scene.water_bodies, scene.grid);
  const bool wet = world.pore_water != nullptr;
  const PoreWater<D>* unsaturated = wet && world.pore_water->unsaturated ? world.pore_water.get() : nullptr;
  std::function<double(const Vector3&)> saturation;
  if (unsaturated != nullptr)
    saturation = [&](const Vector3& x) {
      Index<D> cell;
      for (int d = 0; d < D; ++d)
        cell[d] = static_cast<int>(std::floor((x[d] - scene.grid.origin[d]) / scene.grid.cell));
      const int slot = world.skeleton.grid().is_cell(cell) ? world.skeleton.grid().slot(cell) : -1;
      return slot >= 0 && unsaturated->cells.active(slot) ? unsaturated->unsaturated->field.saturation()[slot]
                                                          : 1.0;
    };
  const double unit_weight = world.unit_weight();
  constexpr int kUp = D - 1, kVertical = D == 2 ? 1 : 2;  // component of the vertical stress
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const InitialStress& initial = scene.bodies[b].stress;
    ParticleSet<D>& set = *world.skeleton.bodies()[b];
    for (int p = 0; p < set.slots(); ++p) {
      const Vector3 x = at(set, p);
      if (initial.kind == InitialStress::Kind::field) {
        for (int k = 0; k < ParticleSet<D>::kStress; ++k)
          set.stress[k][p] = initial.value[k] + initial.gradient[k] * (x[kUp] - initial.datum);
      } else if (initial.kind == InitialStress::Kind::k0) {
        const bool full = wet && !set.wet.empty() && set.wet[p] > 0 &&
                          (scene.water.phreatic.empty() || x[kUp] <= water_table(scene.water, x));
        double pressure = 0;
        if (unsaturated != nullptr)
          pressure = set.wet.empty() ? 0.0 : pushing_pressure_at(world, set, p);
        else if (full)
          pressure =
              std::max(0.0, unit_weight * (pressure_datum(scene, shapes, waters, x, unit_weight) - x[kUp]));
        double total = overburden(scene, shapes, waters, x, kUp, wet, saturation);
        if (wet) {  // open water standing on the surface
          const double ground = ground_over(shapes, x);
          total += unit_weight * std::max(0.0, pond_level(scene, x, ground, unit_weight) - ground);
        }
        const double vertical = std::max(0.0, total - pressure);
        const double horizontal = k0_at(initial, shapes[b].upper()[kUp] - x[kUp]) * vertical;
        const double suction = set.suction_stress.empty() ? 0.0 : set.suction_stress[p];
        for (int k = 0; k < 3; ++k) set.stress[k][p] = -(k == kVertical ? vertical : horizontal) - suction;
      } else if (!set.suction_stress.empty()) {
        for (int k = 0; k < 3; ++k) set.stress[k][p] = -set.suction_stress[p];
      }
    }
  }
}

std::function<double(const Vector3&)> initial_pressure(const Scene& scene, double unit_weight) {
  const int up = scene.dimension() - 1;
  switch (scene.water.initial) {
    case WaterSpec::Initial::zero:
      return [](const Vector3&) { return 0.0; };
    case WaterSpec::Initial::field:
      return [&scene, up](const Vector3& x) {
        return scene.water.initial_pressure +
               scene.water.initial_gradient * (x[up] - scene.water.initial_datum);
      };
    case WaterSpec::Initial::steady:  // begins from here where it is found step by step
    case WaterSpec::Initial::hydrostatic:
      break;
  }
  return [&scene, up, unit_weight, shapes = shapes_of(scene.bodies, scene.grid),
          waters = shapes_of(scene.water_bodies, scene.grid)](const Vector3& x) {
    const double hydrostatic = unit_weight * (pressure_datum(scene, shapes, waters, x, unit_weight) - x[up]);
    return scene.unsaturated() ? hydrostatic : std::max(0.0, hydrostatic);
  };
}

template <int D>
void set_cell_pressure(const World<D>& world, Reals& p) {
  const PoreWater<D>& water = *world.pore_water;
  const auto pressure = initial_pressure(world.scene, world.unit_weight());
  if (world.scene.water.initial == WaterSpec::Initial::zero) std::fill(p.begin(), p.end(), 0.0);
  for (const fdm::ActiveCell<D>& cell : water.cells.cells()) {
    Vector3 x{};
    const Point<D> c = water.cells.centre(cell.index);
    for (int d = 0; d < D; ++d) x[d] = c[d];
    p[cell.slot] = pressure(x);
  }
}

namespace {

// Conductivity over unit weight where drag stands for it otherwise; free water conducts as well as makes no
// difference.
template <int D>
Reals steady_mobility(const World<D>& world) {
  constexpr double kFreeWater = 1e4;  // over the best soil
  const PoreWater<D>& water = *world.pore_water;
  const int slots = world.skeleton.grid().slots();
  Reals mobility(slots, 0.0);
  double best = 0;
  for (int i = 0; i < slots; ++i) {
    const double* s = &water.cell_sums[static_cast<std::size_t>(i) * 4];
    if (s[0] > 0) mobility[i] = s[2] / s[0] / world.unit_weight();
    best = std::max(best, mobility[i]);
  }
  for (double& m : mobility)
    if (m == 0) m = kFreeWater * best;
  return mobility;
}

}  // namespace

template <int D>
void set_initial_pressure(World<D>& world) {
  PoreWater<D>& water = *world.pore_water;
  if (water.unsaturated)
    set_unsaturated_state(world);
  else if (world.scene.water.initial == WaterSpec::Initial::steady)
    water.pressure.steady(water.layer ? steady_mobility(world) : water.darcy_mobility);
  else
    set_cell_pressure(world, water.pressure.pressure());
}

template <int D>
void wet_points(World<D>& world) {
  const Grid<D>& grid = world.skeleton.grid();
  mpm::Sleep<D>* sleep = world.skeleton.sleep();
  std::vector<std::uint8_t> changed;  // blocks; where soil sleeps
  if (sleep != nullptr) changed.assign(grid.occupied_blocks(), 0);
  for (auto& body : world.skeleton.bodies()) {
    ParticleSet<D>& set = *body;
    if (set.suction_stress.empty()) continue;
    const int capillary = world.layouts[set.material].capillary_factor;
    const auto wet = [&](int p) {
      if (set.id[p] < 0 || (set.wet[p] > 0 && !world.pore_water->layer) ||
          (set.suction_stress[p] == 0 && (capillary < 0 || set.state[capillary][p] == 0)))
        return false;
      const int slot = grid.slot(set.cell_of(grid, p));
      if (slot < 0 || !world.pore_water->cells.active(slot)) return false;
      set.suction_stress[p] = 0;
      if (capillary >= 0) set.state[capillary][p] = 0;
      return true;
    };
    parallel_for(static_cast<int>(set.ranges.size()), [&](int block) {
      const auto range = set.ranges[block];
      for (int p = range.first; p < range.first + range.count; ++p)
        if (wet(p) && !changed.empty()) changed[block] = 1;
    });
  }
  if (sleep != nullptr) sleep->wake(changed);
}

#define POLDER_INSTANTIATE(D)                                  \
  template void set_saturation<D>(World<D>&);                  \
  template void set_initial_stress<D>(World<D>&);              \
  template void set_cell_pressure<D>(const World<D>&, Reals&); \
  template void set_initial_pressure<D>(World<D>&);            \
  template void wet_points<D>(World<D>&);
POLDER_INSTANTIATE(2)
POLDER_INSTANTIATE(3)

}  // namespace polder::coupling
