// Measures and expectations: profiles, numbers of curves, times and bounds, through whole runs.
#include <doctest/doctest.h>

#include <unistd.h>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "app/case.hpp"
#include "app/measured.hpp"
#include "app/program.hpp"
#include "coupling/quantities.hpp"
#include "coupling/simulation.hpp"
#include "io/csv.hpp"

namespace fs = std::filesystem;
using namespace polder::app;

namespace {

const fs::path kCases = fs::path(POLDER_SOURCE_DIR) / "tests/valid_cases";
const std::string kMeasures = (kCases / "measures.toml").string();

// A folder of its own for each test, gone afterwards.
struct Scratch {
  fs::path path = fs::temp_directory_path() / ("polder_expectation_test_" + std::to_string(::getpid()));
  Scratch() { fs::create_directories(path); }
  ~Scratch() { fs::remove_all(path); }
};

struct Result {
  int code;
  std::string out, err;
};

Result polder_program(const std::vector<std::string>& words) {
  std::ostringstream out, err;
  const int code = run_program(words, out, err);
  return {code, out.str(), err.str()};
}

std::string text_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  REQUIRE_MESSAGE(file.good(), "missing: " << path.string());
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

nlohmann::json expectations_of(const fs::path& folder) {
  return nlohmann::json::parse(text_of(folder / "summary.json")).at("expectations");
}

}  // namespace

TEST_CASE("numbers of a curve") {
  const Curve c{{0, 1, 3}, {1, -4, 2}};
  CHECK(number_of("last", c, false) == 2);
  CHECK(number_of("largest", c, false) == 2);
  CHECK(number_of("change", c, false) == 1);
  CHECK(number_of("smallest", c, false) == -4);
  CHECK(number_of("magnitude", c, false) == 4);
  CHECK(number_of("mean", c, false) == doctest::Approx((-1.5 - 2.0) / 3));  // over time
  CHECK(number_of("mean", c, true) == doctest::Approx(-1.0 / 3));           // over points
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK(std::isnan(number_of("largest", {{0, 1}, {1, nan}}, false)));
  CHECK(std::isnan(number_of("mean", {}, false)));
}

TEST_CASE("a curve is cut at a time") {
  const Curve c{{0, 1, 3}, {0, 2, 4}};
  CHECK(cut(c, 5).x == c.x);
  CHECK(cut(c, 1).x == std::vector<double>{0, 1});
  CHECK(cut(c, 2).x == std::vector<double>{0, 1, 2});
  CHECK(cut(c, 2).value.back() == 3);
}

TEST_CASE("errors of profiles") {
  const Curve line{{0, 1}, {0, 10}};
  CHECK(profile_error("l2", {{0.5, 0.2, 0.8}, {5, 2, 8}}, line) == doctest::Approx(0));
  CHECK(profile_error("l2", {{0.5, 0.2}, {5.5, 2.2}}, line) == doctest::Approx(0.1));
  CHECK(profile_error("max", {{0.5, 0.2}, {5.0, 3.0}}, line) == doctest::Approx(0.2));
  CHECK(profile_error("l2", {{0.5, 0.2}, {3.0, 3.0}}, {{0, 1}, {0, 0}}) == doctest::Approx(3));  // absolute
  CHECK(std::isnan(profile_error("l2", {{1.5}, {1}}, line)));  // beyond the reference
  CHECK(std::isnan(profile_error("l2", {}, line)));
  CHECK(std::isnan(profile_error("max", {{0.5}, {std::nan("")}}, line)));
}

TEST_CASE("the history has the columns that the case reader knows") {
  for (const auto& entry : fs::directory_iterator(kCases)) {
    if (entry.path().extension() != ".toml") continue;
    CAPTURE(entry.path().string());
    const polder::coupling::Scene scene = read_case(entry.path().string());
    const polder::coupling::Simulation simulation(scene);
    std::vector<std::string> known, given;
    for (const auto& q : polder::coupling::history_quantities(scene))
      known.push_back(q.unit.empty() ? q.name : q.name + "[" + q.unit + "]");
    for (const auto& c : simulation.history()) given.push_back(c.name);
    CHECK(known == given);
  }
}

TEST_CASE("every kind of measure is recorded at the times of expectations, the same after a restart") {
  const Scratch scratch;
  const fs::path whole = scratch.path / "whole", parts = scratch.path / "parts",
                 again = scratch.path / "again";
  REQUIRE(polder_program({"run", kMeasures, "-o", whole.string(), "--quiet"}).code == 0);

  const polder::CsvTable pressure(whole / "profile_pressure.csv");
  CHECK(pressure.columns() == std::vector<std::string>{"time[s]", "y[m]", "pore_pressure[Pa]"});
  const auto rows = pressure.column("time[s]");
  const std::set<double> times(rows.begin(), rows.end());
  // To the digits of the file, not merely the first step after them.
  for (const double t : {0.0, 0.0033, 0.0077, 0.02, 0.0223, 0.03}) CHECK(times.contains(t));
  CHECK(times.size() > 6);  // those of `every`
  CHECK(rows.size() == 20 * times.size());
  const polder::CsvTable probes(whole / "probes.csv");
  CHECK(std::count(probes.column("time[s]").begin(), probes.column("time[s]").end(), 0.0077) == 1);
  const polder::CsvTable heights(whole / "profile_height.csv");
  for (const double y : heights.column("initial_y[m]")) CHECK((y >= 0 && y <= 1));
  CHECK(heights.rows() % 20 == 0);  // `within` leaves two of four columns of points
  for (const auto& e : expectations_of(whole)) CHECK(e.at("pass") == true);

  REQUIRE(polder_program({"run", kMeasures, "-o", parts.string(), "--quiet", "--until", "0.0041"}).code == 0);
  REQUIRE(polder_program({"run", kMeasures, "-o", parts.string(), "--quiet", "--restart"}).code == 0);
  // Where it was stopped the first part has rows of its own.
  for (const char* file : {"profile_pressure.csv", "profile_height.csv", "probes.csv", "history.csv"}) {
    const auto later = [&](const std::string& text) { return text.substr(text.find("\n0.0077") + 1); };
    CHECK_MESSAGE(later(text_of(parts / file)) == later(text_of(whole / file)), file);
  }

  // The resolved case finds its references beside it.
  CHECK(fs::exists(whole / "reference_identity.csv"));
  REQUIRE(polder_program({"run", (whole / "case.toml").string(), "-o", again.string(), "--quiet"}).code == 0);
  const auto first = expectations_of(whole), second = expectations_of(again);
  REQUIRE(first.size() == second.size());
  for (std::size_t i = 0; i < first.size(); ++i) CHECK(first[i].at("error") == second[i].at("error"));
  CHECK(text_of(again / "case.toml") == text_of(whole / "case.toml"));
}

TEST_CASE("expectations are missed where they should be") {
  const Scratch scratch;
  const auto misses = [&](const std::vector<std::string>& settings) {
    std::vector<std::string> words{"verify", kMeasures, "-o", (scratch.path / "v").string()};
    for (const std::string& s : settings) words.insert(words.end(), {"--set", s});
    const Result r = polder_program(words);
    CHECK(r.code == (r.out.find("MISS") == std::string::npos ? 0 : 1));
    int count = 0;
    for (std::size_t at = 0; (at = r.out.find("MISS", at)) != std::string::npos; ++at) ++count;
    return count;
  };
  CHECK(misses({}) == 0);
  CHECK(misses({"expect.1.tolerance=1e-9"}) == 1);
  CHECK(misses({"expect.3.value=0.6"}) == 1);
  CHECK(misses({"expect.4.at_least=1e6", "expect.4.at_most=2e6"}) == 1);
  CHECK(misses({"expect.5.at_most=-1"}) == 1);
  // A time that the run does not reach is no success.
  CHECK(misses({"expect.2.time=1"}) == 1);
  CHECK(misses({"expect.5.time=1"}) == 1);
}

TEST_CASE("verify chooses cases by their effort") {
  CHECK(polder_program({"verify", "--all", "--quick"}).code == 2);
  CHECK(polder_program({"verify", kMeasures, "--all"}).code == 2);
  const Scratch scratch;
  const fs::path here = fs::current_path();
  fs::create_directories(scratch.path / "cases/measures");
  for (const char* file : {"measures.toml", "identity.csv"})
    fs::copy_file(kCases / file, scratch.path / "cases/measures" / file);
  fs::create_directories(scratch.path / "cases/long");
  std::string text = text_of(kMeasures);
  text.replace(text.find("quick"), 5, "extensive");
  text.replace(text.find("identity.csv"), 12, "../measures/identity.csv");
  text.replace(text.find("\"identity.csv"), 13, "\"../measures/identity.csv");
  std::ofstream(scratch.path / "cases/long/long.toml") << text;
  fs::current_path(scratch.path);
  const Result quick = polder_program({"verify", "--quick"}), normal = polder_program({"verify"}),
               all = polder_program({"verify", "--all"});
  const Result folder = polder_program({"verify", "cases/long"}), empty = polder_program({"verify", "cases"});
  const Result one = polder_program({"run", "cases/measures"});
  fs::current_path(here);
  CHECK(quick.out.find("of 1 case met") != std::string::npos);
  CHECK(normal.out.find("of 1 case met") != std::string::npos);
  CHECK(all.out.find("of 2 cases met") != std::string::npos);
  CHECK(all.code == 0);
  CHECK(folder.out.find("of 1 case met") != std::string::npos);
  CHECK(empty.code == 2);
  CHECK(empty.err.find("cases: holds no case with [[expect]]") != std::string::npos);
  CHECK(one.err ==
        "cases/measures: is a folder; allowed: a case file, such as cases/measures/measures.toml\n");
}
