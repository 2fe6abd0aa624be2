#include "mpm/transfer.hpp"

#include "mpm/kernels/kernels.hpp"

namespace polder::mpm {

namespace {

template <int D>
void fit(const Transfer<D>& transfer, int width, Reals& field) {
  field.resize(static_cast<std::size_t>(transfer.grid->slots()) * width);
}

template <int D>
void sum_state(Transfer<D>& transfer, Reals& sums, Reals& velocity) {
  fit(transfer, Transfer<D>::kSum, sums);
  fit(transfer, Transfer<D>::kVector, velocity);
  POLDER_SIMD_CALL(sum_state, transfer, sums, velocity);
}

template <int D>
void sum_momentum(Transfer<D>& transfer, const Reals& sums, Reals& velocity) {
  fit(transfer, Transfer<D>::kVector, velocity);
  POLDER_SIMD_CALL(sum_momentum, transfer, sums, velocity);
}

// What blocks that have just fallen asleep give to their tiles.
template <int D>
void keep_tiles(Transfer<D>& transfer, int width, Reals Sleeper::*kept) {
  const std::size_t size = static_cast<std::size_t>(Transfer<D>::kTileNodes) * width;
  for (std::size_t b = 0; b < transfer.sleepers.size(); ++b) {
    Sleeper& sleeper = transfer.sleepers[b];
    if (!sleeper.asleep || !(sleeper.*kept).empty()) continue;
    const auto tile = transfer.tiles.begin() + static_cast<std::ptrdiff_t>(b * size);
    (sleeper.*kept).assign(tile, tile + static_cast<std::ptrdiff_t>(size));
  }
}

}  // namespace

template <int D>
void scatter_state(Transfer<D>& transfer, AffineKind affine, Reals& sums, Reals& velocity) {
  POLDER_SIMD_CALL(scatter_state, transfer, affine);
  keep_tiles(transfer, Transfer<D>::kSum, &Sleeper::state);
  sum_state(transfer, sums, velocity);
}

template <int D>
void scatter_fluid(Transfer<D>& transfer, AffineKind affine, Reals& sums, Reals& velocity) {
  POLDER_SIMD_CALL(scatter_fluid, transfer, affine);
  fit(transfer, Transfer<D>::kSum, sums);
  fit(transfer, Transfer<D>::kVector, velocity);
  POLDER_SIMD_CALL(sum_fluid, transfer, sums, velocity);
}

template <int D>
void scatter_cells(Transfer<D>& transfer, Reals& cells) {
  POLDER_SIMD_CALL(scatter_cells, transfer);
  keep_tiles(transfer, Transfer<D>::kCellSum, &Sleeper::cells);
  fit(transfer, Transfer<D>::kCellSum, cells);
  POLDER_SIMD_CALL(sum_cells, transfer, cells);
}

template <int D>
void scatter_volume(Transfer<D>& transfer, Reals& cells) {
  POLDER_SIMD_CALL(scatter_volume, transfer);
  fit(transfer, 1, cells);
  POLDER_SIMD_CALL(sum_volume, transfer, cells);
}

template <int D>
void update_velocities(Transfer<D>& transfer, double flip, const Reals& v_old, const Reals& v_new,
                       const Reals& sums, Reals& mapped) {
  POLDER_SIMD_CALL(update_velocities, transfer, flip, v_old, v_new, true);
  sum_momentum(transfer, sums, mapped);
}

template <int D>
void scatter_pore_water(Transfer<D>& transfer, double density, bool kozeny_carman, Reals& sums,
                        Reals& velocity) {
  POLDER_SIMD_CALL(scatter_pore_water, transfer, density, kozeny_carman);
  sum_state(transfer, sums, velocity);
}

template <int D>
void update_pore_velocities(Transfer<D>& transfer, double density, double flip, const Reals& w_old,
                            const Reals& w_new, const Reals& sums, Reals* mapped) {
  POLDER_SIMD_CALL(update_pore_velocities, transfer, density, flip, w_old, w_new, mapped != nullptr);
  if (mapped != nullptr) sum_momentum(transfer, sums, *mapped);
}

template <int D>
void gather_expelled(Transfer<D>& transfer, double dt, const Reals& flow, bool cell_average) {
  POLDER_SIMD_CALL(gather_expelled, transfer, dt, flow, cell_average);
}

template <int D>
MoveResult update_stress_and_move(Transfer<D>& transfer, const MoveOptions& options, const Reals* v_old,
                                  const Reals& v) {
  return POLDER_SIMD_CALL(update_stress_and_move, transfer, options, v_old, v);
}

template <int D>
double shift_points(Transfer<D>& transfer, const Reals& displacement, double most) {
  return POLDER_SIMD_CALL(shift_points, transfer, displacement, most);
}

std::shared_ptr<const void> make_law_handle(int dimension, const MaterialParameters& material, bool plastic) {
  return POLDER_SIMD_CALL(make_law_handle, dimension, material, plastic);
}

#define POLDER_INSTANTIATE(D)                                                                        \
  template void scatter_state<D>(Transfer<D>&, AffineKind, Reals&, Reals&);                          \
  template void scatter_fluid<D>(Transfer<D>&, AffineKind, Reals&, Reals&);                          \
  template void scatter_cells<D>(Transfer<D>&, Reals&);                                              \
  template void scatter_volume<D>(Transfer<D>&, Reals&);                                             \
  template void update_velocities<D>(Transfer<D>&, double, const Reals&, const Reals&, const Reals&, \
                                     Reals&);                                                        \
  template void scatter_pore_water<D>(Transfer<D>&, double, bool, Reals&, Reals&);                   \
  template void update_pore_velocities<D>(Transfer<D>&, double, double, const Reals&, const Reals&,  \
                                          const Reals&, Reals*);                                     \
  template void gather_expelled<D>(Transfer<D>&, double, const Reals&, bool);                        \
  template double shift_points<D>(Transfer<D>&, const Reals&, double);                               \
  template MoveResult update_stress_and_move<D>(Transfer<D>&, const MoveOptions&, const Reals*, const Reals&);
POLDER_INSTANTIATE(2)
POLDER_INSTANTIATE(3)

}  // namespace polder::mpm
