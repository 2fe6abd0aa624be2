#include "coupling/random_field.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "core/error.hpp"
#include "core/fourier.hpp"

namespace polder::coupling {
namespace {

constexpr double kBound = 4;          // standard deviations
constexpr double kNegligible = 1e-4;  // error of the covariance beside the variance: below any sampling error
constexpr double kLargestError = 0.02;        // of the covariance, beside the variance
constexpr std::size_t kMostPoints = 1 << 25;  // of an embedding, half a gigabyte

std::uint64_t scramble(std::uint64_t z) {  // splitmix64
  z += 0x9E3779B97F4A7C15ull;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBull;
  return z ^ (z >> 31);
}

double correlation_at(double r2, RandomProperty::Correlation kind) {
  return kind == RandomProperty::Correlation::gaussian ? std::exp(-r2) : std::exp(-std::sqrt(r2));
}

std::size_t points(const std::array<int, 3>& n) {
  return static_cast<std::size_t>(n[0]) * n[1] * n[2];
}

}  // namespace

int Lattice::nearest(const Vector3& x) const {
  int n = 0;
  for (int d = 2; d >= 0; --d) {
    const int i = static_cast<int>(std::lround((x[d] - lower[d]) / spacing[d]));
    n = n * count[d] + std::clamp(i, 0, count[d] - 1);
  }
  return n;
}

std::array<double, 2> normal_pair(std::uint64_t seed, std::uint64_t index) {
  const std::uint64_t key = scramble(seed);
  const double u = (static_cast<double>(scramble(key ^ scramble(2 * index)) >> 11) + 0.5) * 0x1p-53;
  const double v = static_cast<double>(scramble(key ^ scramble(2 * index + 1)) >> 11) * 0x1p-53;
  const double radius = std::sqrt(-2 * std::log(u)), angle = 2 * std::numbers::pi * v;  // Box-Muller
  return {radius * std::cos(angle), radius * std::sin(angle)};
}

// The embedding starts with twice the lattice and grows while the circulant matrix has negative eigenvalues;
// what remains of them at the largest size is set to zero and the variance restored.
RandomField::RandomField(const Lattice& lattice, const Vector3& correlation_length,
                         RandomProperty::Correlation correlation)
    : lattice_(lattice) {
  for (int d = 0; d < 3; ++d) size_[d] = lattice.count[d] > 1 ? fast_size(2 * lattice.count[d]) : 1;
  if (points(size_) > kMostPoints)
    throw InputError("random field: " + std::to_string(points(lattice.count)) +
                     " points are too many; a coarser grid");
  std::vector<std::complex<double>> row;
  for (;;) {
    row.resize(points(size_));
    std::size_t n = 0;
    for (int k = 0; k < size_[2]; ++k)
      for (int j = 0; j < size_[1]; ++j)
        for (int i = 0; i < size_[0]; ++i, ++n) {
          const std::array<int, 3> at{i, j, k};
          double r2 = 0;
          for (int d = 0; d < 3; ++d) {
            const double r = std::min(at[d], size_[d] - at[d]) * lattice.spacing[d] / correlation_length[d];
            if (size_[d] > 1) r2 += r * r;
          }
          row[n] = correlation_at(r2, correlation);
        }
    fourier_transform({size_[2], size_[1], size_[0]}, row);
    double positive = 0, negative = 0;
    for (const auto& eigenvalue : row)
      (eigenvalue.real() > 0 ? positive : negative) += std::abs(eigenvalue.real());
    std::array<int, 3> larger = size_;
    for (int d = 0; d < 3; ++d)
      if (size_[d] > 1) larger[d] = fast_size(size_[d] + size_[d] / 2);
    // Each eigenvalue set to zero changes every covariance by at most its share of their sum, and so does
    // restoring the variance.
    error_ = 2 * negative / positive;
    if (error_ > kNegligible && points(larger) <= kMostPoints) {
      size_ = larger;
      continue;
    }
    if (error_ > kLargestError)
      throw InputError(
          "random field: the correlation lengths are too large beside the body for an embedding "
          "of its covariance; error " +
          std::to_string(error_) + " of the variance");
    amplitude_.resize(row.size());
    const double total = positive;  // = number of points times the variance, but for what was cut
    for (std::size_t i = 0; i < row.size(); ++i)
      amplitude_[i] = std::sqrt(std::max(0.0, row[i].real()) / total);
    return;
  }
}

std::vector<double> RandomField::sample(std::uint64_t seed) const {
  std::vector<std::complex<double>> wave(amplitude_.size());
  for (std::size_t i = 0; i < wave.size(); ++i) {
    const auto [a, b] = normal_pair(seed, i);
    wave[i] = amplitude_[i] * std::complex<double>(a, b);
  }
  fourier_transform({size_[2], size_[1], size_[0]}, wave);
  std::vector<double> value;
  value.reserve(points(lattice_.count));
  for (int k = 0; k < lattice_.count[2]; ++k)
    for (int j = 0; j < lattice_.count[1]; ++j)
      for (int i = 0; i < lattice_.count[0]; ++i)
        value.push_back(wave[(static_cast<std::size_t>(k) * size_[1] + j) * size_[0] + i].real());
  return value;
}

double factor_of(const RandomProperty& property, double z) {
  z = std::clamp(z, -kBound, kBound);
  const double v = property.coefficient_of_variation;
  if (property.distribution == RandomProperty::Distribution::normal) return 1 + v * z;
  const double s2 = std::log1p(v * v);
  return std::exp(std::sqrt(s2) * z - 0.5 * s2);
}

FactorRange factor_range(const RandomProperty& property) {
  return {factor_of(property, -kBound), factor_of(property, kBound)};
}

FactorField make_factors(const RandomProperty& property, const Lattice& lattice, int dimension) {
  Vector3 length = property.correlation_length;
  if (dimension == 2) length[2] = 1;  // one layer of points
  FactorField field{
      lattice,
      RandomField(lattice, length, property.correlation).sample(static_cast<std::uint64_t>(property.seed))};
  for (double& v : field.factor) v = factor_of(property, v);
  return field;
}

}  // namespace polder::coupling
