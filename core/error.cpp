#include "core/error.hpp"

namespace polder {
namespace {
std::string join(const std::vector<Diagnostic>& diagnostics) {
  std::string all;
  for (const Diagnostic& d : diagnostics) all += (all.empty() ? "" : "\n") + d.text();
  return all;
}
}  // namespace

std::string Diagnostic::text() const {
  std::string t;
  if (!file.empty()) {
    t += file;
    if (line > 0) t += ":" + std::to_string(line);
    if (line > 0 && column > 0) t += ":" + std::to_string(column);
    t += ": ";
  }
  if (!key.empty()) t += key + ": ";
  t += problem;
  if (!allowed.empty()) t += "; allowed: " + allowed;
  return t;
}

InputError::InputError(std::vector<Diagnostic> diagnostics)
    : std::runtime_error(join(diagnostics)), diagnostics_(std::move(diagnostics)) {}

InputError::InputError(const std::string& message)
    : std::runtime_error(message), diagnostics_{Diagnostic{{}, 0, 0, {}, message, {}}} {}

}  // namespace polder
