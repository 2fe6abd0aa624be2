// Curves and boundary flows as means over the height of a cell.
#include <doctest/doctest.h>

#include <cmath>
#include <numeric>
#include <vector>

#include "fdm/boundary_flow.hpp"
#include "fdm/retention.hpp"
#include "tests/unit/fdm_scene.hpp"

using namespace polder;
using namespace polder::fdm;
using namespace polder::fdm::test;
using Model = Retention::Model;

namespace {

std::vector<Retention> curves() {
  Retention vg, clay, bc, gardner, haverkamp, table;
  vg.model = Model::van_genuchten, vg.alpha = 14.5, vg.n = 2.68, vg.residual = 0.1;
  clay = vg, clay.alpha = 0.8, clay.n = 1.09;
  bc.model = Model::brooks_corey, bc.entry_head = 0.2, bc.lambda = 1.5, bc.residual = 0.1;
  gardner.model = Model::gardner, gardner.alpha = 500, gardner.residual = 0.15;
  haverkamp.model = Model::haverkamp, haverkamp.haverkamp = {0.063, 2.9, 0.0003, 5.0};
  table.model = Model::tabulated, table.residual = 0.02;
  table.suction_head = {0.1, 0.3, 1, 3, 10, 100};
  table.saturation = {0.95, 0.7, 0.4, 0.25, 0.15, 0.1};
  table.relative_conductivity = {0.8, 0.2, 1e-2, 3e-4, 1e-5, 1e-8};
  return {vg, clay, bc, gardner, haverkamp, table};
}

// Mean over [p - reach, p + reach] by the midpoint rule.
template <class F>
double mean(double p, double reach, const F& f) {
  constexpr int kParts = 40000;
  double sum = 0;
  for (int i = 0; i < kParts; ++i) sum += f(p + reach * (2 * (i + 0.5) / kParts - 1));
  return sum / kParts;
}

struct Values {
  double saturation, capacity, conductivity, slope;
};
Values values(const RetentionCurve& c, double p) {
  const std::vector<int> which{0};
  const std::vector<double> at{p};
  std::vector<double> s(1), d(1), k(1), slope(1);
  c.evaluate(which, at, s, d, k);
  c.conductivity_slope(which, at, slope);
  return {s[0], d[0], k[0], slope[0]};
}

}  // namespace

TEST_CASE("retention over the height of a cell is the mean of the curve over it") {
  for (const Retention& r : curves())
    for (const double height : {0.05, 0.5}) {
      CAPTURE(static_cast<int>(r.model));
      CAPTURE(height);
      const RetentionCurve point(r, kGamma);
      RetentionCurve cell = point;
      cell.average_over(height);
      const double reach = 0.5 * height * kGamma;
      CHECK(cell.full_pressure() == doctest::Approx(reach));
      CHECK(values(cell, 1.001 * reach).saturation == 1);
      CHECK(values(cell, 1.001 * reach).conductivity == 1);
      for (const double head : {-0.4 * height, 0.0, 0.3 * height, 0.6 * height, 1.0, 12.0, 400.0}) {
        CAPTURE(head);
        const double p = -kGamma * head;
        const Values v = values(cell, p);
        CHECK(v.saturation == cell.saturation(p));
        CHECK(v.capacity == cell.capacity(p));
        const double k = mean(p, reach, [&](double q) { return point.relative_conductivity(q); });
        CHECK(v.saturation ==
              doctest::Approx(mean(p, reach, [&](double q) { return point.saturation(q); })).epsilon(1e-4));
        CHECK(v.conductivity == doctest::Approx(k).epsilon(2e-4));
        const double step = 1e-4 * reach;
        const Values low = values(cell, p - step), high = values(cell, p + step);
        CHECK(v.capacity * 2 * step ==
              doctest::Approx(high.saturation - low.saturation).epsilon(2e-3).scale(1e-9));
        if (k > 1e-6)
          CHECK(v.slope * 2 * step ==
                doctest::Approx(high.conductivity - low.conductivity).epsilon(2e-3).scale(1e-9));
      }
    }
}

TEST_CASE("cells on top of each other hold together what the column holds at rest, however they are cut") {
  Retention r = curves()[0];
  for (const int cells : {1, 3, 20}) {
    RetentionCurve c(r, kGamma);
    c.average_over(2.0 / cells);
    double sum = 0;
    for (int i = 0; i < cells; ++i) sum += c.saturation(kGamma * (0.7 - 2.0 * (i + 0.5) / cells)) / cells;
    const RetentionCurve point(r, kGamma);
    const double exact = mean(kGamma * -0.3, kGamma, [&](double p) { return point.saturation(p); });
    CHECK(sum == doctest::Approx(exact).epsilon(1e-6));
  }
}

TEST_CASE("an upright face on which a level ends: mean of the flows below and above it") {
  const double spread = 500, kappa = 3e-9;
  for (const bool seeps : {true, false})
    for (const double level : {-500.0, -120.0, 0.0, 333.0, 499.9})
      for (const double p : {-2000.0, -499.0, -200.0, 50.0, 340.0, 501.0, 4000.0}) {
        CAPTURE(level);
        CAPTURE(p);
        const BoundaryLaw law{
            .kind = BoundaryLaw::Kind::split, .spread = spread, .level = level, .seeps = seeps};
        const double expected = mean(0, spread, [&](double y) {
          return y < level ? p - level : seeps ? std::max(0.0, p - y) : 0.0;
        });
        const BoundaryFlow flow = boundary_flow(law, kappa, p, 0.1);
        CHECK(flow.inflow == doctest::Approx(-kappa * expected).epsilon(1e-3).scale(kappa));
        const double step = 1e-3;
        CHECK(flow.conductance * 2 * step == doctest::Approx(boundary_flow(law, kappa, p - step, 1).inflow -
                                                             boundary_flow(law, kappa, p + step, 1).inflow)
                                                 .epsilon(1e-4)
                                                 .scale(kappa * 1e-6));
      }
}

TEST_CASE("which faces are split: upright ones that a level or a seepage face may end on") {
  Scene<2> s({0, 0}, {2, 4}, 0.5);
  s.fill_cells([](const auto&) { return 1.0; });
  auto left = boundary<2>(WaterBoundary<2>::Kind::head, 0, 1.1);
  auto right = boundary<2>(WaterBoundary<2>::Kind::head, 1, 1.1);
  auto top = boundary<2>(WaterBoundary<2>::Kind::surface, 3, 0.0);
  left.seepage_above = true;
  s.conditions.boundaries = {left, right, top};
  s.cells.update(s.fill, s.conditions);
  int split = 0;
  for (const BoundaryFace<2>& f : s.cells.boundary_faces()) {
    const double z = s.cells.centre(s.cells.cells()[f.cell].index)[1];
    BoundaryLaw law = boundary_law(f, s.cells.conditions());
    const BoundaryLaw before = law;
    split_law(f, s.cells.conditions(), z, 0.5, law);
    const bool level_here = std::abs(z - 1.1) < 0.25;
    const bool expected = f.axis == 0 && (level_here || (f.boundary == 0 && z > 1.1));
    CHECK((law.kind == BoundaryLaw::Kind::split) == expected);
    if (!expected) {
      CHECK(law.kind == before.kind);
      continue;
    }
    ++split;
    CHECK(law.seeps == (f.boundary == 0));
    CHECK(law.level == doctest::Approx(std::max(kGamma * (1.1 - z), -kGamma * 0.25)));
  }
  CHECK(split == 3);
}
