// Ranges in which the material models are valid.
#include <cmath>
#include <numbers>

#include "mpm/material/curve.hpp"
#include "mpm/material/material.hpp"

namespace polder::mpm {
namespace {

class Checker {
 public:
  explicit Checker(const MaterialParameters& material) : m_(material) {}

  std::vector<ParameterProblem> run() {
    number("young", m_.young, m_.young > 0, "a positive number");
    number("poisson", m_.poisson, m_.poisson > -1 && m_.poisson < 0.5, "more than -1 and less than 0.5");
    if (m_.model == MaterialModel::mohr_coulomb) mohr_coulomb();
    if (m_.model == MaterialModel::von_mises || m_.model == MaterialModel::tresca) undrained();
    return problems_;
  }

 private:
  void report(const std::string& key, const std::string& problem, const std::string& allowed) {
    problems_.push_back({key, problem, allowed});
  }

  void number(const std::string& key, double value, bool sound, const std::string& allowed) {
    if (!std::isfinite(value) || !sound) report(key, key + " = " + std::to_string(value), allowed);
  }

  // The shape of the curve; its values are looked at only where the shape is sound.
  bool curve(const std::string& key, const Mobilised& c) {
    const std::size_t before = problems_.size();
    if (c.kind == Mobilised::Kind::exponential) {
      number(key, c.peak, true, "a number");
      number(key, c.residual, true, "a number");
      number(key, c.rate, c.rate >= 0, "a rate of at least 0");
      return problems_.size() == before;
    }
    if (c.strain.empty() || c.strain.size() != c.value.size()) {
      report(key,
             "has " + std::to_string(c.strain.size()) + " strains and " + std::to_string(c.value.size()) +
                 " values",
             "as many values as strains, at least one");
      return false;
    }
    if (c.strain.size() > kMaxKnots)
      report(key, "has " + std::to_string(c.strain.size()) + " knots",
             "at most " + std::to_string(kMaxKnots));
    for (std::size_t i = 0; i < c.strain.size(); ++i) {
      number(key, c.strain[i], c.strain[i] >= 0, "plastic strains of at least 0");
      number(key, c.value[i], true, "a number");
      if (i > 0 && c.strain[i] <= c.strain[i - 1])
        report(key, "plastic strains do not grow from knot to knot", "strictly ascending plastic strains");
    }
    return problems_.size() == before;
  }

  void within(const std::string& key, const Mobilised& c, double low, double high,
              const std::string& allowed) {
    const Range r = range_of(c);
    if (r.lowest < low || r.highest > high)
      report(key, "reaches " + std::to_string(r.lowest < low ? r.lowest : r.highest), allowed);
  }

  void mohr_coulomb() {
    const double infinity = std::numeric_limits<double>::infinity(), degree = std::numbers::pi / 180;
    if (curve("cohesion", m_.cohesion)) within("cohesion", m_.cohesion, 0, infinity, "at least 0");
    if (curve("capillary_cohesion", m_.capillary_cohesion))
      within("capillary_cohesion", m_.capillary_cohesion, 0, infinity, "at least 0");
    const bool friction = curve("friction", m_.friction), dilation = curve("dilation", m_.dilation);
    if (friction) within("friction", m_.friction, 0, 80 * degree, "from 0 to 80 degrees");
    if (dilation) within("dilation", m_.dilation, -45 * degree, 80 * degree, "from -45 to 80 degrees");
    if (friction && dilation) {
      dilation_below_friction();
      contraction_within_stiffness();
    }
    if (!(m_.tension_cutoff >= 0))  // infinite is allowed: the apex limits it
      report("tension_cutoff", "tension_cutoff = " + std::to_string(m_.tension_cutoff), "at least 0");
  }

  // More dilation than friction would create energy. Both curves are monotone between the strains looked at.
  void dilation_below_friction() {
    std::vector<double> strains{0.0};
    for (const Mobilised* c : {&m_.friction, &m_.dilation}) {
      if (c->kind == Mobilised::Kind::exponential && c->rate > 0)
        for (double multiple : {0.25, 0.5, 1.0, 2.0, 4.0, 40.0}) strains.push_back(multiple / c->rate);
      if (c->kind == Mobilised::Kind::piecewise_linear)
        strains.insert(strains.end(), c->strain.begin(), c->strain.end());
    }
    for (double kappa : strains)
      if (value_at(m_.dilation, kappa) > value_at(m_.friction, kappa) + 1e-12) {
        report("dilation", "exceeds the friction angle at the plastic strain " + std::to_string(kappa),
               "at most the friction angle");
        return;
      }
  }

  // A strongly contractive soil of nearly incompressible grains loses more strength with its confinement than
  // flow on a plane or edge can shed: the return to the yield surface would not exist (principal_return.hpp:
  // the stiffnesses of the multipliers must be positive).
  void contraction_within_stiffness() {
    const double sp = std::sin(range_of(m_.friction).highest), sq = std::sin(range_of(m_.dilation).lowest);
    const double bulk = m_.bulk_modulus(), shear = m_.shear_modulus();
    if (sq >= 0 || !(shear > 0) || !(bulk > 0)) return;
    const double plane = 4 * shear * (1 + sp * sq / 3) + 4 * bulk * sp * sq;
    const double common = 2 * shear * (1 - sp * sq / 3) + 4 * bulk * sp * sq, sided = 2 * shear * (sp + sq);
    const double stiffest = 4 * shear, edge = plane + common - std::abs(sided);
    if (plane < 0.05 * stiffest || edge < 0.05 * stiffest)
      report("dilation", "dilation: contracts faster than the elastic stiffness can follow",
             "less contraction, less friction or a smaller Poisson's ratio");
  }

  void undrained() {
    number("shear_strength", m_.shear_strength,
           m_.shear_strength > 0 || (m_.shear_strength == 0 && m_.strength_gradient > 0),
           "a positive number, or 0 with a positive strength_gradient");
    number("strength_gradient", m_.strength_gradient, m_.strength_gradient >= 0, "at least 0");
    number("residual_strength", m_.residual_strength, m_.residual_strength >= 0, "at least 0");
    number("softening_modulus", m_.softening_modulus, m_.softening_modulus <= 0, "at most 0");
    number("strength_datum", m_.strength_datum, true, "a height");
  }

  const MaterialParameters& m_;
  std::vector<ParameterProblem> problems_;
};

}  // namespace

std::vector<ParameterProblem> check_parameters(const MaterialParameters& material) {
  return Checker(material).run();
}

}  // namespace polder::mpm
