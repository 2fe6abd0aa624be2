// Physical dimensions and quantities written with a unit: "13 h", "2.7 kPa", "30.8 deg", "4.5e-5 m/s", "18
// kN/m3".
//
// A unit is a product of factors joined by a blank or "*", each with an integer exponent ("m2", "m^2",
// "s-1"); "/" divides by the one factor behind it. Values are turned into SI units and radians. An angle is a
// dimension of its own, so that a friction angle and a friction coefficient are told apart.
#pragma once

#include <string>
#include <string_view>

namespace polder {

struct Dimension {
  int mass = 0, length = 0, time = 0, angle = 0;  // exponents of kg, m, s, rad
  bool operator==(const Dimension&) const = default;
};

namespace dimension {
inline constexpr Dimension kNone{};
inline constexpr Dimension kLength{0, 1, 0};
inline constexpr Dimension kArea{0, 2, 0};
inline constexpr Dimension kTime{0, 0, 1};
inline constexpr Dimension kVelocity{0, 1, -1};
inline constexpr Dimension kAcceleration{0, 1, -2};
inline constexpr Dimension kDensity{1, -3, 0};
inline constexpr Dimension kUnitWeight{1, -2, -2};
inline constexpr Dimension kPressure{1, -1, -2};
inline constexpr Dimension kViscosity{1, -1, -1};
inline constexpr Dimension kAngle{0, 0, 0, 1};
inline constexpr Dimension kAngularVelocity{0, 0, -1, 1};
}  // namespace dimension

// What a value of this dimension is called ("pressure", "length"); the SI unit where it has no name of its
// own.
std::string dimension_name(const Dimension& dimension);
// The same with its article: "a pressure", "an angle", "a plain number".
std::string dimension_phrase(const Dimension& dimension);
// "Pa", "m/s", "kg/m3", "rad"; "-" without dimension.
std::string si_unit(const Dimension& dimension);

// The unit of a plain number: SI, but degrees for angles. plain_factor() turns such a number into SI.
std::string plain_unit(const Dimension& dimension);
double plain_factor(const Dimension& dimension);

inline constexpr double kDegree = 3.14159265358979323846 / 180;  // [rad]

struct Quantity {
  double value = 0;  // SI
  Dimension dimension;
  bool has_unit = false;  // false: a bare number, its value as written
  std::string error;      // why the text is not a quantity; empty if it is one
};

Quantity parse_quantity(std::string_view text);

// Some units of a dimension for messages: "Pa, kPa, MPa".
std::string unit_examples(const Dimension& dimension);

// The shortest text that reads back as the same number: "0.1", "1e+09", "inf".
std::string format_number(double value);

}  // namespace polder
