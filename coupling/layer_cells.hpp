// Cells of two layers: how full of water they are, porosity and drag, from the volumes of both layers in
// them (docs/theory/two-layer.md, "Cells").
#pragma once

#include "core/aligned.hpp"
#include "core/simd_level.hpp"

namespace polder::coupling {

inline constexpr double kLeastPorosity = 0.05;

// Arrays over slots; of the soil four numbers a cell (mpm::scatter_cells).
struct LayerCells {
  const double* soil;   // sums of the soil: {V, V of grains, conductivity * V, mass of retained water}
  const double* water;  // volume of the water [m3]
  int slots;
  double cell_volume;     // [m3]
  const double* volumes;  // of every cell, where they differ (axisymmetry), else null [m3]
  double unit_weight;     // of water [N/m3]
  double per_density;     // of the water that grains retain, inverse; 0: none does [m3/kg]
  bool kozeny_carman;     // conductivity is the points' times n^3 / (1 - n)^2
  // Found: fill with water, porosity of the mixture, share taken by soil, part of that soil which lies in
  // water, drag per volume of water [Pa s/m2], volume of grains with the water they retain [m3], share of the
  // water that is in pores (may be null).
  double *fill, *porosity, *soil_fill, *submerged, *drag, *grain_volume, *in_pores;
};

}  // namespace polder::coupling

namespace polder {
POLDER_SIMD_DECLARE(void, find_layer_cells, const coupling::LayerCells&)
}
