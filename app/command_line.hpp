// Reading a command's arguments. A command declares its options once; the declaration reads, checks and
// documents them.
#pragma once

#include <iosfwd>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace polder::app {

struct Option {
  std::string name;        // "--output"
  std::string short_name;  // "-o", may be empty
  std::string value;       // "DIR"; empty: a flag
  std::string sentence;
  bool repeatable = false;
};

class Arguments {
 public:
  std::vector<std::string> words;  // what is not an option

  bool has(const std::string& option) const { return options_.contains(option); }
  std::vector<std::string> all(const std::string& option) const;
  std::optional<std::string> value(const std::string& option) const;
  // Throw InputError if the value is not what is due.
  std::optional<int> integer(const std::string& option, int min, int max) const;
  std::optional<double> time(const std::string& option) const;  // [s], plain or with a unit
  std::vector<double> times(const std::string& option) const;   // of a repeatable option

 private:
  friend struct Command;
  std::map<std::string, std::vector<std::string>> options_;
};

struct Command {
  std::string name;
  std::string words;  // "CASE", "CASE...", "[CASE...]"; empty: none
  std::size_t min_words = 0, max_words = 0;
  std::string summary;
  std::vector<Option> options;
  int (*run)(const Arguments&, std::ostream& out, std::ostream& err) = nullptr;

  // Throws InputError with everything that is wrong.
  Arguments read(const std::vector<std::string>& words) const;
  std::string help() const;
};

}  // namespace polder::app
