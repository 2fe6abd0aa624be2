#include "mpm/transfer.hpp"

#include "core/threads.hpp"
#include "mpm/kernels/kernels.hpp"

namespace polder::mpm {

template <int D>
void scatter_state(Transfer<D>& transfer, AffineKind affine, Reals& sums) {
  POLDER_SIMD_CALL(scatter_state, transfer, affine);
  sum_tiles(transfer, Transfer<D>::kSum, sums);
}

template <int D>
void velocities_of(const Transfer<D>& transfer, const Reals& sums, Reals& velocity) {
  parallel_for(transfer.grid->blocks(), [&](int block) {
    for (int i = block * Grid<D>::kCells; i < (block + 1) * Grid<D>::kCells; ++i) {
      const double* s = &sums[static_cast<std::size_t>(i) * Transfer<D>::kSum];
      double* v = &velocity[static_cast<std::size_t>(i) * Transfer<D>::kVector];
      const double inverse = s[0] > 0 ? 1 / s[0] : 0;
      for (int d = 0; d < D; ++d) v[d] = s[1 + d] * inverse;
    }
  });
}

template <int D>
void scatter_cells(Transfer<D>& transfer, Reals& cells) {
  POLDER_SIMD_CALL(scatter_cells, transfer);
  sum_tiles(transfer, Transfer<D>::kCellSum, cells);
}

template <int D>
void update_velocities(Transfer<D>& transfer, double flip, const Reals& v_old, const Reals& v_new,
                       Reals* momentum) {
  POLDER_SIMD_CALL(update_velocities, transfer, flip, v_old, v_new, momentum != nullptr);
  if (momentum != nullptr) sum_tiles(transfer, Transfer<D>::kVector, *momentum);
}

template <int D>
void scatter_pore_water(Transfer<D>& transfer, double density, bool kozeny_carman, Reals& sums) {
  POLDER_SIMD_CALL(scatter_pore_water, transfer, density, kozeny_carman);
  sum_tiles(transfer, Transfer<D>::kSum, sums);
}

template <int D>
void update_pore_velocities(Transfer<D>& transfer, double density, double flip, const Reals& w_old,
                            const Reals& w_new, Reals* momentum) {
  POLDER_SIMD_CALL(update_pore_velocities, transfer, density, flip, w_old, w_new, momentum != nullptr);
  if (momentum != nullptr) sum_tiles(transfer, Transfer<D>::kVector, *momentum);
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
void sum_tiles(Transfer<D>& transfer, int width, Reals& out) {
  out.resize(static_cast<std::size_t>(transfer.grid->slots()) * width);
  POLDER_SIMD_CALL(sum_tiles, transfer, width, out);
}

std::shared_ptr<const void> make_law_handle(int dimension, const MaterialParameters& material, bool plastic) {
  return POLDER_SIMD_CALL(make_law_handle, dimension, material, plastic);
}

#define POLDER_INSTANTIATE(D)                                                                                \
  template void scatter_state<D>(Transfer<D>&, AffineKind, Reals&);                                          \
  template void velocities_of<D>(const Transfer<D>&, const Reals&, Reals&);                                  \
  template void scatter_cells<D>(Transfer<D>&, Reals&);                                                      \
  template void update_velocities<D>(Transfer<D>&, double, const Reals&, const Reals&, Reals*);              \
  template void scatter_pore_water<D>(Transfer<D>&, double, bool, Reals&);                                   \
  template void update_pore_velocities<D>(Transfer<D>&, double, double, const Reals&, const Reals&, Reals*); \
  template void gather_expelled<D>(Transfer<D>&, double, const Reals&, bool);                                \
  template MoveResult update_stress_and_move<D>(Transfer<D>&, const MoveOptions&, const Reals*,              \
                                                const Reals&);                                               \
  template void sum_tiles<D>(Transfer<D>&, int, Reals&);
POLDER_INSTANTIATE(2)
POLDER_INSTANTIATE(3)

}  // namespace polder::mpm
