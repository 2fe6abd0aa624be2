// The command line: options, their mistakes, help, and the JSON Schema.
#include <doctest/doctest.h>

#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "app/case.hpp"
#include "app/command_line.hpp"
#include "app/nearest.hpp"
#include "app/program.hpp"
#include "core/error.hpp"

using namespace polder;
using namespace polder::app;

namespace {

struct Result {
  int code;
  std::string out, err;
};

Result run(const std::vector<std::string>& words) {
  std::ostringstream out, err;
  const int code = run_program(words, out, err);
  return {code, out.str(), err.str()};
}

const Command kTry{"try",
                   "CASE",
                   1,
                   1,
                   "Try it.",
                   {{"--output", "-o", "DIR", "Where.", false},
                    {"--set", "", "KEY=VALUE", "What.", true},
                    {"--threads", "", "N", "How many.", false},
                    {"--until", "", "T", "How long.", false},
                    {"--quiet", "", "", "Say nothing.", false}},
                   nullptr};

std::string complaint(const std::vector<std::string>& words) {
  try {
    kTry.read(words);
    return {};
  } catch (const InputError& e) {
    return e.what();
  }
}

}  // namespace

TEST_CASE("options in every form") {
  const Arguments a =
      kTry.read({"-o", "out", "--set", "a=1", "--set=b=2", "case.toml", "--quiet", "--threads=2"});
  CHECK(a.words == std::vector<std::string>{"case.toml"});
  CHECK(a.value("--output") == "out");
  CHECK(a.all("--set") == std::vector<std::string>{"a=1", "b=2"});
  CHECK(a.has("--quiet"));
  CHECK_FALSE(a.has("--until"));
  CHECK(a.integer("--threads", 1, 64) == 2);
  CHECK(kTry.read({"--", "--odd-name"}).words.at(0) == "--odd-name");
  CHECK(kTry.read({"c", "--until", "2 min"}).time("--until") == 120);
  CHECK_FALSE(kTry.read({"c"}).time("--until"));
}

TEST_CASE("mistakes in options") {
  CHECK(complaint({"c", "--quite"}) ==
        "polder try: --quite: unknown option, did you mean \"--quiet\"?; allowed: --output, --set, "
        "--threads, --until, "
        "--quiet, --help");
  CHECK(complaint({"c", "--output"}) == "polder try: --output: a value is missing; allowed: --output DIR");
  CHECK(complaint({"c", "-o", "a", "-o", "b"}) == "polder try: --output: is given twice; allowed: once");
  CHECK(complaint({"c", "--quiet=1"}) == "polder try: --quiet: takes no value");
  CHECK(complaint({}) == "polder try: an argument is missing; allowed: polder try CASE");
  CHECK(complaint({"c", "d"}) ==
        "polder try: too many arguments, beginning with \"d\"; allowed: polder try CASE");
  CHECK_THROWS_AS(kTry.read({"c", "--threads", "two"}).integer("--threads", 1, 64), InputError);
  CHECK_THROWS_AS(kTry.read({"c", "--threads", "0"}).integer("--threads", 1, 64), InputError);
  CHECK_THROWS_AS(kTry.read({"c", "--threads", "2x"}).integer("--threads", 1, 64), InputError);
  CHECK_THROWS_AS(kTry.read({"c", "--until", "3 m"}).time("--until"), InputError);
  CHECK_THROWS_AS(kTry.read({"c", "--until", "-1"}).time("--until"), InputError);
}

TEST_CASE("the program's own words") {
  CHECK(run({}).code == 2);
  CHECK(run({"--help"}).code == 0);
  CHECK(run({"--help"}).out.find("check CASE") != std::string::npos);
  CHECK(run({"--version"}).out.starts_with("polder 0."));
  CHECK(run({"check", "--help"}).out.starts_with("usage: polder check CASE"));
  CHECK(run({"chekc", "x"}).code == 2);
  CHECK(run({"chekc", "x"}).err.find("did you mean \"check\"?") != std::string::npos);
  CHECK(run({"element", "x"}).code == 2);
  CHECK(run({"element", "x"}).err.starts_with("polder: element: not in this version; allowed: "));
  CHECK(run({"plot", "x"}).err.find("script `polder`") != std::string::npos);
  CHECK(run({"check", "nowhere.toml"}).code == 2);
  CHECK(run({"check", "nowhere.toml"}).err == "nowhere.toml: no such file\n");
  CHECK(run({"schema", "--jsn"}).err.find("did you mean \"--json\"?") != std::string::npos);
}

TEST_CASE("check goes on after a broken file and shows the resolved case") {
  const std::string folder = std::string(POLDER_SOURCE_DIR) + "/tests/";
  const Result both =
      run({"check", folder + "broken_cases/missing-key.toml", folder + "valid_cases/minimal.toml"});
  CHECK(both.code == 2);
  CHECK(both.err.find("material.sand.young: missing") != std::string::npos);
  CHECK(both.out.find("minimal.toml: valid: dry, 1 body, 1 stage, about 8 particles") != std::string::npos);
  const Result resolved =
      run({"check", "--resolved", folder + "valid_cases/minimal.toml", "--set", "numerics.flip=0.9"});
  CHECK(resolved.code == 0);
  CHECK(resolved.out.find("flip = 0.9\n") != std::string::npos);
}

TEST_CASE("the schema is JSON and describes the keys") {
  const auto schema = nlohmann::json::parse(run({"schema", "--json"}).out);
  CHECK(schema.at("$schema") == "https://json-schema.org/draft/2020-12/schema");
  CHECK(schema.at("additionalProperties") == false);
  const auto& material = schema.at("properties").at("material").at("additionalProperties");
  CHECK(material.at("properties").at("porosity").at("anyOf").at(0).at("exclusiveMaximum") == 1);
  CHECK(schema.at("properties").at("body").at("items").at("properties").contains("polygon"));
  CHECK(schema.at("properties").at("grid").at("required") == nlohmann::json({"size", "cell"}));
}

TEST_CASE("nearest names") {
  CHECK(edit_distance("porosty", "porosity") == 1);
  CHECK(edit_distance("ab", "ba") == 1);
  CHECK(edit_distance("plane_strain", "Plane-Strain") == 0);
  CHECK(nearest_name("frction", {"fraction", "friction"}) == "fraction");  // both one away: the first
  CHECK(nearest_name("friction_angle", {"cohesion", "friction"}) == "friction");
  CHECK(nearest_name("z", {"x", "y"}).empty());
  CHECK(nearest_name("something", {"else"}).empty());
}
