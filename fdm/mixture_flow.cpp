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

// Mean flow through a face along its axis times its area, and mobility.
template <int D>
void face_motion(const MixtureMotion& m, const FaceNodes<D>& nodes, int axis, double area, double n,
                 double& flow, double& mobility) {
  constexpr double kMean = 1.0 / ipow(2, D - 1);
  double velocity = 0, response = 0;
  int count = 0;
  for (int node : nodes) {
    const std::size_t j = static_cast<std::size_t>(node) * NodeGradient<D>::kStride + axis;
    velocity += (1 - n) * m.grains[j] + n * m.water[j];
    const double r = (1 - n) * m.grains_response[j] + n * m.water_response[j];
    response += r;
    count += r > 0;
  }
  flow = kMean * velocity * area;
  mobility = count > 0 ? response / count : 0;
}

}  // namespace

template <int D>
void mixture_flow(const WaterCells<D>& cells, const MixtureMotion& m, Reals& flow, Reals& mobility,
                  Reals& divergence) {
  constexpr double kMean = 1.0 / ipow(2, D - 1);
  const auto list = cells.cells();
  const auto interior = cells.interior_faces();
  const auto boundary = cells.boundary_faces();
  const int n_interior = static_cast<int>(interior.size());
  flow.resize(interior.size() + boundary.size());
  mobility.resize(flow.size());
  for_each(n_interior, [&](int i) {
    const InteriorFace<D>& f = interior[i];
    const double n = 0.5 * (m.porosity[list[f.low].slot] + m.porosity[list[f.high].slot]);
    face_motion<D>(m, f.nodes, f.axis, f.area, n, flow[i], mobility[i]);
  });
  for_each(static_cast<int>(boundary.size()), [&](int b) {
    const BoundaryFace<D>& f = boundary[b];
    face_motion<D>(m, f.nodes, f.axis, f.area, m.porosity[list[f.cell].slot], flow[n_interior + b],
                   mobility[n_interior + b]);
  });
  divergence.resize(list.size());
  for_each(cells.count(), [&](int c) {
    const ActiveCell<D>& cell = list[c];
    double sum = 0;
    for (int side = 0; side < 2 * D; ++side) {
      const int axis = side / 2, upper = side % 2, face = cell.faces[side];
      double out = face >= 0 ? flow[face] : 0;
      if (face < 0 && cell.areas[side] > 0) {  // a wall, which may move
        for (int corner = 0; corner < ipow(2, D); ++corner)
          if (((corner >> axis) & 1) == upper)
            out += node_flow<D>(m, cell.nodes[corner], axis, m.porosity[cell.slot]);
        out *= kMean * cell.areas[side];
      }
      sum += upper ? out : -out;
    }
    divergence[c] = sum;
  });
}

template <int D>
double mixture_outflow(const WaterCells<D>& cells, const MixtureMotion& m, const BoundaryFace<D>& f) {
  const double n = m.porosity[cells.cells()[f.cell].slot];
  double flow = 0;
  for (int node : f.nodes) flow += node_flow<D>(m, node, f.axis, n);
  return f.outward * f.area * flow / static_cast<double>(f.nodes.size());
}

#define POLDER_INSTANTIATE(D)                                                                        \
  template void mixture_flow<D>(const WaterCells<D>&, const MixtureMotion&, Reals&, Reals&, Reals&); \
  template double mixture_outflow<D>(const WaterCells<D>&, const MixtureMotion&, const BoundaryFace<D>&);
POLDER_INSTANTIATE(2)
POLDER_INSTANTIATE(3)

}  // namespace polder::fdm
