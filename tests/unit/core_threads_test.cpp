// Parallel loops: every index once, whatever the number of threads and the weights, in balanced ranges.
#include "core/threads.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <thread>

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

std::vector<long> sums(const Weights& w) {
  std::vector<long> before(1, 0);
  for (const long x : w.work) before.push_back(before.back() + x);
  return before;
}

struct Restore {  // the default number of threads at the end of a test
  ~Restore() { set_threads(0); }
};

}  // namespace

TEST_CASE("loops by work meet every index once") {
  const Restore restore;
  for (const Weights& w : weights())
    for (const int n : {1, 2, 3, 4, 7}) {
      CAPTURE(w.name);
      CAPTURE(n);
      set_threads(n);
      std::vector<std::atomic<int>> met(w.work.size());
      parallel_for_work(sums(w), [&](int i) { ++met[i]; });
      for (const std::atomic<int>& m : met) CHECK(m == 1);
    }
}

TEST_CASE("ranges by work follow each other and hold about equal shares") {
  for (const Weights& w : weights())
    for (const int ranges : {1, 2, 3, 8, 28}) {
      CAPTURE(w.name);
      CAPTURE(ranges);
      const std::vector<long> before = sums(w);
      const long largest = *std::max_element(w.work.begin(), w.work.end());
      CHECK(detail::start_by_work(before, 0, ranges) == 0);
      CHECK(detail::start_by_work(before, ranges, ranges) == static_cast<int>(w.work.size()));
      for (int r = 0; r < ranges; ++r) {
        const int start = detail::start_by_work(before, r, ranges),
                  end = detail::start_by_work(before, r + 1, ranges);
        REQUIRE(start <= end);
        CHECK(before[end] - before[start] <= before.back() / ranges + 1 + largest);
      }
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
  const char* most = std::getenv("OMP_NUM_THREADS");
  CHECK(threads() == (most ? std::atoi(most) : available_cores()));
  CHECK(available_cores() >= 1);
}

TEST_CASE("who is held up keeps only the range it is in from the others") {
  const Restore restore;
  set_threads(2);
  const std::thread::id caller = std::this_thread::get_id();
  const auto patience = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  bool helped = false;
  // The helper may come too late for a loop; before long it does not.
  while (!helped && std::chrono::steady_clock::now() < patience) {
    std::atomic<int> ranges = 0;
    std::atomic<bool> in_time = true, held = false;
    detail::for_ranges(8, [&](int) {
      if (std::this_thread::get_id() != caller && !held.exchange(true)) {
        while (ranges < 7)  // which belong to the helper but for four
          if (std::chrono::steady_clock::now() > patience) {
            in_time = false;
            break;
          }
      }
      ++ranges;
      if (!held) std::this_thread::sleep_for(std::chrono::microseconds(100));
    });
    CHECK(ranges == 8);
    CHECK(in_time);
    helped = held;
  }
  CHECK(helped);
}

TEST_CASE("an exception in a loop reaches its caller: that of the lowest range, after all others are done") {
  const Restore restore;
  for (const int n : {1, 2, 4}) {
    set_threads(n);
    std::atomic<int> done = 0;
    std::string what;
    try {
      detail::for_ranges(16, [&](int range) {
        if (range == 5 || range == 11) throw std::runtime_error("range " + std::to_string(range));
        ++done;
      });
    } catch (const std::runtime_error& e) {
      what = e.what();
    }
    CHECK(what == "range 5");
    if (n > 1) CHECK(done == 14);
    std::atomic<int> after = 0;
    parallel_for(100, [&](int) { ++after; });
    CHECK(after == 100);
  }
}

TEST_CASE("loops within loops and beside loops are done") {
  const Restore restore;
  set_threads(3);
  std::vector<std::atomic<int>> met(40 * 30);
  const auto nested = [&] {
    parallel_for(40, [&](int i) { parallel_for(30, [&](int j) { ++met[30 * i + j]; }); });
  };
  nested();
  std::thread other(nested);
  for (int k = 0; k < 50; ++k) nested();
  other.join();
  for (const std::atomic<int>& m : met) CHECK(m == 52);
}
