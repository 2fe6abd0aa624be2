// Pore water against soil: what a wet formulation needs, the phreatic line, places where water enters.
#include <algorithm>
#include <cmath>

#include "app/check_scene.hpp"
#include "app/codecs.hpp"
#include "app/geometry.hpp"

namespace polder::app {
namespace {

using coupling::Body;
using coupling::Scene;
using coupling::Vector3;
using coupling::WaterBoundary;

bool is_porous(const Scene& scene, const Body& body) {
  const auto i = static_cast<std::size_t>(body.material);
  return i < scene.materials.size() && scene.materials[i].porosity > 0;
}

// Bodies whose shape could be read and whose material holds water.
std::vector<const Body*> porous_bodies(const Reader& reader) {
  std::vector<const Body*> list;
  for (std::size_t i = 0; i < reader.scene.bodies.size(); ++i)
    if (!reader.failed("body." + std::to_string(i + 1)) && is_porous(reader.scene, reader.scene.bodies[i]))
      list.push_back(&reader.scene.bodies[i]);
  return list;
}

bool bodies_are_sound(const Reader& reader) {
  return !reader.failed("body") && !reader.failed("material") && !reader.failed("grid") &&
         !reader.scene.bodies.empty();
}

void check_materials(Reader& reader) {
  const Scene& scene = reader.scene;
  bool any = false;
  for (const auto& m : scene.materials) {
    const std::string key = "material." + m.name;
    any = any || m.porosity > 0;
    if (m.porosity > 0 && m.hydraulic_conductivity == 0 && !m.drag_of_grains() &&
        !reader.failed(key + ".conductivity") && !reader.failed(key + ".porosity"))
      reader.error(
          key + ".conductivity",
          reader.given(key + ".conductivity")
              ? "0 in a porous material with formulation \"" + scene.formulation + "\""
              : "missing: the material is porous and the formulation is \"" + scene.formulation + "\"",
          "hydraulic conductivity greater than 0 [m/s]; or formulation = \"dry\"");
  }
  if (!any && !reader.failed("material") && !scene.materials.empty() && scene.water_bodies.empty())
    reader.error("formulation",
                 "\"" + scene.formulation + "\" without a porous material: there is nowhere for water to be",
                 "a material with porosity greater than 0; or formulation = \"dry\"");
}

void check_phreatic_line(Reader& reader) {
  const Scene& scene = reader.scene;
  const auto& line = scene.water.phreatic;
  const std::string key = "pore_water.phreatic";
  if (line.empty() || reader.failed(key)) return;
  for (std::size_t i = 1; i < line.size(); ++i)
    if (!(line[i][0] > line[i - 1][0])) {
      reader.error(
          key + "." + std::to_string(i + 1),
          "x = " + format_number(line[i][0]) + " does not follow x = " + format_number(line[i - 1][0]),
          "points from left to right");
      return;
    }
  if (scene.gravity == Vector3{} && !reader.failed("gravity"))
    reader.error(key, "a phreatic line without gravity", "gravity; or no phreatic line");
  if (!bodies_are_sound(reader)) return;
  for (const Body* body : porous_bodies(reader)) {
    const Extent e = extent(*body, scene.dimension());
    const double tolerance = 1e-9 * scene.grid.cell;
    if (e.lower[0] >= line.front()[0] - tolerance && e.upper[0] <= line.back()[0] + tolerance) continue;
    reader.error(
        key,
        "runs from x = " + format_number(line.front()[0]) + " to " + format_number(line.back()[0]) +
            " and does not cover body \"" + body->name + "\"",
        "x from " + format_number(e.lower[0]) + " or less to " + format_number(e.upper[0]) + " or more");
  }
}

// The part of a side, as an interval along each of the other axes.
Extent side_part(const Scene& scene, const WaterBoundary& w) {
  Extent e{scene.grid.origin, scene.grid.origin};
  for (std::size_t i = 0; i < 3; ++i) e.upper[i] += scene.grid.size[i];
  if (w.from && w.to)
    for (std::size_t i = 0; i < 3; ++i) {
      e.lower[i] = std::min((*w.from)[i], (*w.to)[i]);
      e.upper[i] = std::max((*w.from)[i], (*w.to)[i]);
    }
  return e;
}

// Whether a body has an edge (2D) or a face (3D) on the part of the side.
bool touches(const Body& body, const Scene& scene, int side, const Extent& part) {
  const auto axis = static_cast<std::size_t>(side / 2);
  const auto dimension = static_cast<std::size_t>(scene.dimension());
  const double at = scene.grid.origin[axis] + (side % 2 ? scene.grid.size[axis] : 0);
  const double tolerance = 1e-6 * scene.grid.cell;
  const auto overlaps = [&](const Vector3& lower, const Vector3& upper) {
    for (std::size_t i = 0; i < dimension; ++i)
      if (i != axis && std::min(upper[i], part.upper[i]) - std::max(lower[i], part.lower[i]) <= tolerance)
        return false;
    return true;
  };
  if (body.polygon.empty()) {
    const Extent e = extent(body, scene.dimension());
    const double face = side % 2 ? e.upper[axis] : e.lower[axis];
    return body.box && std::abs(face - at) <= tolerance && overlaps(e.lower, e.upper);
  }
  const Extent e = extent(body, scene.dimension());
  if (dimension == 3 && axis == 1) {  // an end of a prism
    const double end = side % 2 ? e.upper[1] : e.lower[1];
    const Polygon window{{part.lower[0], part.lower[2], 0},
                         {part.upper[0], part.lower[2], 0},
                         {part.upper[0], part.upper[2], 0},
                         {part.lower[0], part.upper[2], 0}};
    return std::abs(end - at) <= tolerance &&
           overlap_area(body.polygon, window) > tolerance * scene.grid.cell;
  }
  const std::size_t across = axis == 0 ? 0 : 1;  // in the plane of the polygon
  for (std::size_t i = 0; i < body.polygon.size(); ++i) {
    const Vector3 &a = body.polygon[i], &b = body.polygon[(i + 1) % body.polygon.size()];
    if (std::abs(a[across] - at) > tolerance || std::abs(b[across] - at) > tolerance) continue;
    Vector3 lower = e.lower, upper = e.upper;
    const std::size_t along = across == 1 ? 0 : dimension - 1;
    lower[along] = std::min(a[1 - across], b[1 - across]);
    upper[along] = std::max(a[1 - across], b[1 - across]);
    if (overlaps(lower, upper)) return true;
  }
  return false;
}

void check_water_boundaries(Reader& reader) {
  const Scene& scene = reader.scene;
  if (!bodies_are_sound(reader)) return;
  const std::vector<const Body*> bodies = porous_bodies(reader);
  for (std::size_t i = 0; i < scene.water_boundaries.size(); ++i) {
    const WaterBoundary& w = scene.water_boundaries[i];
    const std::string key = "water." + std::to_string(i + 1) + ".where";
    if (reader.failed(key) || !reader.given(key)) continue;
    if (w.side == WaterBoundary::kOnSurface) {
      if (w.kind == WaterBoundary::Kind::surface)
        reader.error("water." + std::to_string(i + 1) + ".kind", "the soil's surface is a surface already",
                     "another kind; or a side of the grid");
      continue;
    }
    const auto axis = static_cast<std::size_t>(w.side / 2);
    const double at = scene.grid.origin[axis] + (w.side % 2 ? scene.grid.size[axis] : 0);
    if (w.from && w.to &&
        (std::abs((*w.from)[axis] - at) > 1e-6 * scene.grid.cell ||
         std::abs((*w.to)[axis] - at) > 1e-6 * scene.grid.cell)) {
      reader.error(key, "from and to do not lie on the side \"" + side_name(w.side, scene.dimension()) + "\"",
                   std::string(1, "xyz"[axis]) + " = " + format_number(at));
      continue;
    }
    const Extent part = side_part(scene, w);
    const bool meets = scene.layered() || std::any_of(bodies.begin(), bodies.end(), [&](const Body* b) {
                         return touches(*b, scene, w.side, part);
                       });
    if (!meets)
      reader.error(key, "no porous soil touches the " + side_name(w.side, scene.dimension()) + " side here",
                   "a side of the grid on which a body of porous material lies");
  }
}

// A relaxation finds forces that balance for a water that stands; time for flow does not pass in it.
void check_relaxations(Reader& reader) {
  const auto& stages = reader.scene.stages;
  for (std::size_t i = 0; i < stages.size(); ++i) {
    const std::string key = "stage." + std::to_string(i + 1);
    if (stages[i].mode == coupling::Stage::Mode::equilibrium && stages[i].damping == 0 &&
        stages[i].water_flows && !reader.failed(key))
      reader.error(key + ".water_flows",
                   "in an equilibrium that is found by relaxation no time passes for water to flow",
                   "false; or a damping, for damped motion in time");
  }
}

// What needs retention curves, and what contradicts them.
void check_unsaturated(Reader& reader) {
  const Scene& scene = reader.scene;
  if (reader.failed("material") || reader.failed("formulation")) return;
  const bool unsaturated = scene.unsaturated();
  const std::string needed = "a material with a retention curve";
  for (std::size_t i = 0; i < scene.water_boundaries.size(); ++i) {
    using Kind = WaterBoundary::Kind;
    const WaterBoundary& w = scene.water_boundaries[i];
    const std::string key = "water." + std::to_string(i + 1);
    if (unsaturated || reader.failed(key)) continue;
    const bool needs_suction = w.kind == Kind::flux || w.kind == Kind::rain || w.kind == Kind::evaporation ||
                               w.kind == Kind::seepage_face;
    // check_water_layer(), check_water_on_points() say what they know
    if ((scene.layered() && needs_suction) || scene.on_points()) continue;
    if (needs_suction)
      reader.error(key + ".kind", "needs unsaturated flow, and no material has a retention curve", needed);
    else if (w.side == WaterBoundary::kOnSurface)
      reader.error(key + ".where",
                   "a part of the soil's surface needs unsaturated flow, and no material has a "
                   "retention curve",
                   needed + "; or a side of the grid");
  }
  for (std::size_t i = 0; i < scene.water_lines.size(); ++i) {
    const std::string key = "water_line." + std::to_string(i + 1);
    if (reader.failed(key)) continue;
    if (scene.on_points()) continue;
    if (!unsaturated)
      reader.error(key, "needs unsaturated flow, and no material has a retention curve", needed);
    else if (scene.dimension() == 3)
      reader.error(key, "lines in the soil are for grids in the plane", "space = \"plane-strain\"");
  }
  if (!unsaturated && scene.water.initial_saturation && !reader.failed("pore_water"))
    reader.error("pore_water.initial_saturation", "needs a retention curve, and no material has one",
                 needed + "; or saturation_above");
  // Nothing, which a resolved case says with a phreatic line, contradicts nothing.
  const std::pair<const char*, double> above[] = {{"saturation_above", scene.water.saturation_above},
                                                  {"suction_above", scene.water.suction_above}};
  if (unsaturated)
    for (const auto& [name, value] : above)
      if (const std::string key = std::string("pore_water.") + name;
          value != 0 && reader.given(key) && !reader.failed(key))
        reader.error(key, "contradicts the retention curves, which give saturation and suction",
                     "initial_saturation; or no retention");
  bool all = true, any = false;
  for (const auto& m : scene.materials)
    if (m.porosity > 0) all = all && m.kozeny_carman, any = any || m.kozeny_carman;
  for (const auto& m : scene.materials) {
    const std::string key = "material." + m.name;
    if (any && !all && m.kozeny_carman)
      reader.error(key + ".kozeny_carman", "other porous materials do not have it",
                   "the same for all porous materials");
    if (!m.anisotropy.empty() && static_cast<int>(m.anisotropy.size()) != scene.dimension() &&
        !reader.failed(key + ".anisotropy") && !reader.failed("grid"))
      reader.error(key + ".anisotropy", std::to_string(m.anisotropy.size()) + " factors",
                   std::to_string(scene.dimension()) + ", one for each axis");
    if (!m.anisotropy.empty() && !unsaturated && !reader.failed(key + ".anisotropy"))
      reader.error(key + ".anisotropy", "needs unsaturated flow, and no material has a retention curve",
                   needed);
  }
}

void check_cell_means(Reader& reader) {
  const Scene& scene = reader.scene;
  const std::string key = "numerics.cell_means";
  if (!scene.numerics.cell_means || reader.failed("numerics") || reader.failed("material")) return;
  if (!scene.unsaturated()) reader.error(key, "needs a retention curve, and no material has one", "false");
  for (const coupling::Stage& s : scene.stages)
    if (s.mode != coupling::Stage::Mode::seepage)
      return reader.error(key, "needs a rigid skeleton, and in stage \"" + s.name + "\" it is not",
                          "false; or stages of mode \"seepage\" alone");
}

void check_stages(Reader& reader) {
  const Scene& scene = reader.scene;
  const coupling::Formulation* f = coupling::find_formulation(scene.formulation);
  if (!f || reader.failed("formulation") || f->carrier != coupling::WaterCarrier::none) return;
  for (std::size_t i = 0; i < scene.stages.size(); ++i)
    if (!scene.stages[i].moves() && !reader.failed("stage." + std::to_string(i + 1)))
      reader.error("stage." + std::to_string(i + 1) + ".mode",
                   "formulation \"" + scene.formulation + "\" has no water to flow",
                   "equilibrium, dynamic; or another formulation");
}

// Where the pressure follows from the compression of the water, there must be some.
void check_compressibility(Reader& reader) {
  const Scene& scene = reader.scene;
  const std::string key = "pore_water.bulk_modulus";
  if (!scene.compressible() || std::isfinite(scene.water.bulk_modulus) || reader.failed(key)) return;
  reader.error(key,
               "incompressible water with formulation \"" + scene.formulation +
                   "\", whose pressure follows from the compression of the water",
               std::string("a finite bulk modulus; or ") +
                   (scene.layered() ? "numerics.pressure = \"projected\"" : "formulation = \"one-layer\""));
}

}  // namespace

void check_water(Reader& reader) {
  const coupling::Formulation* f = coupling::find_formulation(reader.scene.formulation);
  check_phreatic_line(reader);
  check_water_boundaries(reader);
  check_unsaturated(reader);
  check_cell_means(reader);
  check_stages(reader);
  if (!f || reader.failed("formulation") || f->carrier == coupling::WaterCarrier::none) return;
  check_materials(reader);
  check_compressibility(reader);
  check_relaxations(reader);
}

std::vector<std::string> notes(const Scene& scene) {
  std::vector<std::string> list;
  const coupling::Formulation* f = coupling::find_formulation(scene.formulation);
  if (f && f->carrier == coupling::WaterCarrier::none) {
    bool wet = !scene.water.phreatic.empty() || !scene.water_boundaries.empty() || scene.water.outside_level;
    for (const auto& m : scene.materials) wet = wet || m.hydraulic_conductivity > 0;
    if (wet)
      list.push_back("formulation \"" + scene.formulation +
                     "\" has no pore water: conductivity, pore_water and [[water]] are not used");
  }
  return list;
}

}  // namespace polder::app
