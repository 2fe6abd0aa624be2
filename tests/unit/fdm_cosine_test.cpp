#include <doctest/doctest.h>

#include "core/error.hpp"
#include "core/threads.hpp"
#include "fdm/cosine_solver.hpp"
#include "fdm/direct_solver.hpp"
#include "tests/unit/fdm_scene.hpp"

using namespace polder;
using namespace polder::fdm;
using namespace polder::fdm::test;

namespace {

enum class Side { wall, face };

// A full box with layers across `axis` whose values spread over `contrast`. sides: across the other axes;
// ends: sinks of the first and the last layer; cells in a scrambled order.
template <int D>
struct Box {
  Connectivity<D> connectivity;
  std::vector<double> sink, link, rhs;
  SystemValues values() const { return {sink, link, rhs}; }

  Box(Index<D> size, int axis, double contrast, std::array<std::array<Side, 2>, D> sides, double storage,
      std::array<double, 2> ends) {
    verify::Random random(99);
    int total = 1;
    for (int n : size) total *= n;
    std::vector<int> place(total), number(total);
    for (int i = 0; i < total; ++i) place[i] = i;
    for (int i = total - 1; i > 0; --i) std::swap(place[i], place[static_cast<int>(random() * (i + 1))]);
    for (int i = 0; i < total; ++i) number[place[i]] = i;
    std::vector<std::array<double, D>> layer(size[axis]);  // links along each axis
    for (auto& l : layer)
      for (double& v : l) v = std::pow(contrast, random());
    sink.resize(total);
    for (int i = 0; i < total; ++i) {
      Index<D> c;
      for (int d = 0, rest = place[i]; d < D; ++d) c[d] = rest % size[d], rest /= size[d];
      Index<D> shifted = c;
      for (int& n : shifted) n += 5;
      connectivity.cells.push_back(shifted);
      sink[i] = storage * (1 + c[axis]);
      for (int d = 0, step = 1; d < D; step *= size[d++]) {
        const double along = layer[c[axis]][d];
        if (c[d] + 1 < size[d]) {
          connectivity.links.push_back({i, number[place[i] + step], d});
          link.push_back(along);
        }
        for (int end = 0; end < 2; ++end) {
          if (c[d] != (end == 0 ? 0 : size[d] - 1)) continue;
          if (d == axis)
            sink[i] += ends[end];
          else if (sides[d][end] == Side::face)
            sink[i] += 2 * along;
        }
      }
      rhs.push_back(random() - 0.5);
    }
  }
};

template <int D>
void compare(const Box<D>& box, double tolerance = 1e-10) {
  CosineSolver<D> cosine;
  DirectSolver<D> direct;
  cosine.analyse(box.connectivity);
  direct.analyse(box.connectivity);
  REQUIRE(cosine.applies(box.values()));
  std::vector<double> x(box.sink.size()), y(x);
  cosine.solve(box.values(), {.tolerance = 1e-13}, x);
  direct.solve(box.values(), {.tolerance = 1e-13}, y);
  double largest = 0, difference = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    largest = std::max(largest, std::abs(y[i]));
    difference = std::max(difference, std::abs(x[i] - y[i]));
  }
  CHECK(difference < tolerance * largest);
}

constexpr Side W = Side::wall, F = Side::face;

}  // namespace

TEST_CASE("cosine transform agrees with Cholesky for every pair of sides, across either axis") {
  for (int axis : {0, 1})
    for (Side lower : {W, F})
      for (Side upper : {W, F})
        for (double contrast : {1.0, 1e6}) {
          CAPTURE(axis);
          CAPTURE(contrast);
          std::array<std::array<Side, 2>, 2> sides{};
          sides[1 - axis] = {lower, upper};
          // The condition number, some 1e3 times the contrast, times rounding.
          const double tolerance = contrast > 1 ? 1e-9 : 1e-12;
          compare(Box<2>({23, 18}, axis, contrast, sides, 0.01, {0, 3.7}), tolerance);
          compare(Box<2>({23, 18}, axis, contrast, sides, 0, {0.4, 1.1}), tolerance);
        }
}

TEST_CASE("cosine transform agrees with Cholesky in 3D and on thin boxes") {
  compare(Box<3>({9, 8, 11}, 2, 1e3, {{{W, F}, {F, F}, {W, W}}}, 0, {0, 2}));
  compare(Box<3>({9, 8, 11}, 0, 1e3, {{{W, W}, {W, W}, {F, W}}}, 1e-3, {0, 0}));
  compare(Box<2>({2, 30}, 1, 10, {{{W, W}, {W, W}}}, 0, {0, 1}));
  compare(Box<2>({1, 30}, 1, 10, {{{W, W}, {W, W}}}, 0, {0, 1}));
  compare(Box<2>({30, 1}, 0, 10, {{{W, W}, {W, W}}}, 0, {0, 1}));
}

TEST_CASE("cosine transform solves a closed basin that is pinned in one cell") {
  Box<2> box({24, 15}, 1, 1e3, {{{W, W}, {W, W}}}, 0, {0, 0});
  for (std::size_t i = 0; i < box.sink.size(); ++i)
    if (box.connectivity.cells[i] == Index<2>{5, 5}) box.sink[i] = 4;
  compare(box, 1e-9);  // a right-hand side with a net inflow, all of which the pin takes
}

TEST_CASE("a million to one between storage and links, and the other way round, costs no digits") {
  compare(Box<2>({24, 15}, 1, 1, {{{W, W}, {W, W}}}, 1e-8, {0, 0}), 1e-7);
  compare(Box<2>({24, 15}, 1, 1, {{{W, W}, {W, W}}}, 1e8, {0, 0}));
}

TEST_CASE("cosine transform declines what it does not diagonalise") {
  const Box<2> good({24, 15}, 1, 10, {{{W, F}, {W, W}}}, 0, {0, 1});
  const auto applies = [](const Box<2>& box) {
    CosineSolver<2> solver;
    solver.analyse(box.connectivity);
    return solver.applies(box.values());
  };
  REQUIRE(applies(good));
  Box<2> box = good;
  box.link[100] *= 1 + 1e-9;
  CHECK_FALSE(applies(box));
  std::vector<double> x(box.sink.size());
  CosineSolver<2> solver;
  solver.analyse(box.connectivity);
  CHECK_THROWS_AS(solver.solve(box.values(), {}, x), NumericalError);
  box = good;
  box.sink[100] += 1e-9;
  CHECK_FALSE(applies(box));
  box = good;
  box.sink[7] = std::nan("");
  CHECK_FALSE(applies(box));
  box = good;
  box.link[7] = std::nan("");
  CHECK_FALSE(applies(box));
  CHECK_FALSE(applies(Box<2>({24, 15}, 1, 10, {{{W, W}, {W, W}}}, 0, {0, 0})));  // closed: singular
  box = good;                                                                    // a hole
  box.connectivity.cells.pop_back();
  std::erase_if(box.connectivity.links, [&](const auto& l) {
    return std::max(l.low, l.high) == static_cast<int>(box.connectivity.cells.size());
  });
  box.link.resize(box.connectivity.links.size());
  CHECK_FALSE(applies(box));
}

TEST_CASE(
    "cosine transform has the same bits for any number of threads, and where it is the automatic choice") {
  const Box<2> box({200, 120}, 1, 1e3, {{{F, W}, {W, W}}}, 0, {0, 1});
  std::vector<double> x(box.sink.size()), y(x);
  const int before = threads();
  for (int n : {1, 3}) {
    set_threads(n);
    const auto solver = make_solver<2>(n == 1 ? SolverKind::cosine : SolverKind::automatic);
    solver->analyse(box.connectivity);
    solver->solve(box.values(), {}, n == 1 ? x : y);
    CHECK(std::string(solver->name()) == "cosine transform");
  }
  set_threads(before);
  CHECK(x == y);
}
