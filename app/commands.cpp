#include "app/commands.hpp"

#include <ostream>

#include "app/case.hpp"
#include "app/check_scene.hpp"
#include "app/compare.hpp"
#include "app/digits.hpp"
#include "app/run.hpp"
#include "app/seepage.hpp"
#include "app/size_estimate.hpp"
#include "app/stability.hpp"
#include "core/error.hpp"

namespace polder::app {
namespace {

constexpr std::size_t kAnyNumber = 100000;

std::string count(std::size_t n, const std::string& one, const std::string& many) {
  return std::to_string(n) + " " + (n == 1 ? one : many);
}

int check(const Arguments& a, std::ostream& out, std::ostream& err) {
  int result = static_cast<int>(ExitCode::done);
  for (const std::string& file : a.words) {
    try {
      const coupling::Scene scene = read_case(file, a.all("--set"));
      if (a.has("--resolved")) {
        out << write_case(scene);
        continue;
      }
      const SizeEstimate size = estimate_size(scene);
      out << file << ": valid: " << scene.formulation << ", " << count(scene.bodies.size(), "body", "bodies")
          << ", " << count(scene.stages.size(), "stage", "stages") << ", about " << digits(size.particles, 2)
          << " particles, " << digits(size.memory / 1e6, 2) << " MB\n";
      for (const std::string& note : notes(scene)) out << file << ": note: " << note << '\n';
    } catch (const InputError& e) {
      err << e.what() << '\n';
      result = static_cast<int>(ExitCode::bad_input);
    }
  }
  return result;
}

int schema(const Arguments& a, std::ostream& out, std::ostream&) {
  out << (a.has("--json") ? case_json_schema() : case_reference());
  return static_cast<int>(ExitCode::done);
}

int run(const Arguments& a, std::ostream&, std::ostream&) {
  RunOptions o;
  o.case_file = a.words.front();
  o.settings = a.all("--set");
  o.folder = a.value("--output").value_or(default_folder(o.case_file).string());
  o.overwrite = a.has("--overwrite");
  o.restart = a.has("--restart");
  o.quiet = a.has("--quiet");
  o.threads = a.integer("--threads", 1, kMostThreads).value_or(0);
  o.until = a.time("--until");
  if (o.overwrite && o.restart)
    throw InputError("polder run: --overwrite and --restart contradict each other; allowed: one of them");
  // Expectations are told in the log; it is `verify` that fails when one is missed.
  return static_cast<int>(run_case(o).code);
}

Option set_option() {
  return {"--set", "", "KEY=VALUE", "Replace a key of the case, e.g. --set grid.cell=0.05; KEY= removes it.",
          true};
}

Option threads_option() {
  return {"--threads", "", "N",
          "Number of threads; the results do not depend on it. Default: all cores (or OMP_NUM_THREADS), "
          "fewer for a small case.",
          false};
}

Option folder_option(const std::string& fallback) {
  return {"--output", "-o", "DIR", "Folder of the results, default " + fallback + ".", false};
}

}  // namespace

const std::vector<Command>& commands() {
  static const std::vector<Command> list{
      {"run",
       "CASE",
       1,
       1,
       "Compute a case.",
       {folder_option("results/NAME"),
        set_option(),
        threads_option(),
        {"--restart", "", "", "Go on from the checkpoint in the folder.", false},
        {"--until", "", "T",
         "Stop at the simulated time T, e.g. 12.5 or \"2 h\"; --restart goes on from there.", false},
        {"--quiet", "", "", "Say nothing but errors.", false},
        {"--overwrite", "", "", "Replace results that are in the folder.", false}},
       run},
      {"check",
       "CASE...",
       1,
       kAnyNumber,
       "Read and validate case files; compute nothing.",
       {set_option(), {"--resolved", "", "", "Print the resolved case, with every default.", false}},
       check},
      {"explain",
       "CASE",
       1,
       1,
       "What a case needs and skips and why, its size, its step limit, its run time.",
       {set_option(), threads_option()},
       explain_command},
      {"verify",
       "[CASE...]",
       0,
       kAnyNumber,
       "Run cases, or all of a folder, and compare them with their expectations; without CASE those in the "
       "folder cases but the "
       "extensive ones.",
       {folder_option("results/verify"),
        set_option(),
        threads_option(),
        {"--all", "", "", "Without CASE: also the extensive ones, which take minutes.", false},
        {"--quick", "", "", "Without CASE: only the quick ones, which take seconds.", false},
        {"--junit", "", "FILE", "Write the verdicts as JUnit XML, for CI services.", false}},
       verify_command},
      compare_command(),
      seepage_command(),
      stability_command(),
      {"schema",
       "",
       0,
       0,
       "Print the reference of the case file.",
       {{"--json", "", "", "As JSON Schema, for editors.", false}},
       schema},
  };
  return list;
}

}  // namespace polder::app
