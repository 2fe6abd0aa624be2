// The declarations of all keys of a case file, table by table.
#pragma once

#include "app/declare.hpp"

namespace polder::app {

const Table<coupling::Scene>& case_keys();

const Table<coupling::GridSpec>& grid_keys();
const Table<coupling::NumericsSpec>& numerics_keys();
const Table<coupling::WaterSpec>& pore_water_keys();
const Table<coupling::Material>& material_keys();
const Table<coupling::Body>& body_keys();
const Table<coupling::Body>& water_body_keys();
const Table<coupling::Boundary>& boundary_keys();
const Table<coupling::WaterBoundary>& water_keys();
const Table<coupling::WaterLine>& water_line_keys();
const Table<coupling::Stage>& stage_keys();
const Table<coupling::Measure>& measure_keys();
const Table<coupling::Expectation>& expect_keys();
const Table<coupling::OutputSpec>& output_keys();

// The name of a soil of the catalogue, or a table; nothing: saturated at any pressure.
Codec<fdm::Retention> retention();

}  // namespace polder::app
