#include "fdm/flow_results.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>

#include "fdm/boundary_flow.hpp"

namespace polder::fdm {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

// psi(to) - psi(from) = flow.
struct Edge {
  int from, to;
  double flow;
};

// A side with the flow along its axis: across x upwards along the side, across y from right to left.
Edge edge(int axis, const FaceNodes<2>& nodes, double flow) {
  return axis == 0 ? Edge{nodes[0], nodes[1], flow} : Edge{nodes[1], nodes[0], flow};
}

std::vector<Edge> edges_of(const WaterCells<2>& cells, std::span<const double> face_flow) {
  const auto interior = cells.interior_faces();
  const auto boundary = cells.boundary_faces();
  if (face_flow.size() != interior.size() + boundary.size())
    throw std::logic_error("stream_function: one flow for each face is due");
  std::vector<Edge> edges;
  for (std::size_t i = 0; i < interior.size(); ++i)
    edges.push_back(edge(interior[i].axis, interior[i].nodes, -face_flow[i]));
  for (std::size_t b = 0; b < boundary.size(); ++b)
    edges.push_back(
        edge(boundary[b].axis, boundary[b].nodes, -face_flow[interior.size() + b] * boundary[b].outward));
  for (const ActiveCell<2>& c : cells.cells()) {
    const FaceNodes<2> sides[] = {{c.nodes[0], c.nodes[2]},
                                  {c.nodes[1], c.nodes[3]},
                                  {c.nodes[0], c.nodes[1]},
                                  {c.nodes[2], c.nodes[3]}};
    for (int side = 0; side < 4; ++side)
      if (c.faces[side] < 0) edges.push_back(edge(side / 2, sides[side], 0));
  }
  return edges;
}

}  // namespace

std::vector<std::pair<double, double>> phreatic_line(const WaterCells<2>& cells,
                                                     std::span<const double> pressure) {
  const double weight = cells.conditions().unit_weight, h = cells.grid().spacing();
  const int n_interior = static_cast<int>(cells.interior_faces().size());
  std::map<int, double> highest;  // by column
  for (const ActiveCell<2>& c : cells.cells()) {
    const double p = pressure[c.slot];
    if (p <= 0) continue;
    const double z = cells.centre(c.index)[1];
    const int face = c.faces[3];
    double level = 0;
    if (face >= 0 && face < n_interior) {
      const InteriorFace<2>& f = cells.interior_faces()[face];
      const double above = pressure[cells.cells()[f.high].slot];
      if (above > 0) continue;
      level = z + h * p / (p - above);
    } else {
      const double rest = face < 0 ? 0.5 * h : cells.boundary_faces()[face - n_interior].distance;
      level = z + std::min(p / weight, rest);
    }
    const auto [place, is_new] = highest.emplace(c.index[0], level);
    if (!is_new) place->second = std::max(place->second, level);
  }
  std::vector<std::pair<double, double>> line;
  for (const auto& [column, level] : highest)
    line.emplace_back(cells.grid().origin()[0] + (column + 0.5) * h, level);
  return line;
}

StreamFunction stream_function(const WaterCells<2>& cells, std::span<const double> face_flow) {
  const std::vector<Edge> edges = edges_of(cells, face_flow);
  const int slots = cells.grid().slots();
  std::vector<int> first(slots + 1, 0), next;  // edges at each node
  for (const Edge& e : edges) ++first[e.from + 1], ++first[e.to + 1];
  for (int s = 0; s < slots; ++s) first[s + 1] += first[s];
  next.assign(first.begin(), first.end() - 1);
  std::vector<int> at_node(first[slots]);
  for (int k = 0; k < static_cast<int>(edges.size()); ++k)
    at_node[next[edges[k].from]++] = k, at_node[next[edges[k].to]++] = k;

  StreamFunction psi;
  psi.value.assign(slots, kNone);
  std::vector<int> reached;
  for (int start = 0; start < slots; ++start) {
    if (first[start] == first[start + 1] || !std::isnan(psi.value[start])) continue;
    psi.value[start] = 0;
    reached.assign(1, start);
    for (std::size_t r = 0; r < reached.size(); ++r) {
      const int node = reached[r];
      for (int k = first[node]; k < first[node + 1]; ++k) {
        const Edge& e = edges[at_node[k]];
        const int other = e.from == node ? e.to : e.from;
        if (!std::isnan(psi.value[other])) continue;
        psi.value[other] = psi.value[node] + (e.from == node ? e.flow : -e.flow);
        reached.push_back(other);
      }
    }
  }
  for (double v : psi.value) {
    if (std::isnan(v)) continue;
    psi.lowest = std::min(psi.lowest, v);
    psi.highest = std::max(psi.highest, v);
  }
  const double range = psi.highest - psi.lowest;
  for (const Edge& e : edges)
    if (range > 0)
      psi.defect = std::max(psi.defect, std::abs(psi.value[e.to] - psi.value[e.from] - e.flow) / range);
  return psi;
}

std::vector<ExitGradient> exit_gradients(const WaterCells<2>& cells, std::span<const double> pressure) {
  const double weight = cells.conditions().unit_weight;
  std::vector<ExitGradient> found;
  for (const BoundaryFace<2>& f : cells.boundary_faces()) {
    const BoundaryLaw law = boundary_law(f, cells.conditions());
    if (law.kind == BoundaryLaw::Kind::closed || law.kind == BoundaryLaw::Kind::flow) continue;
    const ActiveCell<2>& c = cells.cells()[f.cell];
    Point<2> place = cells.centre(c.index);
    const double rise = f.axis == 1 ? f.outward * f.distance : 0;
    const double gradient = ((pressure[c.slot] - law.upper) / weight - rise) / f.distance;
    if (!(gradient > 0)) continue;
    place[f.axis] += f.outward * f.distance;
    found.push_back({place, c.slot, f.axis, f.outward, f.boundary, gradient});
  }
  return found;
}

std::optional<ExitGradient> largest_upward(std::span<const ExitGradient> gradients,
                                           std::optional<int> boundary) {
  std::optional<ExitGradient> largest;
  for (const ExitGradient& g : gradients) {
    if (g.axis != 1 || g.outward < 0 || (boundary && g.boundary != *boundary)) continue;
    if (!largest || g.gradient > largest->gradient) largest = g;
  }
  return largest;
}

double critical_gradient(double porosity, double density_solid, double density_water) {
  return (1 - porosity) * (density_solid / density_water - 1);
}

double heave_factor(double critical, double gradient) {
  return gradient > 0 ? critical / gradient : std::numeric_limits<double>::infinity();
}

}  // namespace polder::fdm
