#include "app/case.hpp"

#include "app/case_keys.hpp"
#include "app/check_scene.hpp"
#include "app/document.hpp"

namespace polder::app {

coupling::Scene read_case_text(const std::string& text, const std::string& file,
                               const std::vector<std::string>& settings) {
  std::vector<Diagnostic> diagnostics;
  Node document = parse_toml(text, file, diagnostics);
  // Without its structure nothing can be said about the keys of a file.
  if (!diagnostics.empty()) throw InputError(std::move(diagnostics));
  for (const std::string& s : settings) apply_setting(document, s, diagnostics);
  if (!diagnostics.empty()) throw InputError(std::move(diagnostics));

  Reader reader(file);
  case_keys().read(document, "", reader.scene, reader);
  check_scene(reader);
  diagnostics = reader.diagnostics();
  if (!diagnostics.empty()) throw InputError(std::move(diagnostics));
  return std::move(reader.scene);
}

coupling::Scene read_case(const std::string& path, const std::vector<std::string>& settings) {
  return read_case_text(read_text_file(path), path, settings);
}

std::string write_case(const coupling::Scene& scene) {
  return to_toml(case_keys().write(scene, scene));
}

}  // namespace polder::app
