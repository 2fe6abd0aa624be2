// What a formulation in which water has particles of its own needs, and what it cannot do yet.
#include "app/check_scene.hpp"

namespace polder::app {

using coupling::Scene;
using coupling::Stage;
using coupling::WaterBoundary;

namespace {

void check_water_of_layer(Reader& reader) {
  const Scene& scene = reader.scene;
  using Kind = WaterBoundary::Kind;
  for (std::size_t i = 0; i < scene.water_boundaries.size(); ++i) {
    const WaterBoundary& w = scene.water_boundaries[i];
    const std::string key = "water." + std::to_string(i + 1);
    const bool known = w.kind == Kind::head || w.kind == Kind::pressure || w.kind == Kind::impermeable ||
                       w.kind == Kind::surface;
    if (!known && !reader.failed(key))
      reader.error(key + ".kind", "not with formulation \"" + scene.formulation + "\"",
                   "head, pressure, impermeable, surface");
  }
  if (scene.water.outside_level && !reader.failed("pore_water.outside_level"))
    reader.error("pore_water.outside_level",
                 "in formulation \"" + scene.formulation + "\" open water has particles of its own",
                 "a [[water_body]]");
}

// Points that leave through one of two tied sides would have to come in through the other.
void check_boundaries_of_layer(Reader& reader) {
  const Scene& scene = reader.scene;
  for (std::size_t i = 0; i < scene.boundaries.size(); ++i) {
    const std::string key = "boundary." + std::to_string(i + 1) + ".kind";
    if (scene.boundaries[i].kind == coupling::Boundary::Kind::tied && !reader.failed(key))
      reader.error(key, "\"tied\" is not in this version for formulation \"" + scene.formulation + "\"",
                   "\"roller\", \"fixed\", \"friction\", \"free\", \"velocity\"");
  }
}

void check_stages_of_layer(Reader& reader) {
  const Scene& scene = reader.scene;
  for (std::size_t i = 0; i < scene.stages.size(); ++i) {
    const Stage& s = scene.stages[i];
    const std::string key = "stage." + std::to_string(i + 1);
    if (reader.failed(key)) continue;
    if (!s.moves())
      reader.error(key + ".mode", "formulation \"" + scene.formulation + "\" moves its water step by step",
                   "\"equilibrium\", \"dynamic\"; or formulation = \"one-layer\"");
    else if (!s.water_flows && (s.mode == Stage::Mode::dynamic || s.damping > 0))
      reader.error(key + ".water_flows", "the particles of water cannot be held while soil moves in time",
                   "true");
  }
}

// Laws other than Darcy's need the velocity of water points. Conductivities that scatter are Darcy's.
void check_drag(Reader& reader) {
  const Scene& scene = reader.scene;
  if (!coupling::find_formulation(scene.formulation) || scene.formulation == "dry") return;
  for (const coupling::Material& m : scene.materials) {
    const std::string key = "material." + m.name + ".drag_law";
    if (m.drag_law == coupling::DragLaw::darcy || m.porosity <= 0 || reader.failed(key)) continue;
    if (!scene.layered())
      reader.error(key, "formulation \"" + scene.formulation + "\" has Darcy's drag only",
                   "\"darcy\"; or formulation = \"two-layer\"");
  }
  for (const coupling::Material& m : scene.materials) {
    const std::string key = "material." + m.name + ".fluidisation_porosity";
    if (m.fluidisation_porosity == 0 || reader.failed(key)) continue;
    if (!scene.layered())
      reader.error(key, "formulation \"" + scene.formulation + "\" has no grains apart from their water",
                   "no fluidisation_porosity; or formulation = \"two-layer\"");
    else if (!m.drag_of_grains() && !reader.failed("material." + m.name + ".drag_law"))
      reader.error(key, "the drag law does not know grains without contact",
                   "drag_law = \"ergun\", \"gidaspow\" or \"di-felice\"");
  }
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const auto material = static_cast<std::size_t>(scene.bodies[i].material);
    if (material >= scene.materials.size()) continue;
    for (std::size_t k = 0; k < scene.bodies[i].random.size(); ++k) {
      const std::string key =
          "body." + std::to_string(i + 1) + ".random." + std::to_string(k + 1) + ".property";
      if (scene.materials[material].drag_law != coupling::DragLaw::darcy && !reader.failed(key) &&
          scene.bodies[i].random[k].property == coupling::RandomProperty::Property::conductivity)
        reader.error(key,
                     "the drag law of material \"" + scene.materials[material].name + "\" is not Darcy's",
                     "another property; or drag_law = \"darcy\"");
    }
  }
}

// Where solids are grains and no skeleton, they must say when they touch.
void check_grains(Reader& reader) {
  const Scene& scene = reader.scene;
  if (!scene.dispersed()) return;
  for (const coupling::Material& m : scene.materials) {
    const std::string key = "material." + m.name + ".fluidisation_porosity";
    if (m.porosity > 0 && m.fluidisation_porosity == 0 && !reader.failed(key))
      reader.error(
          key, "solids of formulation \"" + scene.formulation + "\" are grains, which touch at some porosity",
          "model = \"mohr-coulomb\" with a drag law of grains and a fluidisation_porosity; or "
          "formulation = \"two-layer\"");
  }
}

// Viscosity and sticking are for water with particles; what is inviscid cannot stick.
void check_shear(Reader& reader) {
  const Scene& scene = reader.scene;
  if (scene.water.viscous && !scene.layered() && !reader.failed("pore_water.viscous"))
    reader.error("pore_water.viscous",
                 "formulation \"" + scene.formulation + "\" has no particles of water that could shear",
                 "false; or formulation = \"two-layer\"");
  for (std::size_t i = 0; i < scene.boundaries.size(); ++i) {
    const coupling::Boundary& b = scene.boundaries[i];
    const std::string key = "boundary." + std::to_string(i + 1) + ".water";
    if (!b.is_wall() || b.water != coupling::Boundary::WaterContact::no_slip || reader.failed(key)) continue;
    if (!scene.layered())
      reader.error(key, "formulation \"" + scene.formulation + "\" has no particles of water to stick",
                   "\"slip\"; or formulation = \"two-layer\"");
    else if (!scene.water.viscous && !reader.failed("pore_water.viscous"))
      reader.error(key, "water without viscosity does not stick", "\"slip\"; or pore_water.viscous = true");
  }
}

}  // namespace

void check_water_layer(Reader& reader) {
  const Scene& scene = reader.scene;
  if (reader.failed("formulation")) return;
  if (scene.numerics.pressure == coupling::PressureMethod::compressible && !scene.compressible() &&
      !reader.failed("numerics.pressure"))
    reader.error("numerics.pressure",
                 "\"compressible\" is not in this version for formulation \"" + scene.formulation + "\"",
                 "\"projected\"; or formulation = \"two-layer\"");
  check_drag(reader);
  check_shear(reader);
  if (!scene.layered()) {
    if (!scene.water_bodies.empty() && !reader.failed("water_body"))
      reader.error("water_body.1",
                   "formulation \"" + scene.formulation + "\" has no particles of water to fill it with",
                   "formulation = \"two-layer\"");
    return;
  }
  check_grains(reader);
  check_water_of_layer(reader);
  check_boundaries_of_layer(reader);
  check_stages_of_layer(reader);
  for (const coupling::Material& m : scene.materials)
    if (const std::string key = "material." + m.name + ".retention"; m.retains() && !reader.failed(key))
      reader.error(
          key, "formulation \"" + scene.formulation + "\" has no unsaturated flow in this version",
          "no retention; pore_water.saturation_above, suction_above; or formulation = \"one-layer\"");
  if (coupling::find_formulation(scene.formulation)->inertia == coupling::RelativeInertia::neglected)
    for (const coupling::Material& m : scene.materials)
      if (const std::string key = "material." + m.name + ".density_solid";
          m.porosity > 0 && m.density_solid <= scene.water.density && !reader.failed(key))
        reader.error(key,
                     "grains not heavier than water with formulation \"" + scene.formulation +
                         "\", which neglects the inertia of the water relative to them",
                     "more than pore_water.density; or formulation = \"two-layer\"");
  if (scene.grid.space == Space::axisymmetric && !reader.failed("grid.space"))
    reader.error("grid.space",
                 "formulation \"" + scene.formulation + "\" is not in this version for an axisymmetric grid",
                 "\"plane-strain\", \"3d\"");
}

}  // namespace polder::app
