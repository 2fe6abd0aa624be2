#include "fdm/defect.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "core/error.hpp"

namespace polder::fdm {

double Defect::start(const SystemValues& system) {
  std::copy(system.sink.begin(), system.sink.end(), diagonal_.begin());
  for (std::size_t k = 0; k < links_.size(); ++k) {
    diagonal_[links_[k].first] += system.link[k];
    diagonal_[links_[k].second] += system.link[k];
  }
  double b2 = 0;
  for (std::size_t i = 0; i < diagonal_.size(); ++i) b2 += system.rhs[i] * system.rhs[i] / diagonal_[i];
  return std::sqrt(b2);
}

bool Defect::reached(const SystemValues& system, const Accuracy& accuracy, double rhs_norm,
                     std::span<const double> x) {
  const double eps = std::numeric_limits<double>::epsilon();
  for (std::size_t i = 0; i < x.size(); ++i) residual_[i] = system.rhs[i] - system.sink[i] * x[i];
  for (std::size_t k = 0; k < links_.size(); ++k) {
    const double flow = system.link[k] * (x[links_[k].first] - x[links_[k].second]);
    residual_[links_[k].first] -= flow;
    residual_[links_[k].second] += flow;
  }
  double r2 = 0, x2 = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    r2 += residual_[i] * residual_[i] / diagonal_[i];
    x2 += x[i] * x[i] * diagonal_[i];
  }
  norm_ = std::sqrt(r2);
  return norm_ <= accuracy.tolerance * rhs_norm + accuracy.floor + 16 * eps * std::sqrt(x2);
}

void Defect::fail(double rhs_norm, const char* method) const {
  throw NumericalError(std::string("pressure equation: ") + method + " leaves a residual of " +
                       number(norm_ / rhs_norm) + " of the right-hand side after refinement (" +
                       std::to_string(diagonal_.size()) + " cells)");
}

}  // namespace polder::fdm
