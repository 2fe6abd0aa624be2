// Threads. Every parallel loop in Polder writes only what its own index owns, and every reduction is done in
// an order that does not depend on the number of threads; so a run gives the same bits with 1, 2 or 4 of
// them, whoever does which part.
//
// A loop is cut into a few contiguous ranges for each thread. Each thread begins with its own, the same in
// every loop over the same indices (so that data stay in its cache), and then takes what others have not
// begun. The calling thread works too and waits only for ranges that are under way: a helper that the system
// does not let run costs its help, not the loop's time (OpenMP's barriers made a loop ten times as long on a
// machine that other programs use).
#pragma once

#include <vector>

namespace polder {

// Number of threads for all later parallel loops; 0 = OMP_NUM_THREADS if that is set, else as many as the
// program may use cores. Not within a parallel loop.
void set_threads(int n);
int threads();

// Number of cores that the program may use, at least 1.
int available_cores();

namespace detail {

using RangeFunction = void (*)(const void* context, int range);

// function(context, range) for range = 0 .. ranges-1, each once, by any thread. An exception of the lowest
// range that threw goes to the caller when all are done. One loop at a time: loops within loops, or begun
// while another thread is in one, are done by their caller alone.
void run_ranges(int ranges, RangeFunction function, const void* context);

// Into how many ranges a loop over n indices is cut.
int ranges_for(int n);

// First index of one of the ranges of about equal work; `range` = `ranges`: their end.
int start_by_work(const std::vector<long>& before, int range, int ranges);

template <class F>
void for_ranges(int ranges, const F& f) {
  run_ranges(
      ranges, [](const void* context, int range) { (*static_cast<const F*>(context))(range); }, &f);
}

}  // namespace detail

// f(i) for i = 0 .. n-1, contiguous ranges. f must write only what belongs to i.
template <class F>
void parallel_for(int n, const F& f) {
  const int ranges = detail::ranges_for(n);
  const auto start = [&](long range) { return static_cast<int>(range * n / ranges); };
  if (ranges > 1)
    detail::for_ranges(ranges, [&](int range) {
      for (int i = start(range), end = start(range + 1); i < end; ++i) f(i);
    });
  else
    for (int i = 0; i < n; ++i) f(i);
}

// The same in contiguous ranges of about equal work. before[i]: work of all indices below i, before.back():
// of all.
template <class F>
void parallel_for_work(const std::vector<long>& before, const F& f) {
  const int n = static_cast<int>(before.size()) - 1;
  const int ranges = detail::ranges_for(n);
  if (ranges <= 1) {
    for (int i = 0; i < n; ++i) f(i);
    return;
  }
  detail::for_ranges(ranges, [&](int range) {
    const int end = detail::start_by_work(before, range + 1, ranges);
    for (int i = detail::start_by_work(before, range, ranges); i < end; ++i) f(i);
  });
}

}  // namespace polder
