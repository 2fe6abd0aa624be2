#include "mpm/material/element_path.hpp"

#include <algorithm>
#include <cmath>

#include "core/cholesky.hpp"
#include "core/error.hpp"

namespace polder::mpm {
namespace {

constexpr int kAxis = 1, kShear = 3;  // yy and xy

// What one test prescribes for a step of the controlled strain.
std::array<ElementPoint::Control, 6> controls(ElementTest test, const Components& initial, double step) {
  std::array<ElementPoint::Control, 6> c{};  // no strain, unless told otherwise
  const auto hold = [&](int i) { c[i] = {true, initial[i]}; };
  switch (test) {
    case ElementTest::triaxial_drained:
      c[kAxis].value = step;
      hold(0);
      c[2].same_as = 0;  // on the edge sigma_xx = sigma_zz the stresses do not tell the lateral strains apart
      break;
    case ElementTest::triaxial_undrained:
      c[kAxis].value = step;
      c[0].value = c[2].value = -0.5 * step;
      break;
    case ElementTest::biaxial_drained:
      c[kAxis].value = step;
      hold(0);
      break;
    case ElementTest::biaxial_undrained:
      c[kAxis].value = step;
      c[0].value = -step;
      break;
    case ElementTest::oedometer:
      c[kAxis].value = step;
      break;
    case ElementTest::isotropic:
      c[0].value = c[1].value = c[2].value = step;
      break;
    case ElementTest::simple_shear_drained:
      c[kShear].value = 0.5 * step;
      hold(kAxis);
      break;
    case ElementTest::simple_shear_undrained:
      c[kShear].value = 0.5 * step;
      break;
    case ElementTest::pure_shear:
      c[kShear].value = 0.5 * step;
      hold(0), hold(1), hold(2);
      break;
  }
  return c;
}

using Matrix = std::array<std::array<double, 6>, 6>;

// The step x that minimises |J x + r|, the shortest one where several do. On an edge of the yield surface two
// principal stresses are tied together and J loses rank; the shortest step then keeps the symmetry of the
// path. Normal equations with a small multiple of the identity (Levenberg 1944), Cholesky; the iteration
// around it removes their rounding.
std::array<double, 6> shortest_step(int n, const Matrix& j, const std::array<double, 6>& r) {
  Matrix a{};
  std::array<double, 6> x{};
  double trace = 0;
  for (int p = 0; p < n; ++p)
    for (int k = 0; k < n; ++k) {
      x[p] -= j[k][p] * r[k];
      for (int q = 0; q < n; ++q) a[p][q] += j[k][p] * j[k][q];
    }
  for (int p = 0; p < n; ++p) trace += a[p][p];
  for (int p = 0; p < n; ++p) a[p][p] += 1e-13 * trace + 1e-300;
  return solve_positive_definite(a, x, static_cast<std::size_t>(n));
}

double excess_pore_pressure(ElementTest test, const Components& initial, const Components& now) {
  switch (test) {
    case ElementTest::triaxial_undrained:
    case ElementTest::biaxial_undrained:
      return now[0] - initial[0];
    case ElementTest::simple_shear_undrained:
      return now[kAxis] - initial[kAxis];
    default:
      return 0;
  }
}

}  // namespace

ElementPoint::ElementPoint(const MaterialParameters& material, bool plastic, double height)
    : state(state_layout(material, 3).count()),
      law_(make_array_law(material, 3, plastic)),
      young_(material.young) {
  set_initial_state(material, 3, height, state);
}

void ElementPoint::apply_strain(const Components& increment) {
  law_->update(1, stress.data(), increment.data(), nullptr, state.data());
  for (int i = 0; i < 6; ++i) strain[i] += increment[i];
}

void ElementPoint::apply(const std::array<Control, 6>& control) {
  Components increment{};
  std::vector<int> unknown;
  double scale = 0;
  for (int i = 0; i < 6; ++i) {
    if (control[i].stress)
      unknown.push_back(i);
    else if (control[i].same_as < 0)
      increment[i] = control[i].value;
    scale = std::max({scale, std::abs(stress[i]), young_ * std::abs(increment[i])});
  }
  const int n = static_cast<int>(unknown.size());

  // The point and its n neighbours (one strain component moved) go through the law together.
  const int count = n + 1, n_state = static_cast<int>(state.size());
  std::vector<double> s(6 * count), e(6 * count), x(std::max(1, n_state * count));
  std::array<double, 6> residual{};
  Matrix jacobian{};
  const double probe = 1e-7 * std::max(scale / young_, 1e-9);
  const auto evaluate = [&](const Components& de) {
    for (int k = 0; k < count; ++k) {
      for (int i = 0; i < 6; ++i) s[i * count + k] = stress[i], e[i * count + k] = de[i];
      for (int i = 0; i < n_state; ++i) x[i * count + k] = state[i];
      if (k > 0) e[unknown[k - 1] * count + k] += probe;
      for (int i = 0; i < 6; ++i)
        if (control[i].same_as >= 0) e[i * count + k] = e[control[i].same_as * count + k];
    }
    law_->update(count, s.data(), e.data(), nullptr, x.data());
    double worst = 0;
    for (int r = 0; r < n; ++r) {
      const double* row = &s[unknown[r] * count];
      residual[r] = row[0] - control[unknown[r]].value;
      worst = std::max(worst, std::abs(residual[r]));
      for (int k = 0; k < n; ++k) jacobian[r][k] = (row[k + 1] - row[0]) / probe;
    }
    return worst;
  };

  const double tolerance = 1e-12 * std::max(scale, 1e-30);
  double error = evaluate(increment);
  for (int iteration = 0; iteration < 200 && error > tolerance; ++iteration) {
    const std::array<double, 6> step = shortest_step(n, jacobian, residual);
    Components trial = increment, best = increment;
    double smallest = error, share = 1;
    for (int halving = 0; halving < 25; ++halving, share *= 0.5) {
      trial = increment;
      for (int k = 0; k < n; ++k) trial[unknown[k]] += share * step[k];
      const double now = evaluate(trial);
      if (now < smallest) {
        smallest = now, best = trial;
        break;
      }
    }
    if (!(smallest < error)) break;
    increment = best;
    error = smallest;
  }
  // the last digits of a stiff point may not be reachable
  if (!(error <= 100 * tolerance))
    throw NumericalError(
        "element test: no strain increment gives the prescribed stress (failure under stress control, or "
        "a step too large); out of balance by " +
        std::to_string(error) + " Pa");
  for (int i = 0; i < 6; ++i)
    if (control[i].same_as >= 0) increment[i] = increment[control[i].same_as];
  apply_strain(increment);
}

std::vector<ElementRow> run_element(const MaterialParameters& material, const ElementPath& path) {
  ElementPoint point(material, path.plastic, path.height);
  point.stress = path.initial_stress;
  std::vector<ElementRow> rows{{0.0, point.strain, point.stress, point.state, 0.0}};
  double control = 0;
  for (double target : path.targets) {
    const double step = (target - control) / path.steps;
    for (int i = 0; i < path.steps; ++i) point.apply(controls(path.test, path.initial_stress, step));
    control = target;
    rows.push_back({control, point.strain, point.stress, point.state,
                    excess_pore_pressure(path.test, path.initial_stress, point.stress)});
  }
  return rows;
}

}  // namespace polder::mpm
