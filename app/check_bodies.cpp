// Bodies: their shapes, where they lie, whether they overlap, and how many particles they make.
#include <algorithm>
#include <cmath>

#include "app/check_scene.hpp"
#include "app/codecs.hpp"
#include "app/digits.hpp"
#include "app/geometry.hpp"
#include "app/size_estimate.hpp"
#include "mpm/material/material.hpp"

namespace polder::app {
namespace {

using coupling::Body;
using coupling::Scene;
using coupling::Vector3;

std::string body_key(std::size_t i) {
  return "body." + std::to_string(i + 1);
}

// The key that holds the shape of a body that stands at `key`.
std::string shape_key(const Body& body, const std::string& key) {
  return key + (body.box ? ".box" : body.centre ? ".centre" : ".polygon");
}

// Numbers in messages: enough digits to find the place.
std::string rounded(double value) {
  return digits(value, 5);
}

bool check_polygon(const Body& body, const std::string& key, Reader& reader) {
  const Polygon& p = body.polygon;
  if (!check_corners(p, key, reader)) return false;
  const double area = std::abs(signed_area(p));
  const Extent e = extent_of(p);
  const double span = std::max(e.upper[0] - e.lower[0], e.upper[1] - e.lower[1]);
  if (area <= 1e-12 * span * span) {
    reader.error(key, "empty body: its corners lie on one line", "corners that enclose an area");
    return false;
  }
  return check_edges(p, key, reader);
}

bool check_place(const Body& body, const std::string& key, Reader& reader) {
  const coupling::GridSpec& grid = reader.scene.grid;
  const int dimension = reader.scene.dimension();
  const Extent e = extent(body, dimension);
  if (grid.space == Space::axisymmetric && e.lower[0] < 0) {
    reader.error(
        key, "the body begins at x = " + rounded(e.lower[0]) + ", beyond the axis of an axisymmetric grid",
        "x of at least 0");
    return false;
  }
  if (reader.failed("grid")) return true;
  const double tolerance = 1e-9 * grid.cell;
  for (std::size_t i = 0; i < static_cast<std::size_t>(dimension); ++i) {
    const double lower = grid.origin[i], upper = grid.origin[i] + grid.size[i];
    if (e.lower[i] >= lower - tolerance && e.upper[i] <= upper + tolerance) continue;
    const std::string axis(1, "xyz"[i]);
    reader.error(key,
                 "body outside the grid: " + axis + " from " + rounded(e.lower[i]) + " to " +
                     rounded(e.upper[i]) + " m",
                 axis + " from " + rounded(lower) + " to " + rounded(upper) + " m");
    return false;
  }
  return true;
}

void check_overlaps(const std::vector<bool>& sound, Reader& reader) {
  const Scene& scene = reader.scene;
  const double cell = std::pow(scene.grid.cell, scene.dimension());
  for (std::size_t j = 1; j < scene.bodies.size(); ++j)
    for (std::size_t i = 0; i < j; ++i) {
      if (!sound[i] || !sound[j]) continue;
      const double shared = overlap(scene.bodies[i], scene.bodies[j], scene.dimension());
      if (shared <= 1e-6 * cell) continue;
      const bool sized = scene.dimension() == 2 || !(scene.bodies[i].centre || scene.bodies[j].centre);
      reader.error(
          shape_key(scene.bodies[j], body_key(j)),
          "overlaps body \"" + scene.bodies[i].name + "\"" +
              (sized ? " by " + rounded(shared) + (scene.dimension() == 3 ? " m3" : " m2") : std::string()),
          "bodies that touch at most");
    }
}

void check_size(Reader& reader) {
  const SizeEstimate size = estimate_size(reader.scene);
  const std::string cells = "; a larger grid.cell";
  if (size.particles > kMaxParticles)
    reader.error("grid.cell",
                 "the bodies make about " + digits(size.particles, 2) + " particles, " +
                     digits(size.memory / 1e9, 2) + " GB of memory",
                 "at most " + format_number(kMaxParticles) + " particles" + cells);
  else if (size.cells > kMaxCells)
    reader.error("grid.cell", "the grid has about " + digits(size.cells, 2) + " cells",
                 "at most " + format_number(kMaxCells) + " cells" + cells);
}

void check_initial_stress(const Body& body, std::size_t i, Reader& reader) {
  if (body.stress.kind != coupling::InitialStress::Kind::k0 || reader.failed("gravity")) return;
  const Vector3& g = reader.scene.gravity;
  const std::size_t up = static_cast<std::size_t>(reader.scene.dimension()) - 1;
  const std::string key = body_key(i) + ".initial.stress";
  if (g == Vector3{})
    reader.error(key, "k0 without gravity: the weight that makes the stress is missing",
                 "gravity; or none, field");
  else if (!(g[up] < 0) || g[0] != 0 || (up == 2 && g[1] != 0))
    reader.error(key, "k0 needs gravity straight down", "gravity along the last axis; or none, field");
}

// A property that the body's material has, and each at most once.
void check_random(const Body& body, std::size_t i, Reader& reader) {
  using Property = coupling::RandomProperty::Property;
  using Model = mpm::MaterialModel;
  const Scene& scene = reader.scene;
  if (reader.failed(body_key(i) + ".material") || body.material >= static_cast<int>(scene.materials.size()))
    return;
  const coupling::Material& m = scene.materials[body.material];
  for (std::size_t r = 0; r < body.random.size(); ++r) {
    const coupling::RandomProperty& random = body.random[r];
    const std::string key = body_key(i) + ".random." + std::to_string(r + 1) + ".property";
    if (reader.failed(key) || !reader.given(key)) continue;
    for (std::size_t earlier = 0; earlier < r; ++earlier)
      if (body.random[earlier].property == random.property)
        reader.error(key, "the body has a field of this property already", "each property once");
    const bool undrained = m.model == Model::von_mises || m.model == Model::tresca;
    const bool frictional = random.property == Property::cohesion || random.property == Property::friction;
    if (frictional && m.model != Model::mohr_coulomb)
      reader.error(key, "material \"" + m.name + "\" has no such strength", "model = \"mohr-coulomb\"");
    else if (random.property == Property::cohesion && mpm::range_of(m.cohesion).highest == 0)
      reader.error(key, "material \"" + m.name + "\" has no cohesion to scatter",
                   "a cohesion greater than 0");
    else if (random.property == Property::friction && mpm::range_of(m.friction).highest == 0)
      reader.error(key, "material \"" + m.name + "\" has no friction to scatter",
                   "a friction angle greater than 0");
    else if (random.property == Property::shear_strength && !undrained)
      reader.error(key, "material \"" + m.name + "\" has no undrained strength",
                   "model = \"von-mises\" or \"tresca\"");
    else if (random.property == Property::conductivity &&
             ((m.hydraulic_conductivity == 0 && !m.drag_of_grains()) || scene.formulation == "dry"))
      reader.error(key, "no water flows through material \"" + m.name + "\"",
                   "a conductivity greater than 0 and a formulation with water");
  }
}

// Whether the shape of the body at `key` is one that lies in the grid and holds a particle.
bool check_shape(const Body& body, const std::string& key, Reader& reader) {
  const Scene& scene = reader.scene;
  const std::string shape = shape_key(body, key);
  const bool shaped = body.box || body.centre || !body.polygon.empty();
  if (!shaped || reader.failed(shape) || reader.failed("grid.space") || !reader.given(shape) ||
      (body.centre && reader.failed(key + ".radius")) || reader.failed(key + ".extrude"))
    return false;
  if ((!body.polygon.empty() && !check_polygon(body, shape, reader)) || !check_place(body, shape, reader))
    return false;
  if (reader.failed("grid") || reader.failed(key + ".particles_per_cell") ||
      holds_a_particle(body, scene.grid, scene.dimension()))
    return true;
  reader.error(shape, "empty body: no particle lies in it",
               "a body larger than a particle's share of a cell; a smaller grid.cell");
  return false;
}

}  // namespace

bool check_edges(const Polygon& p, const std::string& key, Reader& reader) {
  if (const auto crossing = crossing_edges(p)) {
    const auto edge = [&](std::size_t i) {
      return std::to_string(i + 1) + "-" + std::to_string((i + 1) % p.size() + 1);
    };
    reader.error(key,
                 "the edges " + edge(crossing->first) + " and " + edge(crossing->second) + " cross or touch",
                 "a polygon whose edges meet at its corners only");
    return false;
  }
  return true;
}

void check_bodies(Reader& reader) {
  const Scene& scene = reader.scene;
  for (std::size_t i = 0; i < scene.water_bodies.size(); ++i)
    check_shape(scene.water_bodies[i], "water_body." + std::to_string(i + 1), reader);
  std::vector<bool> sound(scene.bodies.size(), false);
  bool all_sound = !scene.bodies.empty();
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const Body& body = scene.bodies[i];
    sound[i] = check_shape(body, body_key(i), reader);
    if (!reader.failed(body_key(i) + ".initial")) check_initial_stress(body, i, reader);
    check_random(body, i, reader);
    all_sound = all_sound && sound[i];
  }
  if (reader.failed("grid")) return;
  check_overlaps(sound, reader);
  if (all_sound) check_size(reader);
}

}  // namespace polder::app
