#include "mpm/runaway.hpp"

#include <cstdio>

#include "core/error.hpp"

namespace polder::mpm {

template <int D>
void require_calm(const MoveResult& r, const ParticleSet<D>& set, double time, double dt) {
  if (r.finite && r.largest_displacement <= kSkin) return;
  const int p = r.fastest_slot;
  char text[320];
  std::snprintf(text, sizeof text,
                "%s: point %d of body '%s' near (%.6g, %.6g%s) moves at %.4g m/s, %.3g cells in a step of "
                "%.4g s, at time %.6g s",
                r.finite ? "runaway velocity" : "velocity is not finite", set.id[p], set.name.c_str(),
                set.position[0][p], set.position[1][p],
                D == 3 ? (", " + std::to_string(set.position[D - 1][p])).c_str() : "", r.largest_speed,
                r.largest_displacement, dt, time);
  throw NumericalError(text);
}

template void require_calm<2>(const MoveResult&, const ParticleSet<2>&, double, double);
template void require_calm<3>(const MoveResult&, const ParticleSet<3>&, double, double);

}  // namespace polder::mpm
