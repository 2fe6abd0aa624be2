#include "coupling/memory_state.hpp"

#include <cstring>

namespace polder::coupling {

void MemoryState::reals(const std::string& name, Reals& values) {
  if (reading_)
    values = arrays.at(name);
  else
    arrays[name] = values;
}
void MemoryState::integers(const std::string& name, std::vector<int>& values) {
  if (reading_)
    values = lists.at(name);
  else
    lists[name] = values;
}
void MemoryState::number(const std::string& name, double& value) {
  if (reading_)
    value = numbers.at(name);
  else
    numbers[name] = value;
}
void MemoryState::count(const std::string& name, std::int64_t& value) {
  if (reading_)
    value = counts.at(name);
  else
    counts[name] = value;
}
std::vector<std::string> MemoryState::differences(const MemoryState& other) const {
  std::vector<std::string> names;
  const auto compare = [&](const auto& mine, const auto& theirs, const auto& same) {
    if (mine.size() != theirs.size()) names.push_back("number of entries");
    for (const auto& [name, value] : mine) {
      const auto match = theirs.find(name);
      if (match == theirs.end() || !same(value, match->second)) names.push_back(name);
    }
  };
  compare(arrays, other.arrays, [](const Reals& a, const Reals& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
  });
  compare(lists, other.lists, [](const auto& a, const auto& b) { return a == b; });
  compare(numbers, other.numbers, [](double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; });
  compare(counts, other.counts, [](auto a, auto b) { return a == b; });
  return names;
}

}  // namespace polder::coupling
