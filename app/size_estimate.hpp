// What a scene will need, estimated from areas and volumes before anything is allocated.
#pragma once

#include "coupling/scene.hpp"

namespace polder::app {

struct SizeEstimate {
  double particles = 0;
  double cells = 0;   // of the whole grid
  double memory = 0;  // [bytes]
};

SizeEstimate estimate_size(const coupling::Scene& scene);

// Threads for a scene: the number asked for; 0: as many as the machine has cores (or OMP_NUM_THREADS), but
// not more than the particles keep busy. A thread with little to do costs more in waiting than it saves, most
// of all on a machine with other work.
int choose_threads(int asked, const coupling::Scene& scene);

// More than this is a mistake in the case, not a plan: numbers of particles and cells are 32-bit integers.
inline constexpr double kMaxParticles = 5e8;
inline constexpr double kMaxCells = 2e9;

}  // namespace polder::app
