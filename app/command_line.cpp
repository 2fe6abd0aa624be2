#include "app/command_line.hpp"

#include <charconv>
#include <cmath>

#include "app/nearest.hpp"
#include "core/error.hpp"
#include "core/units.hpp"

namespace polder::app {
namespace {

const Option* find_option(const std::vector<Option>& options, const std::string& name) {
  for (const Option& o : options)
    if (o.name == name || (!o.short_name.empty() && o.short_name == name)) return &o;
  return nullptr;
}

std::string option_names(const std::vector<Option>& options) {
  std::vector<std::string> names;
  for (const Option& o : options) names.push_back(o.name);
  names.push_back("--help");
  return join(names);
}

}  // namespace

std::vector<std::string> Arguments::all(const std::string& option) const {
  const auto found = options_.find(option);
  return found == options_.end() ? std::vector<std::string>{} : found->second;
}

std::optional<std::string> Arguments::value(const std::string& option) const {
  const auto found = options_.find(option);
  return found == options_.end() ? std::nullopt : std::optional(found->second.back());
}

std::optional<int> Arguments::integer(const std::string& option, int min, int max) const {
  const auto text = value(option);
  if (!text) return std::nullopt;
  int n = 0;
  const auto [end, failure] = std::from_chars(text->data(), text->data() + text->size(), n);
  if (failure != std::errc{} || end != text->data() + text->size() || n < min || n > max)
    throw InputError(option + ": \"" + *text + "\" is not such a number; allowed: integer, from " +
                     std::to_string(min) + " to " + std::to_string(max));
  return n;
}

std::vector<double> Arguments::times(const std::string& option) const {
  std::vector<double> list;
  for (const std::string& text : all(option)) {
    const Quantity q = parse_quantity(text);
    const bool is_time = q.error.empty() && (!q.has_unit || q.dimension == dimension::kTime);
    if (!is_time || !(q.value > 0) || std::isinf(q.value))
      throw InputError(option + ": \"" + text +
                       "\" is not a time greater than 0; allowed: a number in s, or with a unit (" +
                       unit_examples(dimension::kTime) + ")");
    list.push_back(q.value);
  }
  return list;
}

std::optional<double> Arguments::time(const std::string& option) const {
  const std::vector<double> list = times(option);
  return list.empty() ? std::nullopt : std::optional(list.back());
}

Arguments Command::read(const std::vector<std::string>& given) const {
  std::vector<Diagnostic> wrong;
  const auto complain = [&](const std::string& key, const std::string& problem, const std::string& allowed) {
    wrong.push_back({"polder " + name, 0, 0, key, problem, allowed});
  };
  Arguments a;
  bool only_words = false;
  for (std::size_t i = 0; i < given.size(); ++i) {
    const std::string& word = given[i];
    if (word == "--" && !only_words) {
      only_words = true;
      continue;
    }
    if (only_words || word.size() < 2 || word[0] != '-') {
      a.words.push_back(word);
      continue;
    }
    // --output=DIR and --output DIR mean the same.
    const std::size_t equals = word.starts_with("--") ? word.find('=') : std::string::npos;
    const std::string option_name = word.substr(0, equals);
    const Option* option = find_option(options, option_name);
    if (!option) {
      std::vector<std::string> names{"--help"};
      for (const Option& o : options) names.push_back(o.name);
      complain(option_name, "unknown option" + did_you_mean(option_name, names), option_names(options));
      continue;
    }
    if (option->value.empty()) {
      if (equals != std::string::npos) complain(option->name, "takes no value", "");
      a.options_[option->name];
      continue;
    }
    std::string value;
    if (equals != std::string::npos) {
      value = word.substr(equals + 1);
    } else if (i + 1 < given.size()) {
      value = given[++i];
    } else {
      complain(option->name, "a value is missing", option->name + " " + option->value);
      continue;
    }
    std::vector<std::string>& values = a.options_[option->name];
    if (!values.empty() && !option->repeatable) complain(option->name, "is given twice", "once");
    values.push_back(std::move(value));
  }
  if (a.words.size() < min_words) complain("", "an argument is missing", "polder " + name + " " + words);
  if (a.words.size() > max_words)
    complain("", "too many arguments, beginning with \"" + a.words[max_words] + "\"",
             "polder " + name + " " + words);
  if (!wrong.empty()) throw InputError(std::move(wrong));
  return a;
}

std::string Command::help() const {
  std::string text = "usage: polder " + name;
  if (!words.empty()) text += " " + words;
  text += " [options]\n\n" + summary + "\n\noptions:\n";
  const auto line = [&](const std::string& left, const std::string& right) {
    std::string l = "  " + left;
    if (l.size() < 26)
      l.resize(26, ' ');
    else
      l += "\n" + std::string(26, ' ');
    text += l + right + "\n";
  };
  for (const Option& o : options)
    line((o.short_name.empty() ? "" : o.short_name + ", ") + o.name + (o.value.empty() ? "" : " " + o.value),
         o.sentence + (o.repeatable ? " May be repeated." : ""));
  line("--help", "This text.");
  return text;
}

}  // namespace polder::app
