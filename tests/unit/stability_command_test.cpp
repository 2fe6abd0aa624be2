// `polder stability` from the command line, and the slip surface it draws.
#include <doctest/doctest.h>

#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <sstream>

#include "app/case.hpp"
#include "app/slip_surface.hpp"
#include "app/stability_measures.hpp"
#include "io/csv.hpp"
#include "tests/unit/program_support.hpp"

using namespace polder;
using app::test::polder_program;
using app::test::Scratch;
namespace fs = std::filesystem;

namespace {

const std::string kCase = std::string(POLDER_SOURCE_DIR) + "/cases/slope-acads/slope-acads.toml";

std::string text_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  REQUIRE_MESSAGE(in.good(), "missing: " << file.string());
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

nlohmann::json json_of(const fs::path& file) {
  std::ifstream in(file);
  REQUIRE(in.good());
  return nlohmann::json::parse(in);
}

}  // namespace

TEST_CASE("a slip surface is the line between what moves and what rests") {
  // A circle about (4, 12) through the ground: its inside turns by a hundredth.
  constexpr double kSpacing = 0.25, kRadius = 7;
  std::vector<double> positions, motion, area;
  for (int i = 0; i < 64; ++i)
    for (int j = 0; j < 40; ++j) {
      const double x = kSpacing * (i + 0.5), y = kSpacing * (j + 0.5), r = std::hypot(x - 4, y - 12);
      positions.insert(positions.end(), {x, y, 0});
      motion.push_back(r < kRadius ? 0.01 * r : 1e-4);
      area.push_back(kSpacing * kSpacing);
    }
  const app::SlipSurface slip = app::find_slip_surface(positions, motion, area, 0.5);
  REQUIRE(slip.line.size() > 10);
  for (std::size_t i = 1; i + 1 < slip.line.size(); ++i)
    CHECK(std::abs(std::hypot(slip.line[i][0] - 4, slip.line[i][1] - 12) - kRadius) < 0.3);
  CHECK(slip.line.front()[1] >= slip.line.back()[1]);
  double inside = 0;
  for (std::size_t p = 0; p < motion.size(); ++p)
    if (motion[p] > 1e-3) inside += area[p];
  CHECK(slip.area == doctest::Approx(inside).epsilon(0.1));

  CHECK(app::find_slip_surface(positions, std::vector<double>(motion.size(), 0.0), area, 0.5).line.empty());
}

TEST_CASE("stability of a case and of the folder of a run") {
  const Scratch scratch("stability_test");
  const std::string folder = scratch.path / "case", run = scratch.path / "run";
  REQUIRE(polder_program({"stability", kCase, "-o", folder, "--set", "grid.cell=2", "--threads", "1"}) == 0);
  const auto found = json_of(fs::path(folder) / "stability.json");
  const double factor = found.at("factor_of_safety");
  CHECK(factor > 0.9);
  CHECK(factor < 1.2);
  CHECK(found.at("bracket").at("stands").get<double>() < factor);
  CHECK(found.at("bracket").at("fails").get<double>() <=
        found.at("bracket").at("stands").get<double>() * 1.005);
  CHECK(found.at("mechanism").at("moving_area").get<double>() > 20);
  const CsvTable trials(fs::path(folder) / "trials.csv"), slip(fs::path(folder) / "slip_surface.csv");
  CHECK(trials.rows() == found.at("trials").size());
  // From the crest down to the foot of the slope, 20 m <= x <= 40 m.
  CHECK(slip.column("x[m]").front() < 20);
  CHECK(slip.column("x[m]").back() > 32);
  CHECK(slip.column("y[m]").front() > slip.column("y[m]").back());
  CHECK(fs::exists(fs::path(folder) / "soil_000000.hdf"));

  REQUIRE(polder_program({"run", kCase, "-o", run, "--quiet", "--set", "grid.cell=2", "--threads", "1"}) ==
          0);
  REQUIRE(polder_program({"stability", run, "--threads", "1"}) == 0);
  CHECK(json_of(fs::path(run) / "stability" / "stability.json").at("trials") == found.at("trials"));
}

TEST_CASE("a factor of safety as a measure of a run") {
  const Scratch scratch("stability_test");
  fs::create_directories(scratch.path);
  // The slope stands, and is then left to itself for a while; its strength is that of a factor of about 1.4.
  const fs::path file = scratch.path / "two-stages.toml";
  std::ofstream(file) << text_of(kCase) << R"(
[[stage]]
name = "after"
mode = "dynamic"
duration = "50 ms"

[[measure]]
name = "before"
kind = "stability"
quantity = "factor_of_safety"
stage = "initial"

[[expect]]
measure = "before"
at_least = 1.3
at_most = 1.6
)";
  const std::vector<std::string> common{
      file.string(), "--threads", "1", "--set", "grid.cell=2", "--set", "material.soil.cohesion=10e3"};
  const auto polder = [&](std::vector<std::string> words, const std::string& folder) {
    words.insert(words.begin() + 1, common.begin(), common.end());
    words.insert(words.end(), {"-o", (scratch.path / folder).string()});
    return polder_program(words);
  };
  REQUIRE(polder({"stability", "--stage", "initial"}, "command") == 0);
  const double factor = json_of(scratch.path / "command" / "stability.json").at("factor_of_safety");

  // One expectation is met, the other one, that of the published strength, is not.
  CHECK(polder({"verify"}, "verify") == 1);
  const fs::path run = scratch.path / "verify" / "two-stages";
  const CsvTable before(run / "stability_before.csv"), end(run / "stability_factor.csv");
  REQUIRE(before.rows() == 1);
  REQUIRE(end.rows() == 1);
  CHECK(before.column("factor_of_safety[-]")[0] == doctest::Approx(factor).epsilon(1e-9));
  CHECK(end.column("time[s]")[0] == doctest::Approx(before.column("time[s]")[0] + 0.05));
  const auto summary = json_of(run / "summary.json");
  CHECK(summary.at("measures").at("before").get<double>() == doctest::Approx(factor).epsilon(1e-9));
  CHECK(summary.at("expectations").at(0).at("pass") == false);
  CHECK(summary.at("expectations").at(1).at("pass") == true);

  // Stopped and continued: what has been found stays, what is due is found, to the same digits.
  const std::string halfway = std::to_string(before.column("time[s]")[0] + 0.02);
  REQUIRE(polder({"run", "--quiet", "--until", halfway}, "halves") == 0);
  const fs::path halves = scratch.path / "halves";
  CHECK(fs::exists(halves / "stability_before.csv"));
  CHECK(!fs::exists(halves / "stability_factor.csv"));
  const auto written = fs::last_write_time(halves / "stability_before.csv");
  REQUIRE(polder({"run", "--quiet", "--restart"}, "halves") == 0);
  CHECK(fs::last_write_time(halves / "stability_before.csv") == written);
  for (const char* name : {"stability_before.csv", "stability_factor.csv"})
    CHECK(text_of(halves / name) == text_of(run / name));
}

TEST_CASE("a search that is interrupted is due again") {
  const Scratch scratch("stability_test");
  coupling::Simulation simulation(app::read_case(kCase, {"grid.cell=2"}));
  const RunFolder folder(scratch.path, RunFolder::Mode::fresh);
  app::StabilityMeasures measures(simulation, folder, false);
  const fs::path file = app::StabilityMeasures::file(folder, simulation.scene().measures.front());
  while (!simulation.finished()) {
    REQUIRE(measures.see(simulation, [] { return false; }));  // nothing is due
    simulation.step();
  }
  int trials = 0;
  CHECK(!measures.see(simulation, [&] { return ++trials < 3; }));
  CHECK(trials == 3);
  CHECK(!fs::exists(file));
  // As after a restart.
  app::StabilityMeasures later(simulation, folder, true);
  REQUIRE(later.see(simulation, [] { return true; }));
  CHECK(CsvTable(file).rows() == 1);
  CHECK(later.see(simulation, [] { return false; }));  // done
  // A run that goes on from an earlier moment comes to it again.
  later.drop_after(0.5 * simulation.time());
  CHECK(CsvTable(file).rows() == 0);
  CHECK(!later.see(simulation, [] { return false; }));
}

TEST_CASE("what stability refuses") {
  const Scratch scratch("stability_test");
  const std::string folder = scratch.path;
  std::string err;
  CHECK(polder_program({"stability", kCase, "-o", folder, "--stage", "intial"}, &err) == 2);
  CHECK(err.find("did you mean \"initial\"?") != std::string::npos);
  CHECK(polder_program({"stability", kCase, "-o", folder, "--stage", "initial", "--at", "1"}) == 2);
  fs::create_directories(scratch.path / "empty");
  CHECK(polder_program({"stability", folder + "/empty"}, &err) == 2);
  CHECK(err.find("holds no checkpoint.h5") != std::string::npos);
}
