// Quantities with units.
#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <random>
#include <string>

#include "core/units.hpp"

using namespace polder;
namespace d = polder::dimension;

TEST_CASE("quantities become SI") {
  struct Row {
    const char* text;
    double value;
    Dimension dimension;
  };
  const Row rows[] = {
      {"13 h", 46800, d::kTime},
      {"2.7 kPa", 2700, d::kPressure},
      {"2.7kPa", 2700, d::kPressure},
      {"30.8 deg", 30.8 * kDegree, d::kAngle},
      {"4.5e-5 m/s", 4.5e-5, d::kVelocity},
      {"0.4 m/day", 0.4 / 86400, d::kVelocity},
      {"18 kN/m3", 18e3, d::kUnitWeight},
      {"18 kN/m^3", 18e3, d::kUnitWeight},
      {"18 kN m-3", 18e3, d::kUnitWeight},
      {"1e-10 m2", 1e-10, d::kArea},
      {"2.65 g/cm3", 2650, d::kDensity},
      {"1.3 mPa s", 1.3e-3, d::kViscosity},
      {"1.3 mPa*s", 1.3e-3, d::kViscosity},
      {"40 %", 0.4, d::kNone},
      {" +3 m ", 3, d::kLength},
      {"-1 mm", -1e-3, d::kLength},
      {"90 deg/s", 90 * kDegree, d::kAngularVelocity},
      {"5 1/s", 5, {0, 0, -1}},
      {"9.81 m/s2", 9.81, d::kAcceleration},
      {"1 N/m2", 1, d::kPressure},
      {"2 days", 172800, d::kTime},
  };
  for (const Row& row : rows) {
    CAPTURE(row.text);
    const Quantity q = parse_quantity(row.text);
    CHECK(q.error == "");
    CHECK(q.has_unit);
    CHECK(q.value == doctest::Approx(row.value).epsilon(1e-14));
    CHECK(q.dimension == row.dimension);
  }
  CHECK_FALSE(parse_quantity("3.5").has_unit);
  CHECK(parse_quantity("inf").value == std::numeric_limits<double>::infinity());
}

TEST_CASE("what is no quantity says why") {
  CHECK(parse_quantity("").error == "it does not start with a number");
  CHECK(parse_quantity("ten m").error == "it does not start with a number");
  CHECK(parse_quantity("nan m").error == "it does not start with a number");
  CHECK(parse_quantity("1e999 m").error == "the number is too large or too small");
  CHECK(parse_quantity("3 furlong").error == "unknown unit \"furlong\"");
  CHECK(parse_quantity("3 m/").error == "a unit is missing");
  CHECK(parse_quantity("3 * m").error == "a unit is missing before \"*\"");
  CHECK(parse_quantity("3 m99").error == "exponent of the unit \"m\" is not a small integer");
  CHECK(parse_quantity("3 4 m").error == "a unit is missing");
  CHECK(parse_quantity("10 12 m").error == "a unit is missing");
  CHECK(parse_quantity("3 m//s").error == "a unit is missing");
}

TEST_CASE("dimensions have names") {
  CHECK(dimension_phrase(d::kPressure) == "a pressure");
  CHECK(dimension_phrase(d::kAngle) == "an angle");
  CHECK(dimension_phrase(d::kNone) == "a plain number");
  CHECK(dimension_phrase(Dimension{1, 0, -1}) == "a quantity in kg s-1");
  CHECK(si_unit(d::kDensity) == "kg/m3");
  CHECK(plain_unit(d::kAngle) == "deg");
  CHECK(plain_factor(d::kAngle) == kDegree);
}

TEST_CASE("numbers are written so that they read back") {
  CHECK(format_number(0.1) == "0.1");
  CHECK(format_number(2650) == "2650");
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> mantissa(-1, 1), exponent(-300, 300);
  for (int i = 0; i < 1000; ++i) {
    const double value = mantissa(random) * std::pow(10, exponent(random));
    CHECK(parse_quantity(format_number(value)).value == value);
  }
}
