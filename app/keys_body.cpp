// Bodies with their initial state, and the boundaries that hold or load them.
#include <cmath>

#include "app/case_keys.hpp"
#include "app/codecs.hpp"

namespace polder::app {

using coupling::Body;
using coupling::Boundary;
using coupling::InitialStress;
using coupling::RandomProperty;
using coupling::Scene;
using coupling::TimeTable;
using coupling::Vector3;

namespace {

using Stress = std::array<double, 6>;

// [xx, yy, zz, xy] in 2D, [xx, yy, zz, xy, yz, zx] in 3D.
Codec<Stress> stress_components(const Dimension& dimension) {
  const Codec<double> one = number(dimension);
  Codec<Stress> c;
  c.type = "[xx, yy, zz, xy], in 3D [xx, yy, zz, xy, yz, zx], each a " + one.type;
  c.schema = Node::table();
  c.schema.set("type", Node::of("array"));
  c.schema.set("items", one.schema);
  c.read = [one](const Node& n, const std::string& key, Stress& s, Reader& reader) {
    const int d = reader.dimension();
    const std::size_t due = d == 3 ? 6 : 4;
    if (!n.is(Node::Kind::array) || (d > 0 && n.items.size() != due) || n.items.size() > 6) {
      reader.error(key, "expected stress components, found " + n.description(),
                   due == 6 ? "[xx, yy, zz, xy, yz, zx]" : "[xx, yy, zz, xy]");
      return false;
    }
    Stress read{};
    std::size_t i = 0;
    const bool good = read_list(
        n, key, "stress components", reader,
        [&](const Node& item, const std::string& k) { return one.read(item, k, read[i++], reader); });
    s = read;
    return good;
  };
  c.write = [one](const Stress& s, const Scene& scene) {
    Node n = Node::array();
    for (std::size_t i = 0; i < (scene.dimension() == 3 ? 6u : 4u); ++i)
      n.items.push_back(one.write(s[i], scene));
    return n;
  };
  return c;
}

const Table<InitialStress>& initial_keys() {
  using Kind = InitialStress::Kind;
  static const Table<InitialStress> table = [] {
    using I = InitialStress;
    const auto k0 = [](const I& i) { return i.kind == Kind::k0; };
    const auto field = [](const I& i) { return i.kind == Kind::field; };
    Table<I> t;
    t.add("stress", choice<Kind>({{"none", Kind::none}, {"k0", Kind::k0}, {"field", Kind::field}}), &I::kind,
          "Initial effective stress: none; k0: weight of the soil above, k0 times that horizontally; field: "
          "given.");
    t.add("k0", numbers(dimension::kNone, kNotNegative), &I::k0,
          "Horizontal to vertical effective stress; a list has one for each layer, from the top.")
        .only_with("stress", "stress = \"k0\"", k0)
        .required();
    t.add("layers", numbers(dimension::kLength, kPositive), &I::layer_depth,
          "Lower boundary of each layer but the last, below the body's surface.")
        .only_with("stress", "stress = \"k0\"", k0);
    t.add("value", stress_components(dimension::kPressure), &I::value,
          "Effective stress at the height datum; tension positive.")
        .only_with("stress", "stress = \"field\"", field)
        .required();
    t.add("gradient", stress_components(dimension::kUnitWeight), &I::gradient, "Its change with height.")
        .only_with("stress", "stress = \"field\"", field);
    t.add("datum", number(dimension::kLength), &I::datum, "Height at which the stress is value.")
        .only_with("stress", "stress = \"field\"", field);
    t.later("phreatic", "one phreatic line for all bodies: pore_water.phreatic");
    t.check([](I& i, const std::string& path, Reader& reader) {
      if (i.kind != Kind::k0 || reader.failed(path)) return;
      const std::string key = key_path(path, "layers");
      if (i.layer_depth.size() + 1 != i.k0.size())
        reader.error(reader.given(key) ? key : key_path(path, "k0"),
                     "k0 and layers do not fit: " + std::to_string(i.k0.size()) + " and " +
                         std::to_string(i.layer_depth.size()) + " entries",
                     "one boundary fewer than values of k0");
      for (std::size_t n = 1; n < i.layer_depth.size(); ++n)
        if (!(i.layer_depth[n] > i.layer_depth[n - 1])) {
          reader.error(key, "the boundaries of layers do not go down", "rising depths");
          break;
        }
    });
    return t;
  }();
  return table;
}

const Table<RandomProperty>& random_keys() {
  using R = RandomProperty;
  static const Table<R> table = [] {
    Table<R> t;
    t.add("property",
          choice<R::Property>({{"cohesion", R::Property::cohesion},
                               {"friction", R::Property::friction},
                               {"shear_strength", R::Property::shear_strength},
                               {"conductivity", R::Property::conductivity}}),
          &R::property,
          "What scatters about the material's value: cohesion; friction: the tangent of the friction angle; "
          "shear_strength: peak undrained strength; conductivity.")
        .required();
    t.add("coefficient_of_variation", number(dimension::kNone, kPositive), &R::coefficient_of_variation,
          "Standard deviation over mean.")
        .required();
    t.add(
         "correlation_length", vector(dimension::kLength), &R::correlation_length,
         "Along each axis, where the correlation has fallen to 1/e; half of Vanmarcke's scale of fluctuation "
         "if exponential.")
        .required();
    t.add("distribution",
          choice<R::Distribution>(
              {{"lognormal", R::Distribution::lognormal}, {"normal", R::Distribution::normal}}),
          &R::distribution, "Of the property; either is bounded to four standard deviations.");
    t.add("correlation",
          choice<R::Correlation>(
              {{"exponential", R::Correlation::exponential}, {"gaussian", R::Correlation::gaussian}}),
          &R::correlation, "exp(-r) or exp(-r^2), r the distance in correlation lengths.");
    t.add("seed", integer(0, 1'000'000'000), &R::seed,
          "Number of the realisation; properties with equal seeds rise and fall together.");
    t.check([](R& r, const std::string& path, Reader& reader) {
      const std::string cov = key_path(path, "coefficient_of_variation");
      if (r.distribution == R::Distribution::normal && r.coefficient_of_variation > 0.2 &&
          !reader.failed(cov))
        reader.error(cov, "four standard deviations below the mean would leave less than a fifth of it",
                     "at most 0.2 if normal; or distribution = \"lognormal\"");
      const std::string length = key_path(path, "correlation_length");
      if (!reader.given(length) || reader.failed(length)) return;
      for (int d = 0; d < reader.dimension(); ++d)
        if (!(r.correlation_length[d] > 0)) {
          reader.error(length, "not a length", "greater than 0 along each axis");
          return;
        }
    });
    return t;
  }();
  return table;
}

// The name of a material, as its number.
Codec<int> material_reference() {
  Codec<int> c;
  c.type = "name of a material";
  c.schema = Node::table();
  c.schema.set("type", Node::of("string"));
  c.read = [](const Node& n, const std::string& key, int& index, Reader& reader) {
    std::vector<std::string> names;
    for (const auto& m : reader.scene.materials) names.push_back(m.name);
    if (!n.is(Node::Kind::text)) {
      reader.error(key, "expected the name of a material, found " + n.description(), join(names));
      return false;
    }
    for (std::size_t i = 0; i < names.size(); ++i)
      if (names[i] == n.text) {
        index = static_cast<int>(i);
        return true;
      }
    if (names.empty())
      reader.error(key, "the case has no material \"" + n.text + "\"", "[material." + n.text + "]");
    else
      reader.error(key, "the case has no material \"" + n.text + "\"" + did_you_mean(n.text, names),
                   join(names));
    return false;
  };
  c.write = [](const int& index, const Scene& scene) {
    const auto i = static_cast<std::size_t>(index);
    return Node::of(i < scene.materials.size() ? scene.materials[i].name : std::string());
  };
  return c;
}

constexpr int kMaxParticlesPerAxis = 8;

// A square number in 2D, a cube in 3D, as the number along each axis.
Codec<int> particles_per_cell() {
  Codec<int> c;
  c.type = "integer";
  c.allowed = "1, 4, 9, 16, ... 64; in 3D 1, 8, 27, ... 512";
  c.schema = Node::table();
  c.schema.set("type", Node::of("integer"));
  c.schema.set("minimum", Node::of(1));
  c.read = [allowed = c.allowed](const Node& n, const std::string& key, int& per_axis, Reader& reader) {
    if (!n.is(Node::Kind::integer)) {
      reader.error(key, "expected an integer, found " + n.description(), allowed);
      return false;
    }
    const int d = reader.dimension();
    for (int i = 1; i <= kMaxParticlesPerAxis; ++i)
      if ((d != 3 && n.integer == i * i) || (d != 2 && n.integer == i * i * i)) {
        per_axis = i;
        return true;
      }
    reader.error(key, std::to_string(n.integer) + " particles do not fill a cell evenly", allowed);
    return false;
  };
  c.write = [](const int& per_axis, const Scene& scene) {
    return Node::of(ipow(per_axis, scene.dimension()));
  };
  return c;
}

// Where a prism begins and ends along y.
Codec<std::array<double, 2>> depth_range() {
  const Codec<double> one = number(dimension::kLength);
  Codec<std::array<double, 2>> c;
  c.type = "[y0, y1], each a " + one.type;
  c.schema = Node::table();
  c.schema.set("type", Node::of("array"));
  c.schema.set("items", one.schema);
  c.schema.set("minItems", Node::of(2));
  c.schema.set("maxItems", Node::of(2));
  c.read = [one](const Node& n, const std::string& key, std::array<double, 2>& range, Reader& reader) {
    if (!n.is(Node::Kind::array) || n.items.size() != 2) {
      reader.error(key, "expected [y0, y1], found " + n.description(), "the lower and the upper end along y");
      return false;
    }
    std::size_t i = 0;
    if (!read_list(n, key, "[y0, y1]", reader, [&](const Node& item, const std::string& k) {
          return one.read(item, k, range[i++], reader);
        }))
      return false;
    if (range[1] > range[0]) return true;
    reader.error(key, "empty body: y1 is not beyond y0", "[y0, y1]");
    return false;
  };
  c.write = [one](const std::array<double, 2>& range, const Scene& scene) {
    return Node::array({one.write(range[0], scene), one.write(range[1], scene)});
  };
  return c;
}

// Exactly one shape, complete, and one the space has.
void check_shape(Body& body, const std::string& path, Reader& reader) {
  const auto given = [&](const char* name) { return reader.given(key_path(path, name)); };
  const bool round = given("centre") || given("radius");
  const int shapes = int(given("polygon")) + int(given("box")) + int(round);
  const std::string allowed = "polygon; box; or centre and radius";
  if (shapes == 0) reader.error(path, "the body has no shape", allowed);
  if (shapes > 1) reader.error(path, "the body has more than one shape", allowed);
  if (round && !given("radius"))
    reader.error(key_path(path, "radius"), "missing", "the radius that belongs to centre");
  const int dimension = reader.dimension();
  if (dimension == 2 && given("extrude"))
    reader.error(key_path(path, "extrude"), "a body has no depth in a 2D grid", "polygon alone");
  if (dimension == 3 && given("polygon") && !body.extrude && !reader.failed("grid") &&
      !reader.failed(key_path(path, "extrude"))) {
    const coupling::GridSpec& grid = reader.scene.grid;
    body.extrude = {grid.origin[1], grid.origin[1] + grid.size[1]};
  }
  if (dimension == 3 && body.spin != 0)
    reader.error(key_path(path, "spin"), "not in this version for a 3d grid", "velocity");
  if (reader.scene.grid.space == Space::axisymmetric && (body.spin != 0 || body.velocity[0] != 0))
    reader.error(key_path(path, body.spin != 0 ? "spin" : "velocity"),
                 "the axis stands still in an axisymmetric grid", "velocity = [0, vy]");
}

void add_shape(Table<Body>& t) {
  t.add("polygon", section_points(3), &Body::polygon,
        "Corners of a plane body, in either sense; not closed by repeating the first. In 3D the section of "
        "a prism along y.");
  t.add("extrude", depth_range(), &Body::extrude,
        "Where the prism begins and ends along y (3D); default: the whole depth of the grid.")
      .only_with("polygon", "polygon", [](const Body& b) { return !b.polygon.empty(); });
  t.add("box", box(), &Body::box, "Lower and upper corner of a box.");
  t.add("centre", vector(dimension::kLength), &Body::centre, "Centre of a disk, in 3D of a ball.");
  t.add("radius", number(dimension::kLength, kPositive), &Body::radius, "Radius of the disk or ball.")
      .without_default()
      .only_with("centre", "centre", [](const Body& b) { return b.centre.has_value(); });
}

void add_particles(Table<Body>& t) {
  t.add("particles_per_cell", particles_per_cell(), &Body::particles_per_axis, "Particles in a full cell.");
  t.add("jitter", number(dimension::kNone, {.min = 0, .max = 0.9}), &Body::jitter,
        "Largest random displacement of a particle, as a share of the particle spacing.");
  t.add("seed", integer(0, 1'000'000'000), &Body::seed, "Seed of the random displacements.")
      .only_with("jitter", "jitter greater than 0", [](const Body& b) { return b.jitter > 0; });
}

}  // namespace

const Table<Body>& body_keys() {
  static const Table<Body> table = [] {
    Table<Body> t;
    t.add("name", identifier(), &Body::name, "Name in messages and results; default: body-1, body-2, ...");
    t.add("material", material_reference(), &Body::material, "The material it consists of.").required();
    add_shape(t);
    add_particles(t);
    t.add("velocity", vector(dimension::kVelocity), &Body::velocity, "Initial velocity.");
    t.add("spin", number(dimension::kAngularVelocity), &Body::spin,
          "Initial angular velocity about the body's centroid, counter-clockwise (2D).");
    t.add("initial", one_table(initial_keys()), &Body::stress, "Initial effective stress.");
    t.add("random", list_of_tables(random_keys()), &Body::random,
          "Properties that scatter in space as random fields.");
    t.check(check_shape);
    return t;
  }();
  return table;
}

const Table<Body>& water_body_keys() {
  static const Table<Body> table = [] {
    Table<Body> t;
    t.add("name", identifier(), &Body::name, "Name in messages; default: water_body-1, water_body-2, ...");
    add_shape(t);
    add_particles(t);
    t.add("velocity", vector(dimension::kVelocity), &Body::velocity, "Initial velocity.");
    t.check(check_shape);
    return t;
  }();
  return table;
}

const Table<Boundary>& boundary_keys() {
  using Kind = Boundary::Kind;
  static const Table<Boundary> table = [] {
    using B = Boundary;
    const auto is = [](Kind kind) { return [kind](const B& b) { return b.kind == kind; }; };
    Table<B> t;
    t.add("name", identifier(), &B::name,
          "Name in messages and results; default: boundary-1, boundary-2, ...");
    t.add<Place>(
         "where", place(true),
         [](const B& b) {
           return Place{b.side, b.segment, b.polygon};
         },
         [](B& b, Place p) {
           b.side = p.side;
           b.segment = p.segment;
           b.polygon = std::move(p.polygon);
         },
         "Where it acts. On a segment inside the grid the soil lies to the left, seen from `from` to `to`; "
         "the corners of a polygon run counter-clockwise seen from the soil.")
        .required();
    t.add("kind",
          choice<Kind>({{"fixed", Kind::fixed},
                        {"roller", Kind::roller},
                        {"friction", Kind::friction},
                        {"velocity", Kind::velocity},
                        {"free", Kind::free},
                        {"tied", Kind::tied},
                        {"traction", Kind::traction},
                        {"pressure", Kind::pressure}},
                       {"absorbing"}),
          &B::kind,
          "fixed: no motion; roller: none across; friction: Coulomb; velocity: prescribed; free: nothing "
          "holds; tied: this side and the one across move alike, as in an endless slope; traction, pressure: "
          "load on the surface of the soil.")
        .required();
    t.add("water",
          choice<B::WaterContact>({{"slip", B::WaterContact::slip}, {"no-slip", B::WaterContact::no_slip}}),
          &B::water,
          "Water with particles of its own slips along the wall, or (no-slip, viscous water) sticks to it.")
        .only_with("kind", "kind = \"fixed\", \"roller\", \"friction\" or \"velocity\"",
                   [](const B& b) { return b.is_wall(); });
    t.add("coefficient", number(dimension::kNone, kNotNegative), &B::coefficient,
          "Friction coefficient, the tangent of the friction angle.")
        .required()
        .only_with("kind", "kind = \"friction\"", is(Kind::friction));
    t.add<Components>(
         "velocity", components(dimension::kVelocity), [](const B& b) { return b.velocity; },
         [](B& b, Components c) { b.velocity = std::move(c); },
         "Prescribed velocity; components that are not given stay free.")
        .required()
        .only_with("kind", "kind = \"velocity\"", is(Kind::velocity));
    t.add<Components>(
         "traction", components(dimension::kPressure),
         [](const B& b) {
           Components c;
           for (std::size_t i = 0; i < 3; ++i)
             for (const double v : b.traction[i].value)
               if (v != 0) c[i] = b.traction[i];
           if (!c[0] && !c[1] && !c[2]) c[0] = b.traction[0];
           return c;
         },
         [](B& b, Components c) {
           for (std::size_t i = 0; i < 3; ++i) b.traction[i] = c[i].value_or(TimeTable{});
         },
         "Force on an area of the soil's surface.")
        .required()
        .only_with("kind", "kind = \"traction\"", is(Kind::traction));
    t.add("pressure", time_table(dimension::kPressure), &B::pressure,
          "Compression normal to the soil's surface.")
        .required()
        .only_with("kind", "kind = \"pressure\"", is(Kind::pressure));
    return t;
  }();
  return table;
}

}  // namespace polder::app
