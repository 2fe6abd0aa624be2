// `polder seepage`: the water of a case alone, through a skeleton that does not move.
#pragma once

#include <string>
#include <vector>

#include "app/command_line.hpp"
#include "coupling/scene.hpp"

namespace polder::app {

// The case with a rigid skeleton. Seepage and quasi-static stages stay, with their duration or until the flow
// is steady; those of motion drop out. Where none is left there is one: steady flow under the conditions of
// time 0. What of measures and expectations has lost its meaning drops out too; remarks say so. InputError
// where the case has no water that flows.
coupling::Scene seepage_scene(const coupling::Scene& scene, std::vector<std::string>& remarks);

Command seepage_command();

}  // namespace polder::app
