// The folder of a run: the names of its files, and the rule that results are never overwritten by accident.
#pragma once

#include <filesystem>
#include <string>

namespace polder {

class RunFolder {
 public:
  enum class Mode {
    fresh,      // refuses a folder that holds results
    overwrite,  // deletes the results in it; files that are not Polder's stay
    restart,    // needs the checkpoint in it
    read,       // what lies in it is read, nothing is made or changed
  };

  // Creates the folder, with its parents, if it is missing. InputError if the mode does not fit what is
  // there, EnvironmentError if the disk refuses.
  RunFolder(std::filesystem::path path, Mode mode);

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path case_file() const { return path_ / "case.toml"; }  // resolved, with every default
  std::filesystem::path log() const { return path_ / "log.txt"; }
  std::filesystem::path history() const { return path_ / "history.csv"; }
  std::filesystem::path probes() const { return path_ / "probes.csv"; }
  std::filesystem::path bodies() const { return path_ / "bodies.csv"; }
  std::filesystem::path phreatic() const { return path_ / "phreatic.csv"; }
  std::filesystem::path summary() const { return path_ / "summary.json"; }
  std::filesystem::path checkpoint() const { return path_ / "checkpoint.h5"; }

  // Whether a file of this name is one that a run writes.
  static bool is_result(const std::string& file_name);

 private:
  std::filesystem::path path_;
};

}  // namespace polder
