// What a step may not do to a point.
#pragma once

#include "mpm/transfer.hpp"

namespace polder::mpm {

// Throws NumericalError naming the fastest point when the step moved one farther than a sort allows, or when
// a value is not finite. `set`: the one the fastest point belongs to.
template <int D>
void require_calm(const MoveResult& result, const ParticleSet<D>& set, double time, double dt);

}  // namespace polder::mpm
