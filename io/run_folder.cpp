#include "io/run_folder.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "io/atomic_file.hpp"

namespace polder {
namespace fs = std::filesystem;
namespace {

constexpr std::array<std::string_view, 14> kFiles = {
    "case.toml",        "log.txt",      "history.csv",         "probes.csv",        "bodies.csv",
    "phreatic.csv",     "summary.json", "checkpoint.h5",       "stability.json",    "trials.csv",
    "slip_surface.csv", "flow.json",    "stream_function.csv", "exit_gradients.csv"};
constexpr std::array<std::string_view, 4> kSets = {"soil", "water", "fluid", "grains"};

// What comes after `set` in the names of its frames and index: NAME_000120.hdf, NAME.hdf.series, where NAME
// is the set or set_body.
bool is_frame_or_index(std::string_view name) {
  const bool of_set = std::any_of(kSets.begin(), kSets.end(), [&](std::string_view set) {
    return name.starts_with(set) && name.size() > set.size() &&
           (name[set.size()] == '_' || name[set.size()] == '.');
  });
  if (!of_set) return false;
  if (name.ends_with(".hdf.series")) return true;
  if (!name.ends_with(".hdf")) return false;
  name.remove_suffix(4);
  const std::size_t digits = name.size() - std::min(name.find_last_not_of("0123456789") + 1, name.size());
  return digits >= 6 && name[name.size() - digits - 1] == '_';
}

std::vector<fs::path> results_in(const fs::path& folder) {
  std::vector<fs::path> found;
  std::error_code error;
  fs::directory_iterator files(folder, error);
  if (error) throw_file_error(folder, "cannot be listed", error.value());
  for (const fs::directory_entry& entry : files) {
    if (RunFolder::is_result(entry.path().filename().string())) found.push_back(entry.path());
  }
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace

bool RunFolder::is_result(const std::string& file_name) {
  std::string_view name = file_name;
  if (name.ends_with(kTemporarySuffix)) name.remove_suffix(kTemporarySuffix.size());
  // profile_NAME.csv, stability_NAME.csv, and reference_FILE.csv: what is expected, copied beside the results
  const bool numbered =
      (name.starts_with("profile_") || name.starts_with("stability_") || name.starts_with("reference_")) &&
      name.ends_with(".csv");
  return numbered || std::find(kFiles.begin(), kFiles.end(), name) != kFiles.end() || is_frame_or_index(name);
}

RunFolder::RunFolder(fs::path path, Mode mode) : path_(std::move(path)) {
  std::error_code error;
  if (fs::exists(path_, error) && !fs::is_directory(path_, error)) {
    throw InputError(path_.string() + ": is a file; a folder for the results is wanted");
  }
  if (mode == Mode::read) {
    if (!fs::is_directory(path_, error)) throw InputError(path_.string() + ": no such folder");
    return;
  }
  if (mode == Mode::restart && !fs::exists(checkpoint(), error)) {
    throw InputError(path_.string() + ": holds no checkpoint.h5 to restart from; run without --restart");
  }
  fs::create_directories(path_, error);
  if (error) throw_file_error(path_, "the folder cannot be created", error.value());
  if (::access(path_.c_str(), W_OK | X_OK) != 0)
    throw_file_error(path_, "the folder cannot be written to", errno);
  if (mode == Mode::restart) return;

  const std::vector<fs::path> results = results_in(path_);
  if (results.empty()) return;
  if (mode == Mode::fresh) {
    throw InputError(
        path_.string() + ": holds results already (" + results.front().filename().string() +
        "); use --overwrite to replace them, --restart to continue them, or -o for another folder");
  }
  for (const fs::path& file : results) {
    if (!fs::remove(file, error) && error) throw_file_error(file, "cannot be removed", error.value());
  }
}

}  // namespace polder
