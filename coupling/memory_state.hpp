// The state of a simulation in memory: what a checkpoint keeps, to go back to it or to compare it bit by bit.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "coupling/simulation.hpp"

namespace polder::coupling {

class MemoryState final : public StateVisitor {
 public:
  bool reading() const override { return reading_; }
  void reals(const std::string& name, Reals& values) override;
  void integers(const std::string& name, std::vector<int>& values) override;
  void number(const std::string& name, double& value) override;
  void count(const std::string& name, std::int64_t& value) override;

  // Of a Simulation, or of anything else that a visitor may visit.
  template <class Visited>
  void save(Visited& visited) {
    reading_ = false;
    visited.visit(*this);
  }
  template <class Visited>
  void load(Visited& visited) {
    reading_ = true;
    visited.visit(*this);
    reading_ = false;
  }
  // Names of what differs, bit by bit.
  std::vector<std::string> differences(const MemoryState& other) const;

  std::map<std::string, Reals> arrays;
  std::map<std::string, std::vector<int>> lists;
  std::map<std::string, double> numbers;
  std::map<std::string, std::int64_t> counts;

 private:
  bool reading_ = false;
};

}  // namespace polder::coupling
