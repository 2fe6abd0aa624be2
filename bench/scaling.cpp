// Cost of a step for each point against the number of points and of threads, and the memory of a point with
// all outputs on: soil that a run starts with by default (MUSL, GIMP, locking cure, softening Mohr-Coulomb).
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <string>

#include "bench/measure.hpp"
#include "bench/slab_scene.hpp"
#include "core/threads.hpp"
#include "coupling/quantities.hpp"
#include "coupling/simulation.hpp"

using namespace polder;
using namespace polder::bench;

namespace {

const char* const kUsage =
    "bench scaling [--least N = 1e4] [--most N = 1e7] [--threads N = 2] [--seconds S = 4] "
    "[--output DIR = results/bench/scaling]\n"
    "  points grow tenfold from least to most; seconds: for each size and number of threads\n";

// Points, resident bytes of a point while the simulation steps, with a frame of the default fields beside it
// and with one of all, and seconds for a point and step with 1, 2, 4 ... threads.
std::vector<double> measure(const Slab& slab, int threads, double seconds) {
  set_threads(threads);
  const double before = resident_memory();
  coupling::Simulation simulation(make_scene(slab));
  const auto step = [&] { simulation.step(); };
  for (int i = 0; i < 3; ++i) step();
  std::vector<BestWindow> best;
  for (int t = 1; t <= threads; t *= 2) best.emplace_back();
  constexpr int kTurns = 3;
  for (int turn = 0; turn < kTurns; ++turn)
    for (std::size_t i = 0; i < best.size(); ++i) {
      set_threads(1 << i);
      best[i].look(seconds / kTurns, step);
    }
  const auto points = static_cast<double>(simulation.particles());
  const double stepping = resident_memory() - before;
  std::vector<std::string> all;
  for (const coupling::Quantity& q : coupling::frame_quantities()) all.push_back(q.name);
  std::vector<double> numbers{points, stepping / points};
  for (const std::vector<std::string>& fields : {simulation.scene().output.fields, all}) {
    const coupling::PointFrame frame = simulation.points(fields);  // kept while it is written
    numbers.push_back((resident_memory() - before) / points);
  }
  numbers.push_back(best[0].processor() / points);
  for (std::size_t i = 1; i < best.size(); ++i) numbers.push_back(best[i].wall() / points);
  return numbers;
}

}  // namespace

int main(int count, char** words) {
  const Options options(count, words, {"--least", "--most", "--threads", "--seconds", "--output"}, kUsage);
  const int threads = static_cast<int>(options.number("--threads", 2));
  const double least = options.number("--least", 1e4), most = options.number("--most", 1e7);
  try {
    std::vector<std::string> columns{"dimension",    "points",          "bytes per point",
                                     "with a frame", "with all fields", "1 thread [ns per point and step]"};
    for (int t = 2; t <= threads; t *= 2) columns.push_back(std::to_string(t) + " threads [ns]");
    ResultTable table("scaling", "Cost and memory against size", columns);
    for (const int dimension : {2, 3})
      for (double points = least; points <= most * 1.01; points *= 10) {
        Slab slab;
        slab.dimension = dimension, slab.points = points;
        slab.plastic = slab.softening = slab.cell_average = true;
        const std::vector<double> r =
            in_child([&] { return measure(slab, threads, options.number("--seconds", 4)); });
        std::vector<std::string> row{std::to_string(dimension), digits(r[0], 0), digits(r[1], 0),
                                     digits(r[2], 0), digits(r[3], 0)};
        for (std::size_t i = 4; i < r.size(); ++i) row.push_back(digits(1e9 * r[i], 1));
        table.add(row);
        std::fprintf(stderr, "%dD %10.0f points: %6.1f ns\n", dimension, r[0], 1e9 * r[4]);
      }
    table.write(options.text("--output", "results/bench/scaling"));
  } catch (const std::exception& e) {
    std::fprintf(stderr, "error: %s\n", e.what());
    return 3;
  }
  return 0;
}
