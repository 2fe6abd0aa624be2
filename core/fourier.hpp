// Fast Fourier transforms (FFTW, Frigo & Johnson 2005, Proc. IEEE 93), behind a header without FFTW.
//
// Plans are estimated, never measured: a measured plan depends on how busy the machine was, and with it the
// rounding of every later transform. Transforms are done in place, unnormalised, and may be called from
// several threads at a time on different arrays that are aligned as Reals are.
#pragma once

#include <complex>
#include <memory>
#include <span>
#include <vector>

namespace polder {

// What the function does half a sample beyond the lower and the upper end of an axis: `even` is mirrored
// (a wall), `odd` is mirrored with the other sign (zero at the end).
enum class Parity { even, odd };

// Real transforms of samples at the centres of n cells along each axis, the last axis contiguous. Forward
// takes samples to the amplitudes of the eigenvectors of the second difference with these ends,
//   even, even: cos(pi k (i + 1/2) / n)             k = 0 .. n-1      (DCT-II)
//   odd, odd:   sin(pi (k + 1) (i + 1/2) / n)                        (DST-II)
//   even, odd:  cos(pi (k + 1/2) (i + 1/2) / n)                      (DCT-IV)
//   odd, even:  sin(pi (k + 1/2) (i + 1/2) / n)                      (DST-IV)
// and backward returns the samples times scale().
class CellTransform {
 public:
  struct Axis {
    int n = 1;
    Parity lower = Parity::even, upper = Parity::even;
    bool operator==(const Axis&) const = default;
  };
  explicit CellTransform(const std::vector<Axis>& axes);
  ~CellTransform();
  CellTransform(CellTransform&&) noexcept;
  CellTransform& operator=(CellTransform&&) noexcept;

  void forward(double* samples) const;
  void backward(double* amplitudes) const;
  double scale() const;  // 2 n for each axis
  // 2 - 2 cos(wave number) of each amplitude along an axis: eigenvalues of the negative second difference.
  static std::vector<double> eigenvalues(const Axis& axis);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// Complex transform in 1 to 3 dimensions, the last axis contiguous:
//   X_k = sum over i of x_i exp(-2 pi i k.i / n).
void fourier_transform(const std::vector<int>& size, std::span<std::complex<double>> values);

// The smallest number not below n with no prime factor above 7, for which the transforms are fast.
int fast_size(int n);

}  // namespace polder
