#include "fdm/flexible_gmres.hpp"

#include <algorithm>
#include <cmath>

#include "fdm/linear_system.hpp"
#include "fdm/loops.hpp"

namespace polder::fdm {

FlexibleGmres::Report FlexibleGmres::solve(const Map& matrix, const Map& preconditioner,
                                           std::span<const double> b, double reduction, int most,
                                           std::span<double> x) {
  const int n = static_cast<int>(b.size());
  std::fill(x.begin(), x.end(), 0.0);
  const double norm = std::sqrt(dot(b, b));
  Report report;
  if (!(norm > 0) || !std::isfinite(norm)) return report;
  const auto vector = [n](std::vector<Reals>& set, std::size_t i) -> Reals& {
    if (set.size() <= i) set.emplace_back();
    set[i].resize(n);
    return set[i];
  };
  Reals& first = vector(basis_, 0);
  for_each(n, [&](int i) { first[i] = b[i] / norm; });
  hessenberg_.assign(most, {});
  std::vector<double> rhs{norm}, cosine, sine;
  int k = 0;
  while (k < most && std::abs(rhs[k]) > reduction * norm) {
    Reals& z = vector(direction_, k);
    preconditioner(basis_[k], z);
    Reals& w = vector(basis_, k + 1);
    matrix(z, w);
    std::vector<double>& h = hessenberg_[k];
    h.assign(k + 2, 0);
    for (int j = 0; j <= k; ++j) {
      const Reals& v = basis_[j];
      h[j] = dot(w, v);
      for_each(n, [&](int i) { w[i] -= h[j] * v[i]; });
    }
    h[k + 1] = std::sqrt(dot(w, w));
    const double length = h[k + 1];
    if (length > 0) for_each(n, [&](int i) { w[i] /= length; });
    for (int j = 0; j < k; ++j) {
      const double upper = cosine[j] * h[j] + sine[j] * h[j + 1];
      h[j + 1] = cosine[j] * h[j + 1] - sine[j] * h[j];
      h[j] = upper;
    }
    const double radius = std::hypot(h[k], h[k + 1]);
    if (!(radius > 0) || !std::isfinite(radius)) break;  // singular, or not a number
    cosine.push_back(h[k] / radius), sine.push_back(h[k + 1] / radius);
    h[k] = radius;
    rhs.push_back(-sine[k] * rhs[k]);
    rhs[k] *= cosine[k];
    ++k;
    if (length == 0) break;
  }
  for (int i = k - 1; i >= 0; --i) {
    for (int j = i + 1; j < k; ++j) rhs[i] -= hessenberg_[j][i] * rhs[j];
    rhs[i] /= hessenberg_[i][i];
  }
  for (int j = 0; j < k; ++j) {
    const Reals& z = direction_[j];
    for_each(n, [&](int i) { x[i] += rhs[j] * z[i]; });
  }
  report.iterations = k;
  report.reduction = std::abs(rhs[k]) / norm;
  return report;
}

}  // namespace polder::fdm
