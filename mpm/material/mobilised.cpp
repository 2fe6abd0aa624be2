// Values of parameters that are mobilised by plastic deviatoric strain, for one particle at a time.
#include <algorithm>
#include <cmath>

#include "mpm/material/curve.hpp"
#include "mpm/material/material.hpp"

namespace polder::mpm {

double value_at(const Mobilised& m, double kappa) {
  if (m.kind == Mobilised::Kind::exponential)
    return m.residual + (m.peak - m.residual) * std::exp(-m.rate * kappa);
  if (m.kind == Mobilised::Kind::constant || kappa <= m.strain.front()) return m.value.front();
  if (kappa >= m.strain.back()) return m.value.back();
  const auto upper = std::upper_bound(m.strain.begin(), m.strain.end(), kappa);
  const auto i = static_cast<std::size_t>(upper - m.strain.begin());
  const double share = (kappa - m.strain[i - 1]) / (m.strain[i] - m.strain[i - 1]);
  return m.value[i - 1] + share * (m.value[i] - m.value[i - 1]);
}

Range range_of(const Mobilised& m) {
  if (m.kind == Mobilised::Kind::exponential) {
    if (m.rate == 0) return {m.peak, m.peak};
    return {std::min(m.peak, m.residual), std::max(m.peak, m.residual)};
  }
  if (m.kind == Mobilised::Kind::constant) return {m.value.front(), m.value.front()};
  const auto [low, high] = std::minmax_element(m.value.begin(), m.value.end());
  return {*low, *high};
}

Curve compile_curve(const Mobilised& m) {
  const Range range = range_of(m);
  Curve c;
  c.lowest = range.lowest;
  c.highest = range.highest;
  c.start = value_at(m, 0.0);
  if (range.lowest == range.highest) return c;
  if (m.kind == Mobilised::Kind::exponential) {
    c.kind = Curve::Kind::exponential;
    c.residual = m.residual;
    c.rate = m.rate;
    return c;
  }
  c.kind = Curve::Kind::piecewise_linear;
  c.knots = static_cast<int>(m.strain.size());
  for (int i = 0; i < c.knots; ++i) {
    c.strain[i] = m.strain[i];
    c.value[i] = m.value[i];
    if (i + 1 < c.knots) c.slope[i] = (m.value[i + 1] - m.value[i]) / (m.strain[i + 1] - m.strain[i]);
  }
  return c;
}

}  // namespace polder::mpm
