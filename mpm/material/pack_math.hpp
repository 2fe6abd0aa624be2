// Elementary functions of packs that the constitutive laws need beyond core/simd.hpp.
#pragma once

#include <limits>

#include "core/simd.hpp"

namespace polder::POLDER_SIMD_NAMESPACE {

// sin x for |x| <= pi/2: Taylor polynomial of degree 21, error below 1e-16.
POLDER_INLINE Pack sine(Pack x) {
  const double c[] = {1. / 51090942171709440000.,
                      -1. / 121645100408832000.,
                      1. / 355687428096000.,
                      -1. / 1307674368000.,
                      1. / 6227020800.,
                      -1. / 39916800.,
                      1. / 362880.,
                      -1. / 5040.,
                      1. / 120.,
                      -1. / 6.};
  const Pack y = x * x;
  Pack p = broadcast(c[0]);
  for (int i = 1; i < 10; ++i) p = p * y + c[i];
  return x + x * y * p;
}

// Natural logarithm of normal positive numbers, relative error below 4e-16 away from 1 and absolute error of
// that size around it; NaN for x <= 0, so that an inverted particle shows. x = 2^e m with m in [sqrt(1/2),
// sqrt(2)); ln m = 2 artanh((m - 1)/(m + 1)), series to the power 21.
POLDER_INLINE Pack log(Pack x) {
  const Mask bits = (Mask)x;
  Mask e = ((bits >> 52) & 0x7ff) - 1023;
  Pack m = (Pack)((bits & 0x000fffffffffffff) | 0x3ff0000000000000);
  const Mask upper = m > 1.4142135623730951;
  m = select(upper, 0.5 * m, m);
  e -= upper;  // true is -1
  const Pack z = (m - 1) / (m + 1), y = z * z;
  Pack p = broadcast(1. / 21);
  for (int n = 19; n >= 3; n -= 2) p = p * y + 1. / n;
  const Pack r = to_real(e) * 0.69314718055994530942 + (2 * z + 2 * z * y * p);
  return select(x > 0, r, broadcast(std::numeric_limits<double>::quiet_NaN()));
}

// (1 - exp(-y)) / y for y >= 0: the mean of exp(-t) over [0, y].
POLDER_INLINE Pack mean_decay(Pack y) {
  const Pack series =
      1 - y * (1. / 2) * (1 - y * (1. / 3) * (1 - y * (1. / 4) * (1 - y * (1. / 5) * (1 - y * (1. / 6)))));
  const Mask small = y < 5e-3;
  return select(small, series, (1 - exp(-y)) / select(small, broadcast(1.0), y));
}

}  // namespace polder::POLDER_SIMD_NAMESPACE
