#include "core/threads.hpp"

#include <pthread.h>
#include <sched.h>
#include <signal.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <exception>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>

namespace polder {
namespace {

using Clock = std::chrono::steady_clock;
using namespace std::chrono_literals;

constexpr int kRangesPerThread = 4;
constexpr int kSpins = 2000;  // some 20 to 80 microseconds: about what waking a thread takes

// A loop whose last ranges kept the caller waiting for longer than this, and than the loop took it, was held
// up by other programs; the helpers then rest for kRest times as long as the wait, kLongestRest at most.
constexpr auto kWaitNoticed = 300us;
constexpr int kRest = 20;
constexpr Clock::duration kLongestRest = 1s;

void pause() {
#if defined(__x86_64__) || defined(__i386__)
  __builtin_ia32_pause();
#endif
}

thread_local bool within_loop = false;

// The next range that nobody has begun, of those that belong to one thread.
struct alignas(64) Next {
  std::atomic<int> range{0};
  int end = 0;
};

class Pool {
 public:
  explicit Pool(int threads) : threads_(threads), next_(new Next[static_cast<std::size_t>(threads)]) {
    // Signals are for the thread that waits for them.
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    for (int i = 1; i < threads; ++i) helpers_.emplace_back([this, i] { help(i); });
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
  }

  ~Pool() {
    quit_ = true;
    state_ += 2;
    state_.notify_all();
    for (std::thread& t : helpers_) t.join();
  }

  int threads() const { return threads_; }

  void run(int ranges, detail::RangeFunction function, const void* context) {
    const Clock::time_point began = Clock::now();
    function_ = function, context_ = context;
    const bool alone = began < rest_until_;
    const int sharers = alone ? 1 : threads_;
    for (int t = 0; t < threads_; ++t) {
      next_[t].range.store(t < sharers ? first_of(t, ranges, sharers) : ranges, std::memory_order_relaxed);
      next_[t].end = t < sharers ? first_of(t + 1, ranges, sharers) : ranges;
    }
    if (alone) {
      take_ranges(0);
    } else {
      ++state_;  // odd: open
      state_.notify_all();
      take_ranges(0);
      ++state_;  // even: closed
      if (inside_ != 0) await_helpers(began);
    }
    if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
  }

 private:
  static int first_of(int thread, int ranges, int sharers) {
    return static_cast<int>(static_cast<long>(ranges) * thread / sharers);
  }

  // Ranges of thread `me`, then of those after it.
  void take_ranges(int me) {
    within_loop = true;
    for (int k = 0; k < threads_; ++k) {
      Next& next = next_[(me + k) % threads_];
      for (;;) {
        const int range = next.range.fetch_add(1, std::memory_order_relaxed);
        if (range >= next.end) break;
        try {
          function_(context_, range);
        } catch (...) {
          const std::lock_guard lock(error_mutex_);
          if (!error_ || range < error_range_) error_ = std::current_exception(), error_range_ = range;
        }
      }
    }
    within_loop = false;
  }

  void help(int me) {
    std::uint32_t seen = 0;
    for (;;) {
      for (int spin = 0; spin < kSpins && state_.load(std::memory_order_relaxed) == seen; ++spin) pause();
      state_.wait(seen);
      seen = state_;
      if (quit_) return;
      if (seen % 2 == 0) continue;
      // Announced first, then looked again: the caller closes the loop first, then looks who is inside. So
      // either the caller waits for this thread, or this thread sees that the loop is closed.
      ++inside_;
      if (state_ == seen) take_ranges(me);
      --inside_;
    }
  }

  void await_helpers(Clock::time_point began) {
    for (int spin = 0; spin < kSpins; ++spin) {
      if (inside_ == 0) return;
      pause();
    }
    const Clock::time_point closed = Clock::now();
    while (inside_ != 0) sched_yield();
    const Clock::time_point now = Clock::now();
    const Clock::duration waited = now - closed;
    if (waited > kWaitNoticed && waited > closed - began)
      rest_until_ = now + std::min<Clock::duration>(kRest * waited, kLongestRest);
  }

  const int threads_;
  std::unique_ptr<Next[]> next_;
  detail::RangeFunction function_ = nullptr;
  const void* context_ = nullptr;
  Clock::time_point rest_until_{};  // until then the caller works alone
  std::mutex error_mutex_;
  std::exception_ptr error_;
  int error_range_ = 0;
  alignas(64) std::atomic<std::uint32_t> state_{0};  // even: no loop, odd: one to take part in
  alignas(64) std::atomic<int> inside_{0};           // helpers that may be in a range
  std::atomic<bool> quit_{false};
  std::vector<std::thread> helpers_;
};

int default_threads() {
  const char* text = std::getenv("OMP_NUM_THREADS");
  const int n = text ? std::atoi(text) : 0;
  return n > 0 ? n : available_cores();
}

std::mutex pool_mutex;  // held by the thread whose loop runs
std::unique_ptr<Pool> pool;
int wanted_threads = 0;  // 0: not chosen yet

}  // namespace

int available_cores() {
#ifdef __linux__
  cpu_set_t cores;
  if (sched_getaffinity(0, sizeof cores, &cores) == 0) return std::max(1, CPU_COUNT(&cores));
#endif
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

void set_threads(int n) {
  const std::lock_guard lock(pool_mutex);
  wanted_threads = n > 0 ? n : default_threads();
  if (pool && pool->threads() != wanted_threads) pool.reset();
}

int threads() {
  if (wanted_threads == 0) wanted_threads = default_threads();
  return wanted_threads;
}

namespace detail {

int ranges_for(int n) {
  const int t = threads();
  return t == 1 || within_loop ? 1 : std::min(n, kRangesPerThread * t);
}

int start_by_work(const std::vector<long>& before, int range, int ranges) {
  if (range == ranges) return static_cast<int>(before.size()) - 1;
  // In two parts, as the sum of all work may be large.
  const long share = before.back() / ranges * range + before.back() % ranges * range / ranges;
  return static_cast<int>(std::lower_bound(before.begin(), before.end() - 1, share) - before.begin());
}

void run_ranges(int ranges, RangeFunction function, const void* context) {
  std::unique_lock<std::mutex> lock(pool_mutex, std::defer_lock);
  if (within_loop || threads() == 1 || !lock.try_lock()) {
    for (int range = 0; range < ranges; ++range) function(context, range);
    return;
  }
  if (!pool) pool = std::make_unique<Pool>(threads());
  pool->run(ranges, function, context);
}

}  // namespace detail
}  // namespace polder
