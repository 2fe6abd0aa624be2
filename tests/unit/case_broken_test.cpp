// Every file of tests/broken_cases must be refused with exactly the messages beside it, and nothing may be
// started.
#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include "app/program.hpp"

namespace {

namespace fs = std::filesystem;

std::string read_file(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  REQUIRE_MESSAGE(file.good(), "missing: " << path.string());
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

std::vector<fs::path> broken_cases() {
  std::vector<fs::path> list;
  for (const auto& entry : fs::directory_iterator(fs::path(POLDER_SOURCE_DIR) / "tests/broken_cases"))
    if (entry.path().extension() == ".toml") list.push_back(entry.path());
  std::sort(list.begin(), list.end());
  return list;
}

std::string without(std::string text, const std::string& part) {
  for (std::size_t at; (at = text.find(part)) != std::string::npos;) text.erase(at, part.size());
  return text;
}

}  // namespace

TEST_CASE("broken cases are refused with the expected messages") {
  const std::vector<fs::path> cases = broken_cases();
  REQUIRE(cases.size() >= 35);
  for (const fs::path& path : cases) {
    CAPTURE(path.filename().string());
    std::ostringstream out, err;
    const int code = polder::app::run_program({"check", path.string()}, out, err);
    CHECK(code == 2);
    CHECK(out.str() == "");
    fs::path expected = path;
    expected.replace_extension(".expected");
    CHECK(without(err.str(), path.parent_path().string() + "/") == read_file(expected));
  }
}

TEST_CASE("every message names file, line, column and key") {
  for (const fs::path& path : broken_cases()) {
    CAPTURE(path.filename().string());
    std::ostringstream out, err;
    polder::app::run_program({"check", path.string()}, out, err);
    std::istringstream lines(err.str());
    std::string line;
    int count = 0;
    while (std::getline(lines, line)) {
      ++count;
      REQUIRE(line.starts_with(path.string() + ":"));
      int row = 0, column = 0, used = 0;
      const std::string rest = line.substr(path.string().size());
      CHECK(std::sscanf(rest.c_str(), ":%d:%d: %n", &row, &column, &used) == 2);
      CHECK(row >= 1);
      CHECK(column >= 1);
    }
    CHECK(count >= 1);
  }
}
