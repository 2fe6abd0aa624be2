// `polder seepage` from the command line, against exact solutions, and what becomes of a case of moving soil.
#include <doctest/doctest.h>

#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "app/case.hpp"
#include "app/seepage.hpp"
#include "core/error.hpp"
#include "io/csv.hpp"
#include "tests/unit/program_support.hpp"
#include "tests/unit/reference_csv.hpp"

using namespace polder;
using app::test::polder_program;
using app::test::Scratch;
namespace fs = std::filesystem;
using Mode = coupling::Stage::Mode;
using Until = coupling::Stage::Until;

namespace {

const std::string kSource = POLDER_SOURCE_DIR;

std::string case_file(const std::string& name) {
  return kSource + "/cases/" + name + "/" + name + ".toml";
}

nlohmann::json seepage(const fs::path& folder, const std::string& name,
                       const std::vector<std::string>& settings = {}) {
  std::vector<std::string> words{"seepage", case_file(name), "-o",        folder.string(),
                                 "--quiet", "--overwrite",   "--threads", "1"};
  for (const std::string& s : settings) words.insert(words.end(), {"--set", s});
  REQUIRE(polder_program(words) == 0);
  std::ifstream in(folder / "flow.json");
  REQUIRE(in.good());
  return nlohmann::json::parse(in);
}

}  // namespace

TEST_CASE("a dam: discharge of Charny, seepage face of Polubarinova-Kochina") {
  const Scratch scratch("seepage_test");
  constexpr double kCharny = 1e-4 * (4.0 * 4.0 - 1.2 * 1.2) / (2 * 4.0);  // k (h1^2 - h2^2) / 2 L
  const nlohmann::json flow = seepage(scratch.path, "dam-seepage");
  CHECK(flow.at("steady").get<bool>());
  const double out = flow.at("discharge").at("downstream"), in = flow.at("discharge").at("upstream");
  CHECK(std::abs(out / kCharny - 1) < 0.01);
  CHECK(std::abs(out + in) < 1e-6 * kCharny);
  const nlohmann::json& psi = flow.at("stream_function");
  CHECK(psi.at("highest").get<double>() - psi.at("lowest").get<double>() ==
        doctest::Approx(out).epsilon(1e-5));
  CHECK(psi.at("defect").get<double>() < 1e-6);
  CHECK(flow.at("heave").is_null());  // the crest is dry and the base impermeable
  CHECK(flow.at("largest_exit_gradient").at("boundary") == "downstream");

  const CsvTable nodes(scratch.path / "stream_function.csv");
  CHECK(nodes.rows() == 41 * 41);

  // Exit height, at L = h1 and h2 = 0.3 h1: within a hundredth, the line's last point.
  const nlohmann::json& ends = flow.at("phreatic_exits");
  REQUIRE(ends.size() == 1);
  CHECK(ends[0].at("boundary") == "downstream");
  CHECK(ends[0].at("within_cell").get<bool>());
  constexpr double kExit = 0.42686 * 4.0;
  CHECK(ends[0].at("place").at(0).get<double>() == doctest::Approx(4.0));
  CHECK(ends[0].at("place").at(1).get<double>() == doctest::Approx(kExit).epsilon(0.01));
  const CsvTable line(scratch.path / "phreatic.csv");
  CHECK(line.column("x[m]").back() == doctest::Approx(4.0));
  CHECK(line.column("y[m]").back() == doctest::Approx(ends[0].at("place").at(1).get<double>()).epsilon(1e-5));
}

TEST_CASE("a sheet pile: discharge, exit gradient and heave of Harr, of first order in the cell") {
  const Scratch scratch("seepage_test");
  const ReferenceCsv exact("sheet_pile.csv");
  double share = 0, exit = 0;
  REQUIRE(exact.columns.at(1) == "q/(kh)[-]");
  for (const std::vector<double>& row : exact.rows)
    if (std::abs(row[0] - 0.5) < 1e-9) share = row[1], exit = row[2] / 4.0;
  REQUIRE(share > 0);
  double discharge_error[2], gradient_error[2];
  const char* const cells[] = {"grid.cell=0.2", "grid.cell=0.1"};
  for (int i = 0; i < 2; ++i) {
    const nlohmann::json flow = seepage(scratch.path, "sheet-pile", {cells[i]});
    discharge_error[i] = flow.at("discharge").at("downstream").get<double>() / (share * 1e-4) - 1;
    const nlohmann::json& heave = flow.at("heave");
    gradient_error[i] = heave.at("gradient").get<double>() / exit - 1;
    CHECK(std::abs(heave.at("place").at(0).get<double>() - 12.0) < 0.11);  // beside the pile
    CHECK(heave.at("critical_gradient").get<double>() == doctest::Approx(0.6 * 1.65));
    CHECK(heave.at("heave_factor").get<double>() ==
          doctest::Approx(0.99 / heave.at("gradient").get<double>()));
  }
  CHECK(std::abs(discharge_error[1]) < 0.015);
  CHECK(std::abs(gradient_error[1]) < 0.025);
  CHECK(std::log2(discharge_error[0] / discharge_error[1]) == doctest::Approx(1).epsilon(0.1));
  CHECK(std::log2(gradient_error[0] / gradient_error[1]) == doctest::Approx(1).epsilon(0.15));
}

TEST_CASE("a saturated case of moving soil: steady flow upwards") {
  const Scratch scratch("seepage_test");
  const nlohmann::json flow = seepage(scratch.path, "upward-seepage");
  CHECK(flow.at("steady").get<bool>());
  constexpr double kGradient = 0.6 * 0.99;
  CHECK(flow.at("discharge").at("surface").get<double>() == doctest::Approx(1e-3 * kGradient * 0.2));
  CHECK(flow.at("heave").at("gradient").get<double>() == doctest::Approx(kGradient));
  CHECK(flow.at("heave").at("heave_factor").get<double>() == doctest::Approx(1 / 0.6));
  const nlohmann::json& psi = flow.at("stream_function");
  CHECK(psi.at("highest").get<double>() - psi.at("lowest").get<double>() ==
        doctest::Approx(1e-3 * kGradient * 0.2));

  // The case in the folder is what was computed.
  const coupling::Scene scene = app::read_case((scratch.path / "case.toml").string());
  REQUIRE(scene.stages.size() == 1);
  CHECK(scene.stages[0].mode == Mode::seepage);
  CHECK(scene.stages[0].until == Until::steady);
  CHECK(scene.expectations.empty());
}

TEST_CASE("a levee under its phreatic line lets no water out where soil lies above") {
  const Scratch scratch("seepage_test");
  const nlohmann::json flow = seepage(scratch.path, "levee");
  const double in = flow.at("inflow"), out = flow.at("outflow");
  CHECK(in > 0);
  CHECK(out == doctest::Approx(in));
  const CsvTable exits(scratch.path / "exit_gradients.csv");
  // The soil is as high as 3 m for x < 3 m, then (9 - x) / 2: an exit lies within two cells of it.
  for (std::size_t i = 0; i < exits.rows(); ++i) {
    const double x = exits.column("x[m]")[i], y = exits.column("y[m]")[i];
    CHECK(y > std::min(3.0, (9 - x) / 2) - 0.25);
  }
}

TEST_CASE("steady flow under time 0 as the start: a levee of silty clay with a drain") {
  const Scratch scratch("seepage_test");
  fs::create_directories(scratch.path);
  const fs::path file = scratch.path / "clay.toml";
  std::ofstream(file) << R"(
formulation = "one-layer"
[grid]
size = [9.0, 3.0]
cell = 0.1
[pore_water]
initial = "steady"
[material.clay]
model = "linear-elastic"
density_solid = 2700.0
porosity = 0.4
young = "10 MPa"
poisson = 0.3
conductivity = "5.5e-8 m/s"
retention = { model = "van-genuchten", alpha = 0.5, n = 1.09, residual = 0.19 }
[[body]]
material = "clay"
polygon = [[0, 0], [9, 0], [3, 3], [0, 3]]
particles_per_cell = 4
[[water]]
name = "upstream"
where = "left"
kind = "head"
head = 2.375
[[water_line]]
name = "drain"
kind = "drain"
line = [[6.5, 0.15], [8.5, 0.15]]
[[stage]]
mode = "seepage"
duration = "1 s"
)";
  double inflow[2];
  const char* const settings[] = {"numerics.cell_means=false", "numerics.cell_means=true"};
  for (int i = 0; i < 2; ++i) {
    const fs::path folder = scratch.path / ("run" + std::to_string(i));
    REQUIRE(polder_program({"seepage", file.string(), "-o", folder.string(), "--quiet", "--threads", "1",
                            "--set", settings[i]}) == 0);
    std::ifstream in(folder / "flow.json");
    inflow[i] = nlohmann::json::parse(in).at("inflow");
  }
  // In tests/verify/steady_flow.cpp: 2.382e-8. Without means they still give the start.
  CHECK(inflow[1] == doctest::Approx(2.382e-8).epsilon(0.005));
  CHECK(inflow[0] == doctest::Approx(inflow[1]).epsilon(0.02));
}

TEST_CASE("stages of a case with a rigid skeleton") {
  std::vector<std::string> remarks;
  const coupling::Scene given = app::read_case(case_file("levee-story"));
  const coupling::Scene scene = app::seepage_scene(given, remarks);
  REQUIRE(scene.stages.size() == 1);  // of rest, flood, failure
  CHECK(scene.stages[0].name == "flood");
  CHECK(scene.stages[0].mode == Mode::seepage);
  CHECK(scene.stages[0].until == Until::duration);
  CHECK(scene.stages[0].duration == given.stages[1].duration);
  CHECK(scene.water_boundaries[0].value == given.water_boundaries[0].value);
  CHECK(app::read_case_text(app::write_case(scene), "seepage.toml") == scene);
  CHECK(remarks.size() > 0);

  // Without a stage of the water: steady, and a level that rises stays where it is at time 0.
  coupling::Scene dynamic = given;
  dynamic.stages.erase(dynamic.stages.begin() + 1);
  dynamic.water_boundaries[0].value = {{0.0, 10.0}, {1.5, 2.5}};
  remarks.clear();
  const coupling::Scene steady = app::seepage_scene(dynamic, remarks);
  REQUIRE(steady.stages.size() == 1);
  CHECK(steady.stages[0].until == Until::steady);
  CHECK(steady.water_boundaries[0].value.at(100) == 1.5);

  coupling::Scene dry = given;
  dry.formulation = "dry";
  CHECK_THROWS_AS(app::seepage_scene(dry, remarks), InputError);
}

TEST_CASE("what seepage refuses") {
  const Scratch scratch("seepage_test");
  std::string err;
  CHECK(polder_program({"seepage", case_file("column"), "-o", scratch.path.string()}, &err) == 2);
  CHECK(err.find("no water that flows") != std::string::npos);
  seepage(scratch.path, "upward-seepage");
  CHECK(polder_program({"seepage", case_file("upward-seepage"), "-o", scratch.path.string(), "--quiet"}) ==
        2);
}
