#include "app/compare_folders.hpp"

#include <algorithm>
#include <filesystem>
#include <set>

#include "app/digits.hpp"
#include "core/error.hpp"

namespace polder::app {
namespace {

namespace fs = std::filesystem;
using coupling::Scene;

struct Variant {
  Scene scene;  // without what a family or the look at a run may change
  std::vector<std::size_t> runs;
  std::string name;
};

bool is_run(const fs::path& folder) {
  std::error_code failure;
  return fs::exists(folder / "history.csv", failure);
}

std::vector<fs::path> runs_in(const std::string& word) {
  std::error_code failure;
  if (!fs::is_directory(word, failure)) throw InputError(word + ": no such folder");
  if (is_run(word)) return {word};
  std::vector<fs::path> found;
  for (const fs::directory_entry& entry : fs::directory_iterator(word, failure))
    if (entry.is_directory(failure) && is_run(entry.path())) found.push_back(entry.path());
  if (found.empty())
    throw InputError(word + ": holds no run; allowed: the folder of a run, or one of several runs");
  std::sort(found.begin(), found.end());
  return found;
}

Scene bare(Scene s) {
  s.title.clear();
  s.effort = {};
  s.grid.cell = 0;
  s.numerics.courant = 0, s.numerics.time_step.reset();
  s.measures.clear(), s.expectations.clear();
  s.output = {};
  for (coupling::Stage& stage : s.stages) stage.output_every = stage.history_every = 0;
  return s;
}

bool same_size(const ComparedRun& a, const ComparedRun& b) {
  return a.cell() == b.cell() && a.step() == b.step() &&
         a.run.scene.numerics.time_step.has_value() == b.run.scene.numerics.time_step.has_value();
}

std::vector<Variant> group(const std::vector<ComparedRun>& runs) {
  std::vector<Variant> variants;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const Scene scene = bare(runs[i].run.scene);
    auto home = std::find_if(variants.begin(), variants.end(), [&](const Variant& v) {
      return v.scene == scene && std::none_of(v.runs.begin(), v.runs.end(),
                                              [&](std::size_t j) { return same_size(runs[i], runs[j]); });
    });
    if (home == variants.end()) home = variants.insert(home, {scene, {}, ""});
    home->runs.push_back(i);
  }
  return variants;
}

// "results/a-compare/one-layer_cell0.1_courant0.5": one-layer, or with the folders before it.
std::string folder_name(const fs::path& folder, bool whole) {
  const fs::path clean = (folder / "").parent_path();
  const std::string name = whole ? clean.string() : clean.filename().string();
  return name.substr(0, name.rfind("_cell"));
}

template <class Name>
bool names_differ(std::vector<Variant>& variants, const Name& name) {
  std::set<std::string> names;
  for (Variant& v : variants) names.insert(v.name = name(v));
  return names.size() == variants.size();
}

void give_names(std::vector<Variant>& variants, const std::vector<ComparedRun>& runs) {
  const auto first = [&](const Variant& v) { return runs[v.runs.front()].run.folder; };
  if (names_differ(variants, [](const Variant& v) { return v.scene.formulation; })) return;
  if (names_differ(variants, [&](const Variant& v) { return folder_name(first(v), false); })) return;
  if (names_differ(variants, [&](const Variant& v) { return folder_name(first(v), true); })) return;
  names_differ(variants, [&](const Variant& v) { return first(v).string(); });
}

std::string why_incomplete(const RunRecord& run) {
  if (run.completed()) return "";
  return run.status + (run.message.empty() ? " at " + digits(run.time, 5) + " s" : ": " + run.message);
}

}  // namespace

std::vector<ComparedRun> read_runs(const std::vector<std::string>& folders) {
  std::vector<ComparedRun> runs;
  std::set<fs::path> seen;
  for (const std::string& word : folders)
    for (const fs::path& folder : runs_in(word)) {
      if (!seen.insert(fs::canonical(folder)).second)
        throw InputError(folder.string() + ": is given twice; allowed: once");
      ComparedRun r;
      r.run = read_run(folder);
      r.failure = why_incomplete(r.run);
      r.reused = true;
      runs.push_back(std::move(r));
    }
  if (runs.size() < 2)
    throw InputError("polder compare: one run is nothing to compare; allowed: the folders of two or more");
  std::vector<Variant> variants = group(runs);
  give_names(variants, runs);
  std::vector<ComparedRun> ordered;
  for (Variant& v : variants) {
    std::stable_sort(v.runs.begin(), v.runs.end(), [&](std::size_t a, std::size_t b) {
      return is_coarser(runs[a].run.scene, runs[b].run.scene);
    });
    for (const std::size_t i : v.runs) {
      runs[i].variant = v.name;
      ordered.push_back(std::move(runs[i]));
    }
  }
  return ordered;
}

}  // namespace polder::app
