#include "app/checkpoint_state.hpp"

namespace polder::app {

void CheckpointVisitor::reals(const std::string& name, Reals& values) {
  if (writer_) {
    writer_->put(name, std::span<const double>(values));
  } else {
    const std::vector<double> read = reader_->array<double>(name);
    values.assign(read.begin(), read.end());
  }
}

void CheckpointVisitor::integers(const std::string& name, std::vector<int>& values) {
  if (writer_)
    writer_->put(name, std::span<const std::int32_t>(values));
  else
    values = reader_->array<std::int32_t>(name);
}

void CheckpointVisitor::number(const std::string& name, double& value) {
  if (writer_)
    writer_->put_number(name, value);
  else
    value = reader_->number<double>(name);
}

void CheckpointVisitor::count(const std::string& name, std::int64_t& value) {
  if (writer_)
    writer_->put_number(name, value);
  else
    value = reader_->number<std::int64_t>(name);
}

}  // namespace polder::app
