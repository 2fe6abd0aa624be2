#include "coupling/water_viscosity.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "core/error.hpp"
#include "core/threads.hpp"

namespace polder::coupling {
namespace {

constexpr int kStride = 4;
constexpr double kTolerance = 1e-9;  // of the velocity
constexpr int kMostIterations = 10000;

// Stiffness of one cell of side 1 and viscosity 1: [corner][corner][axis][axis], corners in bits, x first.
template <int D>
using Stiffness = std::array<std::array<std::array<std::array<double, D>, D>, ipow(2, D)>, ipow(2, D)>;

// int N_i N_j, int N_i' N_j, int N_i N_j' or int N_i' N_j' of linear functions over a cell of length 1.
constexpr double of_line(int i, int j, bool di, bool dj) {
  const double sign_i = i ? 1 : -1, sign_j = j ? 1 : -1;
  if (di && dj) return sign_i * sign_j;
  if (di) return 0.5 * sign_i;
  if (dj) return 0.5 * sign_j;
  return i == j ? 1.0 / 3 : 1.0 / 6;
}

// int d_a N_i d_b N_j over the cell.
template <int D>
constexpr double of_cell(int i, int j, int a, int b) {
  double product = 1;
  for (int d = 0; d < D; ++d) product *= of_line(i >> d & 1, j >> d & 1, d == a, d == b);
  return product;
}

template <int D>
constexpr Stiffness<D> make_stiffness() {
  Stiffness<D> k{};
  for (int i = 0; i < ipow(2, D); ++i)
    for (int j = 0; j < ipow(2, D); ++j) {
      double laplacian = 0;
      for (int d = 0; d < D; ++d) laplacian += of_cell<D>(i, j, d, d);
      for (int a = 0; a < D; ++a)
        for (int b = 0; b < D; ++b) k[i][j][a][b] = (a == b ? laplacian : 0.0) + of_cell<D>(i, j, b, a);
    }
  return k;
}

template <int D>
constexpr Stiffness<D> kStiffness = make_stiffness<D>();

// Where a corner of a cell lies among the 3^D nodes around another of its corners.
template <int D>
constexpr int around(int from, int to) {
  int at = 0, step = 1;
  for (int d = 0; d < D; ++d, step *= 3) at += ((to >> d & 1) - (from >> d & 1) + 1) * step;
  return at;
}

}  // namespace

template <int D>
void WaterViscosity<D>::follow_grid(const mpm::FluidLayer<D>& fluid) {
  if (revision_ == grid_.revision()) return;
  revision_ = grid_.revision();
  const std::size_t slots = grid_.slots();
  nodes_.resize(slots), cells_.resize(slots), kept_.assign(slots, 0);
  const std::vector<std::uint8_t>& held = fluid.held_components();
  parallel_for(static_cast<int>(slots), [&](int i) {
    const Index<D> at = grid_.index(i);
    bool inside = true;
    for (int d = 0; d < D; ++d) inside &= at[d] <= grid_.cells()[d];
    nodes_[i].fill(-1), cells_[i].fill(-1);
    if (!inside) return;
    for (int k = 0; k < ipow(3, D); ++k) {
      Index<D> node = at;
      int rest = k;
      for (int d = 0; d < D; ++d, rest /= 3) node[d] += rest % 3 - 1;
      nodes_[i][k] = grid_.slot(node);
    }
    for (int k = 0; k < kCorners; ++k) {
      Index<D> cell = at;
      for (int d = 0; d < D; ++d) cell[d] -= k >> d & 1;
      cells_[i][k] = grid_.is_cell(cell) ? grid_.slot(cell) : -1;
      for (int corner = 0; corner < kCorners; ++corner)
        if (nodes_[i][around<D>(k, corner)] < 0) cells_[i][k] = -1;
    }
    kept_[i] = held[i];
    for (int d = 0; d < D; ++d)
      if ((at[d] == 0 || at[d] == grid_.cells()[d]) && !(held[i] >> d & 1))
        kept_[i] |= static_cast<std::uint8_t>(((1u << D) - 1) & ~(1u << d));
  });
  for (Reals* r : {&diagonal_, &residual_, &direction_, &product_}) r->assign(slots * kStride, 0.0);
  share_.assign(slots, 0.0), mass_.assign(slots, 0.0);
  parts_.assign(grid_.blocks(), 0.0);
}

// y = (M + dt K) x in the components that are not kept, 0 in the others.
template <int D>
void WaterViscosity<D>::apply(const Reals& x, Reals& y) const {
  parallel_for(grid_.slots(), [&](int i) {
    double f[D];
    for (int d = 0; d < D; ++d) f[d] = mass_[i] * x[static_cast<std::size_t>(i) * kStride + d];
    for (int k = 0; k < kCorners; ++k) {
      const int cell = cells_[i][k];
      if (cell < 0 || share_[cell] == 0) continue;
      for (int corner = 0; corner < kCorners; ++corner) {
        const double* u = &x[static_cast<std::size_t>(nodes_[i][around<D>(k, corner)]) * kStride];
        for (int a = 0; a < D; ++a)
          for (int b = 0; b < D; ++b) f[a] += share_[cell] * kStiffness<D>[k][corner][a][b] * u[b];
      }
    }
    for (int d = 0; d < D; ++d) y[static_cast<std::size_t>(i) * kStride + d] = kept_[i] >> d & 1 ? 0.0 : f[d];
  });
}

template <int D>
template <class F>
double WaterViscosity<D>::sum(const F& of_component) {
  parallel_for(grid_.blocks(), [&](int block) {
    double part = 0;
    for (int i = block * Grid<D>::kCells; i < (block + 1) * Grid<D>::kCells; ++i)
      for (int d = 0; d < D; ++d) part += of_component(i, static_cast<std::size_t>(i) * kStride + d);
    parts_[block] = part;
  });
  double all = 0;
  for (double part : parts_) all += part;
  return all;
}

template <int D>
void WaterViscosity<D>::diffuse(const mpm::FluidLayer<D>& fluid, const Reals& volume, double dt,
                                Reals& velocity) {
  follow_grid(fluid);
  const double h = grid_.spacing(), cell_volume = std::pow(h, D), unit = dt * viscosity_ * std::pow(h, D - 2);
  parallel_for(grid_.slots(), [&](int i) {
    share_[i] = unit * std::clamp(volume[i] / cell_volume, 0.0, 1.0);
    mass_[i] = fluid.sums()[static_cast<std::size_t>(i) * 8];
  });
  parallel_for(grid_.slots(), [&](int i) {
    for (int d = 0; d < D; ++d) {
      double own = mass_[i];
      for (int k = 0; k < kCorners; ++k)
        if (cells_[i][k] >= 0) own += share_[cells_[i][k]] * kStiffness<D>[k][k][d][d];
      diagonal_[static_cast<std::size_t>(i) * kStride + d] = own;
    }
  });
  const auto over_diagonal = [&](std::size_t j) {
    return diagonal_[j] > 0 ? residual_[j] / diagonal_[j] : 0.0;
  };
  // Trial velocities satisfy M w = M w~, so the first residual is -dt K w~.
  apply(velocity, product_);
  const double motion = sum([&](int i, std::size_t j) { return mass_[i] * velocity[j] * velocity[j]; });
  parallel_for(grid_.slots(), [&](int i) {
    for (int d = 0; d < D; ++d) {
      const std::size_t j = static_cast<std::size_t>(i) * kStride + d;
      residual_[j] = kept_[i] >> d & 1 ? 0.0 : mass_[i] * velocity[j] - product_[j];
      direction_[j] = over_diagonal(j);
    }
  });
  double error = sum([&](int, std::size_t j) { return residual_[j] * over_diagonal(j); });
  const double least = kTolerance * kTolerance * motion;
  for (iterations_ = 0; error > least; ++iterations_) {
    if (iterations_ == kMostIterations || !std::isfinite(error))
      throw NumericalError("viscous stresses of the water were not found in " + std::to_string(iterations_) +
                           " iterations");
    apply(direction_, product_);
    const double step = error / sum([&](int, std::size_t j) { return direction_[j] * product_[j]; });
    parallel_for(grid_.slots(), [&](int i) {
      for (int d = 0; d < D; ++d) {
        const std::size_t j = static_cast<std::size_t>(i) * kStride + d;
        velocity[j] += step * direction_[j];
        residual_[j] -= step * product_[j];
      }
    });
    const double next = sum([&](int, std::size_t j) { return residual_[j] * over_diagonal(j); });
    const double turn = next / error;
    error = next;
    parallel_for(grid_.slots(), [&](int i) {
      for (int d = 0; d < D; ++d) {
        const std::size_t j = static_cast<std::size_t>(i) * kStride + d;
        direction_[j] = over_diagonal(j) + turn * direction_[j];
      }
    });
  }
}

template class WaterViscosity<2>;
template class WaterViscosity<3>;

}  // namespace polder::coupling
