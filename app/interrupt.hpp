// Ctrl-C and termination: the step in progress is finished, a checkpoint is written, the program ends with
// 130. A second Ctrl-C ends it at once.
#pragma once

namespace polder::app {

// While one exists the signals are caught.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

  static bool requested();
};

}  // namespace polder::app
