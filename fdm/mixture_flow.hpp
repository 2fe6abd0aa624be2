// Volume flow of a mixture of grains and water that move each with a velocity of its own: what the pressure
// equation needs in place of one velocity and one mobility.
//
// On a face of porosity n (the mean of its two cells, the cell's own at boundaries) the mixture flows with
//   u = (1 - n) v + n w,
// v and w the means of the face's nodes, and a unit pressure gradient changes that by the mobility
//   (1 - n) s + n r,
// s and r the nodal responses of grains and water along the face's axis, drag between them included
// (coupling/two_layer.hpp). Nodes that carry neither have no response and are left out of the mean.
#pragma once

#include <span>

#include "core/aligned.hpp"
#include "fdm/water_cells.hpp"

namespace polder::fdm {

// Spans over slots; vectors have NodeGradient::kStride numbers a slot.
struct MixtureMotion {
  std::span<const double> grains, water;                    // predicted velocities of the nodes [m/s]
  std::span<const double> grains_response, water_response;  // to a unit pressure gradient, along each axis
  std::span<const double> porosity;                         // of the cells: volume not taken by grains [-]
};

// Volume flow along the axis through each face, interior ones first [m3/s], and its mobility [m3 s/kg]; of
// each active cell the sum of the flows out of it, moving walls included [m3/s].
template <int D>
void mixture_flow(const WaterCells<D>& cells, const MixtureMotion& motion, Reals& flow, Reals& mobility,
                  Reals& divergence);

// Volume flow outwards through one boundary face [m3/s].
template <int D>
double mixture_outflow(const WaterCells<D>& cells, const MixtureMotion& motion, const BoundaryFace<D>& face);

}  // namespace polder::fdm
