// Plane and solid geometry of bodies, for checks before anything is allocated. Lengths in metres.
#pragma once

#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "coupling/scene.hpp"

namespace polder::app {

using Polygon = std::vector<coupling::Vector3>;  // plane, first two components

// Area, positive if the corners run counter-clockwise.
double signed_area(const Polygon& polygon);

// Numbers (from 0) of two edges that are not neighbours and meet, or of neighbours that fold back on each
// other.
std::optional<std::pair<std::size_t, std::size_t>> crossing_edges(const Polygon& polygon);

// Area of the intersection of two polygons: exact, by slabs between all heights at which an edge begins, ends
// or crosses another one.
double overlap_area(const Polygon& a, const Polygon& b);

// Distance of a point from a polygon; 0 inside.
double distance(const Polygon& polygon, double x, double y);

// The outline of a plane body, in 3D the section (x, z) of a box or prism; a disk becomes an inscribed
// polygon of 128 corners.
Polygon outline(const coupling::Body& body, int dimension);

struct Extent {
  coupling::Vector3 lower{}, upper{};
};
Extent extent_of(const Polygon& polygon);
Extent extent(const coupling::Body& body, int dimension);

// Area in 2D (also axisymmetric), volume in 3D.
double measure(const coupling::Body& body, int dimension);

// Shared area or volume of two bodies; in 3D of a ball and another body only whether there is any (1 or 0).
double overlap(const coupling::Body& a, const coupling::Body& b, int dimension);

// Distance of a point from a body; 0 inside.
double distance(const coupling::Body& body, const coupling::Vector3& point, int dimension);

// Whether at least one particle position, the centres of the cells' equal parts, lies in the body.
bool holds_a_particle(const coupling::Body& body, const coupling::GridSpec& grid, int dimension);

}  // namespace polder::app
