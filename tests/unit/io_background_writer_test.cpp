// The thread that writes: order, bounded queue, what happens to errors and to what comes after them.
#include <doctest/doctest.h>

#include <chrono>
#include <csignal>
#include <future>
#include <thread>
#include <vector>

#include "core/error.hpp"
#include "io/atomic_file.hpp"
#include "io/background_writer.hpp"
#include "tests/unit/io_support.hpp"

using namespace polder;

TEST_CASE("jobs are done in order, and all of them") {
  std::vector<int> done;
  {
    BackgroundWriter writer;
    for (int i = 0; i < 20; ++i)
      writer.submit([&done, i] {
        if (i % 5 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(2));
        done.push_back(i);
      });
    writer.flush();
    REQUIRE(done.size() == 20);
    for (int i = 0; i < 20; ++i) CHECK(done[static_cast<std::size_t>(i)] == i);
    CHECK(writer.worked() >= 4 * 0.002);
    for (int i = 20; i < 23; ++i) writer.submit([&done, i] { done.push_back(i); });
  }
  CHECK(done.size() == 23);  // the destructor does what is left
}

TEST_CASE("the computation waits only when the queue is full, and says for how long") {
  BackgroundWriter writer;
  std::promise<void> start;
  std::shared_future<void> started = start.get_future().share();
  int done = 0;
  const auto job = [&done, started] { started.wait(), ++done; };
  for (std::size_t i = 0; i < BackgroundWriter::kWaiting; ++i) writer.submit(job);
  CHECK(done == 0);
  std::thread later([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(30));
    start.set_value();
  });
  // One may be under way beside those that wait: the second of these has to wait for it.
  writer.submit(job);
  writer.submit(job);
  CHECK(writer.waited() > 0.01);
  writer.flush();
  CHECK(done == static_cast<int>(BackgroundWriter::kWaiting) + 2);
  later.join();
}

TEST_CASE("an error reaches the computation once, and ends the writing") {
  const test::TemporaryFolder folder;
  const auto missing = folder / "none/file";
  const std::string expected = missing.string() + ": cannot be written: No such file or directory";
  bool later = false;
  {
    BackgroundWriter writer;
    writer.check();
    writer.submit([&] { write_file_atomically(missing, std::string_view("text")); });
    CHECK(test::message_of<EnvironmentError>([&] { writer.flush(); }) == expected);
    writer.check();
    writer.submit([&] { later = true; });
    writer.flush();
  }
  CHECK_FALSE(later);
  {
    BackgroundWriter writer;
    writer.submit([&] { write_file_atomically(missing, std::string_view("text")); });
    // check() sees it without waiting.
    std::string message = "no exception";
    for (int i = 0; i < 5000 && message == "no exception"; ++i) {
      message = test::message_of<EnvironmentError>([&] { writer.check(); });
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    CHECK(message == expected);
  }
}

TEST_CASE("signals are left to the thread that computes") {
  BackgroundWriter writer;
  sigset_t blocked;
  sigemptyset(&blocked);
  writer.submit([&] { pthread_sigmask(SIG_SETMASK, nullptr, &blocked); });
  writer.flush();
  CHECK(sigismember(&blocked, SIGTERM) == 1);
  sigset_t here;
  pthread_sigmask(SIG_SETMASK, nullptr, &here);
  CHECK(sigismember(&here, SIGTERM) == 0);
}
