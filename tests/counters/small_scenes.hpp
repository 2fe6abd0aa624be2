// Small scenes whose steps are counted rather than timed: what a step takes in instructions, allocations and
// sorts does not depend on what else the machine does.
#pragma once

#include <functional>
#include <string_view>
#include <vector>

#include "bench/slab_scene.hpp"

namespace polder::counters {

struct SmallScene {
  const char* name;
  bench::Slab slab;
  bool bare = false;  // the skeleton's own loop, without balances, stages, choice of the step
};

const std::vector<SmallScene>& small_scenes();
const SmallScene* find_small_scene(std::string_view name);

// Builds the scene and makes that many steps; before_step(i) looks in between. Returns the number of points.
long make_steps(const SmallScene& scene, long steps, const std::function<void(long)>& before_step = {});

}  // namespace polder::counters
