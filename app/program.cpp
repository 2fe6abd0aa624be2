#include "app/program.hpp"

#include <algorithm>
#include <new>
#include <ostream>

#include "app/commands.hpp"
#include "app/nearest.hpp"
#include "app/summary.hpp"
#include "core/error.hpp"

namespace polder::app {
namespace {

int code(ExitCode c) {
  return static_cast<int>(c);
}

// Commands of the design that do not exist yet, so that nobody looks for the mistake in the spelling.
bool is_later(const std::string& name) {
  static const std::vector<std::string> names{"element", "calibrate-band", "report"};
  return std::find(names.begin(), names.end(), name) != names.end();
}

// What the script `polder` at the top of the source tree does before or instead of calling the program.
bool is_of_the_script(const std::string& name) {
  return name == "plot" || name == "test" || name == "setup" || name == "bench";
}

std::vector<std::string> command_names() {
  std::vector<std::string> names;
  for (const Command& c : commands()) names.push_back(c.name);
  return names;
}

std::string version_text() {
  const std::string commit = program_commit();
  return "polder " + program_version() + (commit.empty() ? "" : " " + commit) + " (" + program_build() +
         ")\n";
}

std::string usage() {
  std::string text =
      "Polder computes seepage failure in levees: material points for the soil, finite differences for the "
      "pore water.\n\n"
      "usage: polder COMMAND [arguments]\n\n";
  for (const Command& c : commands()) {
    std::string left = "  " + c.name + " " + c.words;
    left.resize(std::max<std::size_t>(left.size() + 1, 22), ' ');
    text += left + c.summary + "\n";
  }
  text +=
      "\n`polder COMMAND --help` tells more. `polder --version` names the version. The script `polder` at "
      "the top of the\n"
      "source tree adds plot, bench, test and setup.\n\n"
      "exit codes: 0 done; 1 expectation missed; 2 bad input; 3 numerical failure; 4 environment; 130 "
      "interrupted\n";
  return text;
}

int run_command(const std::vector<std::string>& words, std::ostream& out, std::ostream& err) {
  if (words.empty()) {
    err << usage();
    return code(ExitCode::bad_input);
  }
  const std::string& name = words.front();
  if (name == "--help" || name == "-h" || name == "help") {
    out << usage();
    return code(ExitCode::done);
  }
  if (name == "--version") {
    out << version_text();
    return code(ExitCode::done);
  }
  const std::vector<std::string> rest(words.begin() + 1, words.end());
  for (const Command& c : commands()) {
    if (c.name != name) continue;
    // Also where other arguments are wrong: who asks for help gets it.
    const auto last = std::find(rest.begin(), rest.end(), "--");
    if (std::find(rest.begin(), last, "--help") != last || std::find(rest.begin(), last, "-h") != last) {
      out << c.help();
      return code(ExitCode::done);
    }
    return c.run(c.read(rest), out, err);
  }
  const std::string allowed = "; allowed: " + join(command_names());
  if (is_later(name)) throw InputError("polder: " + name + ": not in this version" + allowed);
  if (is_of_the_script(name))
    throw InputError("polder: " + name + ": is done by the script `polder` at the top of the source tree" +
                     allowed);
  throw InputError("polder: " + name + ": unknown command" + did_you_mean(name, command_names()) + allowed);
}

}  // namespace

int run_program(const std::vector<std::string>& words, std::ostream& out, std::ostream& err) {
  try {
    return run_command(words, out, err);
  } catch (const InputError& e) {
    err << e.what() << '\n';
    return code(ExitCode::bad_input);
  } catch (const NumericalError& e) {
    err << "polder: " << e.what() << '\n';
    return code(ExitCode::numerical_failure);
  } catch (const EnvironmentError& e) {
    err << "polder: " << e.what() << '\n';
    return code(ExitCode::environment);
  } catch (const std::bad_alloc&) {
    err << "polder: there is not enough memory for this case\n";
    return code(ExitCode::environment);
  }
}

}  // namespace polder::app
