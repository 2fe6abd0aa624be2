// Makes steps of a small fixed scene, for programs that count what a step takes:
//   step_driver SCENE STEPS
// Writes the number of points. One thread; the same bits every time.
#include <cstdio>
#include <cstdlib>
#include <exception>

#include "core/threads.hpp"
#include "coupling/simulation.hpp"
#include "tests/counters/small_scenes.hpp"

int main(int count, char** words) {
  using namespace polder;
  try {
    const counters::SmallScene* scene = count == 3 ? counters::find_small_scene(words[1]) : nullptr;
    const long steps = count == 3 ? std::atol(words[2]) : 0;
    if (scene == nullptr || steps < 1) {
      std::fprintf(stderr, "usage: step_driver SCENE STEPS\nscenes:");
      for (const counters::SmallScene& s : counters::small_scenes()) std::fprintf(stderr, " %s", s.name);
      std::fprintf(stderr, "\n");
      return 2;
    }
    set_threads(1);
    const long points = counters::make_steps(*scene, steps);
    std::printf("%ld\n", points);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "error: %s\n", e.what());
    return 3;
  }
  return 0;
}
