// Particle-steps per second of whole steps as a run makes them (coupling::Simulation: boundaries, balances,
// choice of the step), for every way to map between points and nodes, shape function and kind of law, in the
// plane and in space, with one thread and with several.
#include <algorithm>
#include <cstdio>
#include <exception>
#include <string>

#include "bench/measure.hpp"
#include "bench/slab_scene.hpp"
#include "core/threads.hpp"
#include "coupling/simulation.hpp"

using namespace polder;
using namespace polder::bench;

namespace {

const char* const kUsage =
    "bench throughput [--points N = 400000] [--threads N = 2] [--seconds S = 1.5] [--only TEXT] "
    "[--output DIR = results/bench/throughput]\n"
    "  seconds: for each row and number of threads; only: rows whose name contains TEXT\n";

std::vector<Slab> all_slabs(double points) {
  using coupling::StressOrder;
  using coupling::Transfer;
  std::vector<Slab> slabs;
  for (const int dimension : {2, 3})
    for (const auto& [order, transfer] :
         {std::pair{StressOrder::usl, Transfer::tpic}, std::pair{StressOrder::usl, Transfer::apic},
          std::pair{StressOrder::usl, Transfer::flip}, std::pair{StressOrder::musl, Transfer::flip}})
      for (const auto shape : {mpm::ShapeKind::quadratic_bspline, mpm::ShapeKind::gimp})
        for (int law = 0; law < 3; ++law) {
          Slab s;
          s.dimension = dimension, s.order = order, s.transfer = transfer, s.shape = shape;
          s.plastic = law > 0, s.softening = law > 1, s.points = points;
          slabs.push_back(s);
          if (order != StressOrder::musl || shape != mpm::ShapeKind::gimp || law == 0) continue;
          s.cell_average = true;  // the default of runs
          slabs.push_back(s);
        }
  return slabs;
}

// Particle-steps per second with one thread and with `threads`, in turns.
std::vector<double> measure(const Slab& slab, int threads, double seconds) {
  set_threads(threads);
  coupling::Simulation simulation(make_scene(slab));
  const auto step = [&] { simulation.step(); };
  for (int i = 0; i < 3; ++i) step();
  BestWindow one, all;
  constexpr int kTurns = 5;
  for (int turn = 0; turn < kTurns; ++turn) {
    set_threads(1);
    one.look(seconds / kTurns, step);
    if (threads < 2) continue;
    set_threads(threads);
    all.look(seconds / kTurns, step);
  }
  const auto points = static_cast<double>(simulation.particles());
  return {points, points / one.processor(), threads < 2 ? 0.0 : points / all.wall()};
}

}  // namespace

int main(int count, char** words) {
  const Options options(count, words, {"--points", "--threads", "--seconds", "--only", "--output"}, kUsage);
  const int threads = static_cast<int>(options.number("--threads", 2));
  const std::string only = options.text("--only", "");
  try {
    ResultTable table("throughput", "Throughput of whole steps",
                      {"run", "points", "one thread [M/s]", "ns per point and step",
                       std::to_string(threads) + " threads [M/s]", "speed-up"});
    for (const Slab& slab : all_slabs(options.number("--points", 4e5))) {
      const std::string name = name_of(slab);
      if (name.find(only) == std::string::npos) continue;
      const std::vector<double> r =
          in_child([&] { return measure(slab, threads, options.number("--seconds", 1.5)); });
      table.add({name, digits(r[0], 0), digits(r[1] * 1e-6, 2), digits(1e9 / r[1], 1),
                 threads < 2 ? "" : digits(r[2] * 1e-6, 2), threads < 2 ? "" : digits(r[2] / r[1], 2)});
      std::fprintf(stderr, "%-40s %8.2f M/s\n", name.c_str(), r[1] * 1e-6);
    }
    table.write(options.text("--output", "results/bench/throughput"));
  } catch (const std::exception& e) {
    std::fprintf(stderr, "error: %s\n", e.what());
    return 3;
  }
  return 0;
}
