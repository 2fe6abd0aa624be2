#include "coupling/strength_reduction.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "coupling/memory_state.hpp"

namespace polder::coupling {
namespace {

// Steps allowed for a trial: for each cell of height, several times what a motion gets before it may count as
// running away.
constexpr long kStepsForEachCell = 400;
constexpr double kMostFriction = 1.39;  // [rad], of strength that is multiplied: just below what a law takes
constexpr double kGrowth = 1.3;         // of the factor while no bracket is known

template <class F>
mpm::Mobilised mapped(mpm::Mobilised m, const F& f) {
  for (double& v : m.value) v = f(v);
  m.peak = f(m.peak), m.residual = f(m.residual);
  return m;
}

// A dilation angle that grows beyond friction is cut to it value by value: where friction softens, to the
// least.
mpm::Mobilised limited_to(const mpm::Mobilised& dilation, const mpm::Mobilised& friction) {
  const double most = mpm::range_of(friction).lowest;
  return mapped(dilation, [&](double v) { return std::min(v, most); });
}

template <int D>
long most_steps(const World<D>& world) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const auto& body : world.skeleton.bodies())
    for (int p = 0; p < body->slots(); ++p)
      if (body->id[p] >= 0) {
        low = std::min(low, body->position[D - 1][p]);
        high = std::max(high, body->position[D - 1][p]);
      }
  const double cells = (high - low) / world.skeleton.grid().spacing();
  return std::max(1200L, static_cast<long>(kStepsForEachCell * cells));
}

}  // namespace

mpm::MaterialParameters with_reduced_strength(const mpm::MaterialParameters& material, double factor) {
  mpm::MaterialParameters m = material;
  const auto divided = [&](double v) { return v / factor; };
  m.cohesion = mapped(m.cohesion, divided);
  m.capillary_cohesion = mapped(m.capillary_cohesion, divided);
  m.friction = mapped(m.friction, [&](double v) {
    return std::min(std::atan(std::tan(v) / factor), std::max(v, kMostFriction));
  });
  m.dilation = limited_to(m.dilation, m.friction);
  m.tension_cutoff /= factor;
  m.shear_strength /= factor, m.strength_gradient /= factor;
  m.residual_strength /= factor, m.softening_modulus /= factor;
  return m;
}

template <int D>
StabilityTrial try_reduced_strength(World<D>& world, double factor, const StabilityOptions& options,
                                    double time) {
  const std::vector<mpm::MaterialParameters> own = world.materials;
  for (mpm::MaterialParameters& m : world.materials) {
    m = with_reduced_strength(m, factor);
    m.young *= kStiffening;
  }
  mpm::Skeleton<D>& skeleton = world.skeleton;
  for (auto& body : skeleton.bodies()) {
    const int peak = world.layouts[body->material].peak_strength;
    if (peak >= 0)
      for (double& v : body->state[peak]) v /= factor;
  }
  skeleton.set_laws(world.materials, true);
  skeleton.boundaries().set_sticking(false);
  skeleton.boundaries().set_friction_share(1 / factor);
  // Stress returns to the smaller yield surface; what it gave up is the load of the trial.
  const Reals rest(static_cast<std::size_t>(skeleton.grid().slots()) * 4, 0.0);
  skeleton.scatter(time);
  skeleton.deform(time, 1.0, rest);

  RelaxationOptions r;
  r.force_tolerance = options.force_tolerance;
  r.most_steps = most_steps(world);
  const RelaxationReport report = relax(world, r, time);

  skeleton.boundaries().set_friction_share(1);
  world.materials = own;
  skeleton.set_laws(own, true);
  StabilityTrial trial;
  trial.factor = factor;
  trial.stands = report.converged, trial.runs_away = report.runs_away;
  trial.steps = report.steps, trial.force_ratio = report.force_ratio;
  trial.displacement = kStiffening * report.displacement;
  trial.largest_displacement = kStiffening * report.largest_displacement;
  return trial;
}

StabilityResult find_factor_of_safety(Simulation& simulation, const StabilityOptions& options,
                                      const std::function<bool(const StabilityTrial&)>& look) {
  MemoryState state;
  state.save(simulation);
  StabilityResult result;
  result.fails = std::numeric_limits<double>::infinity();
  const auto stands = [&](double factor) {
    state.load(simulation);
    const StabilityTrial trial = simulation.try_reduced_strength(factor, options);
    result.trials.push_back(trial);
    if (trial.stands)
      result.stands = std::max(result.stands, factor);
    else
      result.fails = std::min(result.fails, factor);
    return look(trial);
  };
  bool goes_on = stands(options.first);
  while (goes_on && result.stands == 0 && result.fails > options.least) {
    goes_on = stands(std::max(options.least, result.fails / kGrowth));
  }
  while (goes_on && !std::isfinite(result.fails) && result.stands < options.most) {
    goes_on = stands(std::min(options.most, result.stands * kGrowth));
  }
  while (goes_on && result.stands > 0 && std::isfinite(result.fails) &&
         result.fails - result.stands > options.tolerance * result.stands)
    goes_on = stands(0.5 * (result.stands + result.fails));
  state.load(simulation);
  return result;
}

template StabilityTrial try_reduced_strength<2>(World<2>&, double, const StabilityOptions&, double);
template StabilityTrial try_reduced_strength<3>(World<3>&, double, const StabilityOptions&, double);

}  // namespace polder::coupling
