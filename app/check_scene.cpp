#include "app/check_scene.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "app/codecs.hpp"
#include "app/columns.hpp"
#include "app/digits.hpp"
#include "app/geometry.hpp"
#include "coupling/quantities.hpp"
#include "coupling/sleep.hpp"
#include "mpm/plane_patch.hpp"

namespace polder::app {
namespace {

using coupling::Boundary;
using coupling::Scene;
using coupling::Vector3;

std::string item_key(const std::string& table, std::size_t i) {
  return table + "." + std::to_string(i + 1);
}

// What has no name is called after its table and number; two of one name cannot be told apart in results.
template <class T>
void check_names_of(std::vector<T>& list, const std::string& table, Reader& reader) {
  std::map<std::string, std::size_t> seen;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::string key = item_key(table, i) + ".name";
    if (list[i].name.empty()) list[i].name = table + "-" + std::to_string(i + 1);
    if (reader.failed(key)) continue;
    const auto [first, is_new] = seen.emplace(list[i].name, i);
    if (!is_new)
      reader.error(key, "\"" + list[i].name + "\" is also the name of " + item_key(table, first->second),
                   "a name of its own");
  }
}

double side_position(const Scene& scene, int side) {
  const auto axis = static_cast<std::size_t>(side / 2);
  return scene.grid.origin[axis] + (side % 2 ? scene.grid.size[axis] : 0);
}

bool is_load(Boundary::Kind kind) {
  return kind == Boundary::Kind::traction || kind == Boundary::Kind::pressure;
}

bool is_in_grid(const Scene& scene, const Vector3& p) {
  const double tolerance = 1e-6 * scene.grid.cell;
  for (std::size_t i = 0; i < static_cast<std::size_t>(scene.dimension()); ++i)
    if (p[i] < scene.grid.origin[i] - tolerance ||
        p[i] > scene.grid.origin[i] + scene.grid.size[i] + tolerance)
      return false;
  return true;
}

std::string point_text(const Vector3& p, int dimension) {
  std::string t = "[";
  for (std::size_t i = 0; i < static_cast<std::size_t>(dimension); ++i)
    t += (i > 0 ? ", " : "") + format_number(p[i]);
  return t + "]";
}

void check_segment(const Boundary& b, const std::string& key, Reader& reader) {
  const Scene& scene = reader.scene;
  const auto& [from, to] = *b.segment;
  if (scene.dimension() == 3 && !b.side) {
    reader.error(key, "from and to span no surface inside a 3d grid", "a side; or { polygon = [...] }");
    return;
  }
  if (from == to) {
    reader.error(key, "from and to are the same point", "two points");
    return;
  }
  if (reader.failed("grid")) return;
  for (const Vector3* p : {&from, &to}) {
    if (is_in_grid(scene, *p)) continue;
    reader.error(key, point_text(*p, scene.dimension()) + " lies outside the grid", "points of the grid");
    return;
  }
  if (!b.side) return;
  const auto axis = static_cast<std::size_t>(*b.side / 2);
  const double at = side_position(scene, *b.side), tolerance = 1e-6 * scene.grid.cell;
  if (std::abs(from[axis] - at) > tolerance || std::abs(to[axis] - at) > tolerance)
    reader.error(key, "from and to do not lie on the side \"" + side_name(*b.side, scene.dimension()) + "\"",
                 std::string(1, "xyz"[axis]) + " = " + format_number(at));
}

// The names hold those of boundaries, so they are known only when the whole case is.
void check_column(const coupling::Measure& m, std::size_t i, Reader& reader) {
  if (reader.failed("boundary") || reader.failed("water") || reader.failed("formulation")) return;
  std::vector<std::string> names, columns;
  for (const coupling::Quantity& q : coupling::history_quantities(reader.scene)) {
    names.push_back(q.name);
    columns.push_back(q.unit.empty() ? q.name : q.name + "[" + q.unit + "]");
  }
  if (find_column(columns, m.quantity).empty())
    reader.error(item_key("measure", i) + ".quantity",
                 "the history has no column \"" + m.quantity + "\"" + did_you_mean(m.quantity, names),
                 join(names));
}

// A polygon in space: plane, simple, inside the grid.
void check_patch(const Boundary& b, const std::string& key, Reader& reader) {
  const Scene& scene = reader.scene;
  const std::vector<Vector3>& p = b.polygon;
  if (!check_corners(p, key, reader)) return;
  double span = 0;
  for (const Vector3& x : p)
    span = std::max(span, std::hypot(x[0] - p[0][0], x[1] - p[0][1], x[2] - p[0][2]));
  const Vector3 area = mpm::vector_area(p);
  if (std::hypot(area[0], area[1], area[2]) <= 1e-12 * span * span) {
    reader.error(key, "the corners enclose no area", "corners in order around a surface");
    return;
  }
  const mpm::PlanePatch patch(p);
  for (std::size_t i = 0; i < p.size(); ++i)
    if (std::abs(patch.height(p[i])) > 1e-6 * span) {
      reader.error(key,
                   "the corners do not lie in one plane: point " + std::to_string(i + 1) + " is " +
                       digits(std::abs(patch.height(p[i])), 3) + " m off",
                   "a plane polygon; a curved surface in several");
      return;
    }
  Polygon plane;
  for (const Point<2>& x : patch.corners()) plane.push_back({x[0], x[1], 0});
  if (!check_edges(plane, key, reader) || reader.failed("grid")) return;
  for (const Vector3& x : p) {
    if (is_in_grid(scene, x)) continue;
    reader.error(key, point_text(x, 3) + " lies outside the grid", "points of the grid");
    return;
  }
}

// The unit of a measure, "-" or nothing where it has none.
std::string unit_of(const coupling::Measure& m, const Scene& scene) {
  using Kind = coupling::Measure::Kind;
  for (const coupling::Quantity& q : m.kind == Kind::history ? coupling::history_quantities(scene)
                                     : m.kind == Kind::cell || m.kind == Kind::cells
                                         ? coupling::cell_quantities()
                                         : coupling::particle_quantities())
    if (q.name == m.quantity.substr(0, m.quantity.find('['))) return q.unit;
  return "";
}

void check_units(const coupling::Measure& m, const std::string& expect, Reader& reader) {
  const std::string unit = unit_of(m, reader.scene);
  const Dimension due =
      unit.empty() || unit == "-" ? dimension::kNone : parse_quantity("1 " + unit).dimension;
  for (const char* name : {"value", "at_least", "at_most"}) {
    const std::string key = expect + "." + name;
    if (const auto given = reader.dimension_of(key); given && *given != due)
      reader.error(key, "is " + dimension_phrase(*given) + ", the measure is " + dimension_phrase(due),
                   due == dimension::kNone ? "a number"
                                           : "a number in " + plain_unit(due) + ", or a text with a unit");
  }
}

void check_stage(const std::string& name, const std::string& key, Reader& reader) {
  std::vector<std::string> stages;
  for (const coupling::Stage& stage : reader.scene.stages) stages.push_back(stage.name);
  if (std::find(stages.begin(), stages.end(), name) == stages.end())
    reader.error(key, "the case has no stage \"" + name + "\"" + did_you_mean(name, stages), join(stages));
}

// A factor of safety is one number at one moment.
void check_factor(const coupling::Expectation& e, const std::string& expect, Reader& reader) {
  for (const char* name : {"reference", "time", "from_stage"})
    if (reader.given(key_path(expect, name)))
      reader.error(key_path(expect, name), "does not apply here",
                   "value, at_least or at_most; the moment is that of the measure");
  if (reader.given(key_path(expect, "norm")) && e.norm != "last")
    reader.error(key_path(expect, "norm"), "a factor of safety is one number", "last");
}

}  // namespace

void check_names(Reader& reader) {
  Scene& s = reader.scene;
  check_names_of(s.bodies, "body", reader);
  check_names_of(s.water_bodies, "water_body", reader);
  check_names_of(s.boundaries, "boundary", reader);
  check_names_of(s.water_boundaries, "water", reader);
  check_names_of(s.water_lines, "water_line", reader);
  check_names_of(s.stages, "stage", reader);
  check_names_of(s.measures, "measure", reader);
}

void check_boundaries(Reader& reader) {
  const Scene& scene = reader.scene;
  std::map<int, std::size_t> whole_side;
  for (std::size_t i = 0; i < scene.boundaries.size(); ++i) {
    const Boundary& b = scene.boundaries[i];
    const std::string key = item_key("boundary", i) + ".where";
    if (reader.failed(key) || !reader.given(key)) continue;
    if (b.segment) check_segment(b, key, reader);
    if (!b.polygon.empty()) check_patch(b, key + ".polygon", reader);
    const bool space = scene.dimension() == 3;
    if (is_load(b.kind) && (space ? b.polygon.empty() : !b.segment))
      reader.error(key, "a load needs the part of the soil's surface it acts on",
                   space ? "{ polygon = [[x, y, z], ...] }" : "{ from = [x, y], to = [x, y] }");
    if (b.kind == Boundary::Kind::free && !b.side && !reader.failed(item_key("boundary", i) + ".kind"))
      reader.error(key, "inside the grid nothing holds the soil that could be set free",
                   "a side; or side, from and to");
    if (b.kind == Boundary::Kind::tied && !reader.failed(item_key("boundary", i) + ".kind")) {
      const bool axis = scene.grid.space == Space::axisymmetric;
      if (!b.side || b.segment || *b.side / 2 == scene.dimension() - 1 || axis)
        reader.error(key, "only whole sides across from each other can be tied",
                     axis    ? "plane strain or 3D"
                     : space ? "\"left\" or \"front\""
                             : "\"left\"");
      else
        whole_side.emplace(*b.side ^ 1, i);
    }
    if (!b.side || b.segment || is_load(b.kind)) continue;
    const auto [first, is_new] = whole_side.emplace(*b.side, i);
    if (!is_new)
      reader.error(key,
                   "the " + side_name(*b.side, scene.dimension()) + " side already has " +
                       item_key("boundary", first->second),
                   "one constraint for each side, or for each part of it");
  }
}

void check_measures(Reader& reader) {
  using Kind = coupling::Measure::Kind;
  const Scene& scene = reader.scene;
  for (std::size_t i = 0; i < scene.measures.size(); ++i) {
    const auto& m = scene.measures[i];
    if (m.kind == Kind::body && !reader.failed(item_key("measure", i)) && !reader.failed("body")) {
      std::vector<std::string> bodies;
      for (const auto& body : scene.bodies) bodies.push_back(body.name);
      if (std::find(bodies.begin(), bodies.end(), m.body) == bodies.end())
        reader.error(item_key("measure", i) + ".body",
                     "the case has no body \"" + m.body + "\"" + did_you_mean(m.body, bodies), join(bodies));
    }
    if (m.kind == Kind::history && !reader.failed(item_key("measure", i))) check_column(m, i, reader);
    if (m.kind == Kind::stability && !m.stage.empty())
      check_stage(m.stage, item_key("measure", i) + ".stage", reader);
    const std::string key = item_key("measure", i) + ".at";
    if (m.kind == Kind::history || reader.failed("grid") || !reader.given(key) || reader.failed(key))
      continue;
    if (!is_in_grid(scene, m.at)) {
      reader.error(key, point_text(m.at, scene.dimension()) + " lies outside the grid",
                   "a point of the grid");
      continue;
    }
    if (m.kind != Kind::particle || reader.failed("body")) continue;
    // The nearest particle is followed; a point far from all soil is a mistake.
    double nearest = std::numeric_limits<double>::infinity();
    for (const auto& body : scene.bodies)
      nearest = std::min(nearest, distance(body, m.at, scene.dimension()));
    if (nearest > scene.grid.cell)
      reader.error(key, "no body at " + point_text(m.at, scene.dimension()),
                   "a point in a body, or within a cell of it");
  }
  std::vector<std::string> names;
  for (const auto& m : scene.measures) names.push_back(m.name);
  for (std::size_t i = 0; i < scene.expectations.size(); ++i) {
    const auto& e = scene.expectations[i];
    const std::string key = item_key("expect", i) + ".measure";
    if (reader.failed(key) || !reader.given(key)) continue;
    const auto measure = std::find_if(scene.measures.begin(), scene.measures.end(),
                                      [&](const auto& m) { return m.name == e.measure; });
    if (measure == scene.measures.end())
      reader.error(key, "the case has no measure \"" + e.measure + "\"" + did_you_mean(e.measure, names),
                   names.empty() ? "[[measure]]" : join(names));
    else if (measure->is_profile() && (e.norm == "last" || e.norm == "change") &&
             !reader.failed(item_key("expect", i)))
      reader.error(item_key("expect", i) + (reader.given(item_key("expect", i) + ".norm") ? ".norm" : ""),
                   "a profile has many values, none is the first or last",
                   "norm = \"l2\", \"max\" with a reference; "
                   "\"largest\", \"smallest\", \"magnitude\", \"mean\"");
    if (measure != scene.measures.end() && !reader.failed(item_key("expect", i))) {
      check_units(*measure, item_key("expect", i), reader);
      if (measure->kind == Kind::stability) check_factor(e, item_key("expect", i), reader);
    }
    if (!e.from_stage.empty()) check_stage(e.from_stage, item_key("expect", i) + ".from_stage", reader);
  }
}

void check_sleep(Reader& reader) {
  if (!reader.scene.numerics.sleep || reader.failed("numerics") || reader.failed("formulation") ||
      reader.failed("stage") || reader.failed("material") || reader.failed("gravity"))
    return;
  if (const char* why = coupling::keeps_awake(reader.scene))
    reader.error("numerics.sleep", std::string("soil cannot sleep here: ") + why, "false");
}

void check_scene(Reader& reader) {
  check_names(reader);
  check_bodies(reader);
  check_water(reader);
  check_water_layer(reader);
  check_water_on_points(reader);
  check_boundaries(reader);
  check_measures(reader);
  check_sleep(reader);
  const Vector3& g = reader.scene.gravity;
  if (reader.scene.grid.space == Space::axisymmetric && g[0] != 0 && !reader.failed("gravity"))
    reader.error("gravity", "gravity across the axis of an axisymmetric grid", "[0, gy]");
}

}  // namespace polder::app
