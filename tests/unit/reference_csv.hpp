// Reader of the reference solutions in tests/reference: one '#' line with parameters "name=value; ...", one
// line of column names, rows of numbers.
#pragma once

#include <doctest/doctest.h>

#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

struct ReferenceCsv {
  std::map<std::string, double> parameter;
  std::vector<std::string> columns;
  std::vector<std::vector<double>> rows;

  explicit ReferenceCsv(const std::string& name) {
    std::ifstream file(std::string(POLDER_SOURCE_DIR) + "/tests/reference/" + name);
    REQUIRE_MESSAGE(file.good(), name);
    std::string line, cell;
    while (std::getline(file, line)) {
      std::istringstream in(line);
      if (line[0] == '#') {
        while (std::getline(in, cell, ';')) {
          const auto equals = cell.rfind('=');
          const auto space = cell.find_last_of(" ", equals == std::string::npos ? equals : equals - 1);
          std::istringstream number(equals == std::string::npos ? "" : cell.substr(equals + 1));
          double value;
          if (number >> value) parameter[cell.substr(space + 1, equals - space - 1)] = value;
        }
      } else if (columns.empty()) {
        while (std::getline(in, cell, ',')) columns.push_back(cell);
      } else {
        rows.emplace_back();
        while (std::getline(in, cell, ',')) rows.back().push_back(std::stod(cell));
        REQUIRE(rows.back().size() == columns.size());
      }
    }
    REQUIRE(!rows.empty());
  }

  double get(const std::string& name) const {
    REQUIRE_MESSAGE(parameter.count(name) == 1, name);
    return parameter.at(name);
  }
  bool has(const std::string& name) const { return parameter.count(name) == 1; }
};
