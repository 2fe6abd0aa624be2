#include "core/simd.hpp"

#include <doctest/doctest.h>

using namespace polder::simd_native;

TEST_CASE("exp of a pack agrees with the library to 1e-13") {
  for (double x = -60; x < 60; x += 0.137) {
    const Pack y = polder::simd_native::exp(broadcast(x));
    CHECK(y[0] == doctest::Approx(std::exp(x)).epsilon(1e-13));
  }
}

TEST_CASE("floor_to_int rounds down on both sides of zero") {
  const double xs[] = {-2.0, -1.5, -0.25, 0.0, 0.25, 1.0, 7.75};
  for (double x : xs) CHECK(floor_to_int(broadcast(x))[0] == static_cast<std::int64_t>(std::floor(x)));
}

TEST_CASE_TEMPLATE("fields to nodes and back is a transpose", T, std::integral_constant<int, 4>,
                   std::integral_constant<int, 8>) {
  constexpr int N = T::value;
  Pack fields[N], back[N];
  for (int f = 0; f < N; ++f)
    for (int l = 0; l < kLanes; ++l) fields[f][l] = 100 * f + l;
  Reg<N> nodes[kLanes];
  to_nodes<N>(fields, nodes);
  alignas(64) double raw[N];
  for (int l = 0; l < kLanes; ++l) {
    nodes[l].store(raw);
    for (int f = 0; f < N; ++f) CHECK(raw[f] == 100 * f + l);
  }
  to_packs<N>(nodes, back);
  for (int f = 0; f < N; ++f)
    for (int l = 0; l < kLanes; ++l) CHECK(back[f][l] == fields[f][l]);
}
