#include "core/units.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <limits>

namespace polder {
namespace {

struct Unit {
  std::string_view name;
  double factor;  // to SI
  Dimension dimension;
};

constexpr Dimension kForce{1, 1, -2};
constexpr Dimension kMass{1, 0, 0};
constexpr Dimension kEnergy{1, 2, -2};

constexpr std::array kUnits{
    Unit{"m", 1, dimension::kLength},
    Unit{"mm", 1e-3, dimension::kLength},
    Unit{"cm", 1e-2, dimension::kLength},
    Unit{"um", 1e-6, dimension::kLength},
    Unit{"km", 1e3, dimension::kLength},
    Unit{"s", 1, dimension::kTime},
    Unit{"ms", 1e-3, dimension::kTime},
    Unit{"min", 60, dimension::kTime},
    Unit{"h", 3600, dimension::kTime},
    Unit{"day", 86400, dimension::kTime},
    Unit{"days", 86400, dimension::kTime},
    Unit{"d", 86400, dimension::kTime},
    Unit{"week", 604800, dimension::kTime},
    Unit{"weeks", 604800, dimension::kTime},
    Unit{"year", 31557600, dimension::kTime},  // Julian year
    Unit{"years", 31557600, dimension::kTime},
    Unit{"Hz", 1, {0, 0, -1}},
    Unit{"kg", 1, kMass},
    Unit{"g", 1e-3, kMass},
    Unit{"t", 1e3, kMass},
    Unit{"Mg", 1e3, kMass},
    Unit{"N", 1, kForce},
    Unit{"kN", 1e3, kForce},
    Unit{"MN", 1e6, kForce},
    Unit{"Pa", 1, dimension::kPressure},
    Unit{"mPa", 1e-3, dimension::kPressure},
    Unit{"hPa", 1e2, dimension::kPressure},
    Unit{"kPa", 1e3, dimension::kPressure},
    Unit{"MPa", 1e6, dimension::kPressure},
    Unit{"GPa", 1e9, dimension::kPressure},
    Unit{"bar", 1e5, dimension::kPressure},
    Unit{"J", 1, kEnergy},
    Unit{"kJ", 1e3, kEnergy},
    Unit{"rad", 1, dimension::kAngle},
    Unit{"deg", kDegree, dimension::kAngle},
    Unit{"%", 1e-2, dimension::kNone},
    Unit{"1", 1, dimension::kNone},
    Unit{"-", 1, dimension::kNone},
};

struct Name {
  Dimension dimension;
  std::string_view article, name, unit, examples;
};

constexpr std::array kNames{
    Name{dimension::kNone, "a", "plain number", "-", "%"},
    Name{dimension::kLength, "a", "length", "m", "m, cm, mm, km"},
    Name{dimension::kArea, "an", "area", "m2", "m2, cm2"},
    Name{dimension::kTime, "a", "time", "s", "s, min, h, day"},
    Name{dimension::kVelocity, "a", "velocity", "m/s", "m/s, cm/s, m/day"},
    Name{dimension::kAcceleration, "an", "acceleration", "m/s2", "m/s2"},
    Name{kMass, "a", "mass", "kg", "kg, t"},
    Name{kForce, "a", "force", "N", "N, kN"},
    Name{kEnergy, "an", "energy", "J", "J, kJ"},
    Name{dimension::kDensity, "a", "density", "kg/m3", "kg/m3, t/m3, g/cm3"},
    Name{dimension::kUnitWeight, "a", "pressure per length (unit weight)", "Pa/m", "kN/m3, kPa/m"},
    Name{dimension::kPressure, "a", "pressure", "Pa", "Pa, kPa, MPa, GPa"},
    Name{dimension::kViscosity, "a", "dynamic viscosity", "Pa s", "Pa s, mPa s"},
    Name{dimension::kAngle, "an", "angle", "rad", "deg, rad"},
    Name{dimension::kAngularVelocity, "an", "angular velocity", "rad/s", "rad/s, deg/s"},
    Name{{0, 0, -1}, "a", "frequency", "1/s", "Hz, 1/s"},
};

const Name* find_name(const Dimension& dimension) {
  for (const Name& n : kNames)
    if (n.dimension == dimension) return &n;
  return nullptr;
}

std::string base_units(const Dimension& d) {
  std::string text;
  const auto add = [&](const char* unit, int exponent) {
    if (exponent == 0) return;
    if (!text.empty()) text += ' ';
    text += unit;
    if (exponent != 1) text += std::to_string(exponent);
  };
  add("kg", d.mass);
  add("m", d.length);
  add("s", d.time);
  add("rad", d.angle);
  return text;
}

bool is_blank(char c) {
  return c == ' ' || c == '\t';
}
bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

constexpr int kMaxExponent = 9;

// One factor of a unit, e.g. "kN", "m2", "s^-1": moves `text` behind it.
bool read_factor(std::string_view& text, int sign, Quantity& q) {
  std::size_t n = 0;
  while (n < text.size() && !is_blank(text[n]) && !is_digit(text[n]) && text[n] != '^' && text[n] != '*' &&
         text[n] != '/' && (text[n] != '-' || n == 0))
    ++n;
  if (n == 0 && text.substr(0, 2) == "1/") n = 1;  // as in "3 1/s"
  const std::string_view name = text.substr(0, n);
  const Unit* unit = nullptr;
  for (const Unit& u : kUnits)
    if (u.name == name) unit = &u;
  if (!unit) {
    q.error = name.empty() ? "a unit is missing" : "unknown unit \"" + std::string(name) + "\"";
    return false;
  }
  text.remove_prefix(n);
  int exponent = 1;
  if (!text.empty() && (text[0] == '^' || text[0] == '-' || is_digit(text[0]))) {
    if (text[0] == '^') text.remove_prefix(1);
    const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), exponent);
    if (failure != std::errc{} || std::abs(exponent) > kMaxExponent) {
      q.error = "exponent of the unit \"" + std::string(name) + "\" is not a small integer";
      return false;
    }
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  }
  exponent *= sign;
  q.value *= std::pow(unit->factor, exponent);
  q.dimension.mass += exponent * unit->dimension.mass;
  q.dimension.length += exponent * unit->dimension.length;
  q.dimension.time += exponent * unit->dimension.time;
  q.dimension.angle += exponent * unit->dimension.angle;
  return true;
}

}  // namespace

std::string dimension_name(const Dimension& dimension) {
  const Name* n = find_name(dimension);
  return n ? std::string(n->name) : "quantity in " + base_units(dimension);
}

std::string dimension_phrase(const Dimension& dimension) {
  const Name* n = find_name(dimension);
  return (n ? std::string(n->article) : "a") + " " + dimension_name(dimension);
}

std::string si_unit(const Dimension& dimension) {
  const Name* n = find_name(dimension);
  return n ? std::string(n->unit) : base_units(dimension);
}

std::string plain_unit(const Dimension& dimension) {
  return dimension == dimension::kAngle ? "deg" : si_unit(dimension);
}

double plain_factor(const Dimension& dimension) {
  return dimension == dimension::kAngle ? kDegree : 1;
}

std::string unit_examples(const Dimension& dimension) {
  const Name* n = find_name(dimension);
  return n ? std::string(n->examples) : base_units(dimension);
}

Quantity parse_quantity(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  Quantity q;
  std::string_view digits = text;
  if (!digits.empty() && digits.front() == '+') digits.remove_prefix(1);
  const auto [end, failure] = std::from_chars(digits.data(), digits.data() + digits.size(), q.value);
  if (failure == std::errc::result_out_of_range) {
    q.error = "the number is too large or too small";
    return q;
  }
  if (failure != std::errc{} || std::isnan(q.value)) {
    q.error = "it does not start with a number";
    return q;
  }
  text = digits.substr(static_cast<std::size_t>(end - digits.data()));
  int sign = 1;
  bool first = true;
  while (true) {
    while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
    if (text.empty()) break;
    if (text.front() == '/' || text.front() == '*') {
      // "1 /s" divides; "1 * m" has nothing to multiply.
      if (first && text.front() == '*') {
        q.error = "a unit is missing before \"*\"";
        return q;
      }
      sign = text.front() == '/' ? -1 : 1;
      text.remove_prefix(1);
      while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
    }
    if (!read_factor(text, sign, q)) return q;
    sign = 1;
    first = false;
    q.has_unit = true;
  }
  return q;
}

std::string format_number(double value) {
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  if (std::isnan(value)) return "nan";
  char buffer[32];
  const auto [end, failure] = std::to_chars(buffer, buffer + sizeof buffer, value);
  return failure == std::errc{} ? std::string(buffer, end) : "nan";
}

}  // namespace polder
