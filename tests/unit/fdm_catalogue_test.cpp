// The catalogue of named soils.
#include <doctest/doctest.h>

#include <set>

#include "fdm/soil_catalogue.hpp"

using namespace polder::fdm;

TEST_CASE("the catalogue: sound parameters, names once, a source each") {
  std::set<std::string> names;
  for (const CatalogueSoil& s : soil_catalogue()) {
    CAPTURE(s.name);
    CHECK(names.insert(s.name).second);
    CHECK(faults(s.retention).empty());
    CHECK(s.porosity > 0.2);
    CHECK(s.porosity < 0.6);
    CHECK(s.conductivity > 1e-9);
    CHECK(s.conductivity < 1e-3);
    CHECK(s.source.find("(19") != std::string::npos);
    CHECK(find_soil(s.name) == &s);
    CHECK(soil_names().find(s.name) != std::string::npos);
  }
  CHECK(names.size() >= 20);
  CHECK(find_soil("moon-dust") == nullptr);
}

TEST_CASE("units of the catalogue are metres and seconds") {
  const CatalogueSoil* sand = find_soil("sand");
  REQUIRE(sand);
  CHECK(sand->retention.alpha == doctest::Approx(14.5));
  CHECK(sand->retention.residual == doctest::Approx(0.045 / 0.43));
  CHECK(sand->conductivity == doctest::Approx(8.25e-5));
  // Vauclin's sand holds half of its water at 0.386 m of suction, (4e4)^(1/2.9) cm.
  const CatalogueSoil* vauclin = find_soil("vauclin-sand");
  REQUIRE(vauclin);
  const RetentionCurve curve(vauclin->retention, 9810);
  CHECK(curve.saturation(-9810 * 0.3863) == doctest::Approx(0.5).epsilon(1e-3));
}
