// What a point's domain holds of something that a surface bounds.
#pragma once

#include "core/grid.hpp"
#include "coupling/points.hpp"

namespace polder::coupling {

// Mean of share(position) over the domain of sides `spacing` around x. Domains that a surface cuts are
// sampled, so that volumes and surfaces do not come in steps of whole points.
template <int D, class Share>
double mean_share(const Point<D>& x, const Point<D>& spacing, const Share& share) {
  constexpr int kSamples = D == 2 ? 8 : 4;
  const auto at = [&](int number, int per_axis, double reach) {
    Vector3 y{};
    for (int d = 0; d < D; ++d, number /= per_axis)
      y[d] = x[d] + reach * spacing[d] * ((number % per_axis + 0.5) / per_axis - 0.5);
    return share(y);
  };
  const double middle = at(0, 1, 1);
  bool cut = false;
  for (int corner = 0; corner < ipow(2, D); ++corner) cut |= at(corner, 2, 1.9) != middle;
  if (!cut) return middle;
  double sum = 0;
  for (int k = 0; k < ipow(kSamples, D); ++k) sum += at(k, kSamples, 1);
  return sum / ipow(kSamples, D);
}

}  // namespace polder::coupling
