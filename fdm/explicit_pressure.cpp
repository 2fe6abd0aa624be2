#include "fdm/explicit_pressure.hpp"

#include <cmath>
#include <stdexcept>

#include "fdm/loops.hpp"

namespace polder::fdm {
namespace {

// The smallest positive root of wave dt^2 + diffusion dt = 1.
double longest_step(double wave, double diffusion) {
  return 2 / (diffusion + std::sqrt(diffusion * diffusion + 4 * wave));
}

template <int D>
void require(const WaterCells<D>& cells, std::size_t of_cells, std::size_t of_faces) {
  if (of_cells < cells.cells().size() ||
      of_faces < cells.interior_faces().size() + cells.boundary_faces().size())
    throw std::logic_error("explicit pressure: an array does not cover the cells or their faces");
}

}  // namespace

template <int D>
void net_inflow(const WaterCells<D>& cells, std::span<const double> outflow,
                std::span<const double> face_flow, std::span<double> inflow) {
  require(cells, std::min(outflow.size(), inflow.size()), face_flow.size());
  const auto list = cells.cells();
  const int interior = static_cast<int>(cells.interior_faces().size());
  for_each(cells.count(), [&](int c) {
    double sum = -outflow[c];
    for (int side = 0; side < 2 * D; ++side) {
      const int face = list[c].faces[side];
      if (face < 0) continue;
      // Flow along the axis leaves the high cell of a face, whose lower side it is.
      sum += face >= interior || side % 2 ? face_flow[face] : -face_flow[face];
    }
    inflow[c] = sum;
  });
}

template <int D>
ExplicitLimit explicit_limit(const WaterCells<D>& cells, const ExplicitRates& rates) {
  require(cells, rates.storage.size(), std::min(rates.darcy.size(), rates.inertia.size()));
  const auto list = cells.cells();
  const int interior = static_cast<int>(cells.interior_faces().size());
  ExplicitLimit limit;
  for (int c = 0; c < cells.count(); ++c) {
    const double per_storage = 1 / rates.storage[c];
    double wave_sum = 0, diffusion_sum = 0;
    for (int axis = 0; axis < D; ++axis) {
      double wave = 0, diffusion = 0;
      for (int side = 2 * axis; side < 2 * axis + 2; ++side) {
        const int face = list[c].faces[side];
        if (face < 0) continue;
        const double rows = face < interior ? 2 : 1;
        wave += rows * rates.inertia[face], diffusion += rows * rates.darcy[face];
      }
      wave *= 0.25 * per_storage, diffusion *= 0.5 * per_storage;
      wave_sum += wave, diffusion_sum += diffusion;
      const double dt = longest_step(wave, diffusion);
      if (dt < limit.dt) limit = {dt, diffusion * dt > 0.5};
    }
    const double dt = longest_step(2 * rates.chi * wave_sum, diffusion_sum);
    if (dt < limit.dt) limit = {dt, true};
  }
  return limit;
}

#define POLDER_INSTANTIATE(D)                                                                         \
  template void net_inflow<D>(const WaterCells<D>&, std::span<const double>, std::span<const double>, \
                              std::span<double>);                                                     \
  template ExplicitLimit explicit_limit<D>(const WaterCells<D>&, const ExplicitRates&);
POLDER_INSTANTIATE(2)
POLDER_INSTANTIATE(3)

}  // namespace polder::fdm
