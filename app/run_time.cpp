#include "app/run_time.hpp"

#include <chrono>
#include <cmath>
#include <limits>

#include "core/error.hpp"
#include "coupling/simulation.hpp"
#include "coupling/water_pace.hpp"

namespace polder::app {
namespace {

using coupling::Scene;
using coupling::Simulation;
using coupling::Stage;

constexpr double kPatience = 1.0;        // of a trial [s]
constexpr int kWarmUp = 2, kMost = 200;  // steps

// Whether a step of both costs the same.
bool alike(const Stage& a, const Stage& b) {
  return a.mode == b.mode && (a.damping > 0) == (b.damping > 0) && a.water_flows == b.water_flows &&
         a.plastic == b.plastic && a.until == b.until;
}

// Wall clock for one step of the case as if it began with this stage [s].
double trial(const Scene& scene, const Stage& stage) {
  const auto now = [] { return std::chrono::steady_clock::now(); };
  const auto seconds = [](auto duration) { return std::chrono::duration<double>(duration).count(); };
  Scene alone = scene;
  alone.stages = {stage};
  alone.numerics.sleep = false;  // nothing has come to rest yet
  alone.measures.clear();
  alone.expectations.clear();
  try {
    Simulation simulation(alone);
    for (int i = 0; i < kWarmUp && !simulation.finished(); ++i) simulation.step();
    const auto start = now();
    int steps = 0;
    while (steps < kMost && !simulation.finished() && seconds(now() - start) < kPatience) {
      simulation.step();
      ++steps;
    }
    return steps > 0 ? seconds(now() - start) / steps : 0;
  } catch (const NumericalError&) {
    return std::numeric_limits<double>::quiet_NaN();
  }
}

// The fewest steps in which water comes through its stage; 0: any number, because the flow itself ends it.
double fewest_water_steps(const Stage& s) {
  if (s.until == Stage::Until::steady) return 0;
  const coupling::WaterPace pace = coupling::water_pace(s);
  const double growing = std::log(std::max(1.0, pace.largest / pace.first)) / std::log(pace.growth);
  return std::ceil(s.duration / pace.largest + growing);
}

}  // namespace

std::vector<StageTime> estimate_run_time(const Scene& scene, const std::vector<double>& step) {
  std::vector<StageTime> times;
  for (std::size_t i = 0; i < scene.stages.size(); ++i) {
    const Stage& s = scene.stages[i];
    StageTime t;
    t.steps = s.moves() ? std::ceil(s.duration / step[i]) : fewest_water_steps(s);
    std::size_t same = 0;
    while (!alike(scene.stages[same], s)) ++same;
    t.seconds_per_step = same < i ? times[same].seconds_per_step : trial(scene, s);
    times.push_back(t);
  }
  return times;
}

}  // namespace polder::app
