// Checks of a scene as a whole, once every key has been read: geometry, water against soil, sizes, names.
// Parts whose own keys are wrong are left out, so that one mistake gives one message.
#pragma once

#include <string>
#include <vector>

#include "app/geometry.hpp"
#include "app/reader.hpp"

namespace polder::app {

void check_scene(Reader& reader);

// The parts of check_scene().
void check_names(Reader& reader);  // also gives names to what has none
void check_bodies(Reader& reader);
void check_water(Reader& reader);
void check_water_layer(Reader& reader);
void check_water_on_points(Reader& reader);
void check_boundaries(Reader& reader);
void check_measures(Reader& reader);

// Whether every corner of a closed outline occurs once; reports the first that does not.
template <class Corner>
bool check_corners(const std::vector<Corner>& outline, const std::string& key, Reader& reader) {
  const std::size_t count = outline.size();
  for (std::size_t i = 0; i < count; ++i)
    if (outline[i] == outline[(i + 1) % count]) {
      reader.error(key,
                   i + 1 < count
                       ? "points " + std::to_string(i + 1) + " and " + std::to_string(i + 2) + " are the same"
                       : "the last point repeats the first",
                   "each corner once");
      return false;
    }
  return true;
}

// Whether no two edges of a plane outline cross or touch; reports the first two that do.
bool check_edges(const Polygon& outline, const std::string& key, Reader& reader);

// Things that are right but that a user may want to know, such as keys the formulation does not need.
std::vector<std::string> notes(const coupling::Scene& scene);

}  // namespace polder::app
