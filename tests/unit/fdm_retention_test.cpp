// Retention curves: values by hand, derivative, inverse, and the evaluation in batches.
#include <doctest/doctest.h>

#include <cmath>
#include <numeric>

#include "core/error.hpp"
#include "fdm/retention.hpp"

using namespace polder;
using namespace polder::fdm;
using Model = Retention::Model;

namespace {

constexpr double kGamma = 9810;

std::vector<Retention> samples() {
  Retention vg, vg_free, bc, gardner, haverkamp, table, saturated;
  vg.model = Model::van_genuchten, vg.alpha = 3.35, vg.n = 2, vg.residual = 0.28;
  vg_free = vg, vg_free.m = 0.3, vg_free.n = 1.3, vg_free.connectivity = -0.5, vg_free.maximum = 0.95;
  bc.model = Model::brooks_corey, bc.entry_head = 0.2, bc.lambda = 1.5, bc.residual = 0.1;
  gardner.model = Model::gardner, gardner.alpha = 2, gardner.residual = 0.15;
  haverkamp.model = Model::haverkamp, haverkamp.residual = 0.05;
  haverkamp.haverkamp = {0.063, 2.9, 0.0003, 5.0};
  table.model = Model::tabulated, table.residual = 0.02, table.maximum = 0.98;
  table.suction_head = {0.1, 0.3, 1, 3, 10, 100};
  table.saturation = {0.95, 0.7, 0.4, 0.25, 0.15, 0.1};
  table.relative_conductivity = {0.8, 0.2, 1e-2, 3e-4, 1e-5, 1e-8};
  return {vg, vg_free, bc, gardner, haverkamp, table, saturated};
}

}  // namespace

TEST_CASE("retention curves: the formulas at one suction") {
  const auto all = samples();
  const double h = 0.6, p = -kGamma * h;
  {
    const RetentionCurve c(all[0], kGamma);
    const double u = std::pow(3.35 * h, 2), s = 1 / std::sqrt(1 + u);
    CHECK(c.saturation(p) == doctest::Approx(0.28 + 0.72 * s).epsilon(1e-14));
    CHECK(c.relative_conductivity(p) ==
          doctest::Approx(std::sqrt(s) * std::pow(1 - std::sqrt(u / (1 + u)), 2)).epsilon(1e-12));
  }
  {
    const RetentionCurve c(all[2], kGamma);
    const double s = std::pow(3.0, -1.5);
    CHECK(c.saturation(p) == doctest::Approx(0.1 + 0.9 * s).epsilon(1e-14));
    CHECK(c.relative_conductivity(p) == doctest::Approx(std::pow(s, 2 / 1.5 + 2.5)).epsilon(1e-12));
    CHECK(c.saturation(-kGamma * 0.19) == 1);
    CHECK(c.capacity(-kGamma * 0.19) == 0);
    CHECK(c.relative_conductivity(-kGamma * 0.19) == 1);
  }
  {
    const RetentionCurve c(all[3], kGamma);
    CHECK(c.saturation(p) == doctest::Approx(0.15 + 0.85 * std::exp(-1.2)).epsilon(1e-14));
    CHECK(c.relative_conductivity(p) == doctest::Approx(std::exp(-1.2)).epsilon(1e-14));
  }
  {
    const RetentionCurve c(all[4], kGamma);
    CHECK(c.saturation(p) ==
          doctest::Approx(0.05 + 0.95 * 0.063 / (0.063 + std::pow(h, 2.9))).epsilon(1e-14));
    CHECK(c.relative_conductivity(p) == doctest::Approx(0.0003 / (0.0003 + std::pow(h, 5.0))).epsilon(1e-14));
  }
  {
    const RetentionCurve c(all[5], kGamma);
    for (std::size_t i = 0; i < all[5].suction_head.size(); ++i) {
      CHECK(c.saturation(-kGamma * all[5].suction_head[i]) == doctest::Approx(all[5].saturation[i]));
      CHECK(c.relative_conductivity(-kGamma * all[5].suction_head[i]) ==
            doctest::Approx(all[5].relative_conductivity[i]));
    }
    CHECK(c.saturation(-kGamma * 1e4) == doctest::Approx(0.1));  // constant beyond the table
    CHECK(c.capacity(-kGamma * 1e4) == 0);
  }
  CHECK(RetentionCurve(all[6], kGamma).saturation(-1e6) == 1);
}

TEST_CASE("dry van Genuchten soil keeps its conductivity's digits: k_r -> m^2 S_e^(l + 2/m)") {
  Retention r;
  r.model = Model::van_genuchten, r.alpha = 10, r.n = 2;
  const RetentionCurve c(r, kGamma);
  const double h = 1e5, s = 1 / (10 * h);
  CHECK(c.relative_conductivity(-kGamma * h) ==
        doctest::Approx(0.25 * std::pow(s, 0.5) * std::pow(s, 4)).epsilon(1e-9));
}

TEST_CASE("retention curves: derivative, monotony and inverse") {
  for (const Retention& r : samples()) {
    const RetentionCurve c(r, kGamma);
    CAPTURE(static_cast<int>(r.model));
    CHECK(c.saturation(0) == r.maximum);
    CHECK(c.saturation(5000) == r.maximum);
    CHECK(c.relative_conductivity(0) == 1);
    CHECK(c.capacity(1) == 0);
    CHECK(c.pressure(r.maximum) == 0);
    CHECK(c.pressure(1.0) == 0);
    double s_before = r.maximum, k_before = 1;
    for (double h = 1e-3; h < 90; h *= 1.13) {
      CAPTURE(h);
      const double p = -kGamma * h, d = 1e-4 * kGamma * h;
      const double s = c.saturation(p), k = c.relative_conductivity(p);
      CHECK(s <= s_before);
      CHECK(k <= k_before);
      CHECK(k > 0);
      s_before = s, k_before = k;
      // The kink at the air entry aside.
      if (r.model != Model::brooks_corey || std::abs(h - r.entry_head) > 1e-3 * h) {
        const double slope = (c.saturation(p + d) - c.saturation(p - d)) / (2 * d);
        CHECK(c.capacity(p) == doctest::Approx(slope).epsilon(2e-5).scale(1e-3 * (s + 1e-3) / d));
      }
      // As far as a saturation in double precision still tells the suction.
      if (s < r.maximum * (1 - 1e-9) && s > r.residual + 1e-8)
        CHECK(c.pressure(s) == doctest::Approx(p).epsilon(1e-6));
    }
  }
}

TEST_CASE("saturation below the residual has the driest suction") {
  for (const Retention& r : samples()) {
    if (r.model == Model::saturated) continue;
    const RetentionCurve c(r, kGamma);
    CHECK(c.pressure(0.5 * r.residual) == -kGamma * RetentionCurve::kDriestSuction);
    CHECK(c.pressure(r.residual) == -kGamma * RetentionCurve::kDriestSuction);
  }
}

TEST_CASE("a batch gives what single evaluations give, for the cells it is asked for") {
  std::vector<double> p;
  for (int i = 0; i < 50; ++i) p.push_back(2000 - 700.0 * i);
  std::vector<int> which;
  for (int i = 0; i < 50; i += 3) which.push_back(i);
  for (const Retention& r : samples()) {
    const RetentionCurve c(r, kGamma);
    std::vector<double> s(50, -7), capacity(50, -7), k(50, -7);
    c.evaluate(which, p, s, capacity, k);
    for (int i = 0; i < 50; ++i) {
      CHECK(s[i] == doctest::Approx(i % 3 ? -7 : c.saturation(p[i])).epsilon(1e-13));
      CHECK(capacity[i] == doctest::Approx(i % 3 ? -7 : c.capacity(p[i])).epsilon(1e-13));
      CHECK(k[i] == doctest::Approx(i % 3 ? -7 : c.relative_conductivity(p[i])).epsilon(1e-13));
    }
  }
}

TEST_CASE("parameters out of range are told, all of them") {
  Retention r;
  CHECK(faults(r).empty());
  r.model = Model::van_genuchten;
  CHECK(faults(r).size() == 2);  // alpha, n
  r.alpha = 1, r.n = 0.9;
  CHECK(faults(r).size() == 1);
  CHECK_THROWS_WITH_AS(RetentionCurve(r, kGamma), doctest::Contains("n must be greater than one"),
                       InputError);
  r.n = 2, r.residual = 0.6, r.maximum = 0.5;
  CHECK(faults(r).size() == 1);
  r = {};
  r.model = Model::brooks_corey;
  CHECK(faults(r).size() == 2);
  r.model = Model::haverkamp;
  CHECK(faults(r).size() == 2);
  r.model = Model::gardner;
  CHECK(faults(r).size() == 1);
  r.model = Model::tabulated;
  r.suction_head = {0, 1, 0.5}, r.saturation = {1, 0.5, 0.6}, r.relative_conductivity = {1, 0.1, 0};
  CHECK(faults(r).size() == 3);
}
