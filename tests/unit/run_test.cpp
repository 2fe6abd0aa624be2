// Running cases: the folder, restarts and interruptions to the same bits, threads, verdicts, exit codes.
#include <doctest/doctest.h>

#include <unistd.h>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>

#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "app/case.hpp"
#include "app/measured.hpp"
#include "app/program.hpp"
#include "app/run_time.hpp"
#include "app/ticker.hpp"
#include "core/error.hpp"
#include "core/threads.hpp"
#include "io/checkpoint.hpp"

namespace fs = std::filesystem;
using polder::app::curve_error;
using polder::app::Ticker;

namespace {

const std::string kPrism = std::string(POLDER_SOURCE_DIR) + "/tests/valid_cases/prism.toml";
const std::string kColumn = std::string(POLDER_SOURCE_DIR) + "/tests/valid_cases/column.toml";

// A folder of its own for each test, gone afterwards.
class Scratch {
 public:
  Scratch() {
    static int count = 0;
    path_ = fs::temp_directory_path() /
            ("polder_run_test_" + std::to_string(::getpid()) + "_" + std::to_string(count++));
    fs::create_directories(path_);
  }
  ~Scratch() { fs::remove_all(path_); }
  std::string operator/(const std::string& name) const { return (path_ / name).string(); }

 private:
  fs::path path_;
};

struct Result {
  int code;
  std::string out, err;
};

Result polder_program(const std::vector<std::string>& words) {
  std::ostringstream out, err;
  const int code = polder::app::run_program(words, out, err);
  return {code, out.str(), err.str()};
}

std::string text_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  REQUIRE_MESSAGE(file.good(), "missing: " << path);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

nlohmann::json summary_of(const std::string& folder) {
  return nlohmann::json::parse(text_of(folder + "/summary.json"));
}

// Every number of the state, as raw bytes.
void check_same_state(const std::string& a, const std::string& b) {
  const polder::CheckpointReader first(a + "/checkpoint.h5"), second(b + "/checkpoint.h5");
  REQUIRE(first.names() == second.names());
  int compared = 0;
  for (const std::string& name : first.names()) {
    // How far the tables have been written depends on where a run was stopped.
    if (name.starts_with("output/")) continue;
    CAPTURE(name);
    try {
      const auto x = first.array<double>(name), y = second.array<double>(name);
      CHECK(x.size() == y.size());
      CHECK(std::equal(x.begin(), x.end(), y.begin(), y.end(),
                       [](double u, double v) { return u == v || (std::isnan(u) && std::isnan(v)); }));
      ++compared;
    } catch (const polder::EnvironmentError&) {  // integers
    }
  }
  CHECK(compared > 20);
}

}  // namespace

TEST_CASE("a run fills its folder") {
  const Scratch scratch;
  const std::string folder = scratch / "column";
  REQUIRE(polder_program({"run", kColumn, "-o", folder, "--quiet"}).code == 0);
  for (const char* file :
       {"case.toml", "log.txt", "history.csv", "probes.csv", "phreatic.csv", "summary.json", "checkpoint.h5",
        "soil.hdf.series", "fluid.hdf.series", "soil_000000.hdf", "fluid_000005.hdf"})
    CHECK_MESSAGE(fs::exists(folder + "/" + file), file);
  CHECK_FALSE(fs::exists(folder + "/soil_000006.hdf"));
  const auto summary = summary_of(folder);
  CHECK(summary.at("status") == "completed");
  CHECK(summary.at("particles").at("solid") == 80);
  CHECK(summary.at("stages").at(0).at("ended_by") == "duration");
  CHECK(summary.at("stages").at(0).at("time").get<double>() == doctest::Approx(0.05));
  CHECK(std::abs(summary.at("conservation").at("solid_mass").get<double>()) < 1e-12);
  CHECK(summary.at("expectations").at(0).at("pass") == true);
  CHECK(summary.at("measures").at("foot").get<double>() > 5000);
  CHECK(summary.at("measures").at("top").get<double>() > 0);
  // What was not computed, and what was.
  const auto& saved = summary.at("saved");
  CHECK(saved.at("cells").at("grid") == 24);
  CHECK(saved.at("cells").at("in_pressure_system") == 20);
  const long systems = saved.at("pressure_systems").at("solved").get<long>();
  CHECK(systems == summary.at("steps").get<long>());
  CHECK(saved.at("pressure_systems").at("structures_analysed").get<long>() < systems / 2);
  CHECK(saved.at("pressure_systems").at("factorisations").get<long>() <= systems);
  CHECK(saved.at("sleep").at("particle_steps_skipped") == 0);
  // Files are written beside the run, which may wait for them.
  const auto& wall = summary.at("wall_seconds");
  CHECK(wall.at("writer").get<double>() > 0);
  CHECK(wall.at("output_waited").get<double>() <= wall.at("output").get<double>());
  // The resolved case runs by itself to the same numbers.
  const std::string again = scratch / "again";
  REQUIRE(polder_program({"run", folder + "/case.toml", "-o", again, "--quiet"}).code == 0);
  CHECK(text_of(again + "/history.csv") == text_of(folder + "/history.csv"));
  // Results are not overwritten by accident.
  const Result twice = polder_program({"run", kColumn, "-o", folder, "--quiet"});
  CHECK(twice.code == 2);
  CHECK(twice.err.find("--overwrite") != std::string::npos);
  CHECK(polder_program({"run", kColumn, "-o", folder, "--quiet", "--overwrite"}).code == 0);
}

TEST_CASE("a run that is stopped and restarted ends with the same bits") {
  const Scratch scratch;
  const std::string whole = scratch / "whole", parts = scratch / "parts";
  REQUIRE(polder_program({"run", kColumn, "-o", whole, "--quiet"}).code == 0);
  REQUIRE(polder_program({"run", kColumn, "-o", parts, "--quiet", "--until", "0.0173"}).code == 0);
  CHECK(summary_of(parts).at("time").get<double>() < 0.02);
  REQUIRE(polder_program({"run", kColumn, "-o", parts, "--quiet", "--restart", "--until", "31 ms"}).code ==
          0);
  REQUIRE(polder_program({"run", kColumn, "-o", parts, "--quiet", "--restart"}).code == 0);
  check_same_state(whole, parts);
  CHECK(summary_of(parts).at("steps") == summary_of(whole).at("steps"));
  // A restart is refused for another case.
  const Result other = polder_program(
      {"run", kColumn, "-o", parts, "--quiet", "--restart", "--set", "material.sand.young=2e7"});
  CHECK(other.code == 2);
}

// Not to the same bits: cells and masses are found anew at the restart, which the search does only now and
// then.
TEST_CASE("a run that is stopped while it looks for the initial equilibrium can go on") {
  const std::string levee = std::string(POLDER_SOURCE_DIR) + "/cases/levee/levee.toml";
  for (const std::string formulation : {"one-layer", "two-layer"}) {
    CAPTURE(formulation);
    const Scratch scratch;
    const std::string whole = scratch / "whole", parts = scratch / "parts";
    const auto run = [&](const std::string& folder, const std::vector<std::string>& more) {
      std::vector<std::string> words = {"run",
                                        levee,
                                        "-o",
                                        folder,
                                        "--quiet",
                                        "--set",
                                        "grid.cell=0.25",
                                        "--set",
                                        "numerics.courant=0.5",
                                        "--set",
                                        "formulation=" + formulation};
      words.insert(words.end(), more.begin(), more.end());
      return polder_program(words).code;
    };
    REQUIRE(run(whole, {"--until", "0.3"}) == 0);
    REQUIRE(run(parts, {"--until", "0.1"}) == 0);
    CHECK(summary_of(parts).at("time").get<double>() < 0.15);
    REQUIRE(run(parts, {"--restart", "--until", "0.3"}) == 0);
    CHECK(summary_of(parts).at("steps") == summary_of(whole).at("steps"));
    if (formulation != "one-layer")
      continue;  // two layers: on another way to rest, by a twelfth of the settlement
    const polder::CheckpointReader first(whole + "/checkpoint.h5"), second(parts + "/checkpoint.h5");
    for (const char* name : {"body_0/position_x", "body_0/position_y"}) {
      const auto x = first.array<double>(name), y = second.array<double>(name);
      REQUIRE(x.size() == y.size());
      for (std::size_t k = 0; k < x.size(); ++k) REQUIRE(std::abs(x[k] - y[k]) < 1e-5);
    }
  }
}

TEST_CASE("an interrupted run writes a checkpoint, and its tables go on as if nothing had happened") {
  const Scratch scratch;
  const std::string whole = scratch / "whole", parts = scratch / "parts";
  const std::vector<std::string> longer{"run", kColumn, "--quiet", "--set", "stage.settle.duration=0.3",
                                        "-o"};
  const auto run = [&](const std::string& folder, const std::vector<std::string>& more = {}) {
    std::vector<std::string> words = longer;
    words.push_back(folder);
    words.insert(words.end(), more.begin(), more.end());
    return polder_program(words).code;
  };
  REQUIRE(run(whole) == 0);
  // The signal comes once the run has begun to write its history, at whatever step that is.
  std::thread killer([&] {
    for (int i = 0; i < 5000 && !fs::exists(parts + "/soil_000001.hdf"); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    std::raise(SIGTERM);
  });
  const int code = run(parts);
  killer.join();
  REQUIRE(code == 130);
  CHECK(summary_of(parts).at("status") == "interrupted");
  REQUIRE(run(parts, {"--restart"}) == 0);
  check_same_state(whole, parts);
  CHECK(text_of(parts + "/history.csv") == text_of(whole + "/history.csv"));
  CHECK(text_of(parts + "/probes.csv") == text_of(whole + "/probes.csv"));
  CHECK(text_of(parts + "/soil.hdf.series") == text_of(whole + "/soil.hdf.series"));
}

TEST_CASE("a frame that cannot be written ends the run with 4, and the last checkpoint stands") {
  const Scratch scratch;
  const std::string whole = scratch / "whole", parts = scratch / "parts";
  REQUIRE(polder_program({"run", kColumn, "-o", whole, "--quiet"}).code == 0);
  REQUIRE(polder_program({"run", kColumn, "-o", parts, "--quiet", "--until", "0.0173"}).code == 0);
  const std::string before = text_of(parts + "/checkpoint.h5");
  // A folder where the next frame's file is to be built.
  int next = 0;
  const auto frame = [&](int number) { return parts + "/soil_00000" + std::to_string(number) + ".hdf"; };
  while (fs::exists(frame(next))) ++next;
  fs::create_directories(frame(next) + ".tmp/in_the_way");
  const Result stopped = polder_program({"run", kColumn, "-o", parts, "--quiet", "--restart"});
  CHECK(stopped.code == 4);
  CHECK(stopped.err.find(frame(next) + ": cannot be written: Is a directory") != std::string::npos);
  CHECK(text_of(parts + "/checkpoint.h5") == before);
  fs::remove_all(frame(next) + ".tmp");
  REQUIRE(polder_program({"run", kColumn, "-o", parts, "--quiet", "--restart"}).code == 0);
  check_same_state(whole, parts);
  // Frames have the same bytes in any run (the last one before the restart shows where it stopped).
  REQUIRE(next > 2);
  for (int i = 0; i < next - 1; ++i)
    CHECK(text_of(frame(i)) == text_of(whole + frame(i).substr(parts.size())));
}

TEST_CASE("soil asleep is counted, told and restarted") {
  const Scratch scratch;
  const std::string whole = scratch / "whole", parts = scratch / "parts";
  const auto run = [&](const std::string& folder, const std::vector<std::string>& more = {}) {
    std::vector<std::string> words{"run",
                                   kColumn,
                                   "--quiet",
                                   "--set",
                                   "numerics.sleep=true",
                                   "--set",
                                   "numerics.sleep_delay=0.05",
                                   "--set",
                                   "stage.settle.duration=0.4",
                                   "--set",
                                   "stage.settle.damping=0.2",
                                   "-o",
                                   folder};
    words.insert(words.end(), more.begin(), more.end());
    return polder_program(words).code;
  };
  REQUIRE(run(whole) == 0);
  const auto sleep = summary_of(whole).at("saved").at("sleep");
  CHECK(sleep.at("particle_steps_skipped").get<long>() > 0);
  CHECK(sleep.at("particle_steps_skipped").get<long>() < sleep.at("particle_steps").get<long>());
  CHECK(text_of(whole + "/log.txt").find("particle-steps were skipped") != std::string::npos);
  REQUIRE(run(parts, {"--until", "0.37"}) == 0);
  REQUIRE(run(parts, {"--restart"}) == 0);
  check_same_state(whole, parts);
  CHECK(summary_of(parts).at("saved").at("sleep").at("particle_steps_skipped") ==
        sleep.at("particle_steps_skipped"));
}

TEST_CASE("the number of threads does not change a bit") {
  const Scratch scratch;
  for (const char* n : {"1", "2", "4"})
    REQUIRE(polder_program({"run", kColumn, "-o", scratch / n, "--quiet", "--threads", n}).code == 0);
  check_same_state(scratch / "1", scratch / "2");
  check_same_state(scratch / "1", scratch / "4");
}

TEST_CASE("a loaded prism in space: same bits for threads and after a restart") {
  const Scratch scratch;
  for (const char* n : {"1", "2", "4"})
    REQUIRE(polder_program({"run", kPrism, "-o", scratch / n, "--quiet", "--threads", n}).code == 0);
  check_same_state(scratch / "1", scratch / "2");
  check_same_state(scratch / "1", scratch / "4");
  const std::string parts = scratch / "parts";
  REQUIRE(polder_program({"run", kPrism, "-o", parts, "--quiet", "--until", "0.0173"}).code == 0);
  REQUIRE(polder_program({"run", kPrism, "-o", parts, "--quiet", "--restart"}).code == 0);
  check_same_state(scratch / "1", parts);
  // Loaded surfaces are part of the state and have moved; two points a cell fill the prism.
  CHECK(polder::CheckpointReader(parts + "/checkpoint.h5").array<double>("load_0").size() == 9 * 5 * 3);
  CHECK(summary_of(parts).at("particles").at("solid") == 1344);
  CHECK(summary_of(parts).at("measures").at("crest").get<double>() < -1e-5);
}

TEST_CASE("what breaks down ends with 3 and says so") {
  const Scratch scratch;
  const std::string folder = scratch / "failed";
  const Result r = polder_program({"run", kColumn, "-o", folder, "--quiet", "--set",
                                   "stage.settle.mode=equilibrium", "--set", "stage.settle.damping=0.1"});
  CHECK(r.code == 3);
  const auto summary = summary_of(folder);
  CHECK(summary.at("status") == "failed");
  CHECK(summary.at("message").get<std::string>().find("did not come to rest") != std::string::npos);
}

TEST_CASE("bad input starts nothing") {
  const Scratch scratch;
  for (const auto& entry : fs::directory_iterator(std::string(POLDER_SOURCE_DIR) + "/tests/broken_cases")) {
    if (entry.path().extension() != ".toml") continue;
    const std::string folder = scratch / entry.path().stem().string();
    CHECK(polder_program({"run", entry.path().string(), "-o", folder}).code == 2);
    CHECK_FALSE(fs::exists(folder));
  }
  const std::string folder = scratch / "never";
  CHECK(polder_program({"run", kColumn, "-o", folder, "--threads", "none"}).code == 2);
  CHECK(polder_program({"run", kColumn, "-o", folder, "--restart"}).code == 2);
  CHECK(polder_program({"run", kColumn, "-o", folder, "--restart", "--overwrite"}).code == 2);
  CHECK(polder_program({"run", kColumn, "-o", folder, "--set", "measure.mass.quantity=mass_error"}).code ==
        2);
}

TEST_CASE("verify tells what passes and what misses") {
  const Scratch scratch;
  const std::string report = scratch / "report.xml";
  const Result pass = polder_program({"verify", kColumn, "-o", scratch / "v", "--junit", report});
  CHECK(pass.code == 0);
  CHECK(pass.out.find("pass") != std::string::npos);
  CHECK(text_of(report).find("tests=\"1\" failures=\"0\" errors=\"0\"") != std::string::npos);
  const Result miss = polder_program(
      {"verify", kColumn, "-o", scratch / "v", "--junit", report, "--set", "expect.1.value=1"});
  CHECK(miss.code == 1);
  CHECK(miss.out.find("MISS") != std::string::npos);
  CHECK(text_of(report).find("failures=\"1\"") != std::string::npos);
  const Result broken =
      polder_program({"verify", kColumn, "-o", scratch / "v", "--set", "stage.settle.mode=equilibrium",
                      "--set", "stage.settle.damping=0.1"});
  CHECK(broken.code == 3);
  CHECK(polder_program({"verify", std::string(POLDER_SOURCE_DIR) + "/tests/valid_cases/minimal.toml"}).code ==
        2);
}

TEST_CASE("explain tells the plan") {
  const Result r = polder_program({"explain", kColumn, "--threads", "1"});
  CHECK(r.code == 0);
  for (const char* part :
       {"formulation   one-layer", "particles     80 in 1 body", "step limit",
        "(skeleton wave in saturated '", "settle: dynamic", "discrete elements", "run time      about",
        "structure of the pressure system: analysed again only where", "of 24 in the grid",
        "sleep: off, soil at rest is computed on", "points of water: the formulation has none",
        "fields of frames: "})
    CHECK_MESSAGE(r.out.find(part) != std::string::npos, part);
  CHECK(polder_program({"explain", kColumn, "--set", "formulation=dry"}).out.find("pore water  none") !=
        std::string::npos);
  CHECK(r.out.find("random fields: no body has one") != std::string::npos);
  const std::string random = std::string(POLDER_SOURCE_DIR) + "/cases/footing-random/footing-random.toml";
  const std::string out = polder_program({"explain", random, "--threads", "1"}).out;
  CHECK(out.find("random        shear strength of \"ground\": lognormal, coefficient of variation 0.5, "
                 "exponential correlation over 1 x 0.25 m, seed 1\n") != std::string::npos);
  CHECK(out.find("random fields: no body has one") == std::string::npos);
}

TEST_CASE("the run time is that of each stage") {
  // Relaxation, seepage of hours, a slide with unsaturated water.
  polder::set_threads(1);
  const std::string story = std::string(POLDER_SOURCE_DIR) + "/cases/levee-story/levee-story.toml";
  const polder::coupling::Scene scene = polder::app::read_case(story, {"grid.cell=0.25"});
  const std::vector<polder::app::StageTime> times = polder::app::estimate_run_time(scene, {3e-3, 3e-3, 3e-3});
  REQUIRE(times.size() == 3);
  CHECK(times[0].steps == doctest::Approx(10 / 3e-3).epsilon(1e-3));
  CHECK(times[1].steps == 118);  // a hundredth of the duration each, after eighteen that grow
  CHECK(times[2].seconds_per_step > 2 * times[0].seconds_per_step);
  CHECK(times[1].seconds_per_step > 2 * times[0].seconds_per_step);
  const std::string dam = std::string(POLDER_SOURCE_DIR) + "/cases/dam-seepage/dam-seepage.toml";
  CHECK(polder_program({"explain", dam, "--threads", "1"}).out.find("run time      not known before") !=
        std::string::npos);
}

TEST_CASE("errors of curves") {
  const std::vector<double> t{0, 1, 2}, r{0, 1, 2};
  CHECK(curve_error("l2", t, r, t, r) == 0);
  // m = 1.1 r: 10 % in both norms.
  const std::vector<double> m{0, 1.1, 2.2};
  CHECK(curve_error("l2", t, m, t, r) == doctest::Approx(0.1));
  CHECK(curve_error("max", t, m, t, r) == doctest::Approx(0.1));
  // Against zero the error is absolute.
  CHECK(curve_error("l2", t, {0.2, 0.2, 0.2}, t, {0, 0, 0}) == doctest::Approx(0.2));
  // A line is followed exactly from fewer points.
  CHECK(curve_error("max", {0, 2}, {0, 2}, t, r) == doctest::Approx(0).epsilon(1e-15));
  CHECK(std::isnan(curve_error("l2", {0, 1}, {0, 1}, t, r)));  // ends before the reference
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK(std::isnan(curve_error("max", t, {0, nan, 2}, t, r)));
  CHECK(std::isnan(curve_error("l2", t, {0, nan, 2}, t, r)));
}

TEST_CASE("a ticker is due once for each multiple") {
  Ticker tick(0.1);
  CHECK(tick.due(0));
  CHECK_FALSE(tick.due(0.0999));
  CHECK(tick.due(0.1));
  CHECK_FALSE(tick.due(0.15));
  CHECK(tick.due(0.35));  // steps larger than the interval: once
  CHECK_FALSE(tick.due(0.39));
  CHECK(tick.due(0.1 * 3 + 0.1));  // 0.4 up to rounding
  Ticker never(0);
  CHECK_FALSE(never.due(1e9));
}
