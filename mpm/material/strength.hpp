// Strength of a pack of particles as a function of the plastic deviatoric strain, in the three forms the
// frictional law is built with. Each class offers
//   particle(state)          what the strength of these particles depends on
//   at(particle, increment)  strength after that increment of plastic strain; the dilation angle is the mean
//   over the
//                            increment, so that the volume change of a step is exact to second order, also
//                            across knots
//   lowest_cohesion(particle), bounds()   what they can never fall below, for the elastic skip
//   cohesion_slope(particle, increment)   change of the cohesion with the plastic strain there
//   varies(), knots(), knot(j, particle)  does at() change with the increment, and the strains where its
//   slope jumps
#pragma once

#include <limits>
#include <type_traits>

#include "mpm/material/curve.hpp"
#include "mpm/material/pack_math.hpp"
#include "mpm/material/principal_return.hpp"

namespace polder::POLDER_SIMD_NAMESPACE {

struct StrengthBounds {
  double sin_lowest = 0, sin_highest = 0, cos_lowest = 1;  // of the friction angle
  double tension = std::numeric_limits<double>::infinity();
};

// Mohr-Coulomb, all parameters constant.
class ConstantStrength {
 public:
  using Angle = double;
  using Cohesion = double;
  struct Particle {};
  explicit ConstantStrength(const mpm::MaterialParameters& m) {
    const double friction = mpm::compile_curve(m.friction).start;
    state_.sin_friction = std::sin(friction);
    state_.cos_friction = std::cos(friction);
    state_.cohesion = mpm::compile_curve(m.cohesion).start;
    state_.sin_dilation = std::sin(mpm::compile_curve(m.dilation).start);
    state_.cutoff = m.tension_cutoff;
  }
  POLDER_INLINE Particle particle(const Pack*) const { return {}; }
  POLDER_INLINE StrengthState<double, double> at(Particle, Pack) const { return state_; }
  POLDER_INLINE double lowest_cohesion(Particle) const { return state_.cohesion; }
  POLDER_INLINE StrengthBounds bounds() const {
    return {state_.sin_friction, state_.sin_friction, state_.cos_friction, state_.cutoff};
  }
  POLDER_INLINE Pack cohesion_slope(Particle, Pack) const { return Pack{}; }
  static constexpr bool varies() { return false; }
  static constexpr int knots() { return 0; }
  POLDER_INLINE Pack knot(int, Particle) const { return Pack{}; }

 private:
  StrengthState<double, double> state_;
};

POLDER_INLINE Pack value_of(const mpm::Curve& c, Pack kappa) {
  if (c.kind == mpm::Curve::Kind::exponential)
    return c.residual + (c.start - c.residual) * exp(-c.rate * kappa);
  Pack v = broadcast(c.start);
  for (int i = 0; i + 1 < c.knots; ++i)
    v += c.slope[i] * clamp(kappa - c.strain[i], 0, c.strain[i + 1] - c.strain[i]);
  return v;
}

// Slope of the curve; at a knot that of the part behind it.
POLDER_INLINE Pack slope_of(const mpm::Curve& c, Pack kappa) {
  if (c.kind == mpm::Curve::Kind::exponential) return c.rate * (c.residual - c.start) * exp(-c.rate * kappa);
  Pack slope = Pack{};
  for (int i = 0; i + 1 < c.knots; ++i)
    slope = select((kappa >= c.strain[i]) & (kappa < c.strain[i + 1]), broadcast(c.slope[i]), slope);
  return slope;
}

// Mean of the curve over [from, to].
POLDER_INLINE Pack mean_of(const mpm::Curve& c, Pack from, Pack to) {
  if (c.kind == mpm::Curve::Kind::exponential)
    return c.residual + (c.start - c.residual) * exp(-c.rate * from) * mean_decay(c.rate * (to - from));
  Pack sum = Pack{};  // integral of (curve - start)
  for (int i = 0; i + 1 < c.knots; ++i) {
    const double s = c.strain[i], e = c.strain[i + 1];
    const Pack a = clamp(from, s, e), b = clamp(to, s, e);
    // the part inside the segment, and the part beyond it where the segment's whole rise counts
    sum += c.slope[i] * ((b - a) * (0.5 * (a + b) - s) + (e - s) * (max(to, e) - max(from, e)));
  }
  const Mask moves = to > from;
  return select(moves, c.start + sum / select(moves, to - from, broadcast(1.0)), value_of(c, from));
}

POLDER_INLINE void assign(double& to, double from) {
  to = from;
}
POLDER_INLINE void assign(Pack& to, double from) {
  to = broadcast(from);
}

// Mohr-Coulomb with parameters mobilised by plastic strain, and capillary cohesion. AngleType is double where
// neither friction nor dilation varies, which spares most of the work of an evaluation.
template <class AngleType>
class MobilisedStrength {
 public:
  using Angle = AngleType;
  using Cohesion = Pack;
  struct Particle {
    Pack kappa, capillary;
  };

  MobilisedStrength(const mpm::MaterialParameters& m, int capillary_index)
      : friction_(mpm::compile_curve(m.friction)),
        dilation_(mpm::compile_curve(m.dilation)),
        cohesion_(mpm::compile_curve(m.cohesion)),
        capillary_(mpm::compile_curve(m.capillary_cohesion)),
        sin_dilation_(std::sin(dilation_.start)),
        capillary_index_(capillary_index) {
    varies_ = friction_.varies() || dilation_.varies() || cohesion_.varies() || capillary_.varies();
    bounds_ = {std::sin(friction_.lowest), std::sin(friction_.highest), std::cos(friction_.highest),
               m.tension_cutoff};
    for (const mpm::Curve* c : {&friction_, &dilation_, &cohesion_, &capillary_})
      for (int i = 0; i < c->knots; ++i) add_knot(c->strain[i]);
  }

  POLDER_INLINE Particle particle(const Pack* state) const {
    return {state[0], capillary_index_ < 0 ? Pack{} : state[capillary_index_]};
  }

  POLDER_INLINE StrengthState<Angle, Pack> at(const Particle& p, Pack increment) const {
    const Pack kappa = p.kappa + increment;
    StrengthState<Angle, Pack> m;
    assign(m.sin_friction, bounds_.sin_lowest);
    assign(m.cos_friction, bounds_.cos_lowest);
    assign(m.sin_dilation, sin_dilation_);
    if constexpr (!std::is_same_v<Angle, double>) {
      if (friction_.varies()) {
        m.sin_friction = sine(value_of(friction_, kappa));
        m.cos_friction = sqrt(1 - m.sin_friction * m.sin_friction);
      }
      if (dilation_.varies()) m.sin_dilation = sine(mean_of(dilation_, p.kappa, kappa));
    }
    m.cohesion = value_of(cohesion_, kappa);
    if (capillary_index_ >= 0) m.cohesion += p.capillary * value_of(capillary_, kappa);
    m.cutoff = bounds_.tension;
    return m;
  }
  // The two parts of the cohesion.
  POLDER_INLINE Pack cohesion_at(const Particle& p, Pack increment) const {
    return value_of(cohesion_, p.kappa + increment);
  }
  POLDER_INLINE Pack capillary_at(const Particle& p, Pack increment) const {
    return capillary_index_ < 0 ? Pack{} : p.capillary * value_of(capillary_, p.kappa + increment);
  }

  POLDER_INLINE Pack cohesion_slope_at(const Particle& p, Pack increment) const {
    return slope_of(cohesion_, p.kappa + increment);
  }
  POLDER_INLINE Pack capillary_slope_at(const Particle& p, Pack increment) const {
    return capillary_index_ < 0 ? Pack{} : p.capillary * slope_of(capillary_, p.kappa + increment);
  }
  POLDER_INLINE Pack cohesion_slope(const Particle& p, Pack increment) const {
    return cohesion_slope_at(p, increment) + capillary_slope_at(p, increment);
  }

  POLDER_INLINE double lowest_cohesion(const Particle&) const { return cohesion_.lowest; }
  POLDER_INLINE StrengthBounds bounds() const { return bounds_; }
  POLDER_INLINE bool varies() const { return varies_; }
  POLDER_INLINE int knots() const { return n_knots_; }
  POLDER_INLINE Pack knot(int j, const Particle& p) const { return knots_[j] - p.kappa; }

 private:
  void add_knot(double strain) {  // ascending, each once
    int at = 0;
    while (at < n_knots_ && knots_[at] < strain) ++at;
    if (at < n_knots_ && knots_[at] == strain) return;
    for (int i = n_knots_; i > at; --i) knots_[i] = knots_[i - 1];
    knots_[at] = strain;
    ++n_knots_;
  }

  mpm::Curve friction_, dilation_, cohesion_, capillary_;
  double sin_dilation_;  // of a constant dilation angle
  int capillary_index_;
  bool varies_;
  StrengthBounds bounds_;
  double knots_[4 * mpm::kMaxKnots];
  int n_knots_ = 0;
};

// Mohr-Coulomb whose particles carry factors of their own on the cohesion and on the tangent of the friction
// angle: the mobilised strength, scaled. The dilation angle is kept at or below the friction angle.
class ScatteredStrength {
 public:
  using Angle = Pack;
  using Cohesion = Pack;
  struct Particle {
    MobilisedStrength<Pack>::Particle mobilised;
    Pack cohesion_factor, friction_factor;
  };

  ScatteredStrength(const mpm::MaterialParameters& m, int capillary_index, int cohesion_index,
                    int friction_index)
      : mobilised_(m, capillary_index), cohesion_index_(cohesion_index), friction_index_(friction_index) {
    bounds_ = mobilised_.bounds();
    if (friction_index >= 0) {
      bounds_.sin_lowest = scaled_sine(bounds_.sin_lowest, m.scatter.lowest_friction);
      bounds_.sin_highest = scaled_sine(bounds_.sin_highest, m.scatter.highest_friction);
      bounds_.cos_lowest = std::sqrt(1 - bounds_.sin_highest * bounds_.sin_highest);
    }
  }

  POLDER_INLINE Particle particle(const Pack* state) const {
    return {mobilised_.particle(state), cohesion_index_ < 0 ? broadcast(1.0) : state[cohesion_index_],
            friction_index_ < 0 ? broadcast(1.0) : state[friction_index_]};
  }
  POLDER_INLINE StrengthState<Pack, Pack> at(const Particle& p, Pack increment) const {
    StrengthState<Pack, Pack> m = mobilised_.at(p.mobilised, increment);
    m.cohesion = mobilised_.cohesion_at(p.mobilised, increment) * p.cohesion_factor +
                 mobilised_.capillary_at(p.mobilised, increment);
    if (friction_index_ >= 0) {
      const Pack tangent = p.friction_factor * m.sin_friction / m.cos_friction;
      m.cos_friction = 1 / sqrt(1 + tangent * tangent);
      m.sin_friction = tangent * m.cos_friction;
      m.sin_dilation = min(m.sin_dilation, m.sin_friction);
    }
    return m;
  }
  POLDER_INLINE Pack cohesion_slope(const Particle& p, Pack increment) const {
    return mobilised_.cohesion_slope_at(p.mobilised, increment) * p.cohesion_factor +
           mobilised_.capillary_slope_at(p.mobilised, increment);
  }
  POLDER_INLINE Pack lowest_cohesion(const Particle& p) const {
    return mobilised_.lowest_cohesion(p.mobilised) * p.cohesion_factor;
  }
  POLDER_INLINE StrengthBounds bounds() const { return bounds_; }
  POLDER_INLINE bool varies() const { return mobilised_.varies(); }
  POLDER_INLINE int knots() const { return mobilised_.knots(); }
  POLDER_INLINE Pack knot(int j, const Particle& p) const { return mobilised_.knot(j, p.mobilised); }

 private:
  // Sine of the angle whose tangent is `factor` times that of the angle of this sine.
  static double scaled_sine(double sine, double factor) {
    const double tangent = factor * sine / std::sqrt(1 - sine * sine);
    return tangent / std::sqrt(1 + tangent * tangent);
  }

  MobilisedStrength<Pack> mobilised_;
  int cohesion_index_, friction_index_;
  StrengthBounds bounds_;
};

// Tresca: shear strength peak + softening_modulus kappa, not below min(peak, residual); the peak belongs to
// the particle.
class UndrainedStrength {
 public:
  using Angle = double;
  using Cohesion = Pack;
  struct Particle {
    Pack kappa, peak, residual;
  };

  UndrainedStrength(const mpm::MaterialParameters& m, int peak_index)
      : softening_(m.softening_modulus), residual_(m.residual_strength), peak_index_(peak_index) {}

  POLDER_INLINE Particle particle(const Pack* state) const {
    return {state[0], state[peak_index_], min(state[peak_index_], residual_)};
  }
  POLDER_INLINE Pack shear_strength(const Particle& p, Pack increment) const {
    return max(p.peak + softening_ * (p.kappa + increment), p.residual);
  }
  POLDER_INLINE StrengthState<double, Pack> at(const Particle& p, Pack increment) const {
    return {0, 1, 0, shear_strength(p, increment), std::numeric_limits<double>::infinity()};
  }
  POLDER_INLINE Pack cohesion_slope(const Particle& p, Pack increment) const {
    return select(p.peak + softening_ * (p.kappa + increment) > p.residual, broadcast(softening_), Pack{});
  }
  POLDER_INLINE Pack lowest_cohesion(const Particle& p) const { return varies() ? p.residual : p.peak; }
  POLDER_INLINE StrengthBounds bounds() const { return {}; }
  POLDER_INLINE bool varies() const { return softening_ != 0; }
  POLDER_INLINE int knots() const { return varies() ? 1 : 0; }
  POLDER_INLINE Pack knot(int, const Particle& p) const {
    return (p.residual - p.peak) / softening_ - p.kappa;
  }

 private:
  double softening_, residual_;
  int peak_index_;
};

}  // namespace polder::POLDER_SIMD_NAMESPACE
