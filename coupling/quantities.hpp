// What can be measured and drawn: the names a case may use in [[measure]] and in [output] fields, and the
// names the probes, frames and histories carry. The case reader offers exactly these; the observers must
// provide each of them.
//
// Signs: stresses are effective and positive in tension, except mean_effective_stress p' = -tr(sigma')/3
// (positive in compression) and deviatoric_stress q = sqrt(3 J2); pore pressure is positive in compression.
#pragma once

#include <string>
#include <vector>

#include "coupling/scene.hpp"

namespace polder::coupling {

struct Quantity {
  std::string name;
  std::string unit;
};

const std::vector<Quantity>& particle_quantities();  // scalars of one particle, for [[measure]]
const std::vector<Quantity>& cell_quantities();      // scalars of one cell, for [[measure]]
const std::vector<Quantity>& frame_quantities();     // fields of the soil's frames
// Columns of a scene's history, in their order: what Simulation::history() will give.
std::vector<Quantity> history_quantities(const Scene& scene);

// Then the history tells of its searches for equilibrium.
bool has_quasi_static_stage(const Scene& scene);

}  // namespace polder::coupling
