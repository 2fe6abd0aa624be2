// Between a running simulation and a checkpoint file: every number that decides what comes next, there and
// back.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "coupling/simulation.hpp"
#include "io/checkpoint.hpp"

namespace polder::app {

class CheckpointVisitor final : public coupling::StateVisitor {
 public:
  explicit CheckpointVisitor(CheckpointWriter& writer) : writer_(&writer) {}
  explicit CheckpointVisitor(const CheckpointReader& reader) : reader_(&reader) {}

  bool reading() const override { return reader_ != nullptr; }
  void reals(const std::string& name, Reals& values) override;
  void integers(const std::string& name, std::vector<int>& values) override;
  void number(const std::string& name, double& value) override;
  void count(const std::string& name, std::int64_t& value) override;

 private:
  CheckpointWriter* writer_ = nullptr;
  const CheckpointReader* reader_ = nullptr;
};

}  // namespace polder::app
