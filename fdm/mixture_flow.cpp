#include "fdm/mixture_flow.hpp"

#include "fdm/loops.hpp"
#include "fdm/node_gradient.hpp"

namespace polder::fdm {
namespace {

template <int D>
double node_flow(const MixtureMotion& m, int node, int axis, double n) {
  const std::size_t j = static_cast<std::size_t>(node) * NodeGradient<D>::kStride + axis;
  return (1 - n) * m.grains[j] + n * m.water[j];
}

template <int D>
double mobility_of(const MixtureMotion& m, const FaceNodes<D>& nodes, int axis, double n) {
  double sum = 0;
  int count = 0;
  for (int node : nodes) {
    const std::size_t j = static_cast<std::size_t>(node) * NodeGradient<D>::kStride + axis;
    const double response = (1 - n) * m.grains_response[j] + n * m.water_response[j];
    sum += response;
    count += response > 0;
  }
  return count > 0 ? sum / count : 0;
}

}  // namespace

template <int D>
void mixture_divergence(const WaterCells<D>& cells, const MixtureMotion& m, Reals& out) {
  constexpr double kMean = 1.0 / ipow(2, D - 1);
  const auto list = cells.cells();
  const auto interior = cells.interior_faces();
  const int n_interior = static_cast<int>(interior.size());
  out.resize(list.size());
  for_each(cells.count(), [&](int c) {
    const ActiveCell<D>& cell = list[c];
    const double own = m.porosity[cell.slot];
    double sum = 0;
    for (int side = 0; side < 2 * D; ++side) {
      const int axis = side / 2, upper = side % 2, face = cell.faces[side];
      double n = own;
      if (face >= 0 && face < n_interior)
        n = 0.5 * (own + m.porosity[list[upper ? interior[face].high : interior[face].low].slot]);
      double flow = 0;
      for (int corner = 0; corner < ipow(2, D); ++corner)
        if (((corner >> axis) & 1) == upper) flow += node_flow<D>(m, cell.nodes[corner], axis, n);
      sum += (upper ? kMean : -kMean) * flow * cell.areas[side];
    }
    out[c] = sum;
  });
}

template <int D>
void mixture_mobility(const WaterCells<D>& cells, const MixtureMotion& m, Reals& out) {
  const auto list = cells.cells();
  const auto interior = cells.interior_faces();
  const auto boundary = cells.boundary_faces();
  const int n_interior = static_cast<int>(interior.size());
  out.resize(interior.size() + boundary.size());
  for_each(n_interior, [&](int i) {
    const InteriorFace<D>& f = interior[i];
    const double n = 0.5 * (m.porosity[list[f.low].slot] + m.porosity[list[f.high].slot]);
    out[i] = mobility_of<D>(m, f.nodes, f.axis, n);
  });
  for_each(static_cast<int>(boundary.size()), [&](int b) {
    const BoundaryFace<D>& f = boundary[b];
    out[n_interior + b] = mobility_of<D>(m, f.nodes, f.axis, m.porosity[list[f.cell].slot]);
  });
}

template <int D>
double mixture_outflow(const WaterCells<D>& cells, const MixtureMotion& m, const BoundaryFace<D>& f) {
  const double n = m.porosity[cells.cells()[f.cell].slot];
  double flow = 0;
  for (int node : f.nodes) flow += node_flow<D>(m, node, f.axis, n);
  return f.outward * f.area * flow / static_cast<double>(f.nodes.size());
}

#define POLDER_INSTANTIATE(D)                                                              \
  template void mixture_divergence<D>(const WaterCells<D>&, const MixtureMotion&, Reals&); \
  template void mixture_mobility<D>(const WaterCells<D>&, const MixtureMotion&, Reals&);   \
  template double mixture_outflow<D>(const WaterCells<D>&, const MixtureMotion&, const BoundaryFace<D>&);
POLDER_INSTANTIATE(2)
POLDER_INSTANTIATE(3)

}  // namespace polder::fdm
