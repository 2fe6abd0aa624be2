// Soil that water has lifted off itself: grains without contact carry no effective stress.
//
// A point of a material with a fluidisation porosity n_f is fluidised when its porosity exceeds n_f and its
// effective stress has vanished: less than kVanished of Young's modulus is left of the mean compression. From
// then on its stress is zero, and only drag (coupling/drag_law.hpp, which such a material has from its
// grains) and pressure move it. When its porosity has fallen to n_f again it has settled, and the material's
// law takes up from no stress. Grains dispersed in water (formulation mixture; Mackenzie-Helnwein et al.
// 2010, Shin 2010) are no skeleton that could keep a stress: there the porosity alone decides. Porosity is
// that of the point, from its mass and tracked volume; which points are fluid is part of the state.
#pragma once

#include "coupling/world.hpp"

namespace polder::coupling {

// Looks at all points and takes the stress of the fluidised ones away; after the points' stresses have been
// updated, and once at the start. Does nothing where no material can be fluidised.
template <int D>
void fluidise(World<D>& world);

// Share of the grains' mass that is fluidised [-].
template <int D>
double fluidised_share(const World<D>& world);

}  // namespace polder::coupling
