// von Mises and Tresca: linear softening against the closed form, snap-back, strength of the single particle;
// and the limit of Mohr-Coulomb for a vanishing friction angle.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "mpm/material/element_path.hpp"
#include "tests/unit/reference_csv.hpp"

using namespace polder::mpm;

namespace {

constexpr double kKilo = 1e3;

MaterialParameters vertical_cut(MaterialModel model) {  // the soil of pure_shear_linear_softening.csv
  MaterialParameters m;
  m.model = model;
  m.young = 1e6;
  m.poisson = 0.35;
  m.shear_strength = 10e3;
  m.residual_strength = 3e3;
  m.softening_modulus = -30e3;
  return m;
}

double worst_shear_stress(const ReferenceCsv& r, const std::vector<ElementRow>& rows) {
  double worst = 0;
  for (std::size_t i = 0; i < r.rows.size(); ++i)
    worst = std::max(worst, std::abs(rows[i + 1].stress[3] - r.rows[i][1] * kKilo) / (r.rows[0][1] * kKilo));
  return worst;
}

std::vector<double> first_column(const ReferenceCsv& r) {
  std::vector<double> targets;
  for (const auto& row : r.rows) targets.push_back(row[0]);
  return targets;
}

}  // namespace

TEST_CASE("pure shear with linear softening: exact from row to row for von Mises and Tresca") {
  const ReferenceCsv r("pure_shear_linear_softening.csv");
  for (MaterialModel model : {MaterialModel::von_mises, MaterialModel::tresca}) {
    const auto rows = run_element(vertical_cut(model),
                                  {.test = ElementTest::simple_shear_undrained, .targets = first_column(r)});
    const double error = worst_shear_stress(r, rows);
    MESSAGE("largest error relative to the peak: " << error);
    CHECK(error < 1e-12);
    for (std::size_t i = 0; i < r.rows.size(); ++i)
      CHECK(std::abs(rows[i + 1].state[0] - r.rows[i][2] / std::sqrt(3.0)) < 1e-12);
    // one single step from rest to the end: the strength is that of the end of the step
    const auto jump = run_element(
        vertical_cut(model), {.test = ElementTest::simple_shear_undrained, .targets = {r.rows.back()[0]}});
    CHECK(jump[1].stress[3] == doctest::Approx(rows.back().stress[3]).epsilon(1e-9));
  }
}

TEST_CASE(
    "Mohr-Coulomb without friction and exponential softening follows the Tresca closed form in simple "
    "shear") {
  const ReferenceCsv r("simple_shear_tresca_softening.csv");
  MaterialParameters m;
  m.model = MaterialModel::mohr_coulomb;
  m.young = 1e7, m.poisson = 0.3;
  m.cohesion.kind = Mobilised::Kind::exponential;
  m.cohesion.peak = r.get("c_peak") * kKilo, m.cohesion.residual = r.get("c_res") * kKilo,
  m.cohesion.rate = r.get("eta");
  for (double friction : {0.0, 1e-12}) {
    m.friction.value = {friction};
    const auto rows = run_element(m, {.test = ElementTest::simple_shear_undrained,
                                      .initial_stress = {-50e3, -50e3, -50e3},
                                      .targets = first_column(r)});
    const double error = worst_shear_stress(r, rows);
    MESSAGE("phi = " << friction << ": largest error relative to the peak: " << error);
    CHECK(error < 1e-9);
  }
}

TEST_CASE("softening steeper than elastic unloading drops the stress to the residual at constant strain") {
  for (MaterialModel model : {MaterialModel::von_mises, MaterialModel::tresca}) {
    MaterialParameters m = vertical_cut(model);
    m.softening_modulus = -3 * m.shear_modulus();
    const double at_yield = m.shear_strength / m.shear_modulus();
    const auto rows = run_element(m, {.test = ElementTest::simple_shear_undrained,
                                      .targets = {0.999 * at_yield, 1.001 * at_yield, 1.2 * at_yield}});
    CHECK(rows[1].stress[3] == doctest::Approx(0.999 * m.shear_strength));
    CHECK(rows[1].state[0] == 0);
    CHECK(rows[2].stress[3] == doctest::Approx(m.residual_strength).epsilon(1e-12));
    CHECK(rows[2].state[0] == doctest::Approx((1.001 * m.shear_strength - m.residual_strength) /
                                              m.shear_modulus() / std::sqrt(3.0)));
    CHECK(rows[3].stress[3] == doctest::Approx(m.residual_strength).epsilon(1e-12));
  }
}

TEST_CASE(
    "snap-back of Mohr-Coulomb rests at the first root: the stress is on the surface of the strength it "
    "softened to") {
  MaterialParameters m;
  m.model = MaterialModel::mohr_coulomb;
  m.young = 20e6, m.poisson = 0.33;
  const double degree = std::acos(-1.0) / 180;
  m.cohesion.kind = m.friction.kind = Mobilised::Kind::exponential;
  m.cohesion.peak = 25e3, m.cohesion.residual = 0.5e3, m.cohesion.rate = 2000;
  m.friction.peak = 26 * degree, m.friction.residual = 15 * degree, m.friction.rate = 2000;
  const double p = 50e3;
  // constant volume: the strain path is prescribed, whatever the stress does
  ElementPath path{.test = ElementTest::biaxial_undrained, .initial_stress = {-p, -p, -p}, .targets = {}};
  for (int i = 1; i <= 400; ++i) path.targets.push_back(-1e-5 * i);
  const auto rows = run_element(m, path);
  double largest_drop = 0, peak = 0;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const double q = rows[i].stress[0] - rows[i].stress[1],
                 before = rows[i - 1].stress[0] - rows[i - 1].stress[1];
    largest_drop = std::max(largest_drop, before - q);
    peak = std::max(peak, q);
    const double kappa = rows[i].state[0];
    const double c = value_at(m.cohesion, kappa), phi = value_at(m.friction, kappa);
    const double f = q + (rows[i].stress[0] + rows[i].stress[1]) * std::sin(phi) - 2 * c * std::cos(phi);
    if (kappa > 0) CHECK(std::abs(f) < 1e-9 * p);
    // the plastic strain that the return needs is the one the strength was taken at
    const double e1 = -rows[i].strain[1] - (q / 2) / (2 * m.shear_modulus());
    if (kappa > 0) CHECK(kappa == doctest::Approx(2 / std::sqrt(3.0) * e1).epsilon(1e-6));
  }
  MESSAGE("largest drop in one step of 1e-5: " << largest_drop << " Pa of a peak " << peak << " Pa");
  CHECK(largest_drop > 0.2 * peak);
}

TEST_CASE("the peak strength is the particle's own") {
  MaterialParameters m = vertical_cut(MaterialModel::von_mises);
  m.strength_gradient = 5e3, m.strength_datum = 8.0, m.softening_modulus = 0;
  for (double height : {8.0, 6.0, 1.0}) {
    const auto rows =
        run_element(m, {.test = ElementTest::simple_shear_undrained, .targets = {0.5}, .height = height});
    CHECK(rows[1].stress[3] == doctest::Approx(peak_strength_at(m, height)).epsilon(1e-12));
  }
}

TEST_CASE("Mohr-Coulomb tends to Tresca as friction vanishes, on planes and edges") {
  MaterialParameters tresca = vertical_cut(MaterialModel::tresca), mohr = tresca;
  tresca.softening_modulus = 0;
  mohr.model = MaterialModel::mohr_coulomb;
  mohr.cohesion.value = {tresca.shear_strength};
  mohr.friction.value = {1e-13};
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-0.05, 0.05);
  double worst = 0;
  for (int i = 0; i < 500; ++i) {
    ElementPoint a(tresca), b(mohr);
    Components de{};
    for (double& e : de) e = uniform(random);
    if (i % 3 == 0) de = {de[0], de[0], -2 * de[0], 0, 0, 0};  // an edge
    a.apply_strain(de), b.apply_strain(de);
    for (int c = 0; c < 6; ++c) worst = std::max(worst, std::abs(a.stress[c] - b.stress[c]));
  }
  CHECK(worst < 1e-6 * tresca.shear_strength);
}
