#include "app/curve_family.hpp"

#include <algorithm>
#include <cmath>

namespace polder::app {
namespace {

constexpr double kLeastOrder = 0.5, kMostOrder = 2;

struct Largest {
  double value = -1, at = 0;
  std::size_t curve = 0;
};

// Mean square of the difference, which is linear between the points of both curves; NaN: nothing in common.
double mean_square(const Curve& a, const Curve& b, double offset, std::size_t number, Largest& largest) {
  double length = 0, square = 0, before = 0, at_point = std::numeric_limits<double>::quiet_NaN();
  if (a.x.empty() || b.x.empty()) return at_point;
  const double start = std::max(a.x.front(), b.x.front()), end = std::min(a.x.back(), b.x.back());
  std::vector<double> points;
  for (const Curve* c : {&a, &b})
    for (const double x : c->x)
      if (x >= start && x <= end) points.push_back(x);
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double d = interpolate(a.x, a.value, points[i]) - interpolate(b.x, b.value, points[i]);
    if (std::abs(d) > largest.value) largest = {std::abs(d), offset + points[i], number};
    if (!std::isnan(d)) at_point = d * d;
    if (i > 0 && !std::isnan(before) && !std::isnan(d)) {
      const double dx = points[i] - points[i - 1];
      length += dx;
      square += dx / 3 * (before * before + before * d + d * d);
    }
    before = d;
  }
  return length > 0 ? square / length : at_point;
}

}  // namespace

CurveDifference difference(const Trace& a, const Trace& b) {
  Largest largest;
  double offset = 0, sum = 0;
  int curves = 0;
  for (std::size_t s = 0; s < std::min(a.size(), b.size()); ++s) {
    const double square = mean_square(a[s], b[s], offset, s, largest);
    if (!std::isnan(square)) sum += square, ++curves;
    if (!a[s].x.empty()) offset += a[s].x.back();
  }
  CurveDifference d;
  if (curves == 0) return d;
  d.l2 = std::sqrt(sum / curves);
  d.max = largest.value, d.max_at = largest.at, d.max_curve = largest.curve;
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
