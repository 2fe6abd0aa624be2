// Loops over cells and faces: on one thread while they are too short to pay for waking the others.
#pragma once

#include "core/threads.hpp"

namespace polder::fdm {

// Below this many elements starting a parallel region (about 2 us) costs more than it saves.
inline constexpr int kParallelFrom = 2048;

// f(i) for i = 0 .. n-1; f writes only what belongs to i, so the result does not depend on the number of
// threads.
template <class F>
void for_each(int n, const F& f) {
  if (n < kParallelFrom)
    for (int i = 0; i < n; ++i) f(i);
  else
    parallel_for(n, f);
}

}  // namespace polder::fdm
