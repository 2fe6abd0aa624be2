// What formulations with the pore water on the soil's own points (u-p, v-w) cannot do.
#include "app/check_scene.hpp"

namespace polder::app {

using coupling::Scene;
using coupling::Stage;
using coupling::WaterBoundary;

namespace {

std::string with_formulation(const Scene& scene) {
  return "formulation \"" + scene.formulation + "\"";
}

void check_water_of_points(Reader& reader) {
  const Scene& scene = reader.scene;
  using Kind = WaterBoundary::Kind;
  for (std::size_t i = 0; i < scene.water_boundaries.size(); ++i) {
    const WaterBoundary& w = scene.water_boundaries[i];
    const std::string key = "water." + std::to_string(i + 1);
    if (reader.failed(key)) continue;
    const bool known = w.kind == Kind::head || w.kind == Kind::pressure || w.kind == Kind::impermeable ||
                       w.kind == Kind::surface;
    if (!known)
      reader.error(key + ".kind", "not with " + with_formulation(scene),
                   "head, pressure, impermeable, surface");
    else if (w.side == WaterBoundary::kOnSurface)
      reader.error(key + ".where", "the soil's surface has no pressure but 0 in " + with_formulation(scene),
                   "a side of the grid");
  }
  if (scene.water.outside_level && !reader.failed("pore_water.outside_level"))
    reader.error("pore_water.outside_level", "no open water on the soil in " + with_formulation(scene),
                 "formulation = \"one-layer\"; or \"two-layer\" with a [[water_body]]");
  for (std::size_t i = 0; i < scene.water_lines.size(); ++i)
    if (const std::string key = "water_line." + std::to_string(i + 1); !reader.failed(key))
      reader.error(key, "not with " + with_formulation(scene), "formulation = \"one-layer\"");
}

// Inside the grid the weak form of the pressure presses the grains on a wall as if water were one of them.
void check_boundaries_of_points(Reader& reader) {
  const Scene& scene = reader.scene;
  using Kind = coupling::Boundary::Kind;
  for (std::size_t i = 0; i < scene.boundaries.size(); ++i) {
    const coupling::Boundary& b = scene.boundaries[i];
    const std::string key = "boundary." + std::to_string(i + 1) + ".kind";
    if (reader.failed(key)) continue;
    if (b.kind == Kind::tied)
      reader.error(key, "\"tied\" is not in this version for " + with_formulation(scene),
                   "\"roller\", \"fixed\", \"friction\", \"free\", \"velocity\"");
    else if (b.kind == Kind::friction && !b.side)
      reader.error(key, "friction inside the grid is not in this version for " + with_formulation(scene),
                   "a side of the grid; or \"roller\", \"fixed\"");
  }
}

void check_stages_of_points(Reader& reader) {
  const Scene& scene = reader.scene;
  for (std::size_t i = 0; i < scene.stages.size(); ++i) {
    const std::string key = "stage." + std::to_string(i + 1);
    if (!scene.stages[i].moves() && !reader.failed(key))
      reader.error(key + ".mode", with_formulation(scene) + " moves its water step by step",
                   "\"equilibrium\", \"dynamic\"; or formulation = \"one-layer\"");
  }
}

void check_numerics_of_points(Reader& reader) {
  const Scene& scene = reader.scene;
  if (scene.numerics.transfer != coupling::Transfer::flip && !reader.failed("numerics.transfer"))
    reader.error("numerics.transfer", "only a FLIP/PIC blend with " + with_formulation(scene), "\"flip\"");
  if (scene.numerics.point_pressure == coupling::PointPressure::mixed &&
      scene.grid.space == Space::axisymmetric && !reader.failed("numerics.point_pressure"))
    reader.error("numerics.point_pressure", "\"mixed\" is not in this version for an axisymmetric grid",
                 "\"cell-mean\", \"points\"");
}

}  // namespace

void check_water_on_points(Reader& reader) {
  const Scene& scene = reader.scene;
  if (reader.failed("formulation")) return;
  const coupling::Formulation* f = coupling::find_formulation(scene.formulation);
  const bool kept = f != nullptr && scene.on_points() && f->inertia == coupling::RelativeInertia::kept;
  const auto moves_water = [](const std::string& q) { return q.rfind("water_velocity", 0) == 0; };
  const std::string unknown = with_formulation(scene) + " has no velocity of the water at the points";
  for (std::size_t i = 0; i < scene.measures.size() && !kept; ++i)
    if (const std::string key = "measure." + std::to_string(i + 1) + ".quantity";
        moves_water(scene.measures[i].quantity) && !reader.failed(key))
      reader.error(key, unknown, "formulation = \"v-w\"");
  for (const std::string& name : scene.output.fields)
    if (moves_water(name) && !kept && !reader.failed("output.fields"))
      reader.error("output.fields", unknown, "formulation = \"v-w\"");
  if (!scene.on_points()) return;
  check_water_of_points(reader);
  check_boundaries_of_points(reader);
  check_stages_of_points(reader);
  check_numerics_of_points(reader);
  for (const coupling::Material& m : scene.materials) {
    const std::string key = "material." + m.name + ".retention";
    if (m.retains() && !reader.failed(key))
      reader.error(
          key, with_formulation(scene) + " has no unsaturated flow",
          "no retention; pore_water.saturation_above, suction_above; or formulation = \"one-layer\"");
  }
}

}  // namespace polder::app
