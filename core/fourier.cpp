#include "core/fourier.hpp"

#include <fftw3.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <numbers>
#include <stdexcept>

#include "core/aligned.hpp"

namespace polder {
namespace {

// FFTW's planner, unlike its plans, is not safe to use from two threads.
std::mutex& planner() {
  static std::mutex mutex;
  return mutex;
}

fftw_r2r_kind forward_kind(const CellTransform::Axis& axis) {
  if (axis.lower == axis.upper) return axis.lower == Parity::even ? FFTW_REDFT10 : FFTW_RODFT10;
  return axis.lower == Parity::even ? FFTW_REDFT11 : FFTW_RODFT11;
}

fftw_r2r_kind backward_kind(const CellTransform::Axis& axis) {
  if (axis.lower == axis.upper) return axis.lower == Parity::even ? FFTW_REDFT01 : FFTW_RODFT01;
  return forward_kind(axis);
}

}  // namespace

struct CellTransform::Impl {
  fftw_plan forward = nullptr, backward = nullptr;
  double scale = 1;
  ~Impl() {
    const std::lock_guard lock(planner());
    if (forward) fftw_destroy_plan(forward);
    if (backward) fftw_destroy_plan(backward);
  }
};

CellTransform::CellTransform(const std::vector<Axis>& axes) : impl_(std::make_unique<Impl>()) {
  std::vector<int> n;
  std::vector<fftw_r2r_kind> forward, backward;
  std::size_t size = 1;
  for (const Axis& axis : axes) {
    n.push_back(axis.n);
    forward.push_back(forward_kind(axis));
    backward.push_back(backward_kind(axis));
    size *= axis.n;
    impl_->scale *= 2.0 * axis.n;
  }
  Reals sample(size);
  const std::lock_guard lock(planner());
  const int rank = static_cast<int>(n.size());
  impl_->forward = fftw_plan_r2r(rank, n.data(), sample.data(), sample.data(), forward.data(), FFTW_ESTIMATE);
  impl_->backward =
      fftw_plan_r2r(rank, n.data(), sample.data(), sample.data(), backward.data(), FFTW_ESTIMATE);
  if (!impl_->forward || !impl_->backward)
    throw std::logic_error("CellTransform: FFTW has no transform for these axes");
}

CellTransform::~CellTransform() = default;
CellTransform::CellTransform(CellTransform&&) noexcept = default;
CellTransform& CellTransform::operator=(CellTransform&&) noexcept = default;

void CellTransform::forward(double* samples) const {
  fftw_execute_r2r(impl_->forward, samples, samples);
}
void CellTransform::backward(double* amplitudes) const {
  fftw_execute_r2r(impl_->backward, amplitudes, amplitudes);
}
double CellTransform::scale() const {
  return impl_->scale;
}

std::vector<double> CellTransform::eigenvalues(const Axis& axis) {
  const double first = axis.lower != axis.upper ? 0.5 : axis.lower == Parity::odd ? 1 : 0;
  std::vector<double> values(axis.n);
  for (int k = 0; k < axis.n; ++k) {  // 4 sin^2 keeps the digits of small wave numbers
    const double s = std::sin(0.5 * std::numbers::pi * (k + first) / axis.n);
    values[k] = 4 * s * s;
  }
  return values;
}

void fourier_transform(const std::vector<int>& size, std::span<std::complex<double>> values) {
  std::size_t count = 1;
  for (int n : size) count *= n;
  if (size.empty() || count != values.size())
    throw std::logic_error("fourier_transform: the size does not fit the values");
  auto* const data = reinterpret_cast<fftw_complex*>(values.data());
  fftw_plan plan = nullptr;
  {
    const std::lock_guard lock(planner());
    plan = fftw_plan_dft(static_cast<int>(size.size()), size.data(), data, data, FFTW_FORWARD,
                         FFTW_ESTIMATE | FFTW_UNALIGNED);
  }
  if (!plan) throw std::logic_error("fourier_transform: FFTW has no transform for this size");
  fftw_execute(plan);
  const std::lock_guard lock(planner());
  fftw_destroy_plan(plan);
}

int fast_size(int n) {
  for (int size = std::max(n, 1);; ++size) {
    int rest = size;
    for (int factor : {2, 3, 5, 7})
      while (rest % factor == 0) rest /= factor;
    if (rest == 1) return size;
  }
}

}  // namespace polder
