// Time of one solution of the pressure system by solver, size, contrast of the coefficients and shape: the
// measurement behind the choice in fdm/solver_choice.cpp. Conductances as in steady seepage through cells of
// conductivity k, harmonic mean at the faces, no storage:
//   uniform   rectangle 2 : 1 between two water levels, k = 1
//   layers    the same, level layers of k from 1 to the contrast
//   random    the same, k of every cell from 1 to the contrast, logarithmically uniform
//   levee     levee on its subsoil with blanket, core and fill, half of the box; water on one slope, seepage
//             on the other, surfaces at 0.2 to 1.5 cells from the centres
//   column    3D, 1 : 1 : 4, k as in random, water on its top
// Every repetition has new values. Columns: milliseconds, of one thread on the processor (what others do on
// the machine counts less than in wall clock time), of the analysis of a new mask, of a solution with new
// values (the fastest of the repetitions), of another right-hand side with the same values; iterations.
// '*' marks the solver of the automatic choice.
//   bench_solver_table [largest number of cells = 1000000] [seconds a row may take = 4] [solvers whose name
//   contains]
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "bench/geometric_multigrid.hpp"
#include "core/error.hpp"
#include "core/threads.hpp"
#include "fdm/aggregation_multigrid.hpp"
#include "fdm/cosine_solver.hpp"
#include "fdm/direct_solver.hpp"

using namespace polder;
using namespace polder::fdm;

namespace {

constexpr double kTolerance = 1e-8;

enum class Shape { uniform, layers, random, levee, column };
const char* const kShapeNames[] = {"uniform", "layers", "random", "levee", "column"};

double uniform_number(std::uint64_t i) {  // in [0, 1), by index
  i = (i + 1) * 0x9e3779b97f4a7c15u;
  i = (i ^ (i >> 30)) * 0xbf58476d1ce4e5b9u;
  i = (i ^ (i >> 27)) * 0x94d049bb133111ebu;
  return static_cast<double>((i ^ (i >> 31)) >> 11) * 0x1p-53;
}

double seconds(const std::function<void()>& work) {  // of this thread on the processor
  const auto now = [] {
    timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
  };
  const double start = now();
  work();
  return now() - start;
}

// Height of the levee's surface over the lower side, in parts of the box.
double levee_surface(double x) {
  return 0.4 + 0.5 * std::clamp(std::min((x - 0.3) / 0.15, (0.7 - x) / 0.15), 0.0, 1.0);
}

template <int D>
struct Problem {
  Shape shape;
  double contrast;
  Index<D> size{};
  std::vector<int> number;
  Connectivity<D> connectivity;
  std::vector<double> k, sink, link, rhs;

  Problem(Shape s, double c, double cells) : shape(s), contrast(c) {
    if (D == 3) {
      const int side = static_cast<int>(std::lround(std::cbrt(cells / 4)));
      size.fill(side);
      size[D - 1] = 4 * side;
    } else {
      const double filled = shape == Shape::levee ? 0.525 : 1;
      size[1] = static_cast<int>(std::lround(std::sqrt(cells / filled / 2)));
      size[0] = 2 * size[1];
    }
    int box = 1;
    for (int d = 0; d < D; ++d) box *= size[d];
    number.assign(box, -1);
    for (int n = 0; n < box; ++n) {
      const Index<D> c = place(n);
      if (shape == Shape::levee && (c[1] + 0.5) / size[1] > levee_surface((c[0] + 0.5) / size[0])) continue;
      number[n] = static_cast<int>(connectivity.cells.size());
      connectivity.cells.push_back(c);
    }
    for (int i = 0; i < count(); ++i)
      for (int d = 0; d < D; ++d)
        if (const int j = neighbour(i, d); j >= 0) connectivity.links.push_back({i, j, d});
  }
  int count() const { return static_cast<int>(connectivity.cells.size()); }
  Index<D> place(int n) const {
    Index<D> c;
    for (int d = 0; d < D; ++d) c[d] = n % size[d], n /= size[d];
    return c;
  }
  int neighbour(int i, int axis) const {
    Index<D> c = connectivity.cells[i];
    if (++c[axis] >= size[axis]) return -1;
    int n = 0;
    for (int d = D - 1; d >= 0; --d) n = n * size[d] + c[d];
    return number[n];
  }
  double conductivity(int i, int step) const {
    const Index<D>& c = connectivity.cells[i];
    const double x = (c[0] + 0.5) / size[0], y = (c[D - 1] + 0.5) / size[D - 1];
    double part = 0;
    if (shape == Shape::layers) part = static_cast<int>(y * 20) * 7 % 11 / 10.0;
    if (shape == Shape::random || shape == Shape::column) part = uniform_number(i);
    if (shape == Shape::levee)
      part = y < 0.3 ? 1 : y < 0.4 ? 0 : x > 0.47 && x < 0.53 ? 0 : 0.5 + 0.1 * (uniform_number(i) - 0.5);
    return std::pow(contrast, part) * (1 + 0.01 * step);
  }
  void set_values(int step) {
    k.resize(count());
    for (int i = 0; i < count(); ++i) k[i] = conductivity(i, step);
    link.clear();
    for (const auto& l : connectivity.links)
      link.push_back(2 * k[l.low] * k[l.high] / (k[l.low] + k[l.high]));
    sink.assign(count(), 0);
    rhs.assign(count(), 0);
    const auto prescribe = [&](int i, double distance, double head) {
      sink[i] += k[i] / distance;
      rhs[i] += k[i] / distance * head;
    };
    for (int i = 0; i < count(); ++i) {
      const Index<D>& c = connectivity.cells[i];
      if (shape == Shape::levee) {
        const double x = (c[0] + 0.5) / size[0];
        const double distance =
            std::max(0.2, levee_surface(x) * size[1] - (c[1] + 0.5) + 1e-9 * uniform_number(i));
        if (neighbour(i, 1) < 0 && (x < 0.45 || x > 0.55)) prescribe(i, std::min(distance, 1.5), x < 0.45);
      } else if (shape == Shape::column) {
        if (c[D - 1] == size[D - 1] - 1) prescribe(i, 0.5, uniform_number(i));
      } else {
        if (c[0] == 0) prescribe(i, 0.5, 1);
        if (c[0] == size[0] - 1) prescribe(i, 0.5, 0);
      }
    }
  }
};

template <int D>
struct Candidate {
  const char* name;
  bool usual;  // false: a variant that is never the automatic choice
  std::function<std::unique_ptr<LinearSolver<D>>()> make;
};

template <int D>
std::vector<Candidate<D>> candidates() {
  using Ordering = CholeskyMethod::Ordering;
  const auto direct = [](Ordering ordering, bool supernodal) {
    return [=] { return std::make_unique<DirectSolver<D>>(CholeskyMethod{ordering, supernodal}); };
  };
  return {
      {"Cholesky, minimum degree, LDLT", true, direct(Ordering::minimum_degree, false)},
      {"Cholesky, nested dissection, LDLT", false, direct(Ordering::nested_dissection, false)},
      {"Cholesky, minimum degree, supernodal", false, direct(Ordering::minimum_degree, true)},
      {"aggregation multigrid", true, [] { return std::make_unique<AggregationMultigrid<D>>(); }},
      {"geometric multigrid", false, [] { return std::make_unique<GeometricMultigrid<D>>(); }},
      {"cosine transform", true, [] { return std::make_unique<CosineSolver<D>>(); }},
  };
}

// Time at each size of one solver on one family of problems, for the growth exponents.
using Growth = std::map<std::string, std::vector<std::pair<double, double>>>;

template <int D>
void measure(Shape shape, double contrast, double cells, double patience, const char* only, Growth& growth) {
  Problem<D> problem(shape, contrast, cells);
  problem.set_values(0);
  std::vector<double> x(problem.count());
  const auto automatic = make_solver<D>(SolverKind::automatic);
  automatic->analyse(problem.connectivity);
  automatic->solve({problem.sink, problem.link, problem.rhs}, {.tolerance = kTolerance}, x);
  for (const Candidate<D>& candidate : candidates<D>()) {
    if (!std::strstr(candidate.name, only)) continue;
    char family[64];
    std::snprintf(family, sizeof family, "%-8s %7.0e  %s", kShapeNames[static_cast<int>(shape)], contrast,
                  candidate.name);
    auto& history = growth[family];
    if (!history.empty() && history.back().second * 8 > patience)
      continue;  // the next size would take longer
    const auto solver = candidate.make();
    const double analysis = seconds([&] { solver->analyse(problem.connectivity); });
    double fastest = 1e9, again = 1e9, spent = analysis;
    int iterations = 0;
    try {
      for (int step = 0; step < 3 || (spent < 0.2 && step < 20); ++step) {
        problem.set_values(step);
        const SystemValues system{problem.sink, problem.link, problem.rhs};
        const double t =
            seconds([&] { iterations = solver->solve(system, {.tolerance = kTolerance}, x).iterations; });
        problem.rhs[0] += 1;
        again = std::min(again, seconds([&] { solver->solve(system, {.tolerance = kTolerance}, x); }));
        fastest = std::min(fastest, t);
        spent += t;
        if (spent > patience) break;
      }
    } catch (const NumericalError& error) {
      if (std::strcmp(candidate.name, "cosine transform") != 0)
        std::printf("%7d %s: %s\n", problem.count(), family, error.what());
      continue;  // the transform does not apply
    }
    history.emplace_back(problem.count(), fastest);
    std::printf("%8d %c %-58s %9.2f %9.2f %9.2f %5d\n", problem.count(),
                candidate.usual && std::strcmp(solver->name(), automatic->name()) == 0 ? '*' : ' ', family,
                1e3 * analysis, 1e3 * fastest, 1e3 * again, iterations);
    std::fflush(stdout);
  }
}

// Exponent of a power law through the last sizes: least squares in logarithms, from 2e4 cells on.
void print_growth(const Growth& growth) {
  std::printf("\ntime ~ cells^p from 2e4 cells on\n");
  for (const auto& [family, points] : growth) {
    double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
    for (const auto& [cells, time] : points) {
      if (cells < 1.9e4) continue;
      const double x = std::log(cells), y = std::log(time);
      n += 1, sx += x, sy += y, sxx += x * x, sxy += x * y;
    }
    if (n >= 2) std::printf("%-58s p = %.2f\n", family.c_str(), (n * sxy - sx * sy) / (n * sxx - sx * sx));
  }
}

}  // namespace

int main(int argc, char** argv) {
  const double largest = argc > 1 ? std::atof(argv[1]) : 1e6;
  const double patience = argc > 2 ? std::atof(argv[2]) : 4;
  const char* const only = argc > 3 ? argv[3] : "";
  set_threads(1);
  std::printf("1 thread, tolerance %.0e\n", kTolerance);
  std::printf("%8s   %-58s %9s %9s %9s %5s\n", "cells", "problem, contrast, solver", "analysis", "new values",
              "same", "iter.");
  Growth growth;
  const std::pair<Shape, double> families[] = {
      {Shape::uniform, 1},  {Shape::layers, 1e3}, {Shape::layers, 1e6}, {Shape::random, 1e3},
      {Shape::random, 1e6}, {Shape::levee, 1},    {Shape::levee, 1e3},  {Shape::levee, 1e6}};
  for (double cells : {5e2, 1e3, 5e3, 2e4, 1e5, 3e5, 1e6}) {
    if (cells > largest) break;
    for (const auto& [shape, contrast] : families) measure<2>(shape, contrast, cells, patience, only, growth);
    for (double contrast : {1.0, 1e3, 1e6})
      if (cells >= 5e3) measure<3>(Shape::column, contrast, cells, patience, only, growth);
  }
  print_growth(growth);
}
