// Files written by a thread of their own while the computation goes on.
//
// Jobs are done one after the other, in the order in which they were handed over, so what a checkpoint counts
// as written has been written before it. A job owns what it writes. At most kWaiting jobs wait, which bounds
// the memory: whoever hands over one more waits for the first of them to be taken up.
//
// A job that throws ends the writing: those after it are dropped, and the exception reaches the computation
// from the next call of submit(), check() or flush(), once.
//
// The libraries below the files (HDF5) need not be safe for threads: while jobs are under way nobody else may
// use them.
#pragma once

#include <atomic>
#include <condition_variable>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>

namespace polder {

class BackgroundWriter {
 public:
  using Job = std::function<void()>;
  static constexpr std::size_t kWaiting = 2;

  BackgroundWriter();
  // Does what is left, unless a job has failed.
  ~BackgroundWriter();
  BackgroundWriter(const BackgroundWriter&) = delete;
  BackgroundWriter& operator=(const BackgroundWriter&) = delete;

  void submit(Job job);
  void flush();  // returns when everything handed over has been written
  void check();  // cheap enough for every step

  // Wall time [s] that submit() and flush() have waited, and that jobs have taken (those that have ended).
  double waited() const { return waited_; }
  double worked() const;

 private:
  void work();
  void rethrow(std::unique_lock<std::mutex>& lock);

  mutable std::mutex mutex_;
  std::condition_variable handed_, taken_;
  std::deque<Job> jobs_;
  bool busy_ = false, ending_ = false, dropping_ = false;
  std::atomic<bool> failed_ = false;  // an exception waits to be thrown
  std::exception_ptr failure_;
  double waited_ = 0, worked_ = 0;
  std::thread thread_;
};

}  // namespace polder
