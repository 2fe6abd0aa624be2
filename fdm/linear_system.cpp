#include "fdm/linear_system.hpp"

#include <algorithm>
#include <cstdio>

namespace polder::fdm {
namespace {

constexpr std::size_t kChunk = 4096;

double dot_chunk(const double* a, const double* b, std::size_t n) {
  double lane[8] = {};
  const std::size_t whole = n / 8 * 8;
  for (std::size_t i = 0; i < whole; i += 8)
    for (std::size_t k = 0; k < 8; ++k) lane[k] += a[i + k] * b[i + k];
  for (std::size_t i = whole; i < n; ++i) lane[i - whole] += a[i] * b[i];
  return ((lane[0] + lane[4]) + (lane[2] + lane[6])) + ((lane[1] + lane[5]) + (lane[3] + lane[7]));
}

}  // namespace

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2e", value);
  return text;
}

double dot(std::span<const double> a, std::span<const double> b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); i += kChunk)
    sum += dot_chunk(a.data() + i, b.data() + i, std::min(kChunk, a.size() - i));
  return sum;
}

}  // namespace polder::fdm
