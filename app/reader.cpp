#include "app/reader.hpp"

#include <algorithm>
#include <tuple>

namespace polder::app {
namespace {

// "body.2.polygon" -> "body.2" -> "body" -> "".
std::string parent_of(const std::string& key) {
  const std::size_t dot = key.rfind('.');
  return dot == std::string::npos ? std::string() : key.substr(0, dot);
}

}  // namespace

bool is_identifier(const std::string& text) {
  for (const char c : text)
    if (!((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-'))
      return false;
  return !text.empty();
}

const coupling::Scene& default_scene() {
  static const coupling::Scene scene;
  return scene;
}

Reader::Reader(std::string file)
    : file_(std::move(file)), directory_(std::filesystem::path(file_).parent_path()) {
  sources_[""] = {file_, 1, 1};
}

void Reader::mark(const std::string& key, const Source& source) {
  sources_[key] = source;
}

void Reader::error(const std::string& key, const std::string& problem, const std::string& allowed) {
  std::string at = key;
  while (!sources_.contains(at)) at = parent_of(at);
  const Source& source = sources_.at(at);
  diagnostics_.push_back({source.file, source.line, source.column, key, problem, allowed});
  failed_.insert(key);
}

bool Reader::failed(const std::string& key) const {
  for (std::string at = key; !at.empty(); at = parent_of(at))
    if (failed_.contains(at)) return true;
  const auto inside = failed_.lower_bound(key + ".");
  return inside != failed_.end() && inside->starts_with(key + ".");
}

std::vector<Diagnostic> Reader::diagnostics() const {
  std::vector<Diagnostic> sorted = diagnostics_;
  std::stable_sort(sorted.begin(), sorted.end(), [](const Diagnostic& a, const Diagnostic& b) {
    return std::tie(a.line, a.column) < std::tie(b.line, b.column);
  });
  return sorted;
}

}  // namespace polder::app
