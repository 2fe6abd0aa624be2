#include "io/background_writer.hpp"

#include <pthread.h>

#include <chrono>
#include <csignal>
#include <utility>

namespace polder {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

}  // namespace

BackgroundWriter::BackgroundWriter() {
  // Signals are for the thread that computes: none may interrupt a write. A new thread inherits the mask.
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  thread_ = std::thread([this] { work(); });
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

BackgroundWriter::~BackgroundWriter() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  handed_.notify_one();
  thread_.join();
}

void BackgroundWriter::work() {
  std::unique_lock lock(mutex_);
  while (true) {
    handed_.wait(lock, [&] { return !jobs_.empty() || ending_; });
    if (jobs_.empty()) return;
    Job job = std::move(jobs_.front());
    jobs_.pop_front();
    busy_ = true;
    taken_.notify_all();
    lock.unlock();
    const Clock::time_point start = Clock::now();
    std::exception_ptr failure;
    try {
      job();
      job = nullptr;  // what it holds goes while nobody waits for the lock
    } catch (...) {
      failure = std::current_exception();
    }
    lock.lock();
    worked_ += seconds_since(start);
    busy_ = false;
    if (failure) {
      failure_ = failure;
      dropping_ = true;
      jobs_.clear();
      failed_ = true;
    }
    taken_.notify_all();
  }
}

void BackgroundWriter::rethrow(std::unique_lock<std::mutex>& lock) {
  if (!failed_) return;
  failed_ = false;
  const std::exception_ptr failure = std::exchange(failure_, nullptr);
  lock.unlock();
  std::rethrow_exception(failure);
}

void BackgroundWriter::submit(Job job) {
  std::unique_lock lock(mutex_);
  const Clock::time_point start = Clock::now();
  taken_.wait(lock, [&] { return jobs_.size() < kWaiting; });
  waited_ += seconds_since(start);
  rethrow(lock);
  if (dropping_) return;
  jobs_.push_back(std::move(job));
  lock.unlock();
  handed_.notify_one();
}

void BackgroundWriter::flush() {
  std::unique_lock lock(mutex_);
  const Clock::time_point start = Clock::now();
  taken_.wait(lock, [&] { return jobs_.empty() && !busy_; });
  waited_ += seconds_since(start);
  rethrow(lock);
}

void BackgroundWriter::check() {
  if (!failed_) return;
  std::unique_lock lock(mutex_);
  rethrow(lock);
}

double BackgroundWriter::worked() const {
  const std::lock_guard lock(mutex_);
  return worked_;
}

}  // namespace polder
