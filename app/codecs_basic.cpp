// Numbers, words, lists and points. See codecs.hpp.
#include <algorithm>
#include <cmath>

#include "app/codecs.hpp"

namespace polder::app {
namespace {

using coupling::Scene;
using coupling::Vector3;

Node schema_type(const char* type) {
  Node n = Node::table();
  n.set("type", Node::of(type));
  return n;
}

// A number, or a text with a unit.
Node schema_number(const Range& range, const Dimension& dimension) {
  Node plain = schema_type("number");
  if (std::isfinite(range.min))
    plain.set(range.min_open ? "exclusiveMinimum" : "minimum", Node::of(range.min));
  if (std::isfinite(range.max))
    plain.set(range.max_open ? "exclusiveMaximum" : "maximum", Node::of(range.max));
  Node with_unit = schema_type("string");
  with_unit.set("description", Node::of("number with a unit: " + unit_examples(dimension)));
  Node n = Node::table();
  n.set("anyOf", Node::array({std::move(plain), std::move(with_unit)}));
  return n;
}

std::string type_of(const Dimension& dimension) {
  if (dimension == dimension::kNone) return "number";
  return dimension_name(dimension) + " [" + plain_unit(dimension) + "]";
}

std::string how_to_write(const Dimension& dimension) {
  if (dimension == dimension::kNone) return "a number";
  return "a number in " + plain_unit(dimension) + ", or a text with a unit (" + unit_examples(dimension) +
         ")";
}

// The value in SI; false with an error if it is not a number of this dimension.
bool read_quantity(const Node& n, const std::string& key, const Dimension& dimension, double& value,
                   Reader& reader) {
  if (n.is_number()) {
    value = n.number * plain_factor(dimension);
    return true;
  }
  if (!n.is(Node::Kind::text)) {
    reader.error(key, "expected " + dimension_phrase(dimension) + ", found " + n.description(),
                 how_to_write(dimension));
    return false;
  }
  const Quantity q = parse_quantity(n.text);
  if (!q.error.empty()) {
    reader.error(key, "\"" + n.text + "\" is not a quantity: " + q.error, how_to_write(dimension));
    return false;
  }
  if (!q.has_unit) {
    value = q.value * plain_factor(dimension);
    return true;
  }
  if (q.dimension != dimension) {
    reader.error(key,
                 "\"" + n.text + "\" is " + dimension_phrase(q.dimension) + ", " +
                     dimension_phrase(dimension) + " is due",
                 how_to_write(dimension));
    return false;
  }
  value = q.value;
  return true;
}

// An angle in degrees that reads back as exactly the same radians; as a text in radians where no number does.
Node write_angle(double radians) {
  const double degrees = radians / kDegree;
  for (const double scale : {1e6, 1e9, 1e12}) {
    const double rounded = std::round(degrees * scale) / scale;
    if (rounded * kDegree == radians) return Node::of(rounded);
  }
  for (const double d : {degrees, std::nextafter(degrees, 1e9), std::nextafter(degrees, -1e9)})
    if (d * kDegree == radians) return Node::of(d);
  return Node::of(format_number(radians) + " rad");
}

}  // namespace

bool Range::contains(double value) const {
  if (std::isnan(value) || (std::isinf(value) && !infinite)) return false;
  if (min_open ? !(value > min) : !(value >= min)) return false;
  return max_open ? value < max : value <= max;
}

std::string Range::text() const {
  std::string t;
  if (std::isfinite(min)) t = (min_open ? "greater than " : "at least ") + format_number(min);
  if (std::isfinite(max)) {
    if (!t.empty()) t += " and ";
    t += (max_open ? "less than " : "at most ") + format_number(max);
  }
  if (infinite) t += t.empty() ? "inf included" : ", inf included";
  return t;
}

Codec<double> number(const Dimension& dimension, const Range& range) {
  Codec<double> c;
  c.type = type_of(dimension);
  c.allowed = range.text();
  c.schema = schema_number(range, dimension);
  c.read = [=, what = c.description()](const Node& n, const std::string& key, double& value, Reader& reader) {
    double read = 0;
    if (!read_quantity(n, key, dimension, read, reader)) return false;
    const double plain = n.is_number() ? n.number : read / plain_factor(dimension);
    if (!range.contains(plain)) {
      const bool text = n.is(Node::Kind::text);
      reader.error(key, (text ? "\"" + n.text + "\"" : format_number(plain)) + " is out of range", what);
      return false;
    }
    value = read;
    return true;
  };
  c.write = [dimension](const double& value, const Scene&) {
    if (dimension == dimension::kAngle) return write_angle(value).with_comment("deg");
    Node n = Node::of(value);
    if (dimension != dimension::kNone) n.comment = plain_unit(dimension);
    return n;
  };
  return c;
}

Codec<int> integer(int min, int max) {
  Codec<int> c;
  c.type = "integer";
  c.allowed = "from " + std::to_string(min) + " to " + std::to_string(max);
  c.schema = schema_type("integer");
  c.schema.set("minimum", Node::of(min));
  c.schema.set("maximum", Node::of(max));
  c.read = [=, what = c.description()](const Node& n, const std::string& key, int& value, Reader& reader) {
    if (!n.is(Node::Kind::integer)) {
      reader.error(key, "expected an integer, found " + n.description(), what);
      return false;
    }
    if (n.integer < min || n.integer > max) {
      reader.error(key, std::to_string(n.integer) + " is out of range", what);
      return false;
    }
    value = static_cast<int>(n.integer);
    return true;
  };
  c.write = [](const int& value, const Scene&) { return Node::of(value); };
  return c;
}

Codec<bool> boolean() {
  Codec<bool> c;
  c.type = "true or false";
  c.schema = schema_type("boolean");
  c.read = [](const Node& n, const std::string& key, bool& value, Reader& reader) {
    if (!n.is(Node::Kind::boolean)) {
      reader.error(key, "expected true or false, found " + n.description(), "true, false");
      return false;
    }
    value = n.boolean;
    return true;
  };
  c.write = [](const bool& value, const Scene&) { return Node::of(value); };
  return c;
}

Codec<std::string> text() {
  Codec<std::string> c;
  c.type = "text";
  c.schema = schema_type("string");
  c.read = [](const Node& n, const std::string& key, std::string& value, Reader& reader) {
    if (!n.is(Node::Kind::text)) {
      reader.error(key, "expected a text, found " + n.description(), "a text in quotes");
      return false;
    }
    value = n.text;
    return true;
  };
  c.write = [](const std::string& value, const Scene&) { return Node::of(value); };
  return c;
}

Codec<std::string> identifier() {
  Codec<std::string> c = text();
  c.type = "name";
  c.allowed = "letters, digits, _ and -";
  c.schema.set("pattern", Node::of("^[A-Za-z0-9_-]+$"));
  c.read = [plain = c.read, allowed = c.allowed](const Node& n, const std::string& key, std::string& value,
                                                 Reader& reader) {
    std::string read;
    if (!plain(n, key, read, reader)) return false;
    if (!is_identifier(read)) {
      reader.error(key, "\"" + read + "\" is not a name", allowed);
      return false;
    }
    value = std::move(read);
    return true;
  };
  return c;
}

Codec<std::string> word(std::vector<std::string> options, std::vector<std::string> later) {
  Codec<std::string> c = text();
  c.type = "one of " + join(options);
  Node names = Node::array();
  for (const std::string& o : options) names.items.push_back(Node::of(o));
  c.schema = Node::table();
  c.schema.set("enum", std::move(names));
  c.read = [options, later, allowed = join(options)](const Node& n, const std::string& key,
                                                     std::string& value, Reader& reader) {
    if (!n.is(Node::Kind::text)) {
      reader.error(key, "expected a text, found " + n.description(), allowed);
      return false;
    }
    const std::string& read = n.text;
    if (std::find(options.begin(), options.end(), read) != options.end()) {
      value = read;
      return true;
    }
    if (std::find(later.begin(), later.end(), read) != later.end())
      reader.error(key, "\"" + read + "\" is not in this version", allowed);
    else
      reader.error(key, "unknown choice \"" + read + "\"" + did_you_mean(read, options), allowed);
    return false;
  };
  return c;
}

Codec<std::vector<std::string>> words(const std::vector<std::string>& options) {
  const Codec<std::string> one = word(options);
  Codec<std::vector<std::string>> c;
  c.type = "list, each " + one.type;
  c.schema = schema_type("array");
  c.schema.set("items", one.schema);
  c.read = [one](const Node& n, const std::string& key, std::vector<std::string>& list, Reader& reader) {
    std::vector<std::string> read;
    const bool good =
        read_list(n, key, "a list of texts", reader, [&](const Node& item, const std::string& k) {
          std::string w;
          if (!one.read(item, k, w, reader)) return false;
          if (std::find(read.begin(), read.end(), w) != read.end()) {
            reader.error(k, "\"" + w + "\" is given twice");
            return false;
          }
          read.push_back(std::move(w));
          return true;
        });
    list = std::move(read);
    return good;
  };
  c.write = [](const std::vector<std::string>& list, const Scene&) {
    Node n = Node::array();
    for (const std::string& w : list) n.items.push_back(Node::of(w));
    return n;
  };
  return c;
}

bool read_list(const Node& n, const std::string& key, const std::string& expected, Reader& reader,
               const std::function<bool(const Node&, const std::string&)>& item) {
  if (!n.is(Node::Kind::array)) {
    reader.error(key, "expected " + expected + ", found " + n.description());
    return false;
  }
  bool good = true;
  for (std::size_t i = 0; i < n.items.size(); ++i) {
    const std::string k = key + "." + std::to_string(i + 1);
    reader.mark(k, n.items[i].source);
    good = item(n.items[i], k) && good;
  }
  return good;
}

namespace {

// The items of a list as coordinates, of which there must be at most three.
bool read_coordinates(const Node& n, const std::string& key, const std::string& expected,
                      const Codec<double>& one, Vector3& v, Reader& reader) {
  Vector3 read{};
  std::size_t i = 0;
  const bool good = read_list(n, key, expected, reader, [&](const Node& item, const std::string& k) {
    return one.read(item, k, read[i++], reader);
  });
  v = read;
  return good;
}

}  // namespace

Codec<std::vector<double>> numbers(const Dimension& dimension, const Range& range) {
  const Codec<double> one = number(dimension, range);
  Codec<std::vector<double>> c;
  c.type = one.type + ", or a list";
  c.allowed = one.allowed;
  Node list = schema_type("array");
  list.set("items", one.schema);
  c.schema = Node::table();
  c.schema.set("anyOf", Node::array({one.schema, std::move(list)}));
  c.read = [one](const Node& n, const std::string& key, std::vector<double>& values, Reader& reader) {
    values.clear();
    const auto read_one = [&](const Node& item, const std::string& k) {
      double v = 0;
      const bool good = one.read(item, k, v, reader);
      values.push_back(v);
      return good;
    };
    return n.is(Node::Kind::array) ? read_list(n, key, "a list of numbers", reader, read_one)
                                   : read_one(n, key);
  };
  c.write = [one](const std::vector<double>& values, const Scene& scene) {
    if (values.size() == 1) return one.write(values.front(), scene);
    Node n = Node::array();
    for (const double v : values) n.items.push_back(one.write(v, scene));
    return n;
  };
  return c;
}

Codec<Vector3> vector(const Dimension& dimension) {
  const Codec<double> one = number(dimension);
  Codec<Vector3> c;
  c.type = "[x, y], in 3D [x, y, z], each a " + one.type;
  c.schema = schema_type("array");
  c.schema.set("items", one.schema);
  c.schema.set("minItems", Node::of(2));
  c.schema.set("maxItems", Node::of(3));
  c.read = [one](const Node& n, const std::string& key, Vector3& v, Reader& reader) {
    const int d = reader.dimension();
    const std::string expected = d == 3 ? "[x, y, z]" : d == 2 ? "[x, y]" : "[x, y] or [x, y, z]";
    const int count = static_cast<int>(n.items.size());
    if (!n.is(Node::Kind::array) || (d > 0 ? count != d : count != 2 && count != 3)) {
      reader.error(key, "expected " + expected + ", found " + n.description(),
                   d == 3   ? "three coordinates in a 3d grid"
                   : d == 2 ? "two coordinates in a 2D grid"
                            : "");
      return false;
    }
    return read_coordinates(n, key, expected, one, v, reader);
  };
  c.write = [one](const Vector3& v, const Scene& scene) {
    Node n = Node::array();
    for (int i = 0; i < scene.dimension(); ++i)
      n.items.push_back(one.write(v[static_cast<std::size_t>(i)], scene));
    if (!n.items.front().comment.empty()) n.comment = n.items.front().comment;
    return n;
  };
  return c;
}

namespace {

// [x, y]; in 3D [x, z], a point of the section across y.
Codec<Vector3> section_point() {
  const Codec<double> one = number(dimension::kLength);
  Codec<Vector3> c;
  c.schema = schema_type("array");
  c.schema.set("items", one.schema);
  c.schema.set("minItems", Node::of(2));
  c.schema.set("maxItems", Node::of(2));
  c.read = [one](const Node& n, const std::string& key, Vector3& v, Reader& reader) {
    const std::string expected = reader.dimension() == 3 ? "[x, z]" : "[x, y]";
    if (!n.is(Node::Kind::array) || n.items.size() != 2) {
      reader.error(
          key, "expected " + expected + ", found " + n.description(),
          reader.dimension() == 3 ? "two coordinates: a section across y" : "two coordinates in a 2D grid");
      return false;
    }
    return read_coordinates(n, key, expected, one, v, reader);
  };
  c.write = [one](const Vector3& v, const Scene& scene) {
    return Node::array({one.write(v[0], scene), one.write(v[1], scene)});
  };
  return c;
}

Codec<std::vector<Vector3>> list_of_points(const Codec<Vector3>& one, std::string type,
                                           std::size_t at_least) {
  Codec<std::vector<Vector3>> c;
  c.type = std::move(type);
  c.allowed = "at least " + std::to_string(at_least) + " points";
  c.schema = schema_type("array");
  c.schema.set("items", one.schema);
  c.schema.set("minItems", Node::of(static_cast<int>(at_least)));
  c.read = [one, at_least](const Node& n, const std::string& key, std::vector<Vector3>& list,
                           Reader& reader) {
    list.clear();
    if (!read_list(n, key, "a list of points", reader, [&](const Node& item, const std::string& k) {
          Vector3 v{};
          if (!one.read(item, k, v, reader)) return false;
          list.push_back(v);
          return true;
        }))
      return false;
    if (list.size() < at_least) {
      reader.error(key, "only " + std::to_string(list.size()) + " point" + (list.size() == 1 ? "" : "s"),
                   "at least " + std::to_string(at_least));
      return false;
    }
    return true;
  };
  c.write = [one](const std::vector<Vector3>& list, const Scene& scene) {
    Node n = Node::array();
    for (const Vector3& v : list) n.items.push_back(one.write(v, scene));
    return n;
  };
  return c;
}

}  // namespace

Codec<std::vector<Vector3>> points(std::size_t at_least) {
  return list_of_points(vector(dimension::kLength),
                        "list of points [[x, y], ...], in 3D [[x, y, z], ...] [m]", at_least);
}

Codec<std::vector<Vector3>> section_points(std::size_t at_least) {
  return list_of_points(section_point(), "list of points [[x, y], ...], in 3D [[x, z], ...] [m]", at_least);
}

}  // namespace polder::app
