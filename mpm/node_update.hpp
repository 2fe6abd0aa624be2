// The momentum balance of a step at the nodes, on the arrays of mpm/transfer.hpp: sums of eight and
// velocities of four numbers a slot.
//
//   v = v_old + dt a,     a = f / m + g + (what another phase adds)
//
// of nodes heavier than the floor, v = v_old of the others. Local damping (Cundall 1987): the share alpha of
// a component that drives the motion is taken off, and added to one that brakes it.
#pragma once

#include <cstdint>
#include <vector>

#include "core/grid.hpp"
#include "core/simd_level.hpp"

namespace polder::mpm {

template <int D>
struct NodePrediction {
  double dt = 0;
  Point<D> gravity{};
  double damping = 0;                               // alpha
  double mass_floor = 0;                            // [kg]
  const Reals* acceleration = nullptr;              // of another phase [slots * 4], or none
  const std::vector<std::uint8_t>* held = nullptr;  // bit d: component d is not damped [slots]
};

}  // namespace polder::mpm

namespace polder {
POLDER_SIMD_DECLARE(double, predict_velocities, const Grid<2>&, const mpm::NodePrediction<2>&, const Reals&,
                    const Reals&, Reals&)
POLDER_SIMD_DECLARE(double, predict_velocities, const Grid<3>&, const mpm::NodePrediction<3>&, const Reals&,
                    const Reals&, Reals&)
POLDER_SIMD_DECLARE(double, squared_impulse, const Grid<2>&, const Reals&, const Reals&, const Reals&)
POLDER_SIMD_DECLARE(double, squared_impulse, const Grid<3>&, const Reals&, const Reals&, const Reals&)

namespace mpm {

// Returns the sum of m^2 over the nodes that feel forces [kg2].
template <int D>
double predict_velocities(const Grid<D>& grid, const NodePrediction<D>& prediction, const Reals& sums,
                          const Reals& v_old, Reals& v) {
  return POLDER_SIMD_CALL(predict_velocities, grid, prediction, sums, v_old, v);
}

// Sum of (m |after - before|)^2 over the nodes [N2 s2].
template <int D>
double squared_impulse(const Grid<D>& grid, const Reals& sums, const Reals& before, const Reals& after) {
  return POLDER_SIMD_CALL(squared_impulse, grid, sums, before, after);
}

}  // namespace mpm
}  // namespace polder
