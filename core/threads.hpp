// Threads. Every parallel loop in Polder writes only what its own index owns, and every reduction is done in
// an order that does not depend on the number of threads; so a run gives the same bits with 1, 2 or 4 of
// them.
#pragma once

#include <omp.h>

namespace polder {

// Number of threads for all later parallel loops; 0 = as many as the machine has cores.
void set_threads(int n);
int threads();

// f(i) for i = 0 .. n-1, contiguous ranges. f must write only what belongs to i.
template <class F>
void parallel_for(int n, const F& f) {
#pragma omp parallel for schedule(static)
  for (int i = 0; i < n; ++i) f(i);
}

}  // namespace polder
