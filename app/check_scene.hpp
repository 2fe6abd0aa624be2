// Checks of a scene as a whole, once every key has been read: geometry, water against soil, sizes, names.
// Parts whose own keys are wrong are left out, so that one mistake gives one message.
#pragma once

#include <string>
#include <vector>

#include "app/reader.hpp"

namespace polder::app {

void check_scene(Reader& reader);

// The parts of check_scene().
void check_names(Reader& reader);  // also gives names to what has none
void check_bodies(Reader& reader);
void check_water(Reader& reader);
void check_boundaries(Reader& reader);
void check_measures(Reader& reader);

// Things that are right but that a user may want to know, such as keys the formulation does not need.
std::vector<std::string> notes(const coupling::Scene& scene);

}  // namespace polder::app
