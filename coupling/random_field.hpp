// Spatially correlated random fields on a lattice, by circulant embedding (Dietrich & Newsam 1997, SIAM J.
// Sci. Comput. 18; Wood & Chan 1994, J. Comput. Graph. Stat. 3): the covariance matrix of the lattice is a
// part of a circulant one, whose eigenvalues are a Fourier transform of its first row, so that a sample with
// exactly this covariance costs one more transform.
//
// Standard normal fields of correlation
//   exponential   rho = exp(-r)      gaussian   rho = exp(-r^2),     r^2 = sum over axes of (dx / l)^2,
// l the correlation lengths [m]: where the correlation has fallen to 1/e. (Vanmarcke's scale of fluctuation
// is 2 l for the exponential and sqrt(pi) l for the Gaussian one.)
//
// Values are those of points, not means over a particle's domain; they belong to the lattice, so the field is
// the same for any number of threads and decided by the seed. Numbers come from a counter (splitmix64).
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "coupling/scene.hpp"

namespace polder::coupling {

struct Lattice {
  Vector3 lower{};                      // the first point [m]
  Vector3 spacing{1, 1, 1};             // [m]
  std::array<int, 3> count{1, 1, 1};    // points along each axis
  int nearest(const Vector3& x) const;  // number of the point nearest to x, x fastest
};

class RandomField {
 public:
  // Throws InputError if the lattice is too long beside the correlation lengths to be embedded in memory.
  RandomField(const Lattice& lattice, const Vector3& correlation_length,
              RandomProperty::Correlation correlation);

  // One sample: standard normal values at the points of the lattice.
  std::vector<double> sample(std::uint64_t seed) const;
  // The largest error of the covariance, relative to the variance; at most 1e-4 where memory
  // allows the embedding to be long enough, else at most 0.02.
  double covariance_error() const { return error_; }

 private:
  Lattice lattice_;
  std::array<int, 3> size_{1, 1, 1};  // of the embedding
  std::vector<double> amplitude_;     // root of the eigenvalues over the number of points
  double error_ = 0;
};

// Standard normal numbers by counter: the pair number `index` of the sequence `seed`.
std::array<double, 2> normal_pair(std::uint64_t seed, std::uint64_t index);

// The factor on a property's mean that belongs to a standard normal value z, bounded to four standard
// deviations: 1 + V z, or exp(s z - s^2 / 2) with s^2 = ln(1 + V^2), of mean 1 and coefficient of variation
// V.
double factor_of(const RandomProperty& property, double z);
struct FactorRange {
  double lowest = 1, highest = 1;
};
FactorRange factor_range(const RandomProperty& property);

// The field of a body as factors at its lattice.
struct FactorField {
  Lattice lattice;
  std::vector<double> factor;
  double at(const Vector3& x) const { return factor[lattice.nearest(x)]; }
};
FactorField make_factors(const RandomProperty& property, const Lattice& lattice, int dimension);

}  // namespace polder::coupling
