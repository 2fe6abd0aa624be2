#include "coupling/sleep.hpp"

#include <algorithm>
#include <cmath>

namespace polder::coupling {
namespace {

constexpr double kVelocity = 3e-3;  // of sqrt(g h)
constexpr double kDelay = 15;       // times sqrt(h / g)

double magnitude(const Vector3& v) {
  return std::hypot(v[0], v[1], v[2]);
}

}  // namespace

const char* keeps_awake(const Scene& scene) {
  const WaterCarrier carrier = find_formulation(scene.formulation)->carrier;
  if (carrier != WaterCarrier::none && carrier != WaterCarrier::cells)
    return "water with points of its own, or on the soil's, moves on in resting soil";
  if (scene.compressible())
    return "with an explicit pressure the water of rigid soil would follow its own stiffness";
  if (scene.unsaturated()) return "suction changes in resting soil, and its stress with it";
  if (magnitude(scene.gravity) == 0)
    return "forces at rest are measured by the weight, and there is no gravity";
  if (std::none_of(scene.stages.begin(), scene.stages.end(),
                   [](const Stage& s) { return s.mode == Stage::Mode::dynamic; }))
    return "no stage is dynamic";
  return nullptr;
}

mpm::SleepOptions sleep_options(const Scene& scene) {
  const NumericsSpec& n = scene.numerics;
  const double g = magnitude(scene.gravity), h = scene.grid.cell;
  mpm::SleepOptions o;
  o.velocity = n.sleep_velocity > 0 ? n.sleep_velocity : kVelocity * std::sqrt(g * h);
  o.delay = n.sleep_delay > 0 ? n.sleep_delay : kDelay * std::sqrt(h / g);
  o.force = n.sleep_force;
  return o;
}

}  // namespace polder::coupling
