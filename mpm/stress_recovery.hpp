// Stress at the material points recovered from the means over cells.
//
// A shape function that is piecewise linear, as GIMP's is for points whose domain lies inside a cell, gives
// all points of a cell one strain. Where the true stress varies linearly the points miss it by the slope
// times their distance from the middle of the cell, a first-order error; the mean over the points is right to
// higher order there (superconvergence, as in Zienkiewicz & Zhu 1992). Recovery fits the slope to the means
// of the neighbouring cells, by least squares through the cell's own mean, and gives each point
//
//   sigma(x) = mean + slope . (x - centroid of the cell's points).
//
// Means over cells stay as they are, and a linear field is reproduced exactly wherever a cell has a neighbour
// along each axis. It is for reporting: the points' own stresses, which the law has made and which obey its
// yield criterion, do not change, and recovered ones may lie beyond the criterion next to a jump. Bodies are
// recovered one by one, since stress may jump between them. Tension positive [Pa].
#pragma once

#include <array>

#include "core/particles.hpp"

namespace polder::mpm {

// Components as ParticleSet::stress, one value a slot of the set; slots without a point get 0.
template <int D>
std::array<Reals, ParticleSet<D>::kStress> recover_stress(const Grid<D>& grid, const ParticleSet<D>& set);

}  // namespace polder::mpm
