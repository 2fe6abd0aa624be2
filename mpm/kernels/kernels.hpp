// The kernels of every vector level, for the dispatcher (mpm/transfer.cpp).
#pragma once

#include <memory>

#include "mpm/transfer.hpp"

#define POLDER_DECLARE_KERNELS(D)                                                                           \
  POLDER_SIMD_DECLARE(void, scatter_state, mpm::Transfer<D>&, mpm::AffineKind)                              \
  POLDER_SIMD_DECLARE(void, scatter_fluid, mpm::Transfer<D>&, mpm::AffineKind)                              \
  POLDER_SIMD_DECLARE(void, scatter_cells, mpm::Transfer<D>&)                                               \
  POLDER_SIMD_DECLARE(void, scatter_volume, mpm::Transfer<D>&)                                              \
  POLDER_SIMD_DECLARE(void, scatter_pore_water, mpm::Transfer<D>&, double, bool)                            \
  POLDER_SIMD_DECLARE(void, sum_state, mpm::Transfer<D>&, Reals&, Reals&)                                   \
  POLDER_SIMD_DECLARE(void, sum_fluid, mpm::Transfer<D>&, Reals&, Reals&)                                   \
  POLDER_SIMD_DECLARE(void, sum_momentum, mpm::Transfer<D>&, const Reals&, Reals&)                          \
  POLDER_SIMD_DECLARE(void, sum_cells, mpm::Transfer<D>&, Reals&)                                           \
  POLDER_SIMD_DECLARE(void, sum_volume, mpm::Transfer<D>&, Reals&)                                          \
  POLDER_SIMD_DECLARE(void, update_velocities, mpm::Transfer<D>&, double, const Reals&, const Reals&, bool) \
  POLDER_SIMD_DECLARE(void, update_pore_velocities, mpm::Transfer<D>&, double, double, const Reals&,        \
                      const Reals&, bool)                                                                   \
  POLDER_SIMD_DECLARE(void, gather_expelled, mpm::Transfer<D>&, double, const Reals&, bool)                 \
  POLDER_SIMD_DECLARE(double, shift_points, mpm::Transfer<D>&, const Reals&, double)                        \
  POLDER_SIMD_DECLARE(mpm::MoveResult, update_stress_and_move, mpm::Transfer<D>&, const mpm::MoveOptions&,  \
                      const Reals*, const Reals&)

namespace polder {
POLDER_DECLARE_KERNELS(2)
POLDER_DECLARE_KERNELS(3)
POLDER_SIMD_DECLARE(std::shared_ptr<const void>, make_law_handle, int, const mpm::MaterialParameters&, bool)
}  // namespace polder
