// The state of reading one case: the scene being filled, where each key was written, and everything that is
// wrong. Keys are dotted paths with list elements counted from 1: "body.2.polygon".
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "app/node.hpp"
#include "core/error.hpp"
#include "core/units.hpp"
#include "coupling/scene.hpp"

namespace polder::app {

// Whether a text can be part of keys, file names and column names: letters, digits, "_" and "-".
bool is_identifier(const std::string& text);

// A scene as it is before anything is read: where the defaults come from.
const coupling::Scene& default_scene();

class Reader {
 public:
  // file: as the user named it; files mentioned in the case are looked for beside it.
  explicit Reader(std::string file);

  coupling::Scene scene;

  const std::filesystem::path& directory() const { return directory_; }

  void mark(const std::string& key, const Source& source);  // the key is given, there
  bool given(const std::string& key) const { return sources_.contains(key); }

  // Dimension of the unit with which a value of any dimension is given; none if it is a plain number.
  void note_dimension(const std::string& key, const Dimension& d) { dimensions_.emplace(key, d); }
  std::optional<Dimension> dimension_of(const std::string& key) const {
    const auto at = dimensions_.find(key);
    return at == dimensions_.end() ? std::nullopt : std::optional(at->second);
  }

  // Something is wrong with a key; its place is that of the key, or of the nearest table around it.
  void error(const std::string& key, const std::string& problem, const std::string& allowed = "");
  // An error was found in this key, in a part of it or in a table around it: its value cannot be relied on.
  bool failed(const std::string& key) const;

  // Number of coordinates of points; 0 while the grid's space could not be read.
  int dimension() const { return failed("grid.space") ? 0 : scene.dimension(); }

  // All errors, in the order of the file.
  std::vector<Diagnostic> diagnostics() const;

 private:
  std::string file_;
  std::filesystem::path directory_;
  std::map<std::string, Source> sources_;
  std::map<std::string, Dimension> dimensions_;
  std::set<std::string> failed_;
  std::vector<Diagnostic> diagnostics_;
};

}  // namespace polder::app
