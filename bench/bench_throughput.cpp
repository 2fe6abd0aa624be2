// Particle-steps per second of the soil skeleton: one full explicit step of a shearing slab of soil, for
// every transfer, two shapes and two laws, in the plane and in space.
//
//   bench_throughput [particles = 500000] [steps = 15] [threads = 1] [name contains]
//
// Times are those of the fastest and of the middle step, on the wall clock and in processor time over the
// threads (what counts on a machine that others use too).
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <numbers>

#include "core/threads.hpp"
#include "tests/verify/mpm_scene.hpp"

using namespace polder;
using namespace polder::verify;

namespace {

struct Arguments {
  double particles = 500000;
  int steps = 15, threads = 1;
  const char* filter = nullptr;
};

double wall_clock() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}
double processor_clock() {
  timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

MaterialParameters soil(bool plastic) {
  MaterialParameters m = elastic(1800, 2e7, 0.3);
  if (!plastic) return m;
  m.model = MaterialModel::mohr_coulomb;  // nearly all points yield
  m.friction.value = {std::asin(0.5)};
  m.dilation.value = {std::asin(0.1)};
  m.cohesion.kind = Mobilised::Kind::exponential;
  m.cohesion.peak = 200, m.cohesion.residual = 20, m.cohesion.rate = 30;
  return m;
}

template <int D>
void run(const Arguments& a, const char* transfer, ShapeKind shape, bool musl, AffineKind affine,
         bool plastic, bool average) {
  char name[96];
  std::snprintf(name, sizeof name, "%dD %s %s %s%s", D, plastic ? "MC" : "el", transfer,
                shape == ShapeKind::gimp ? "gimp" : "bspline", average ? " cell-average" : "");
  if (a.filter != nullptr && std::strstr(name, a.filter) == nullptr) return;

  constexpr double kSpacing = 0.1;
  constexpr int up = D - 1;
  const double filled = a.particles / (1 << D);
  Index<D> soil_cells;
  if (D == 2) {
    soil_cells[1] = static_cast<int>(std::sqrt(filled / 2));
    soil_cells[0] = static_cast<int>(filled / soil_cells[1]);
  } else {
    soil_cells[up] = static_cast<int>(std::cbrt(filled / 2));
    soil_cells[0] = soil_cells[1] = static_cast<int>(std::sqrt(filled / soil_cells[up]));
  }
  Index<D> cells;
  Point<D> lower, upper;
  for (int d = 0; d < D; ++d) {
    cells[d] = soil_cells[d] + 12;
    lower[d] = 4 * kSpacing, upper[d] = (4 + soil_cells[d]) * kSpacing;
  }
  SkeletonOptions options;
  options.shape = shape, options.musl = musl, options.affine = affine, options.cell_average = average;
  Scene<D> scene(Grid<D>(Point<D>{}, cells, kSpacing), options, all_sides<D>(BoundaryKind::roller));
  ParticleSet<D>& set = scene.add(soil(plastic), lower, upper, 2, 0.4);
  for (int p = 0; p < set.slots(); ++p) {
    const double vertical = -1800 * 9.81 * (upper[up] - set.position[up][p]);
    for (int k = 0; k < 3; ++k) set.stress[k][p] = k == up ? vertical : 0.45 * vertical;
    set.velocity[0][p] = 0.5 * std::sin(set.position[up][p] / kSpacing * 0.7);
  }
  scene.gravity[up] = -9.81;
  const double dt = scene.wave_step(0.3);
  scene.step(dt);  // sorts
  std::vector<double> wall, processor;
  for (int i = 0; i < a.steps; ++i) {
    const double w = wall_clock(), c = processor_clock();
    scene.step(dt);
    wall.push_back(wall_clock() - w), processor.push_back((processor_clock() - c) / a.threads);
  }
  std::sort(wall.begin(), wall.end()), std::sort(processor.begin(), processor.end());
  const double million = 1e-6 * set.count();
  std::printf(
      "%-34s %8d points %d threads: wall best %6.2f median %6.2f, processor best %6.2f median %6.2f M/s\n",
      name, set.count(), a.threads, million / wall[0], million / wall[wall.size() / 2],
      million / processor[0], million / processor[processor.size() / 2]);
  std::fflush(stdout);
}

template <int D>
void run_all(const Arguments& a) {
  struct Transfer {
    const char* name;
    bool musl;
    AffineKind affine;
  };
  for (const Transfer& t :
       {Transfer{"tpic", false, AffineKind::tpic}, Transfer{"apic", false, AffineKind::apic},
        Transfer{"flip", false, AffineKind::none}, Transfer{"musl", true, AffineKind::none}})
    for (const ShapeKind shape : {ShapeKind::quadratic_bspline, ShapeKind::gimp})
      for (const bool plastic : {false, true}) run<D>(a, t.name, shape, t.musl, t.affine, plastic, false);
  run<D>(a, "musl", ShapeKind::gimp, true, AffineKind::none, true, true);
}

}  // namespace

int main(int count, char** words) {
  Arguments a;
  if (count > 1) a.particles = std::atof(words[1]);
  if (count > 2) a.steps = std::atoi(words[2]);
  if (count > 3) a.threads = std::atoi(words[3]);
  if (count > 4) a.filter = words[4];
  if (!(a.particles >= 1000) || a.steps < 1 || a.threads < 1) {
    std::fprintf(stderr, "usage: bench_throughput [particles >= 1000] [steps] [threads] [name contains]\n");
    return 2;
  }
  set_threads(a.threads);
  run_all<2>(a);
  run_all<3>(a);
  return 0;
}
