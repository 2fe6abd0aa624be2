// Reading good cases: values and units, the echo that reads back as the same scene, settings of the command
// line.
#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "app/case.hpp"
#include "app/document.hpp"
#include "app/geometry.hpp"
#include "core/units.hpp"

using namespace polder;
using namespace polder::app;
namespace fs = std::filesystem;

namespace {

const fs::path kSource = POLDER_SOURCE_DIR;

const std::string kMinimal = R"([grid]
size = [4.0, 2.0]
cell = 0.1
[material.sand]
model = "mohr-coulomb"
density_solid = 2650
porosity = 0.4
young = "10 MPa"
poisson = 0.3
friction = "33 deg"
[[body]]
material = "sand"
polygon = [[0, 0], [3, 0], [1, 1], [0, 1]]
[[stage]]
name = "fall"
mode = "dynamic"
duration = 1.0
)";

std::vector<fs::path> valid_cases() {
  std::vector<fs::path> list;
  for (const char* folder : {"cases", "tests/valid_cases"})
    for (const auto& entry : fs::recursive_directory_iterator(kSource / folder))
      if (entry.path().extension() == ".toml") list.push_back(entry.path());
  return list;
}

// What read_case() says about a text; empty if it is accepted.
std::string complaint(const std::string& text, const std::vector<std::string>& settings = {}) {
  try {
    read_case_text(text, "c.toml", settings);
    return {};
  } catch (const InputError& e) {
    return e.what();
  }
}

std::string file_text(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

}  // namespace

TEST_CASE("the minimal case has SI values and the defaults of the scene") {
  const coupling::Scene s = read_case_text(kMinimal, "c.toml");
  CHECK(s.formulation == "dry");
  CHECK(s.gravity == coupling::Vector3{0, -9.81, 0});
  REQUIRE(s.materials.size() == 1);
  CHECK(s.materials[0].name == "sand");
  CHECK(s.materials[0].young == 1e7);
  CHECK(s.materials[0].friction.value.at(0) == 33 * kDegree);
  CHECK(std::isinf(s.materials[0].tension_cutoff));
  REQUIRE(s.bodies.size() == 1);
  CHECK(s.bodies[0].name == "body-1");
  CHECK(s.bodies[0].particles_per_axis == 2);
  CHECK(s.numerics.flip == coupling::NumericsSpec{}.flip);
  CHECK(s.stages.at(0).duration == 1.0);
}

TEST_CASE("in 3D gravity points along z by default") {
  const std::string text =
      "[grid]\nspace = \"3d\"\nsize = [1, 1, 1]\ncell = 0.1\n[material.m]\nmodel = \"linear-elastic\"\n"
      "unit_weight = \"19.62 kN/m3\"\nyoung = 1e6\npoisson = 0.2\n[[body]]\nmaterial = "
      "\"m\"\nparticles_per_cell = 27\n"
      "box = [[0, 0, 0], [0.5, 0.5, 0.5]]\n[[boundary]]\nwhere = \"back\"\nkind = \"roller\"\n"
      "[[stage]]\nmode = \"dynamic\"\nduration = 1\n";
  const coupling::Scene s = read_case_text(text, "c.toml");
  CHECK(s.gravity == coupling::Vector3{0, 0, -9.81});
  CHECK(s.bodies[0].particles_per_axis == 3);
  CHECK(s.boundaries[0].side == 3);
  CHECK(s.materials[0].density_solid == doctest::Approx(2000).epsilon(1e-14));
}

TEST_CASE("conductivity and permeability are told apart by unit") {
  const auto conductivity = [](const std::string& value) {
    return read_case_text(kMinimal, "c.toml", {"material.sand.conductivity=" + value})
        .materials[0]
        .hydraulic_conductivity;
  };
  CHECK(conductivity("5e-4") == 5e-4);
  CHECK(conductivity("\"0.4 m/day\"") == doctest::Approx(0.4 / 86400).epsilon(1e-14));
  // k = kappa rho g / mu = 1e-10 * 1000 * 9.81 / 1e-3
  CHECK(conductivity("\"1e-10 m2\"") == doctest::Approx(9.81e-4).epsilon(1e-14));
  const std::string thick = kMinimal + "[pore_water]\nviscosity = \"2 mPa s\"\n";
  CHECK(read_case_text(thick, "c.toml", {"material.sand.conductivity=1e-10 m2"})
            .materials[0]
            .hydraulic_conductivity == doctest::Approx(4.905e-4).epsilon(1e-14));
}

TEST_CASE("the resolved case of every valid case reads back as the same scene") {
  const std::vector<fs::path> cases = valid_cases();
  REQUIRE(cases.size() >= 6);
  for (const fs::path& path : cases) {
    CAPTURE(path.string());
    const coupling::Scene scene = read_case(path.string());
    const std::string echo = write_case(scene);
    // Beside the case, so that its references are found.
    const coupling::Scene again = read_case_text(echo, (path.parent_path() / "echo.toml").string());
    CHECK(again == scene);
    CHECK(write_case(again) == echo);
  }
}

TEST_CASE("angles survive the echo to the last bit") {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> angle(0, 1.5);
  for (int i = 0; i < 300; ++i) {
    coupling::Scene scene = read_case_text(kMinimal, "c.toml");
    scene.materials[0].friction.value = {angle(random)};
    scene.materials[0].young = std::exp(20 * angle(random));
    CHECK(read_case_text(write_case(scene), "c.toml") == scene);
  }
}

TEST_CASE("settings replace keys, elements of lists by number and by name") {
  const auto read = [](const std::vector<std::string>& settings) {
    return read_case_text(kMinimal, "c.toml", settings);
  };
  CHECK(read({"grid.cell=0.05"}).grid.cell == 0.05);
  CHECK(read({"material.sand.young=20 MPa"}).materials[0].young == 2e7);
  CHECK(read({"material.sand.young=\"20 MPa\""}).materials[0].young == 2e7);
  CHECK(read({"stage.1.duration=3"}).stages[0].duration == 3);
  CHECK(read({"stage.fall.duration=2 min"}).stages[0].duration == 120);
  CHECK(read({"numerics.courant=0.9"}).numerics.courant == 0.9);
  CHECK(read({"formulation=dry"}).formulation == "dry");
  CHECK(read({"body.1.polygon=[[0,0],[1,0],[0,1]]"}).bodies[0].polygon.size() == 3);
  CHECK(read({"grid.cell=0.05", "grid.cell=0.2"}).grid.cell == 0.2);
  CHECK(read({"stage.fall.name="}).stages[0].name == "stage-1");
  CHECK(complaint(kMinimal, {"stage.1="}).find("stage: is empty") != std::string::npos);
  CHECK(complaint(kMinimal, {"grid.shape="}) ==
        "--set grid.shape=: grid.shape: is not there to be removed; allowed: a key that the case gives");
}

TEST_CASE("wrong settings are told with the setting as their place") {
  CHECK(complaint(kMinimal, {"grid.cell=-1"}) ==
        "--set grid.cell=-1: grid.cell: -1 is out of range; allowed: length [m], greater than 0");
  CHECK(complaint(kMinimal, {"grid.cel=1"}) ==
        "--set grid.cel=1: grid.cel: unknown key, did you mean \"cell\"?; allowed: space, origin, size, "
        "cell, shape");
  CHECK(complaint(kMinimal, {"stage.rise.duration=1"}) ==
        "--set stage.rise.duration=1: stage.rise.duration: stage has no element \"rise\"; allowed: 1 to 1, "
        "fall");
  CHECK(complaint(kMinimal, {"stage.2.duration=1"}).find("no element \"2\"") != std::string::npos);
  CHECK(complaint(kMinimal, {"grid.cell.x=1"}) ==
        "--set grid.cell.x=1: grid.cell.x: grid.cell is the number 0.1, it has no parts");
  CHECK(complaint(kMinimal, {"grid.cell"}) == "--set grid.cell: no key and value; allowed: --set key=value");
  CHECK(complaint(kMinimal, {"grid..cell=1"}).find("a part of the key is empty") != std::string::npos);
  CHECK(complaint(kMinimal, {"grid.size=[1, 2"}).find("the value is not TOML") != std::string::npos);
  CHECK(complaint(kMinimal, {"formulation=one-layer"}).find("material.sand.conductivity: missing") !=
        std::string::npos);
}

TEST_CASE("the levee has the published areas") {
  const coupling::Scene s = read_case((kSource / "cases/levee/levee.toml").string());
  CHECK(measure(s.bodies.at(0), 2) == doctest::Approx(18.0).epsilon(1e-12));
  Polygon saturated = s.water.phreatic;
  saturated.insert(saturated.begin(), {0, 0, 0});
  CHECK(overlap_area(saturated, s.bodies[0].polygon) == doctest::Approx(12.4).epsilon(1e-12));
}

TEST_CASE("the reference page is what the program prints") {
  CHECK_MESSAGE(file_text(kSource / "docs/reference/case-file.md") == case_reference(),
                "write it anew: polder schema > docs/reference/case-file.md");
}

TEST_CASE("files that are not case files are refused") {
  CHECK_THROWS_WITH_AS(read_case("nowhere.toml"), "nowhere.toml: no such file", InputError);
  CHECK_THROWS_AS(read_case(kSource.string()), InputError);
}

TEST_CASE("damaged case files never crash the reader") {
  const std::string whole = file_text(kSource / "cases/levee/levee.toml");
  REQUIRE(whole.size() > 500);
  const std::string alphabet = "0123456789.-+e[]{}=\",#\n abcxyz_\xff\x00";
  std::mt19937 random(1);
  const auto below = [&](std::size_t n) {
    return std::uniform_int_distribution<std::size_t>(0, n - 1)(random);
  };
  int accepted = 0, refused = 0;
  for (int i = 0; i < 1500; ++i) {
    std::string text = whole;
    for (std::size_t edits = 1 + below(4); edits > 0; --edits) {
      const std::size_t at = below(text.size());
      switch (below(4)) {
        case 0:
          text[at] = alphabet[below(alphabet.size())];
          break;
        case 1:
          text.erase(at, 1 + below(40));
          break;
        case 2:
          text.insert(at, text.substr(below(text.size()), below(60)));
          break;
        default:
          text.insert(at, 1, alphabet[below(alphabet.size())]);
      }
      if (text.empty()) text = "x";
    }
    CAPTURE(text);
    try {
      const coupling::Scene scene = read_case_text(text, "c.toml");
      // What is accepted must also survive the echo.
      CHECK(read_case_text(write_case(scene), "c.toml") == scene);
      ++accepted;
    } catch (const InputError& e) {
      CHECK(!e.diagnostics().empty());
      ++refused;
    }
  }
  CHECK(accepted > 50);
  CHECK(refused > 500);
}
