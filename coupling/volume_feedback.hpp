// What the change of the soil's volume asks of the pore water in quasi-static stages: the fixed-stress split
// of consolidation (Kim, Tchelepi & Juanes 2011, Comput. Methods Appl. Mech. Engrg. 200).
//
// Water flows through a skeleton that takes no notice, and equilibrium is sought under a pressure that takes
// none. The flow foresees what the skeleton will do: that it expands by c_s dp, the total mean stress being
// held. A relaxation then tells how much the pores have opened, and the difference between the two is taken
// from the water in the cell in the next step:
//   owed_c <- owed_c + sum_p o_pc S_p dV_p - foreseen_c,    foreseen_c = sum over steps of phi V S c_s dp
// with the share o_pc of point p in cell c. Undrained loading, of which the flow foresees nothing, comes to
// the water in this way, too. With c_s = 1 / (lambda + G), the compliance of plane strain, what is left of a
// difference after another round is a share between -1/2 and 1/2 of it in one dimension, in plane strain and
// in space, for every Poisson's ratio from 0 to 1/2.
//
// Volumes [m3] per metre of thickness in plane strain, per radian in axisymmetric scenes; positive: taken
// from the cell.
#pragma once

#include <vector>

#include "coupling/world.hpp"

namespace polder::coupling {

// Volume of each point, by body and number.
template <int D>
std::vector<Reals> point_volumes(const World<D>& world);

// At the start of a quasi-static stage, with cells up to date; one that follows another goes on.
template <int D>
void begin_feedback(World<D>& world);
// At the end of the last of them. Returns the water that was still owed.
template <int D>
double end_feedback(World<D>& world);

// After a relaxation from these volumes, with cells up to date. Returns the water of pores that lie in no
// active cell and beside none, for which there is none to ask.
template <int D>
double charge_volume(World<D>& world, const std::vector<Reals>& before);

// Of the active cells, in a step of this length: what is owed, but at most half of the water that the cell
// can give [m3/s].
template <int D>
const Reals& withdrawal(World<D>& world, double dt);
// After that step. before: pressure at its start.
template <int D>
void settle_withdrawal(World<D>& world, double dt, const Reals& before);

}  // namespace polder::coupling
