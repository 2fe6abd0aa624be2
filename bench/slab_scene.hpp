// The scene of the speed benchmarks: a slab of soil in a box with smooth sides and a rough floor, pulled
// aside by gravity at 22 degrees to the vertical, so that all of it moves and Mohr-Coulomb soil yields nearly
// everywhere. SI units.
#pragma once

#include <string>

#include "coupling/scene.hpp"

namespace polder::bench {

struct Slab {
  int dimension = 2;
  bool plastic = false;    // Mohr-Coulomb, nearly without cohesion
  bool softening = false;  // its cohesion falls off with plastic strain
  coupling::StressOrder order = coupling::StressOrder::musl;
  coupling::Transfer transfer = coupling::Transfer::flip;
  mpm::ShapeKind shape = mpm::ShapeKind::gimp;
  bool cell_average = false;  // locking cure
  double points = 1e5;        // at least
  std::string formulation = "dry";
};

coupling::Scene make_scene(const Slab& slab);

// For instance "3D Mohr-Coulomb, flip, gimp".
std::string name_of(const Slab& slab);

}  // namespace polder::bench
