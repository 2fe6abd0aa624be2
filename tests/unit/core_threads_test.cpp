// Parallel loops: every index once, whatever the number of threads and the weights, in balanced ranges.
#include "core/threads.hpp"

#include <doctest/doctest.h>

#include <atomic>

using namespace polder;

namespace {

struct Weights {
  const char* name;
  std::vector<long> work;
};

std::vector<Weights> weights() {
  std::vector<long> ramp, irregular;
  for (long i = 0; i < 257; ++i) ramp.push_back(i), irregular.push_back(i * i * 7919 % 101);
  return {{"one", {5}},
          {"one of nothing", {0}},
          {"equal", std::vector<long>(100, 3)},
          {"all zero", std::vector<long>(37, 0)},
          {"fewer than threads", {1, 1, 1}},
          {"zeros at both ends", {0, 0, 0, 4, 0, 0, 9, 1, 0, 0, 0, 0}},
          {"all in the first", {1000, 0, 0, 0, 0, 0}},
          {"all in the last", {0, 0, 0, 0, 0, 1000}},
          {"one outweighs the rest", {1, 1, 1, 1000, 1, 1, 1, 1, 1, 1}},
          {"many million", std::vector<long>(50, 1000000000000L)},
          {"ramp", ramp},
          {"irregular", irregular}};
}

struct Restore {  // the default number of threads at the end of a test
  ~Restore() { set_threads(0); }
};

}  // namespace

TEST_CASE("loops by work meet every index once, in contiguous ranges of about equal work") {
  const Restore restore;
  for (const Weights& w : weights())
    for (const int n : {1, 2, 3, 4, 7}) {
      CAPTURE(w.name);
      CAPTURE(n);
      set_threads(n);
      std::vector<long> before(1, 0);
      long largest = 0;
      for (long x : w.work) before.push_back(before.back() + x), largest = std::max(largest, x);
      std::vector<std::atomic<int>> met(w.work.size());
      std::vector<int> by(w.work.size(), -1);
      parallel_for_work(before, [&](int i) {
        ++met[i];
        by[i] = omp_get_thread_num();
      });
      std::vector<long> share(n, 0);
      for (std::size_t i = 0; i < w.work.size(); ++i) {
        CHECK(met[i] == 1);
        REQUIRE(by[i] >= 0);
        REQUIRE(by[i] < n);
        share[by[i]] += w.work[i];
        if (i > 0) CHECK(by[i] >= by[i - 1]);
      }
      for (long s : share) CHECK(s <= before.back() / n + 1 + largest);
    }
}

TEST_CASE("a loop over nothing does nothing") {
  const Restore restore;
  for (const int n : {1, 4}) {
    set_threads(n);
    std::atomic<int> calls = 0;
    parallel_for_work({0}, [&](int) { ++calls; });
    parallel_for(0, [&](int) { ++calls; });
    CHECK(calls == 0);
  }
}

TEST_CASE("plain loops meet every index once") {
  const Restore restore;
  for (const int n : {1, 2, 3, 4})
    for (const int size : {1, 3, 100}) {
      set_threads(n);
      std::vector<std::atomic<int>> met(size);
      parallel_for(size, [&](int i) { ++met[i]; });
      for (const auto& m : met) CHECK(m == 1);
    }
}

TEST_CASE("the number of threads is what was asked for; 0 is one for each core") {
  const Restore restore;
  for (const int n : {1, 3, 5}) {
    set_threads(n);
    CHECK(threads() == n);
  }
  set_threads(0);
  CHECK(threads() == omp_get_num_procs());
}
