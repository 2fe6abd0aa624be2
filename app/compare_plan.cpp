#include "app/compare_plan.hpp"

#include <algorithm>
#include <optional>

#include "app/case.hpp"
#include "app/check_scene.hpp"
#include "app/comparison.hpp"
#include "app/document.hpp"
#include "app/run.hpp"
#include "app/run_record.hpp"
#include "core/error.hpp"
#include "core/units.hpp"
#include "io/run_folder.hpp"

namespace polder::app {
namespace {

namespace fs = std::filesystem;
using coupling::Scene;

struct Variant {
  std::string name;
  std::vector<std::string> settings;
};

// "key=value,key=value": commas inside brackets, braces and quotes belong to a value.
std::vector<std::string> split_settings(const std::string& text) {
  std::vector<std::string> parts(1);
  int depth = 0;
  char quote = 0;
  for (const char c : text) {
    if (quote != 0) {
      if (c == quote) quote = 0;
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '[' || c == '{') {
      ++depth;
    } else if (c == ']' || c == '}') {
      --depth;
    }
    if (c == ',' && depth == 0 && quote == 0)
      parts.emplace_back();
    else
      parts.back() += c;
  }
  return parts;
}

std::vector<Variant> variants(const Arguments& a, const std::string& own_formulation) {
  std::vector<Variant> list;
  for (const std::string& f : a.all("--formulation")) list.push_back({f, {"formulation=" + f}});
  for (const std::string& text : a.all("--variant")) {
    const std::size_t colon = text.find(':');
    const std::string name = text.substr(0, colon);
    if (colon == std::string::npos || colon + 1 == text.size() || !is_identifier(name))
      throw InputError("polder compare: --variant \"" + text +
                       "\": no name and settings; allowed: NAME:key=value,key=value, a name of letters, "
                       "digits, \"_\" and \"-\"");
    list.push_back({name, split_settings(text.substr(colon + 1))});
  }
  if (list.empty()) list.push_back({own_formulation, {}});
  for (std::size_t i = 0; i < list.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (list[i].name == list[j].name)
        throw InputError("polder compare: \"" + list[i].name + "\" is given twice; allowed: once");
  return list;
}

// The options' values, or once nothing where there are none.
std::vector<std::optional<std::string>> values(const Arguments& a, const std::string& option) {
  std::vector<std::optional<std::string>> list;
  for (const std::string& v : a.all(option)) list.emplace_back(v);
  if (list.empty()) list.emplace_back();
  return list;
}

std::string folder_name(const std::string& variant, const Scene& s) {
  return variant + "_cell" + format_number(s.grid.cell) +
         (s.numerics.time_step ? "_step" + format_number(*s.numerics.time_step)
                               : "_courant" + format_number(s.numerics.courant));
}

// What is wrong, and with which runs. What is wrong with all of them is the case's own mistake.
class Findings {
 public:
  void add(const Diagnostic& d, const std::string& label) { find(d).labels.push_back(label); }
  bool empty() const { return found_.empty(); }
  std::vector<Diagnostic> list(std::size_t runs) const {
    std::vector<Diagnostic> all;
    for (const Found& f : found_) {
      all.push_back(f.diagnostic);
      if (f.labels.size() == runs) continue;
      std::string labels;
      for (const std::string& l : f.labels) labels += (labels.empty() ? "" : "; ") + l;
      all.back().problem += " (" + labels + ")";
    }
    return all;
  }

 private:
  struct Found {
    Diagnostic diagnostic;
    std::vector<std::string> labels;
  };
  Found& find(const Diagnostic& d) {
    for (Found& f : found_)
      if (f.diagnostic.text() == d.text()) return f;
    found_.push_back({d, {}});
    return found_.back();
  }
  std::vector<Found> found_;
};

bool holds_results(const fs::path& folder) {
  std::error_code failure;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, failure))
    if (RunFolder::is_result(entry.path().filename().string())) return true;
  return false;
}

PlannedRun::Action action_for(const PlannedRun& run, bool overwrite) {
  using Action = PlannedRun::Action;
  std::error_code failure;
  if (!holds_results(run.folder)) return Action::fresh;
  if (overwrite) return Action::again;
  const RunFolder folder(run.folder, RunFolder::Mode::read);
  if (!fs::exists(folder.case_file(), failure) ||
      read_text_file(folder.case_file().string()) != resolved_case(run.scene))
    throw InputError(run.folder.string() +
                     ": holds results of another case or of other settings; allowed: --overwrite to replace "
                     "them, or -o for another folder");
  const bool checkpoint = fs::exists(folder.checkpoint(), failure);
  if (!fs::exists(folder.summary(), failure)) return checkpoint ? Action::go_on : Action::again;
  const RunRecord found = read_run(run.folder);
  if (found.finished()) return Action::reuse;
  return checkpoint && found.status != "failed" ? Action::go_on : Action::again;
}

void check_options(const Arguments& a) {
  if (a.has("--courant") && a.has("--step"))
    throw InputError(
        "polder compare: --courant and --step contradict each other; allowed: one of them, "
        "several times");
}

// One run as the command line asks for it; throws InputError.
Scene scene_of(const std::string& file, const std::vector<std::string>& settings,
               std::optional<double> step) {
  Scene scene = read_case(file, settings);
  if (step) scene.numerics.time_step = step;
  return scene;
}

}  // namespace

ComparePlan plan_comparison(const Arguments& a, const fs::path& folder, bool overwrite) {
  check_options(a);
  ComparePlan plan;
  plan.case_file = a.words.front();
  const std::vector<std::string> common = a.all("--set");
  const bool named = a.has("--formulation") || a.has("--variant");
  const std::vector<Variant> all_variants =
      variants(a, named ? std::string() : read_case(plan.case_file, common).formulation);
  std::vector<std::optional<double>> steps;
  for (const double s : a.times("--step")) steps.emplace_back(s);
  if (steps.empty()) steps.emplace_back();

  Findings wrong, noted;
  std::size_t count = 0;
  for (const Variant& v : all_variants) {
    std::vector<PlannedRun> family;
    for (const auto& cell : values(a, "--cell"))
      for (const auto& courant : values(a, "--courant"))
        for (const auto& step : steps) {
          ++count;
          std::vector<std::string> settings = common;
          std::string label = v.name;
          settings.insert(settings.end(), v.settings.begin(), v.settings.end());
          if (cell) settings.push_back("grid.cell=" + *cell), label += ", cell " + *cell;
          if (courant) settings.push_back("numerics.courant=" + *courant), label += ", courant " + *courant;
          try {
            PlannedRun run;
            run.variant = v.name;
            run.scene = scene_of(plan.case_file, settings, step);
            for (const std::string& note : notes(run.scene))
              noted.add({plan.case_file, 0, 0, "", "note: " + note, ""}, label);
            family.push_back(std::move(run));
          } catch (const InputError& e) {
            for (const Diagnostic& d : e.diagnostics()) wrong.add(d, label);
          }
        }
    std::stable_sort(family.begin(), family.end(),
                     [](const PlannedRun& x, const PlannedRun& y) { return is_coarser(x.scene, y.scene); });
    std::move(family.begin(), family.end(), std::back_inserter(plan.runs));
  }
  if (!wrong.empty()) throw InputError(wrong.list(count));
  if (count < 2)
    throw InputError(
        "polder compare: one run is nothing to compare; allowed: several times --formulation, --variant, "
        "--cell, --courant or --step");
  if ((a.has("--courant") || a.has("--step")) &&
      std::none_of(plan.runs.front().scene.stages.begin(), plan.runs.front().scene.stages.end(),
                   [](const coupling::Stage& s) { return s.moves(); }))
    throw InputError(
        "polder compare: no stage of the case moves soil, so --courant and --step change nothing; allowed: "
        "without them");
  for (const Diagnostic& d : noted.list(count)) plan.notes.push_back(d.text());

  const bool steps_differ = a.has("--courant") || a.has("--step");
  for (PlannedRun& run : plan.runs) {
    run.label = run_label(run.variant, run.scene, a.has("--cell"), steps_differ);
    run.folder = folder / folder_name(run.variant, run.scene);
    const auto same = [&](const PlannedRun& r) { return &r != &run && r.folder == run.folder; };
    if (std::any_of(plan.runs.begin(), plan.runs.end(), same))
      throw InputError("polder compare: " + run.label + " is given twice; allowed: once");
    check_memory(run.scene);
    run.action = action_for(run, overwrite);
  }
  return plan;
}

}  // namespace polder::app
