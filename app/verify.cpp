// `polder verify`: runs cases and compares them with their expectations.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <ostream>

#include "app/case.hpp"
#include "app/commands.hpp"
#include "app/digits.hpp"
#include "app/run.hpp"
#include "app/text_table.hpp"
#include "io/atomic_file.hpp"
#include "io/log.hpp"

namespace polder::app {
namespace {

namespace fs = std::filesystem;

// Of one case.
struct Verdict {
  std::string name, file, failure;
  RunOutcome outcome;

  bool missed() const {
    return std::any_of(outcome.expectations.begin(), outcome.expectations.end(),
                       [](const auto& e) { return !e.pass; });
  }
};

// The case files of a folder that expect something and take no more than this effort.
std::vector<std::string> cases_in(const fs::path& folder, coupling::Effort most) {
  std::vector<std::string> list;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() != ".toml") continue;
    const coupling::Scene scene = read_case(entry.path().string());
    if (!scene.expectations.empty() && scene.effort <= most) list.push_back(entry.path().string());
  }
  std::sort(list.begin(), list.end());
  return list;
}

// cases/NAME/*.toml of the present folder.
std::vector<std::string> all_cases(coupling::Effort most) {
  std::vector<std::string> list;
  std::error_code failure;
  for (const fs::directory_entry& folder : fs::directory_iterator("cases", failure)) {
    if (!folder.is_directory(failure)) continue;
    const std::vector<std::string> found = cases_in(folder.path(), most);
    list.insert(list.end(), found.begin(), found.end());
  }
  if (list.empty())
    throw InputError(
        "polder verify: no case with [[expect]] in the folder cases here; allowed: polder verify CASE..., or "
        "another folder");
  std::sort(list.begin(), list.end());
  return list;
}

// A folder stands for the cases in it.
std::vector<std::string> named_cases(const std::vector<std::string>& words) {
  std::vector<std::string> list;
  for (const std::string& word : words) {
    std::error_code failure;
    if (!fs::is_directory(word, failure)) {
      list.push_back(word);
      continue;
    }
    const std::vector<std::string> found = cases_in(word, coupling::Effort::extensive);
    if (found.empty()) throw InputError("polder verify: " + word + ": holds no case with [[expect]]");
    list.insert(list.end(), found.begin(), found.end());
  }
  return list;
}

void print_table(const std::vector<Verdict>& verdicts, std::ostream& out) {
  TextRows rows{{"case", "measure", "norm", "", "measured", "expected", "error", "tolerance", "", "wall"}};
  const auto number = [](double x, int n) { return std::isnan(x) ? std::string("-") : digits(x, n); };
  double wall = 0;
  int missed = 0, all = 0;
  for (const Verdict& v : verdicts) {
    wall += v.outcome.wall_seconds;
    std::string name = v.name, seconds = duration_text(v.outcome.wall_seconds);
    for (const ExpectationResult& e : v.outcome.expectations) {
      rows.push_back({name, e.measure, e.norm, e.when, number(e.measured, 5), e.expected, number(e.error, 3),
                      e.tolerance > 0 ? digits(e.tolerance, 3) : "-", e.pass ? "pass" : "MISS", seconds,
                      e.problem});
      ++all, missed += e.pass ? 0 : 1;
      name.clear(), seconds.clear();  // once for each case
    }
  }
  out << aligned_table(rows);
  for (const Verdict& v : verdicts)
    if (!v.failure.empty()) out << v.name << "  FAILED: " << v.failure << '\n';
  out << all - missed << " of " << all << " expectations of " << verdicts.size()
      << (verdicts.size() == 1 ? " case" : " cases") << " met in " << duration_text(wall) << '\n';
}

std::string xml(const std::string& text) {
  std::string out;
  for (const char c : text) switch (c) {
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '&':
        out += "&amp;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  return out;
}

// The format that CI services read: one test case for each expectation.
std::string junit(const std::vector<Verdict>& verdicts) {
  std::string body;
  int tests = 0, failures = 0, errors = 0;
  for (const Verdict& v : verdicts) {
    const auto open = [&](const std::string& name) {
      ++tests;
      body += "  <testcase classname=\"" + xml(v.name) + "\" name=\"" + xml(name) + "\" time=\"" +
              digits(v.outcome.wall_seconds, 3) + "\"";
    };
    if (!v.failure.empty()) {
      open("run");
      ++errors;
      body += "><error message=\"" + xml(v.failure) + "\"/></testcase>\n";
    }
    for (const ExpectationResult& e : v.outcome.expectations) {
      open(e.measure + " " + e.norm + (e.when.empty() ? "" : " " + e.when));
      if (e.pass) {
        body += "/>\n";
        continue;
      }
      ++failures;
      body += "><failure message=\"error " + digits(e.error, 3) + ", tolerance " + digits(e.tolerance, 3) +
              (e.problem.empty() ? "" : "; " + xml(e.problem)) + "\"/></testcase>\n";
    }
  }
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuite name=\"polder verify\" tests=\"" +
         std::to_string(tests) + "\" failures=\"" + std::to_string(failures) + "\" errors=\"" +
         std::to_string(errors) + "\">\n" + body + "</testsuite>\n";
}

}  // namespace

int verify_command(const Arguments& a, std::ostream& out, std::ostream& err) {
  if (a.has("--all") && a.has("--quick"))
    throw InputError("polder verify: --all and --quick contradict each other; allowed: one of them");
  if (!a.words.empty() && (a.has("--all") || a.has("--quick")))
    throw InputError(
        "polder verify: --all and --quick choose among the cases in the folder cases; allowed: "
        "without CASE");
  const std::vector<std::string> files = !a.words.empty()
                                             ? named_cases(a.words)
                                             : all_cases(a.has("--all")     ? coupling::Effort::extensive
                                                         : a.has("--quick") ? coupling::Effort::quick
                                                                            : coupling::Effort::normal);
  // All are read before the first one runs: a mistake in the last should not show after hours.
  std::vector<Diagnostic> wrong;
  for (const std::string& file : files) {
    try {
      if (read_case(file, a.all("--set")).expectations.empty())
        wrong.push_back({file, 0, 0, "expect", "the case expects nothing", "[[expect]]"});
    } catch (const InputError& e) {
      wrong.insert(wrong.end(), e.diagnostics().begin(), e.diagnostics().end());
    }
  }
  if (!wrong.empty()) throw InputError(std::move(wrong));

  std::vector<Verdict> verdicts;
  ExitCode code = ExitCode::done;
  for (const std::string& file : files) {
    Verdict v{fs::path(file).stem().string(), file, "", {}};
    RunOptions o;
    o.case_file = file;
    o.settings = a.all("--set");
    o.folder = fs::path(a.value("--output").value_or("results/verify")) / v.name;
    o.overwrite = true;
    o.quiet = true;
    o.threads = a.integer("--threads", 1, kMostThreads).value_or(0);
    err << "running " << file << '\n' << std::flush;
    v.outcome = run_case(o);
    if (v.outcome.code == ExitCode::interrupted) return static_cast<int>(ExitCode::interrupted);
    if (v.outcome.code != ExitCode::done) {
      v.failure = "the computation broke down, see " + (o.folder / "log.txt").string();
      code = v.outcome.code;
    } else if (v.missed() && code == ExitCode::done) {
      code = ExitCode::expectation_missed;
    }
    verdicts.push_back(std::move(v));
  }
  print_table(verdicts, out);
  if (const auto report = a.value("--junit")) write_file_atomically(*report, junit(verdicts));
  return static_cast<int>(code);
}

}  // namespace polder::app
