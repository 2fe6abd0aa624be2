#include "app/commands.hpp"

#include <cmath>
#include <ostream>

#include "app/case.hpp"
#include "app/check_scene.hpp"
#include "app/size_estimate.hpp"
#include "core/error.hpp"
#include "core/units.hpp"

namespace polder::app {
namespace {

constexpr std::size_t kAnyNumber = 100000;

// Two digits: what is estimated should not look exact.
std::string coarse(double value) {
  if (!(value > 0)) return "0";
  const double scale = std::pow(10, 1 - std::floor(std::log10(value)));
  return format_number(std::round(value * scale) / scale);
}

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
          << ", " << count(scene.stages.size(), "stage", "stages") << ", about " << coarse(size.particles)
          << " particles, " << coarse(size.memory / 1e6) << " MB\n";
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

}  // namespace

Option set_option() {
  return {"--set", "", "KEY=VALUE", "Replace a key of the case, e.g. --set grid.cell=0.05.", true};
}

Option threads_option() {
  return {"--threads", "", "N", "Number of threads; the results do not depend on it.", false};
}

const std::vector<Command>& commands() {
  static const std::vector<Command> list{
      {"check",
       "CASE...",
       1,
       kAnyNumber,
       "Read and validate case files; compute nothing.",
       {set_option(), {"--resolved", "", "", "Print the resolved case, with every default.", false}},
       check},
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
