// The types a value of a case file can have: numbers with units and ranges, choices, points, tables in time,
// strength mobilised by plastic strain, places on the grid's sides.
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/declare.hpp"
#include "core/units.hpp"

namespace polder::app {

// Bounds of a number, in the unit of plain numbers (degrees for angles).
struct Range {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool min_open = false;  // min itself is not allowed
  bool max_open = false;
  bool infinite = false;  // inf is allowed

  bool contains(double value) const;
  std::string text() const;  // "greater than 0 and at most 1"
};

inline constexpr Range kAnyNumber{};
inline constexpr Range kPositive{.min = 0, .min_open = true};
inline constexpr Range kNotNegative{.min = 0};

Codec<double> number(const Dimension& dimension, const Range& range = {});
Codec<int> integer(int min, int max);
Codec<bool> boolean();
Codec<std::string> text();
Codec<std::string> identifier();  // letters, digits, "_" and "-": it becomes part of column and file names
// One of the words; `later` are known, but not in this version.
Codec<std::string> word(std::vector<std::string> words, std::vector<std::string> later = {});
Codec<std::vector<std::string>> words(const std::vector<std::string>& words);
// A number, or a list of numbers.
Codec<std::vector<double>> numbers(const Dimension& dimension, const Range& range = {});

Codec<coupling::Vector3> vector(const Dimension& dimension);         // as many components as the space has
Codec<std::vector<coupling::Vector3>> points(std::size_t at_least);  // list of [x, y], in 3D [x, y, z]
// List of [x, y]; in 3D of [x, z], a section across y.
Codec<std::vector<coupling::Vector3>> section_points(std::size_t at_least);
Codec<std::array<coupling::Vector3, 2>> box();  // [lower corner, upper corner]

// A number, or { time = [...], value = [...] }.
Codec<coupling::TimeTable> time_table(const Dimension& dimension, const Range& range = {});
// { x = ..., y = ... }, each a number or a table in time; absent ones are free.
using Components = std::array<std::optional<coupling::TimeTable>, 3>;
Codec<Components> components(const Dimension& dimension);

// A number; { peak, residual, rate }: exponential; { peak, residual, strain_peak, strain_residual } or
// { strain = [...], value = [...] }: piecewise linear.
Codec<mpm::Mobilised> mobilised(const Dimension& dimension, const Range& range = {});

// "left", { side = "left", from = [..], to = [..] }, in 2D { from = [..], to = [..] }, in 3D
// { polygon = [..] }.
struct Place {
  std::optional<int> side;  // 2 * axis + (0 lower, 1 upper)
  std::optional<std::array<coupling::Vector3, 2>> segment;
  std::vector<coupling::Vector3> polygon;  // plane, in 3D
};
// inner: also places inside the grid.
Codec<Place> place(bool inner);
std::string side_name(int side, int dimension);

template <class E>
Codec<E> choice(const std::vector<std::pair<std::string, E>>& options, std::vector<std::string> later = {}) {
  std::vector<std::string> names;
  for (const auto& o : options) names.push_back(o.first);
  const Codec<std::string> base = word(names, std::move(later));
  Codec<E> c;
  c.type = base.type;
  c.allowed = base.allowed;
  c.schema = base.schema;
  c.read = [base, options](const Node& n, const std::string& key, E& e, Reader& reader) {
    std::string chosen;
    if (!base.read(n, key, chosen, reader)) return false;
    for (const auto& o : options)
      if (o.first == chosen) e = o.second;
    return true;
  };
  c.write = [options](const E& e, const coupling::Scene&) {
    for (const auto& o : options)
      if (o.second == e) return Node::of(o.first);
    return Node::of("");
  };
  return c;
}

// Reads items of a list one by one, each under its own key; false if it is no list or an item is wrong.
bool read_list(const Node& n, const std::string& key, const std::string& expected, Reader& reader,
               const std::function<bool(const Node&, const std::string&)>& item);

}  // namespace polder::app
