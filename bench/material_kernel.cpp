#include "bench/material_kernel.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "mpm/material/make_law.hpp"
#include "mpm/material/material.hpp"

namespace polder::POLDER_SIMD_NAMESPACE {
namespace {

template <int D>
double time_law(const bench::MaterialCase& c) {
  const auto law = make_law<D>(c.material);
  const mpm::StateLayout layout = mpm::state_layout(c.material, D);
  StressBatch<D> start{}, batch{};
  start.packs = kBatchPacks;
  constexpr int kStress = StressBatch<D>::kStress;
  for (int p = 0; p < kBatchPacks; ++p)
    for (int lane = 0; lane < kLanes; ++lane) {
      const int i = p * kLanes + lane;
      // a compressed state turned by some angle; yield is passed by a stress increment of about a percent
      const double angle = 0.37 * i, size = c.loading == bench::Loading::elastic ? 0.2 : 1;
      double s1 = -1e5, s2 = -1.6e5, s3 = -1e5 * 3 - 6.93e4 - 2e3;
      if (c.loading == bench::Loading::edge_and_apex) {
        s2 = lane % 2 == 0 ? s3 + 5 : s1 - 5;
        if (lane % 4 == 3) s1 = s2 = s3 = 5e4;
      }
      const bool undrained =
          c.material.model == mpm::MaterialModel::tresca || c.material.model == mpm::MaterialModel::von_mises;
      if (undrained) s1 = -1e5, s2 = -1.2e5, s3 = -1.42e5;
      const double mid = s1 == s3 ? s1 : (s1 + s3) / 2, radius = size * (s1 - s3) / 2;
      start.stress[p][0][lane] = mid + radius * std::cos(angle);
      start.stress[p][1][lane] = mid - radius * std::cos(angle);
      start.stress[p][2][lane] = mid + size * (s2 - mid);
      start.stress[p][3][lane] = radius * std::sin(angle);
      for (int k = 0; k < kStress; ++k) start.strain[p][k][lane] = 1e-9 * (k - 1);
      for (int v = 0; v < layout.count(); ++v) start.state[p][v][lane] = layout.variables[v].initial;
      if (layout.plastic_strain == 0) start.state[p][0][lane] = 1e-3;
    }
  if constexpr (D == 3)  // let the third axis take part: turn about x by some 30 degrees
    for (int p = 0; p < kBatchPacks; ++p) {
      Pack(&s)[kStress] = start.stress[p];
      const double c1 = 0.866, s0 = std::sqrt(1 - c1 * c1);
      const Pack yy = s[1], zz = s[2], xy = s[3];
      s[1] = c1 * c1 * yy + s0 * s0 * zz, s[2] = s0 * s0 * yy + c1 * c1 * zz, s[4] = c1 * s0 * (yy - zz);
      s[3] = c1 * xy, s[5] = s0 * xy;
    }
  batch = start;
  double best = 1e300;
  constexpr int kRepeat = 500;
  for (int trial = 0; trial < 200; ++trial) {
    const auto t0 = std::chrono::steady_clock::now();
    for (int r = 0; r < kRepeat; ++r) {
      for (int p = 0; p < kBatchPacks; ++p) {
        for (int k = 0; k < kStress; ++k) batch.stress[p][k] = start.stress[p][k];
        for (int v = 0; v < layout.count(); ++v) batch.state[p][v] = start.state[p][v];
      }
      law->update(batch);
    }
    const double ns = std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - t0).count();
    best = std::min(best, ns / (double(kRepeat) * kBatchPacks * kLanes));
  }
  return best;
}

}  // namespace

double time_material(const bench::MaterialCase& c, int dimension) {
  return dimension == 2 ? time_law<2>(c) : time_law<3>(c);
}

}  // namespace polder::POLDER_SIMD_NAMESPACE
