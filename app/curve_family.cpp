#include "app/curve_family.hpp"

#include <algorithm>
#include <cmath>

namespace polder::app {
namespace {

constexpr double kLeastOrder = 0.5, kMostOrder = 2;

struct Sums {
  double time = 0, square = 0, largest = -1, largest_at = 0;
  std::size_t largest_in = 0;
};

// Integrates the square of the difference, which is linear between the points of both curves.
void add(const Curve& a, const Curve& b, double offset, std::size_t number, Sums& sums) {
  if (a.x.empty() || b.x.empty()) return;
  const double start = std::max(a.x.front(), b.x.front()), end = std::min(a.x.back(), b.x.back());
  std::vector<double> times;
  for (const Curve* c : {&a, &b})
    for (const double t : c->x)
      if (t >= start && t <= end) times.push_back(t);
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end()), times.end());
  double before = 0;
  for (std::size_t i = 0; i < times.size(); ++i) {
    const double d = interpolate(a.x, a.value, times[i]) - interpolate(b.x, b.value, times[i]);
    if (std::abs(d) > sums.largest)
      sums.largest = std::abs(d), sums.largest_at = offset + times[i], sums.largest_in = number;
    if (i > 0 && !std::isnan(before) && !std::isnan(d)) {
      const double dt = times[i] - times[i - 1];
      sums.time += dt;
      sums.square += dt / 3 * (before * before + before * d + d * d);
    }
    before = d;
  }
}

}  // namespace

CurveDifference difference(const Trace& a, const Trace& b) {
  Sums sums;
  double offset = 0;
  for (std::size_t s = 0; s < std::min(a.size(), b.size()); ++s) {
    add(a[s], b[s], offset, s, sums);
    if (!a[s].x.empty()) offset += a[s].x.back();
  }
  CurveDifference d;
  if (sums.largest < 0) return d;
  d.max = sums.largest, d.max_at = sums.largest_at, d.max_curve = sums.largest_in;
  d.l2 = sums.time > 0 ? std::sqrt(sums.square / sums.time) : sums.largest;
  return d;
}

void extend(Extremes& e, const Trace& trace) {
  for (const Curve& c : trace)
    for (const double v : c.value)
      if (!std::isnan(v)) e.low = std::min(e.low, v), e.high = std::max(e.high, v);
}

double observed_order(double coarse, double fine, double h3, double h2, double h1) {
  if (!(coarse > 0) || !(fine > 0)) return std::numeric_limits<double>::quiet_NaN();
  // Rises with p; at p = 0 it is a ratio of logarithms.
  const auto ratio = [&](double p) {
    return std::abs(p) < 1e-6 ? std::log(h3 / h2) / std::log(h2 / h1)
                              : (std::pow(h3 / h1, p) - std::pow(h2 / h1, p)) / (std::pow(h2 / h1, p) - 1);
  };
  double low = -kMostOrderSought, high = kMostOrderSought;
  for (int i = 0; i < 60; ++i) {
    const double p = 0.5 * (low + high);
    (ratio(p) < coarse / fine ? low : high) = p;
  }
  return high;
}

FamilyError family_error(std::span<const double> h, std::span<const Trace> traces) {
  FamilyError e;
  e.members = static_cast<int>(traces.size());
  if (e.members < 2) return e;
  const std::size_t n = traces.size();
  const CurveDifference fine = difference(traces[n - 2], traces[n - 1]);
  double p = 1;
  if (n > 2) {
    const CurveDifference coarse = difference(traces[n - 3], traces[n - 2]);
    e.order = observed_order(coarse.l2, fine.l2, h[n - 3], h[n - 2], h[n - 1]);
    e.converges = !(e.order <= 0);
    if (!e.converges) {
      e.l2 = std::max(coarse.l2, fine.l2), e.max = std::max(coarse.max, fine.max);
      return e;
    }
    if (!std::isnan(e.order)) p = std::clamp(e.order, kLeastOrder, kMostOrder);
  }
  const double share = 1 / (std::pow(h[n - 2] / h[n - 1], p) - 1);
  e.l2 = share * fine.l2, e.max = share * fine.max;
  return e;
}

}  // namespace polder::app
