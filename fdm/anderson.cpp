#include "fdm/anderson.hpp"

#include <algorithm>
#include <cmath>

#include "fdm/linear_system.hpp"
#include "fdm/loops.hpp"

namespace polder::fdm {
namespace {

// Differences that the normal equations cannot tell apart from the others leave the combination.
constexpr double kIndependent = 1e-10;

}  // namespace

void Anderson::resize(std::size_t n) {
  for (auto* set : {&change_step_, &image_step_})
    for (Reals& a : *set) a.assign(n, 0);
  for (Reals* a : {&change_, &image_, &scaled_}) a->assign(n, 0);
  restart();
}

void Anderson::next(std::span<double> x, std::span<const double> g, std::span<const double> weight) {
  const int n = static_cast<int>(x.size());
  if (previous_) newest_ = (newest_ + 1) % kDepth, count_ = std::min(count_ + 1, kDepth);
  for_each(n, [&](int i) {
    const double change = std::sqrt(weight[i]) * (g[i] - x[i]);
    if (previous_) {
      change_step_[newest_][i] = change - change_[i];
      image_step_[newest_][i] = g[i] - image_[i];
    }
    change_[i] = change;
    image_[i] = g[i];
    x[i] = g[i];
  });
  previous_ = true;

  // Least squares by Cholesky factorisation of the Gram matrix, newest difference first.
  std::array<std::array<double, kDepth>, kDepth> lower{};
  std::array<double, kDepth> solution{};
  std::array<bool, kDepth> kept{};
  const auto step = [&](int i) { return (newest_ - i + kDepth) % kDepth; };
  for (int i = 0; i < count_; ++i) {
    const double square = dot(change_step_[step(i)], change_step_[step(i)]);
    double pivot = square;
    for (int j = 0; j < i; ++j) {
      if (!kept[j]) continue;
      double sum = dot(change_step_[step(i)], change_step_[step(j)]);
      for (int k = 0; k < j; ++k) sum -= lower[i][k] * lower[j][k];
      lower[i][j] = sum / lower[j][j];
      pivot -= lower[i][j] * lower[i][j];
    }
    kept[i] = pivot > kIndependent * square;
    if (!kept[i]) {
      lower[i].fill(0);
      continue;
    }
    lower[i][i] = std::sqrt(pivot);
    double sum = dot(change_step_[step(i)], change_);
    for (int k = 0; k < i; ++k) sum -= lower[i][k] * solution[k];
    solution[i] = sum / lower[i][i];
  }
  for (int i = count_ - 1; i >= 0; --i) {
    if (!kept[i]) continue;
    for (int k = i + 1; k < count_; ++k)
      if (kept[k]) solution[i] -= lower[k][i] * solution[k];
    solution[i] /= lower[i][i];
  }
  for (int i = 0; i < count_; ++i) {
    if (!kept[i]) continue;
    const Reals& image_step = image_step_[step(i)];
    const double factor = solution[i];
    for_each(n, [&](int k) { x[k] -= factor * image_step[k]; });
  }
}

}  // namespace polder::fdm
