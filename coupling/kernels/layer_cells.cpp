// Cells of two layers in packs: lane = cell.
#include "coupling/layer_cells.hpp"

#include "core/simd.hpp"
#include "core/threads.hpp"

namespace polder::POLDER_SIMD_NAMESPACE {
namespace {

using coupling::kLeastPorosity;
using coupling::LayerCells;

// What the pack of cells that begins at slot i holds.
struct Contents {
  Pack soil, grains, grains_retained, conducting, water;  // the third with what grains retain

  POLDER_INLINE Contents(const LayerCells& c, int i) {
    Reg<4> rows[kLanes];
    Pack fields[4];
    for (int l = 0; l < kLanes; ++l) rows[l] = Reg<4>::load(c.soil + static_cast<std::size_t>(i + l) * 4);
    to_packs<4>(rows, fields);
    water = load(c.water + i);
    soil = fields[0], grains = fields[1], conducting = fields[2];
    grains_retained = grains + fields[3] * c.per_density;
  }
  POLDER_INLINE bool nothing() const { return !any(((soil + grains_retained) + water) > 0); }
};

POLDER_INLINE void leave_empty(const LayerCells& c, int i) {
  for (double* field : {c.fill, c.soil_fill, c.submerged, c.drag, c.grain_volume}) store(field + i, Pack{});
  store(c.porosity + i, broadcast(1.0));
  if (c.in_pores != nullptr) store(c.in_pores + i, Pack{});
}

POLDER_INLINE void find_pack(const LayerCells& c, int i) {
  const Contents in(c, i);
  if (in.nothing()) return leave_empty(c, i);
  const Pack volume = c.volumes != nullptr ? load(c.volumes + i) : broadcast(c.cell_volume);
  const Mask some = in.soil > 1e-9 * volume;
  const Pack soil_fill = in.soil / volume;
  const Pack pores =  // of soil, for it
      select(some, clamp(1.0 - in.grains_retained / in.soil, kLeastPorosity, 1.0), broadcast(1.0));
  // Water fills the pores first, then the space beside and above the soil.
  const Pack room = pores * soil_fill * volume;
  const Pack own = min(soil_fill, 1.0);
  const Pack fill = select(in.water <= room, in.water / (pores * volume), own + (in.water - room) / volume);
  // Of the mixture: of soil where it ends with the water, of both where water stands above it.
  const Pack mixture = volume * clamp(max(soil_fill, fill), 1e-9, 1.0);
  const Pack porosity = clamp(1.0 - in.grains_retained / mixture, kLeastPorosity, 1.0);
  Pack conductivity = select(some, in.conducting / in.soil, Pack{});
  if (c.kozeny_carman) {
    const Pack n = clamp(1.0 - in.grains / in.soil, kLeastPorosity, 1.0);
    conductivity = select(some, conductivity * (n * n * n / ((1.0 - n) * (1.0 - n))), Pack{});
  }
  const Mask conducts = conductivity > 0;
  // What makes the head lost across a layer of soil in the cell right: its share of the mixture, and water
  // that is slower by the ratio of the porosities than in the layer.
  const Pack in_mixture = min(soil_fill * volume / mixture, 1.0);
  const Pack layer_share = in_mixture * porosity / pores;
  store(c.fill + i, fill);
  store(c.porosity + i, porosity);
  store(c.soil_fill + i, own);
  store(c.grain_volume + i, in.grains_retained);
  // Pressure pushes the grains of the soil that lies in water.
  store(c.submerged + i, select(own > 0, min(fill / own, 1.0), Pack{}));
  store(c.drag + i, select(conducts, layer_share * pores * c.unit_weight / conductivity, Pack{}));
  if (c.in_pores != nullptr)
    store(c.in_pores + i, select(conducts, min(in_mixture * pores / porosity, 1.0), Pack{}));
}

}  // namespace

void find_layer_cells(const LayerCells& c) {
  parallel_for(c.slots / kLanes, [&](int pack) { find_pack(c, pack * kLanes); });
}

}  // namespace polder::POLDER_SIMD_NAMESPACE
