#include <doctest/doctest.h>

#include "core/error.hpp"
#include "fdm/aggregation_multigrid.hpp"
#include "fdm/direct_solver.hpp"
#include "tests/unit/fdm_scene.hpp"

using namespace polder;
using namespace polder::fdm;
using namespace polder::fdm::test;

namespace {

template <int D>
struct System {
  Connectivity<D> connectivity;
  std::vector<double> sink, link, rhs;
  SystemValues values() const { return {sink, link, rhs}; }
};

// Cells where `inside`, with holes; conductances spread over `contrast` by patches of 5 cells, times
// `anisotropy` along the last axis; a sink wherever a neighbour is missing above.
template <int D, class Inside>
System<D> irregular(Index<D> size, double contrast, double anisotropy, const Inside& inside) {
  verify::Random random(12345);
  System<D> s;
  const auto linear = [&](const Index<D>& c) {
    int n = 0;
    for (int d = D - 1; d >= 0; --d) n = n * size[d] + c[d];
    return n;
  };
  int total = 1;
  for (int d = 0; d < D; ++d) total *= size[d];
  std::vector<int> number(total, -1);
  std::vector<double> k;
  for (int n = 0; n < total; ++n) {
    Index<D> c;
    for (int d = 0, rest = n; d < D; ++d) c[d] = rest % size[d], rest /= size[d];
    if (!inside(c) || random() < 0.03) continue;
    number[n] = static_cast<int>(k.size());
    s.connectivity.cells.push_back(c);
    int patch = 0;
    for (int d = 0; d < D; ++d) patch = 31 * patch + c[d] / 5;
    k.push_back(std::pow(contrast, (patch * 7 % 11) / 10.0) * (0.8 + 0.4 * random()));
  }
  s.sink.assign(k.size(), 0);
  for (std::size_t i = 0; i < k.size(); ++i)
    for (int d = 0; d < D; ++d) {
      Index<D> up = s.connectivity.cells[i];
      const bool outside = ++up[d] >= size[d];
      const int j = outside ? -1 : number[linear(up)];
      if (j >= 0) {
        s.connectivity.links.push_back({static_cast<int>(i), j, d});
        s.link.push_back((d == D - 1 ? anisotropy : 1) * 0.5 * (k[i] + k[j]));
      } else if (d == D - 1) {
        s.sink[i] += k[i] / (0.02 + 1.48 * random());
      }
    }
  for (std::size_t i = 0; i < k.size(); ++i) s.rhs.push_back(random() - 0.5);
  return s;
}

template <int D>
void compare(const System<D>& s, int most_iterations) {
  DirectSolver<D> direct;
  AggregationMultigrid<D> multigrid;
  direct.analyse(s.connectivity);
  multigrid.analyse(s.connectivity);
  std::vector<double> x(s.sink.size()), y(x);
  direct.solve(s.values(), {.tolerance = 1e-12}, x);
  const SolveReport report = multigrid.solve(s.values(), {.tolerance = 1e-12}, y);
  double largest = 0, difference = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    largest = std::max(largest, std::abs(x[i]));
    difference = std::max(difference, std::abs(x[i] - y[i]));
  }
  INFO("cells " << x.size() << " levels " << multigrid.levels() << " iterations " << report.iterations);
  CHECK(multigrid.levels() > 1);
  CHECK(difference < 1e-8 * largest);
  CHECK(report.iterations <= most_iterations);
  CHECK(report.iterations > 3);
}

}  // namespace

TEST_CASE("multigrid agrees with Cholesky on a levee with holes, contrast 1 to 1e6") {
  for (double contrast : {1.0, 1e3, 1e6}) {
    CAPTURE(contrast);
    compare(
        irregular<2>({90, 40}, contrast, 1, [](const auto& c) { return in_levee(c[0] / 90.0, c[1] / 90.0); }),
        30);
  }
}

TEST_CASE("multigrid agrees with Cholesky in 3D") {
  for (double contrast : {1.0, 1e6}) {
    CAPTURE(contrast);
    compare(irregular<3>({26, 9, 12}, contrast, 1,
                         [](const auto& c) { return in_levee(c[0] / 26.0, c[2] / 26.0 + 0.0 * c[1]); }),
            30);
  }
}

TEST_CASE("stiff layers are aggregated along the stiff axis only") {
  for (double anisotropy : {0.01, 100.0}) {
    CAPTURE(anisotropy);
    compare(irregular<2>({90, 40}, 10, anisotropy,
                         [](const auto& c) { return in_levee(c[0] / 90.0, c[1] / 90.0); }),
            70);
  }
}

TEST_CASE("the inverse of the matrix is symmetric with both solvers") {
  const System<2> s = irregular<2>({30, 20}, 1e3, 1, [](const auto& c) { return c[1] < 14 || c[0] < 9; });
  for (SolverKind kind : {SolverKind::direct, SolverKind::multigrid}) {
    const auto solver = make_solver<2>(kind);
    solver->analyse(s.connectivity);
    const int n = static_cast<int>(s.sink.size());
    std::vector<double> rhs(n), x(n);
    const auto response = [&](int source, int at) {
      std::fill(rhs.begin(), rhs.end(), 0.0);
      rhs[source] = 1;
      solver->solve({s.sink, s.link, rhs}, {.tolerance = 1e-13}, x);
      return x[at];
    };
    for (const auto& [i, j] : {std::pair{0, n - 1}, {n / 2, 3}, {n / 3, n / 3 + 1}})
      CHECK(response(i, j) == doctest::Approx(response(j, i)).epsilon(1e-9));
  }
}

TEST_CASE("a solution depends on its system alone, not on the ones before") {
  const auto inside = [](const auto& c) { return in_levee(c[0] / 90.0, c[1] / 90.0); };
  const System<2> a = irregular<2>({90, 40}, 1, 1, inside), b = irregular<2>({90, 40}, 1, 100, inside);
  for (SolverKind kind : {SolverKind::direct, SolverKind::multigrid}) {
    const auto fresh = make_solver<2>(kind), used = make_solver<2>(kind);
    fresh->analyse(a.connectivity);
    used->analyse(a.connectivity);
    std::vector<double> x(a.sink.size()), y(x);
    used->solve(b.values(), {}, y);
    used->solve(a.values(), {}, y);
    fresh->solve(a.values(), {}, x);
    CHECK(x == y);
  }
}

TEST_CASE("failures are reported, not returned") {
  System<2> s = irregular<2>({90, 40}, 1, 1, [](const auto& c) { return c[1] < 30; });
  std::vector<double> x(s.sink.size());
  AggregationMultigrid<2> multigrid;
  multigrid.analyse(s.connectivity);
  s.rhs[7] = std::nan("");
  CHECK_THROWS_AS(multigrid.solve(s.values(), {}, x), NumericalError);
  DirectSolver<2> direct;
  direct.analyse(s.connectivity);
  CHECK_THROWS_AS(direct.solve(s.values(), {}, x), NumericalError);
  s.rhs[7] = 1;
  for (double& v : s.link) v = -v;
  CHECK_THROWS_AS(direct.solve(s.values(), {}, x), NumericalError);
  CHECK_THROWS_AS(multigrid.solve(s.values(), {}, x), NumericalError);
}

TEST_CASE("where multigrid does not converge the automatic choice answers with Cholesky") {
  System<2> s = irregular<2>({60, 40}, 1, 1, [](const auto&) { return true; });
  verify::Random random(12345);
  for (double& link : s.link) link *= std::pow(10.0, 14 * random() - 7);
  const Accuracy accuracy{.tolerance = 1e-13};
  std::vector<double> x(s.sink.size()), y(x);
  AggregationMultigrid<2> multigrid;
  multigrid.analyse(s.connectivity);
  CHECK_THROWS_AS(multigrid.solve(s.values(), accuracy, x), NumericalError);
  const auto direct = make_solver<2>(SolverKind::direct), automatic = make_solver<2>(SolverKind::automatic);
  for (auto* solver : {direct.get(), automatic.get()}) solver->analyse(s.connectivity);
  direct->solve(s.values(), accuracy, x);
  automatic->solve(s.values(), accuracy, y);
  CHECK(x == y);
}

TEST_CASE("every way to factorise gives the same solution, and keeps its factor while the values stand") {
  const System<2> s = irregular<2>({60, 40}, 1e3, 1, [](const auto& c) { return c[1] < 30 || c[0] < 20; });
  std::vector<double> first(s.sink.size()), x(first), y(first), other = s.rhs;
  for (double& b : other) b = -2 * b;
  using Ordering = CholeskyMethod::Ordering;
  for (Ordering ordering : {Ordering::minimum_degree, Ordering::nested_dissection})
    for (bool supernodal : {false, true}) {
      CAPTURE(supernodal);
      DirectSolver<2> fresh(CholeskyMethod{ordering, supernodal}), used(CholeskyMethod{ordering, supernodal});
      fresh.analyse(s.connectivity);
      used.analyse(s.connectivity);
      fresh.solve({s.sink, s.link, other}, {.tolerance = 1e-12}, x);
      used.solve(s.values(), {.tolerance = 1e-12}, y);
      double largest = 0, difference = 0;
      if (ordering == Ordering::minimum_degree && !supernodal) first = y;
      for (std::size_t i = 0; i < y.size(); ++i) {
        largest = std::max(largest, std::abs(first[i]));
        difference = std::max(difference, std::abs(first[i] - y[i]));
      }
      CHECK(difference < 1e-9 * largest);
      used.solve({s.sink, s.link, other}, {.tolerance = 1e-12}, y);  // with the factor it has
      CHECK(x == y);
      std::vector<double> sink = s.sink;
      sink[5] += 1;  // and not with it when one value changed
      fresh.solve({sink, s.link, s.rhs}, {.tolerance = 1e-12}, x);
      DirectSolver<2> newest(CholeskyMethod{ordering, supernodal});
      newest.analyse(s.connectivity);
      newest.solve({sink, s.link, s.rhs}, {.tolerance = 1e-12}, y);
      CHECK(x == y);
    }
}

TEST_CASE("the choice follows size, mask and contrast") {
  const auto name = [](const System<2>& s) {
    const auto solver = make_solver<2>(SolverKind::automatic);
    solver->analyse(s.connectivity);
    std::vector<double> x(s.sink.size());
    solver->solve(s.values(), {}, x);
    return std::string(solver->name());
  };
  const auto levee = [](const auto& c) { return in_levee(c[0] / 90.0, c[1] / 90.0); };
  CHECK(name(irregular<2>({20, 10}, 1e6, 1, levee)) == "sparse Cholesky");
  CHECK(name(irregular<2>({90, 40}, 1e3, 1, levee)) == "conjugate gradients with aggregation multigrid");
  System<2> torn = irregular<2>({90, 40}, 1, 1, levee);
  verify::Random random(7);
  for (double& link : torn.link) link *= std::pow(10.0, 6 * random());
  CHECK(name(torn) == "sparse Cholesky");
}

TEST_CASE("Cholesky solves a small system to round-off") {
  // Tridiagonal 2, -1: the inverse applied to ones is i (n + 1 - i) / 2.
  constexpr int n = 50;
  Cholesky cholesky;
  std::vector<Cholesky::Pair> pairs;
  for (int i = 0; i + 1 < n; ++i) pairs.push_back({(i * 7) % 2 ? i : i + 1, (i * 7) % 2 ? i + 1 : i});
  cholesky.analyse(n, pairs);
  const std::vector<double> diagonal(n, 2.0), off(n - 1, -1.0), rhs(n, 1.0);
  std::vector<double> x(n);
  cholesky.factorise(diagonal, off);
  cholesky.solve(rhs, x);
  for (int i = 1; i <= n; ++i) CHECK(x[i - 1] == doctest::Approx(0.5 * i * (n + 1 - i)).epsilon(1e-13));
}
