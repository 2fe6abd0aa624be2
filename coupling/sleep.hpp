// Sleeping soil in a scene: whether it may, and the thresholds (mpm/sleep.hpp has the method).
#pragma once

#include "coupling/scene.hpp"
#include "mpm/sleep.hpp"

namespace polder::coupling {

// Null where soil of this scene may sleep; else what it is about the scene that keeps it awake.
const char* keeps_awake(const Scene& scene);

// Thresholds with their defaults. Natural units of a cell under gravity are sqrt(g h) and sqrt(h / g): rest
// is 0.003 of the former, for fifteen of the latter.
mpm::SleepOptions sleep_options(const Scene& scene);

}  // namespace polder::coupling
