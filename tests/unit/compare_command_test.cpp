// `polder compare`: discretisation errors from families of curves, and the command from plan to tables.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/curve_family.hpp"
#include "app/text_table.hpp"
#include "io/csv.hpp"
#include "tests/unit/program_support.hpp"

using namespace polder;
using app::Curve;
using app::Trace;
using app::test::polder_program;
using app::test::Scratch;
namespace fs = std::filesystem;

namespace {

const std::string kColumn = std::string(POLDER_SOURCE_DIR) + "/tests/valid_cases/column.toml";

std::string text_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  REQUIRE_MESSAGE(in.good(), "missing: " << file.string());
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

struct Outcome {
  int code;
  std::string err;
  nlohmann::json json;  // null where nothing was written
};

Outcome compare(const fs::path& folder, const std::string& file, const std::vector<std::string>& more) {
  // Frames on the disk take most of the time.
  std::vector<std::string> words{"compare",   file, "-o",    folder.string(),
                                 "--threads", "1",  "--set", "output.every=0"};
  words.insert(words.end(), more.begin(), more.end());
  Outcome o{};
  o.code = polder_program(words, &o.err);
  if (fs::exists(folder / "compare.json")) o.json = nlohmann::json::parse(text_of(folder / "compare.json"));
  return o;
}

const nlohmann::json& measure(const nlohmann::json& root, const std::string& name) {
  const auto& list = root.at("measures");
  const auto found =
      std::find_if(list.begin(), list.end(), [&](const auto& m) { return m.at("name") == name; });
  REQUIRE_MESSAGE(found != list.end(), name);
  return *found;
}

std::vector<std::string> files_in(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

// f + C h^p, f and C of time.
Trace approximation(double h, double order) {
  Curve c;
  for (int i = 0; i <= 50; ++i) {
    const double t = 0.02 * i;
    c.x.push_back(t);
    c.value.push_back(std::sin(3 * t) + (1 + t) * std::pow(h, order));
  }
  return {c};
}

}  // namespace

TEST_CASE("differences of curves that are linear between their points") {
  const Trace a{{{0, 1, 2}, {0, 1, 2}}}, b{{{0, 2}, {1, 1}}};
  const app::CurveDifference d = app::difference(a, b);
  CHECK(d.l2 == doctest::Approx(std::sqrt(1.0 / 3)));  // t - 1 over [0, 2]
  CHECK(d.max == doctest::Approx(1));
  CHECK(d.max_at == 0);
  // Only the time that both have; stages follow each other and count alike.
  const Trace shorter{{{0, 1}, {1, 1}}, {{0, 4}, {0, 0}}}, two{{{0, 1}, {1, 1}}, {{0, 2}, {0, 3}}};
  const app::CurveDifference e = app::difference(shorter, two);
  CHECK(e.max == doctest::Approx(3));
  CHECK(e.max_at == doctest::Approx(3));
  CHECK(e.l2 == doctest::Approx(std::sqrt((0 + 3.0) / 2)));
  CHECK(std::isnan(app::difference({{{0, 1}, {0, 0}}}, {{{2, 3}, {0, 0}}}).l2));
  // A curve without a number for a while is compared over the rest.
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Trace gap{{{0, 1, 2, 3}, {nan, nan, 2, 2}}}, whole{{{0, 3}, {1, 1}}};
  CHECK(app::difference(gap, whole).l2 == doctest::Approx(1));
}

TEST_CASE("a family tells the error of its finest member") {
  const auto error = [](const std::vector<double>& h, double order) {
    std::vector<Trace> traces;
    for (const double size : h) traces.push_back(approximation(size, order));
    return app::family_error(h, traces);
  };
  // Orders are found from any ratio of sizes, and the error is the true one.
  for (const double order : {0.7, 1.0, 1.5, 2.0})
    for (const std::vector<double>& h :
         {std::vector<double>{0.4, 0.2, 0.1}, {0.4, 0.25, 0.1}, {0.8, 0.4, 0.3, 0.1}}) {
      CAPTURE(order);
      const app::FamilyError e = error(h, order);
      const app::CurveDifference exact =
          app::difference({approximation(0.1, order)}, approximation(0, order));
      CHECK(e.converges);
      CHECK(e.order == doctest::Approx(order).epsilon(1e-6));
      CHECK(e.l2 == doctest::Approx(exact.l2).epsilon(1e-6));
      CHECK(e.max == doctest::Approx(exact.max).epsilon(1e-6));
    }
  // With two the order is taken as 1.
  const app::FamilyError two = error({0.2, 0.1}, 1);
  CHECK(two.members == 2);
  CHECK(std::isnan(two.order));
  CHECK(two.max == doctest::Approx(2 * 0.1));
  // One tells nothing.
  CHECK_FALSE(error({0.1}, 1).known());
  // Beyond the order of the method the error is not made smaller than second order gives.
  const app::FamilyError fast = error({0.4, 0.2, 0.1}, 4);
  CHECK(fast.order == doctest::Approx(4).epsilon(1e-6));
  CHECK(fast.max == doctest::Approx((2 * std::pow(0.2, 4) - 2 * std::pow(0.1, 4)) / 3));
  // What does not converge has the larger difference as its error.
  const std::vector<double> h{0.4, 0.2, 0.1};
  const std::vector<Trace> noise{{{{0, 1}, {0, 0}}}, {{{0, 1}, {1, 1}}}, {{{0, 1}, {-2, -2}}}};
  const app::FamilyError none = app::family_error(h, noise);
  CHECK_FALSE(none.converges);
  CHECK(none.l2 == doctest::Approx(3));
  // Alike to the bit.
  const std::vector<Trace> same(3, approximation(0.1, 1));
  CHECK(app::family_error(h, same).l2 == 0);
}

TEST_CASE("tables of text") {
  CHECK(app::aligned_table({{"a", "bb"}, {"ccc", "d"}}) == "a    bb\nccc  d\n");
  CHECK(app::markdown_table({{"a", "é|"}, {"ccc"}}) == "| a   | é\\| |\n|-----|-----|\n| ccc |     |\n");
}

TEST_CASE("two formulations with two sizes of cells") {
  const Scratch scratch("compare_test");
  const std::vector<std::string> words{"--formulation", "one-layer", "--formulation", "dry",
                                       "--cell",        "0.1",       "--cell",        "0.2"};
  const Outcome o = compare(scratch.path, kColumn, words);
  REQUIRE_MESSAGE(o.code == 0, o.err);
  CHECK(o.err.find("run 3 of 4: dry, cell 0.2 m") != std::string::npos);
  const std::vector<std::string> names{"compare.csv",
                                       "compare.json",
                                       "compare.md",
                                       "compare_differences.csv",
                                       "compare_errors.csv",
                                       "dry_cell0.1_courant0.5",
                                       "dry_cell0.2_courant0.5",
                                       "one-layer_cell0.1_courant0.5",
                                       "one-layer_cell0.2_courant0.5"};
  CHECK(files_in(scratch.path) == names);
  const auto& runs = o.json.at("runs");
  REQUIRE(runs.size() == 4);
  // Variants as they were given, each from coarse to fine.
  CHECK(runs[1].at("label") == "one-layer, cell 0.1 m");
  CHECK(runs[1].at("cell") == 0.1);
  CHECK(runs[2].at("label") == "dry, cell 0.2 m");
  CHECK(runs[1].at("particles").at("solid") == 80);
  CHECK(runs[1].at("dt").at("limited_by") == "skeleton wave");
  CHECK(runs[1].at("dt").at("limited_share").get<double>() > 0.9);
  CHECK(std::abs(runs[1].at("dt").at("mean").get<double>() * runs[1].at("steps").get<double>() - 0.05) <
        1e-9);
  CHECK(runs[1].at("conservation").at("solid_mass").get<double>() < 1e-12);
  CHECK(runs[1].at("conservation").at("water_mass").get<double>() > 0);
  CHECK(runs[2].at("conservation").at("water_mass").is_null());  // there is none
  CHECK(runs[1].at("expectations").at(0).at("pass") == true);

  // The numbers of the table are those of the runs' own files.
  const fs::path fine = scratch.path / runs[1].at("folder").get<std::string>();
  const fs::path coarse = scratch.path / runs[0].at("folder").get<std::string>();
  const CsvTable a(fine / "history.csv", {"dt_limit"}), b(coarse / "history.csv", {"dt_limit"});
  const auto& outflow = measure(o.json, "water_outflow");
  CHECK(runs[1].at("measures").at("water_outflow") == a.column("water_outflow[m3]").back());
  const auto curve = [](const CsvTable& t, const char* name) {
    const auto x = t.column("time[s]"), y = t.column(name);
    return Trace{{{x.begin(), x.end()}, {y.begin(), y.end()}}};
  };
  const Trace x = curve(a, "water_outflow[m3]"), y = curve(b, "water_outflow[m3]");
  app::Extremes extremes;
  app::extend(extremes, x);
  CHECK(outflow.at("scale").get<double>() == doctest::Approx(extremes.range()));
  CHECK(outflow.at("errors").at(0).at("cell").at("l2").get<double>() ==
        doctest::Approx(app::difference(x, y).l2 / extremes.range()));
  // What only one of them has is not compared; what both have is.
  CHECK(outflow.at("differences").empty());
  const auto& top = measure(o.json, "top");
  REQUIRE(top.at("differences").size() == 1);
  const auto& d = top.at("differences").at(0);
  CHECK(d.at("first") == 1);
  CHECK(d.at("second") == 3);
  CHECK(d.at("beyond") != "not known");
  CHECK(d.at("error_l2").get<double>() == doctest::Approx(top.at("errors").at(0).at("l2").get<double>() +
                                                          top.at("errors").at(1).at("l2").get<double>()));
  CHECK((d.at("beyond") == "yes") == (d.at("l2").get<double>() > d.at("error_l2").get<double>()));
  CHECK(d.at("cells").size() == 2);
  // Errors and noise are told for each run.
  for (const auto& m : o.json.at("measures")) CHECK(m.at("quantity") != "solid_mass_error");
  const CsvTable table(scratch.path / "compare.csv",
                       {"run", "variant", "formulation", "status", "limited_by"});
  REQUIRE(table.rows() == 4);
  CHECK(table.column("particles_solid")[3] == 80);
  CHECK(table.column("top[m]")[1] == doctest::Approx(runs[1].at("measures").at("top").get<double>()));

  // Complete runs are taken as they are; what was measured of time does not change.
  const Outcome again = compare(scratch.path, kColumn, words);
  REQUIRE(again.code == 0);
  for (std::size_t i = 0; i < 4; ++i) {
    CHECK(again.json.at("runs")[i].at("reused") == true);
    CHECK(again.json.at("runs")[i].at("wall_seconds") == runs[i].at("wall_seconds"));
  }
  CHECK(again.json.at("measures") == o.json.at("measures"));
  // More cells: only what is missing runs.
  const Outcome more =
      compare(scratch.path, kColumn, {"--formulation", "dry", "--cell", "0.1", "--cell", "0.05"});
  REQUIRE(more.code == 0);
  CHECK(more.json.at("runs")[0].at("reused") == true);
  CHECK(more.json.at("runs")[1].at("reused") == false);
  // Other settings into the same folder are refused before anything runs, or replace what is there.
  const std::vector<std::string> other{"--formulation", "dry",  "--cell", "0.1",
                                       "--cell",        "0.05", "--set",  "material.sand.young=2e7"};
  const Outcome refused = compare(scratch.path, kColumn, other);
  CHECK(refused.code == 2);
  CHECK(refused.err.find("dry_cell0.1_courant0.5: holds results of another case") != std::string::npos);
  CHECK(refused.err.find("--overwrite") != std::string::npos);
  std::vector<std::string> replace = other;
  replace.push_back("--overwrite");
  const Outcome replaced = compare(scratch.path, kColumn, replace);
  REQUIRE(replaced.code == 0);
  CHECK(replaced.json.at("runs")[0].at("reused") == false);
  CHECK(replaced.json.at("runs")[0].at("measures") != more.json.at("runs")[0].at("measures"));
}

TEST_CASE("variants: none, one, and the discretisation error of steps") {
  const Scratch scratch("compare_test");
  const Outcome o =
      compare(scratch.path, kColumn,
              {"--formulation", "one-layer", "--variant", "same:material.sand.poisson=0.2", "--variant",
               "tight:gravity=[0.0,-9.81],title=\"a, b\",material.sand.conductivity=5e-4", "--courant", "0.5",
               "--courant", "0.25", "--courant", "1"});
  REQUIRE_MESSAGE(o.code == 0, o.err);
  REQUIRE(o.json.at("runs").size() == 9);
  CHECK(o.json.at("runs")[0].at("label") == "one-layer, courant 1");
  CHECK(o.json.at("runs")[2].at("label") == "one-layer, courant 0.25");
  const auto& top = measure(o.json, "top");
  const auto& error = top.at("errors").at(0);
  CHECK(error.at("cell").is_null());
  CHECK(error.at("step").at("members") == 3);
  REQUIRE(top.at("differences").size() == 3);
  CHECK(top.at("differences")[0].at("l2") == 0);
  CHECK(top.at("differences")[0].at("beyond") == "no");
  // Half the conductivity: far beyond the error of the steps.
  CHECK(top.at("differences")[1].at("beyond") == "yes");
  CHECK(top.at("differences")[1].at("l2").get<double>() > 0.1);
  CHECK(top.at("differences")[2].at("l2") == top.at("differences")[1].at("l2"));
  const std::string text = text_of(scratch.path / "compare.md");
  CHECK(text.find("- one-layer and tight differ by more than their discretisation error: top") !=
        std::string::npos);
  CHECK(text.find("- one-layer and same are closer than their discretisation error: top") !=
        std::string::npos);
}

TEST_CASE(
    "without a family the discretisation error is not known; a fixed step instead of the limit's share") {
  const Scratch scratch("compare_test");
  const Outcome o = compare(scratch.path, kColumn,
                            {"--variant", "a:material.sand.young=1e7", "--variant",
                             "b:material.sand.young=2e7", "--step", "2e-4 s"});
  REQUIRE_MESSAGE(o.code == 0, o.err);
  CHECK(o.json.at("runs")[0].at("time_step") == 2e-4);
  CHECK(o.json.at("runs")[0].at("courant").is_null());
  CHECK(o.json.at("runs")[0].at("steps") == 250);
  const auto& top = measure(o.json, "top");
  CHECK(top.at("errors").at(0).at("known") == false);
  CHECK(top.at("differences").at(0).at("error_l2").is_null());
  CHECK(top.at("differences").at(0).at("beyond") == "not known");
  CHECK(text_of(scratch.path / "compare.md").find("not known: give --cell several") != std::string::npos);
}

TEST_CASE("times count from the end of the search for equilibrium") {
  const Scratch scratch("compare_test");
  fs::create_directories(scratch.path);
  std::string text = text_of(kColumn);
  text.insert(text.find("[[stage]]"),
              "[[stage]]\nname = \"rest\"\nmode = \"equilibrium\"\nduration = 10\nwater_flows = false\n"
              "reset_displacement = true\nreset_velocity = true\n\n");
  text.insert(
      text.find("[[measure]]"),
      "[[measure]]\nname = \"profile\"\nkind = \"cells\"\nquantity = \"pore_pressure\"\nalong = \"y\"\n"
      "every = \"10 ms\"\n\n");
  const std::string file = (scratch.path / "case.toml").string();
  std::ofstream(file) << text;
  const Outcome o = compare(scratch.path / "out", file, {"--cell", "0.2", "--cell", "0.1"});
  REQUIRE_MESSAGE(o.code == 0, o.err);
  for (const auto& run : o.json.at("runs")) {
    CHECK(run.at("start").get<double>() > 0);
    CHECK(run.at("time").get<double>() - run.at("start").get<double>() == doctest::Approx(0.05));
    CHECK(run.at("dt").at("mean").get<double>() < 0.01);  // not of the pseudo-time
    REQUIRE(run.at("stages").size() == 1);
    CHECK(run.at("stages")[0].at("name") == "settle");
    CHECK(run.at("stages")[0].at("start") == run.at("start"));
  }
  CHECK(o.json.at("runs")[0].at("start") != o.json.at("runs")[1].at("start"));
  const auto& foot = measure(o.json, "foot");
  CHECK(foot.at("errors").at(0).at("known") == true);

  // Profiles at the same times of both.
  const auto& profile = measure(o.json, "profile");
  std::vector<double> times = profile.at("times");
  REQUIRE(times.size() >= 6);  // from the end of the search on
  CHECK(std::abs(times.front()) < 1e-9);
  // Of each its own times; those of the other in between.
  struct Record {
    double time;
    Curve curve;
  };
  std::vector<Record> records[2];
  for (int r = 0; r < 2; ++r) {
    const auto& run = o.json.at("runs")[r];
    const double start = run.at("start");
    const CsvTable rows(scratch.path / "out" / run.at("folder").get<std::string>() / "profile_profile.csv");
    for (std::size_t i = 0; i < rows.rows(); ++i) {
      const double t = rows.column(0)[i] - start;  // rounded in the table
      if (t < -1e-9) continue;
      if (records[r].empty() || t > records[r].back().time) records[r].push_back({t, {}});
      Curve& c = records[r].back().curve;
      if (!c.x.empty() && rows.column(1)[i] <= c.x.back() * 1.001)
        continue;  // cells beside each other are alike
      c.x.push_back(rows.column(1)[i]), c.value.push_back(rows.column(2)[i]);
    }
  }
  REQUIRE(records[0][0].curve.x.size() == 5);
  REQUIRE(records[1][0].curve.x.size() == 10);
  Trace traces[2];
  for (const double t : times)
    for (int r = 0; r < 2; ++r) {
      std::size_t i = 0;
      while (i + 2 < records[r].size() && records[r][i + 1].time < t) ++i;
      const Record &a = records[r][i], &b = records[r][i + 1];
      Curve c = a.curve;
      const double share = std::min(1.0, (t - a.time) / (b.time - a.time));
      for (std::size_t k = 0; k < c.x.size(); ++k) c.value[k] += share * (b.curve.value[k] - c.value[k]);
      traces[r].push_back(c);
    }
  app::Extremes extremes;
  app::extend(extremes, traces[1]);
  CHECK(profile.at("scale").get<double>() == doctest::Approx(extremes.range()));
  CHECK(profile.at("errors")[0].at("l2").get<double>() ==
        doctest::Approx(app::difference(traces[0], traces[1]).l2 / extremes.range()));
}

TEST_CASE("factors of safety of a case without motion") {
  const Scratch scratch("compare_test");
  const Outcome o = compare(
      scratch.path, std::string(POLDER_SOURCE_DIR) + "/cases/slope-acads/slope-acads.toml",
      {"--formulation", "dry", "--variant", "weak:material.soil.friction=15", "--cell", "4", "--cell", "2"});
  REQUIRE_MESSAGE(o.code == 0, o.err);
  REQUIRE(o.json.at("measures").size() == 1);  // how the equilibrium was found is not compared
  const auto& factor = measure(o.json, "factor");
  std::vector<double> found;
  for (const auto& run : o.json.at("runs")) found.push_back(run.at("measures").at("factor"));
  CHECK(found[1] > found[3]);
  // One number, as a share of the largest.
  CHECK(factor.at("scale") == found[1]);
  CHECK(factor.at("errors")[0].at("l2").get<double>() ==
        doctest::Approx(std::abs(found[1] - found[0]) / found[1]));
  CHECK(factor.at("differences")[0].at("l2").get<double>() ==
        doctest::Approx((found[1] - found[3]) / found[1]));
  // The case expects a factor of its own cells; what is missed is named.
  CHECK(text_of(scratch.path / "compare.md").find("weak, cell 2 m missed: factor") != std::string::npos);
}

TEST_CASE("a run that fails is reported, the others go on") {
  const Scratch scratch("compare_test");
  const std::vector<std::string> words{"--variant",
                                       "restless:stage.settle.mode=equilibrium,stage.settle.damping=0.1",
                                       "--formulation", "one-layer"};
  const Outcome o = compare(scratch.path, kColumn, words);
  CHECK(o.code == 3);
  CHECK(o.err.find("FAILED, see ") != std::string::npos);
  CHECK(o.json.at("runs")[0].at("label") == "one-layer");
  CHECK(o.json.at("runs")[0].at("status") == "completed");
  CHECK(o.json.at("runs")[1].at("status") == "failed");
  CHECK(o.json.at("runs")[1].at("reason").get<std::string>().find("did not come to rest") !=
        std::string::npos);
  CHECK(measure(o.json, "top").at("differences").empty());
  CHECK(text_of(scratch.path / "compare.md").find("restless FAILED: ") != std::string::npos);
  // It runs again, the other does not.
  const Outcome again = compare(scratch.path, kColumn, words);
  CHECK(again.code == 3);
  CHECK(again.json.at("runs")[0].at("reused") == true);
  CHECK(again.json.at("runs")[1].at("reused") == false);
}

TEST_CASE("a run that was stopped goes on to the same numbers") {
  const Scratch scratch("compare_test");
  const std::vector<std::string> words{"--cell", "0.2", "--cell", "0.1"};
  const Outcome whole = compare(scratch.path / "a", kColumn, words);
  REQUIRE(whole.code == 0);
  const std::string name = whole.json.at("runs")[1].at("folder");
  REQUIRE(polder_program({"run", kColumn, "-o", (scratch.path / "b" / name).string(), "--quiet", "--until",
                          "0.02", "--set", "output.every=0"}) == 0);
  const Outcome parts = compare(scratch.path / "b", kColumn, words);
  REQUIRE_MESSAGE(parts.code == 0, parts.err);
  CHECK(parts.json.at("measures") == whole.json.at("measures"));
  const auto& run = parts.json.at("runs")[1];
  CHECK(run.at("steps") == whole.json.at("runs")[1].at("steps"));
  CHECK(run.at("computed_steps").get<int>() < run.at("steps").get<int>());
  CHECK(text_of(scratch.path / "b" / "compare.md").find("restarted: ") != std::string::npos);
}

TEST_CASE("bad input starts nothing") {
  const Scratch scratch("compare_test");
  const auto refuse = [&](const std::vector<std::string>& words, const std::string& says) {
    const Outcome o = compare(scratch.path, kColumn, words);
    CAPTURE(o.err);
    CHECK(o.code == 2);
    CHECK(o.err.find(says) != std::string::npos);
    CHECK_FALSE(fs::exists(scratch.path));
  };
  refuse({}, "one run is nothing to compare");
  refuse({"--formulation", "one-layer"}, "one run is nothing to compare");
  refuse({"--formulation", "one-layer", "--formulation", "one-leyer"}, "did you mean \"one-layer\"?");
  refuse({"--formulation", "dry", "--formulation", "dry"}, "\"dry\" is given twice");
  // Which runs a mistake belongs to; one that all have is said once.
  refuse({"--formulation", "one-layer", "--formulation", "dry", "--cell", "0.1", "--cell", "0.07"},
         "(one-layer, cell 0.07; dry, cell 0.07)");
  refuse({"--cell", "0.2", "--cell", "0.1", "--set", "material.sand.porosty=0.4"}, "porosty");
  refuse({"--cell", "0.1", "--cell", "10 cm"}, "is given twice");
  refuse({"--courant", "0.5", "--courant", "0.25", "--set", "numerics.time_step=1e-4"}, "numerics.courant");
  refuse({"--courant", "0.5", "--step", "1e-4"}, "--courant and --step contradict");
  refuse({"--step", "1 m", "--step", "1e-4"}, "is not a time greater than 0");
  refuse({"--variant", "soft", "--formulation", "dry"}, "NAME:key=value");
  refuse({"--cell", "0.2", "--cell", "0.1", "--threads", "0"}, "--threads");
  // A folder that holds a run is not turned into one of a comparison.
  REQUIRE(polder_program({"run", kColumn, "-o", scratch.path.string(), "--quiet", "--until", "1e-3"}) == 0);
  const Outcome o = compare(scratch.path, kColumn, {"--cell", "0.2", "--cell", "0.1"});
  CHECK(o.code == 2);
  CHECK(o.err.find("holds the results of a run") != std::string::npos);
}

TEST_CASE("runs made earlier") {
  const Scratch scratch("compare_test");
  const fs::path family = scratch.path / "family";
  REQUIRE(compare(family, kColumn,
                  {"--formulation", "one-layer", "--formulation", "dry", "--cell", "0.2", "--cell", "0.1"})
              .code == 0);
  const auto run = [&](const std::string& name, const std::vector<std::string>& settings) {
    std::vector<std::string> words{"run", kColumn, "-o", (scratch.path / name).string(), "--quiet"};
    for (const std::string& s : settings) words.insert(words.end(), {"--set", s});
    REQUIRE(polder_program(words) == 0);
    return (scratch.path / name).string();
  };
  const auto compare_runs = [&](const std::string& out, const std::vector<std::string>& folders) {
    std::vector<std::string> words{"compare", "-o", (scratch.path / out).string()};
    words.insert(words.end(), folders.begin(), folders.end());
    Outcome o{};
    o.code = polder_program(words, &o.err);
    if (const fs::path file = scratch.path / out / "compare.json"; fs::exists(file))
      o.json = nlohmann::json::parse(text_of(file));
    return o;
  };
  // The folder of a comparison: the same again.
  const Outcome again = compare_runs("again", {family.string()});
  REQUIRE_MESSAGE(again.code == 0, again.err);
  const auto root = nlohmann::json::parse(text_of(family / "compare.json"));
  CHECK(measure(again.json, "top").at("differences")[0].at("l2") ==
        measure(root, "top").at("differences")[0].at("l2"));
  CHECK(measure(again.json, "top").at("errors")[0].at("known") == true);
  CHECK(again.json.at("runs")[0].at("label") == "dry, cell 0.2 m");  // in the order of the folders
  CHECK(fs::exists(scratch.path / "again" / again.json.at("runs")[0].at("folder").get<std::string>()));

  // Runs with more measures and other output belong to the family of the same scene; other soil does not.
  const std::string fine = run("fine", {"grid.cell=0.05", "output.every=0.01"}),
                    same = run("one-layer-again", {}), soft = run("soft", {"material.sand.young=5e6"});
  const Outcome o = compare_runs("mixed", {(family / "one-layer_cell0.2_courant0.5").string(), fine + "/",
                                           (family / "one-layer_cell0.1_courant0.5").string(), soft, same});
  REQUIRE_MESSAGE(o.code == 0, o.err);
  REQUIRE(o.json.at("runs").size() == 5);
  CHECK(measure(o.json, "top").at("errors")[0].at("cell").at("members") == 3);
  // A second run of the same size is a side of its own, called after its folder.
  CHECK(o.json.at("variants") == nlohmann::json::array({"one-layer", "soft", "one-layer-again"}));
  CHECK(measure(o.json, "top").at("differences")[1].at("l2") == 0);

  const auto refuse = [&](const std::vector<std::string>& words, const std::string& says) {
    const Outcome refused = compare_runs("refused", words);
    CAPTURE(refused.err);
    CHECK(refused.code == 2);
    CHECK(refused.err.find(says) != std::string::npos);
    CHECK_FALSE(fs::exists(scratch.path / "refused"));
  };
  refuse({same}, "one run is nothing to compare");
  refuse({same, same + "/../one-layer-again"}, "is given twice");
  refuse({same, (scratch.path / "nowhere").string()}, "no such folder");
  refuse({kColumn, same}, "is no folder");
  refuse({same, soft, "--cell", "0.1"}, "--cell: runs made earlier are taken as they are");
  fs::create_directories(scratch.path / "empty");
  refuse({same, (scratch.path / "empty").string()}, "holds no run");
}
