// Tables in time, mobilised strength, places on the grid. See codecs.hpp.
#include <algorithm>
#include <cmath>

#include "app/codecs.hpp"

namespace polder::app {
namespace {

using coupling::Scene;
using coupling::TimeTable;
using coupling::Vector3;
using mpm::Mobilised;

constexpr const char* kAxes[] = {"x", "y", "z"};

Node object_schema(const std::vector<std::pair<std::string, Node>>& keys,
                   const std::vector<std::string>& required) {
  Node properties = Node::table();
  for (const auto& k : keys) properties.set(k.first, k.second);
  Node n = Node::table();
  n.set("type", Node::of("object"));
  n.set("properties", std::move(properties));
  if (!required.empty()) {
    Node names = Node::array();
    for (const std::string& r : required) names.items.push_back(Node::of(r));
    n.set("required", std::move(names));
  }
  n.set("additionalProperties", Node::of(false));
  return n;
}

Node list_schema(const Node& item) {
  Node n = Node::table();
  n.set("type", Node::of("array"));
  n.set("items", item);
  return n;
}

Node any_of(std::vector<Node> options) {
  Node n = Node::table();
  n.set("anyOf", Node::array(std::move(options)));
  return n;
}

// Marks the keys of a small table and complains about those that are not among `names`.
bool check_keys(const Node& n, const std::string& key, const std::vector<std::string>& names,
                Reader& reader) {
  bool good = true;
  for (const Member& m : n.members) {
    const std::string inner = key + "." + m.key;
    reader.mark(inner, m.key_source);
    if (std::find(names.begin(), names.end(), m.key) != names.end()) continue;
    reader.error(inner, "unknown key" + did_you_mean(m.key, names), join(names));
    good = false;
  }
  return good;
}

// Two lists that are the knots of a piecewise linear curve: as long as each other, the first one rising.
bool read_curve(const Node& n, const std::string& key, const std::string& abscissa,
                const Codec<double>& along, const Codec<double>& value, std::vector<double>& x,
                std::vector<double>& y, Reader& reader) {
  if (!check_keys(n, key, {abscissa, "value"}, reader)) return false;
  bool good = true;
  const auto read = [&](const std::string& name, const Codec<double>& codec, std::vector<double>& list) {
    const Node* node = n.find(name);
    if (!node) {
      reader.error(key + "." + name, "missing", "a list, each a " + codec.description());
      good = false;
      return;
    }
    list.clear();
    good = read_list(*node, key + "." + name, "a list of numbers", reader,
                     [&](const Node& item, const std::string& k) {
                       double v = 0;
                       const bool ok = codec.read(item, k, v, reader);
                       list.push_back(v);
                       return ok;
                     }) &&
           good;
  };
  read(abscissa, along, x);
  read("value", value, y);
  if (!good) return false;
  if (x.empty() || x.size() != y.size()) {
    reader.error(
        key,
        std::to_string(x.size()) + " entries in " + abscissa + ", " + std::to_string(y.size()) + " in value",
        "as many values as entries in " + abscissa + ", at least one");
    return false;
  }
  for (std::size_t i = 1; i < x.size(); ++i)
    if (!(x[i] > x[i - 1])) {
      const std::string entry = key + "." + abscissa + "." + std::to_string(i + 1);
      reader.error(entry, format_number(x[i]) + " does not follow " + format_number(x[i - 1]),
                   "rising values");
      return false;
    }
  return true;
}

Node write_list(const std::vector<double>& values, const Codec<double>& codec, const Scene& scene) {
  Node n = Node::array();
  for (const double v : values) n.items.push_back(codec.write(v, scene));
  return n;
}

std::vector<std::string> side_names(int dimension) {
  std::vector<std::string> names{"left", "right"};
  if (dimension != 2) names.insert(names.end(), {"front", "back"});
  names.insert(names.end(), {"bottom", "top"});
  return names;
}

int side_number(const std::string& name, int dimension) {
  for (int side = 0; side < 2 * dimension; ++side)
    if (side_name(side, dimension) == name) return side;
  return -1;
}

}  // namespace

Codec<TimeTable> time_table(const Dimension& dimension, const Range& range) {
  const Codec<double> value = number(dimension, range);
  const Codec<double> time = number(dimension::kTime);
  Codec<TimeTable> c;
  c.type = value.type + ", or { time = [...], value = [...] }";
  c.allowed = value.allowed;
  c.schema = any_of(
      {value.schema, object_schema({{"time", list_schema(time.schema)}, {"value", list_schema(value.schema)}},
                                   {"time", "value"})});
  c.read = [=](const Node& n, const std::string& key, TimeTable& t, Reader& reader) {
    t = TimeTable{};
    if (n.is(Node::Kind::table)) return read_curve(n, key, "time", time, value, t.time, t.value, reader);
    return value.read(n, key, t.value.front(), reader);
  };
  c.write = [=](const TimeTable& t, const Scene& scene) {
    if (t.value.size() == 1 && t.time.front() == 0) return value.write(t.value.front(), scene);
    Node n = Node::inline_table();
    n.set("time", write_list(t.time, time, scene));
    n.set("value", write_list(t.value, value, scene));
    return n;
  };
  return c;
}

Codec<Components> components(const Dimension& dimension) {
  const Codec<TimeTable> one = time_table(dimension);
  Codec<Components> c;
  c.type = "{ x = ..., y = ... }, in 3D also z, each a " + one.type;
  c.schema = object_schema({{"x", one.schema}, {"y", one.schema}, {"z", one.schema}}, {});
  c.read = [one](const Node& n, const std::string& key, Components& value, Reader& reader) {
    if (!n.is(Node::Kind::table)) {
      reader.error(key, "expected components, found " + n.description(), "{ x = ..., y = ... }");
      return false;
    }
    std::vector<std::string> names{"x", "y"};
    if (reader.dimension() != 2) names.push_back("z");
    bool good = check_keys(n, key, names, reader);
    if (n.members.empty()) {
      reader.error(key, "no component is given", join(names));
      return false;
    }
    for (std::size_t i = 0; i < names.size(); ++i)
      if (const Node* component = n.find(kAxes[i])) {
        TimeTable t;
        good = one.read(*component, key + "." + kAxes[i], t, reader) && good;
        value[i] = std::move(t);
      }
    return good;
  };
  c.write = [one](const Components& value, const Scene& scene) {
    Node n = Node::inline_table();
    for (std::size_t i = 0; i < 3; ++i)
      if (value[i]) n.set(kAxes[i], one.write(*value[i], scene));
    return n;
  };
  return c;
}

Codec<Mobilised> mobilised(const Dimension& dimension, const Range& range) {
  const Codec<double> value = number(dimension, range);
  const Codec<double> strain = number(dimension::kNone, kNotNegative);
  const Codec<double> rate = number(dimension::kNone, kPositive);
  const std::string forms =
      "a number, { peak, residual, rate }, { peak, residual, strain_peak, strain_residual } or { strain = "
      "[...], "
      "value = [...] }";
  Codec<Mobilised> c;
  c.type = value.type + ", or mobilised by plastic deviatoric strain";
  c.allowed = value.allowed;
  c.schema =
      any_of({value.schema,
              object_schema({{"peak", value.schema}, {"residual", value.schema}, {"rate", rate.schema}},
                            {"peak", "residual", "rate"}),
              object_schema({{"peak", value.schema},
                             {"residual", value.schema},
                             {"strain_peak", strain.schema},
                             {"strain_residual", strain.schema}},
                            {"peak", "residual", "strain_peak", "strain_residual"}),
              object_schema({{"strain", list_schema(strain.schema)}, {"value", list_schema(value.schema)}},
                            {"strain", "value"})});
  c.read = [=](const Node& n, const std::string& key, Mobilised& m, Reader& reader) {
    m = Mobilised{};
    if (!n.is(Node::Kind::table)) return value.read(n, key, m.value.front(), reader);
    if (n.find("strain") || n.find("value")) {
      m.kind = Mobilised::Kind::piecewise_linear;
      return read_curve(n, key, "strain", strain, value, m.strain, m.value, reader);
    }
    if (!check_keys(n, key, {"peak", "residual", "rate", "strain_peak", "strain_residual", "strain", "value"},
                    reader))
      return false;
    if (n.find("rate") && (n.find("strain_peak") || n.find("strain_residual"))) {
      reader.error(key, "rate and strain_peak, strain_residual contradict each other", forms);
      return false;
    }
    bool good = true;
    const auto read = [&](const std::string& name, const Codec<double>& codec) {
      double v = 0;
      const Node* node = n.find(name);
      if (!node) {
        reader.error(key + "." + name, "missing", codec.description());
        good = false;
      } else {
        good = codec.read(*node, key + "." + name, v, reader) && good;
      }
      return v;
    };
    m.peak = read("peak", value);
    m.residual = read("residual", value);
    if (n.find("rate")) {
      m.kind = Mobilised::Kind::exponential;
      m.rate = read("rate", rate);
      return good;
    }
    // Peak equal to residual: nothing is mobilised, no strains are needed.
    if (good && m.peak == m.residual && !n.find("strain_peak") && !n.find("strain_residual")) {
      m.value = {m.peak};
      m.peak = m.residual = 0;
      return true;
    }
    const double at_peak = read("strain_peak", strain);
    const double at_residual = read("strain_residual", strain);
    if (!good) return false;
    if (!(at_residual > at_peak)) {
      reader.error(key + ".strain_residual", format_number(at_residual) + " is not beyond strain_peak",
                   "greater than " + format_number(at_peak));
      return false;
    }
    m.kind = Mobilised::Kind::piecewise_linear;
    m.strain = {at_peak, at_residual};
    m.value = {m.peak, m.residual};
    m.peak = m.residual = 0;
    return true;
  };
  c.write = [=](const Mobilised& m, const Scene& scene) {
    if (m.kind == Mobilised::Kind::constant) return value.write(m.value.front(), scene);
    Node n = Node::inline_table();
    if (m.kind == Mobilised::Kind::exponential) {
      n.set("peak", value.write(m.peak, scene));
      n.set("residual", value.write(m.residual, scene));
      n.set("rate", rate.write(m.rate, scene));
    } else {
      n.set("strain", write_list(m.strain, strain, scene));
      n.set("value", write_list(m.value, value, scene));
    }
    return n;
  };
  return c;
}

std::string side_name(int side, int dimension) {
  // The last axis points up, so in 3D y runs from the front to the back.
  static const char* const kPlane[] = {"left", "right", "bottom", "top"};
  static const char* const kSpace[] = {"left", "right", "front", "back", "bottom", "top"};
  return (dimension == 3 ? kSpace : kPlane)[side];
}

Codec<Place> place(bool inner) {
  const Codec<Vector3> point = vector(dimension::kLength);
  const Codec<std::vector<Vector3>> corners = points(3);
  Node side = Node::table();
  Node names = Node::array();
  for (const std::string& s : side_names(3)) names.items.push_back(Node::of(s));
  side.set("enum", std::move(names));
  Codec<Place> c;
  c.type = "side of the grid, { side, from, to } for a part of it";
  if (inner)
    c.type += ", { from, to } for a segment inside (2D), { polygon } for a plane polygon inside (3D)";
  c.allowed = "left, right, bottom, top; in 3D also front, back";
  std::vector<std::pair<std::string, Node>> keys{
      {"side", side}, {"from", point.schema}, {"to", point.schema}};
  if (inner) keys.emplace_back("polygon", corners.schema);
  c.schema = any_of({side, object_schema(keys, {})});
  c.read = [=](const Node& n, const std::string& key, Place& p, Reader& reader) {
    const int dimension = reader.dimension();
    const auto read_side = [&](const Node& s, const std::string& k) {
      const std::vector<std::string> sides = side_names(dimension);
      if (!s.is(Node::Kind::text) || std::find(sides.begin(), sides.end(), s.text) == sides.end()) {
        const bool text = s.is(Node::Kind::text);
        reader.error(k,
                     text ? "unknown side \"" + s.text + "\"" + did_you_mean(s.text, sides)
                          : "expected a side of the grid, found " + s.description(),
                     join(sides));
        return false;
      }
      p.side = side_number(s.text, dimension == 0 ? 3 : dimension);
      return true;
    };
    if (!n.is(Node::Kind::table)) return read_side(n, key);
    std::vector<std::string> names{"side", "from", "to"};
    if (inner) names.push_back("polygon");
    if (!check_keys(n, key, names, reader)) return false;
    bool good = true;
    if (const Node* polygon = n.find("polygon")) {
      if (n.members.size() > 1) {
        reader.error(key, "a polygon stands alone", "{ polygon = [...] }; or side, from and to");
        return false;
      }
      if (dimension == 2) {
        reader.error(key + ".polygon", "a polygon is a surface in a 3d grid", "from and to");
        return false;
      }
      return corners.read(*polygon, key + ".polygon", p.polygon, reader);
    }
    const Node *s = n.find("side"), *from = n.find("from"), *to = n.find("to");
    if (s) good = read_side(*s, key + ".side");
    if ((from != nullptr) != (to != nullptr) || (!s && !from)) {
      reader.error(key,
                   from ? "from without to"
                   : to ? "to without from"
                        : "neither a side nor from and to",
                   "side, from and to; or from and to");
      return false;
    }
    if (from) {
      p.segment.emplace();
      good = point.read(*from, key + ".from", (*p.segment)[0], reader) && good;
      good = point.read(*to, key + ".to", (*p.segment)[1], reader) && good;
    }
    return good;
  };
  c.write = [point, corners](const Place& p, const Scene& scene) {
    if (p.side && !p.segment) return Node::of(side_name(*p.side, scene.dimension()));
    Node n = Node::inline_table();
    if (p.side) n.set("side", Node::of(side_name(*p.side, scene.dimension())));
    if (p.segment) {
      n.set("from", point.write((*p.segment)[0], scene));
      n.set("to", point.write((*p.segment)[1], scene));
    }
    if (!p.polygon.empty()) n.set("polygon", corners.write(p.polygon, scene));
    return n;
  };
  return c;
}

Codec<std::array<Vector3, 2>> box() {
  const Codec<std::vector<Vector3>> corners = points(2);
  Codec<std::array<Vector3, 2>> c;
  c.type = "[lower corner, upper corner] [m]";
  c.schema = corners.schema;
  c.read = [corners](const Node& n, const std::string& key, std::array<Vector3, 2>& b, Reader& reader) {
    std::vector<Vector3> list;
    if (!corners.read(n, key, list, reader)) return false;
    if (list.size() != 2) {
      reader.error(key, std::to_string(list.size()) + " corners", "two: the lower and the upper one");
      return false;
    }
    for (std::size_t i = 0; i < static_cast<std::size_t>(reader.dimension()); ++i)
      if (!(list[1][i] > list[0][i])) {
        reader.error(
            key, "empty box: the upper corner is not beyond the lower one along " + std::string(1, "xyz"[i]),
            "[lower corner, upper corner]");
        return false;
      }
    b = {list[0], list[1]};
    return true;
  };
  c.write = [corners](const std::array<Vector3, 2>& b, const Scene& scene) {
    return corners.write({b[0], b[1]}, scene);
  };
  return c;
}

}  // namespace polder::app
