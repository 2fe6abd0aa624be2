// Threads. Every parallel loop in Polder writes only what its own index owns, and every reduction is done in
// an order that does not depend on the number of threads; so a run gives the same bits with 1, 2 or 4 of
// them.
#pragma once

#include <omp.h>

#include <algorithm>
#include <vector>

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

// The same in contiguous ranges of about equal work. before[i]: work of all indices below i, before.back():
// of all.
template <class F>
void parallel_for_work(const std::vector<long>& before, const F& f) {
  const int n = static_cast<int>(before.size()) - 1;
#pragma omp parallel
  {
    const long thread = omp_get_thread_num(), threads = omp_get_num_threads();
    const auto start = [&](long t) {
      if (t == threads) return n;
      return static_cast<int>(std::lower_bound(before.begin(), before.end(), before.back() * t / threads) -
                              before.begin());
    };
    for (int i = start(thread), end = start(thread + 1); i < end; ++i) f(i);
  }
}

}  // namespace polder
