// `polder verify`: runs cases and compares them with their expectations.
#include <algorithm>
#include <filesystem>
#include <ostream>

#include "app/case.hpp"
#include "app/commands.hpp"
#include "app/digits.hpp"
#include "app/run.hpp"
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

// cases/NAME/NAME.toml of the present folder that expect something.
std::vector<std::string> cases_with_expectations() {
  std::vector<std::string> list;
  std::error_code failure;
  for (const fs::directory_entry& entry : fs::directory_iterator("cases", failure)) {
    const fs::path file = entry.path() / (entry.path().filename().string() + ".toml");
    if (fs::exists(file, failure) && !read_case(file.string()).expectations.empty())
      list.push_back(file.string());
  }
  if (list.empty())
    throw InputError(
        "polder verify: no cases/NAME/NAME.toml with [[expect]] here; allowed: polder verify CASE...");
  std::sort(list.begin(), list.end());
  return list;
}

std::string padded(std::string text, std::size_t width) {
  if (text.size() < width) text.resize(width, ' ');
  return text + "  ";
}

void print_table(const std::vector<Verdict>& verdicts, std::ostream& out) {
  out << padded("case", 24) << padded("measure", 20) << padded("norm", 8) << padded("error", 10)
      << padded("tolerance", 10) << padded("", 6) << "wall\n";
  for (const Verdict& v : verdicts) {
    if (!v.failure.empty()) out << padded(v.name, 24) << "FAILED: " << v.failure << '\n';
    for (const ExpectationResult& e : v.outcome.expectations)
      out << padded(v.name, 24) << padded(e.measure, 20) << padded(e.norm, 8)
          << padded(digits(e.error, 3), 10) << padded(digits(e.tolerance, 3), 10)
          << padded(e.pass ? "pass" : "MISS", 6) << duration_text(v.outcome.wall_seconds)
          << (e.problem.empty() ? "" : "  " + e.problem) << '\n';
  }
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
      open(e.measure + " " + e.norm);
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
  const std::vector<std::string> files = a.words.empty() ? cases_with_expectations() : a.words;
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
