// What observers ask about the water in the cells: phreatic line, flow net, exit gradients, frames.
//
// Pressures [Pa], compression positive; heads [m]; flows [m3/s] per metre of thickness in plane strain, per
// radian in axisymmetric scenes. Definitions and signs: fdm/flow_results.hpp.
#include <algorithm>
#include <cmath>
#include <limits>

#include "coupling/simulation_run.hpp"
#include "fdm/flow_results.hpp"
#include "fdm/phreatic_exit.hpp"

namespace polder::coupling {
namespace {

// Density of the grains of the point nearest to a place.
double grain_density_at(const World<2>& world, const Point<2>& place) {
  double nearest = std::numeric_limits<double>::infinity(), density = 0;
  for (const auto& body : world.skeleton.bodies())
    for (int id = 0; id < body->count(); ++id) {
      const int p = body->find(id);
      const double x = body->position[0][p] - place[0], y = body->position[1][p] - place[1];
      if (x * x + y * y >= nearest) continue;
      nearest = x * x + y * y;
      density = body->density_solid;
    }
  return density;
}

// Cells with a point in them.
std::vector<unsigned char> occupied_cells(const World<2>& world) {
  const Grid<2>& grid = world.skeleton.grid();
  std::vector<unsigned char> occupied(static_cast<std::size_t>(grid.slots()), 0);
  for (const auto& body : world.skeleton.bodies())
    for (int p = 0; p < body->slots(); ++p) {
      if (body->id[p] < 0) continue;
      Index<2> cell;
      for (int d = 0; d < 2; ++d)
        cell[d] = static_cast<int>(std::floor((body->position[d][p] - grid.origin()[d]) / grid.spacing()));
      const int slot = grid.is_cell(cell) ? grid.slot(cell) : -1;
      if (slot >= 0) occupied[static_cast<std::size_t>(slot)] = 1;
    }
  return occupied;
}

// A free surface of saturated soil that lies under soil, which is not part of the system, is no place where
// water leaves the ground. The cell next to the surface may hold a sliver: the one after it tells.
bool is_buried(const Grid<2>& grid, const std::vector<unsigned char>& occupied, const fdm::ExitGradient& g) {
  if (g.boundary >= 0) return false;
  Index<2> beyond = grid.index(g.slot);
  beyond[g.axis] += 2 * g.outward;
  const int slot = grid.is_cell(beyond) ? grid.slot(beyond) : -1;
  return slot >= 0 && occupied[static_cast<std::size_t>(slot)] != 0;
}

std::vector<FlowExit> find_exits(const World<2>& world) {
  const PoreWater<2>& water = *world.pore_water;
  const auto& bodies = world.skeleton.bodies();
  const bool alike = std::all_of(bodies.begin(), bodies.end(), [&](const auto& b) {
    return b->density_solid == bodies.front()->density_solid;
  });
  const std::vector<unsigned char> occupied = occupied_cells(world);
  std::vector<FlowExit> exits;
  for (const fdm::ExitGradient& g : fdm::exit_gradients(water.cells, water.pore_pressure())) {
    if (is_buried(world.skeleton.grid(), occupied, g)) continue;
    FlowExit e;
    e.place = {g.place[0], g.place[1], 0};
    e.direction[g.axis] = g.outward;
    e.boundary = g.boundary;
    e.gradient = g.gradient;
    const double density = alike ? bodies.front()->density_solid : grain_density_at(world, g.place);
    e.critical = fdm::critical_gradient(water.porosity[g.slot], density, world.scene.water.density);
    exits.push_back(e);
  }
  return exits;
}

}  // namespace

template <int D>
std::vector<std::pair<double, double>> Simulation::Run<D>::phreatic_line() const {
  std::vector<std::pair<double, double>> line;
  if (!world->pore_water || D != 2) return line;
  look_at_cells();
  if constexpr (D == 2)
    if (world->pore_water->unsaturated) {
      const PoreWater<D>& w = *world->pore_water;
      line = fdm::phreatic_line(w.cells, w.pore_pressure());
      for (const fdm::PhreaticExit& e : fdm::phreatic_exits(w.cells, w.pore_pressure()))
        if (e.found) line.emplace_back(e.place[0], e.place[1]);
      std::sort(line.begin(), line.end());
      return line;
    }
  // Saturated soil has its surface where its cells end.
  const PoreWater<D>& water = *world->pore_water;
  const Grid<D>& grid = world->skeleton.grid();
  for (const auto& face : water.cells.boundary_faces()) {
    if (face.axis != D - 1 || face.outward < 0 || face.outside < 0) continue;
    const Point<D> c = water.cells.centre(water.cells.cells()[face.cell].index);
    line.emplace_back(c[0], c[D - 1] + std::min(face.distance, 1.5 * grid.spacing()));
  }
  // Above a hole in the water lies its surface all the same: the highest point of each column of cells
  // counts.
  std::sort(line.begin(), line.end());
  const auto first = std::unique(line.rbegin(), line.rend(),
                                 [](const auto& a, const auto& b) { return a.first == b.first; });
  line.erase(line.begin(), first.base());
  return line;
}

template <int D>
FlowNet Simulation::Run<D>::flow_net() const {
  FlowNet net;
  if constexpr (D == 2) {
    if (!world->pore_water) return net;
    look_at_cells();
    const PoreWater<D>& water = *world->pore_water;
    const fdm::StreamFunction psi =
        water.unsaturated
            ? fdm::stream_function(water.cells, water.unsaturated->field.face_flow())
            : fdm::stream_function(water.cells, water.pressure.darcy_flow(water.darcy_mobility));
    const Grid<D>& grid = world->skeleton.grid();
    for (int slot = 0; slot < grid.slots(); ++slot) {
      if (std::isnan(psi.value[slot])) continue;
      const Point<D> x = grid.position(grid.index(slot));
      net.stream_function.push_back({x[0], x[1], psi.value[slot]});
    }
    net.lowest = psi.lowest, net.highest = psi.highest, net.defect = psi.defect;
    net.exits = find_exits(*world);
    if (!water.unsaturated) return net;
    for (const fdm::PhreaticExit& e : fdm::phreatic_exits(water.cells, water.pore_pressure()))
      net.seepage_ends.push_back({{e.place[0], e.place[1], 0}, e.slope, e.boundary, e.found});
  }
  return net;
}

template <int D>
CellFrame Simulation::Run<D>::water_cells() const {
  CellFrame f;
  f.corners_per_cell = ipow(2, D);
  f.fields = {{"pore_pressure", 1, {}}, {"head", 1, {}}, {"fill", 1, {}}};
  if (!world->pore_water) return f;
  look_at_cells();
  const PoreWater<D>& water = *world->pore_water;
  if (water.unsaturated) f.fields.push_back({"saturation", 1, {}});
  const Grid<D>& grid = world->skeleton.grid();
  std::vector<int> vertex(grid.slots(), -1);
  static const int order[] = {0, 1, 3, 2, 4, 5, 7, 6};  // VTK turns around each layer
  for (const auto& cell : water.cells.cells()) {
    for (int k = 0; k < f.corners_per_cell; ++k) {
      const int slot = cell.nodes[order[k]];
      if (vertex[slot] < 0) {
        vertex[slot] = static_cast<int>(f.vertices.size() / 3);
        const Point<D> x = grid.position(grid.index(slot));
        for (int d = 0; d < 3; ++d) f.vertices.push_back(d < D ? x[d < D ? d : 0] : 0.0);
      }
      f.corners.push_back(vertex[slot]);
    }
    const double p = water.pore_pressure()[cell.slot];
    f.fields[0].values.push_back(p);
    f.fields[1].values.push_back(p / world->unit_weight() + water.cells.centre(cell.index)[D - 1]);
    f.fields[2].values.push_back(water.fill[cell.slot]);
    if (water.unsaturated) f.fields[3].values.push_back(water.unsaturated->field.saturation()[cell.slot]);
  }
  return f;
}

#define POLDER_INSTANTIATE(D)                                                                \
  template std::vector<std::pair<double, double>> Simulation::Run<D>::phreatic_line() const; \
  template FlowNet Simulation::Run<D>::flow_net() const;                                     \
  template CellFrame Simulation::Run<D>::water_cells() const;
POLDER_INSTANTIATE(2)
POLDER_INSTANTIATE(3)

}  // namespace polder::coupling
