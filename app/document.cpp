#include "app/document.hpp"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <toml++/toml.h>

#include "app/nearest.hpp"

namespace polder::app {
namespace {

constexpr std::uintmax_t kMaxFileSize = 16u
                                        << 20;  // a case is written by hand; more than 16 MiB is a mistake

Source source_of(const toml::source_region& region, const std::string& file) {
  return {file, static_cast<int>(region.begin.line), static_cast<int>(region.begin.column)};
}

bool is_before(const Source& a, const Source& b) {
  return a.line != b.line ? a.line < b.line : a.column < b.column;
}

Node convert(const toml::node& from, const std::string& file) {
  Node n;
  if (const toml::table* table = from.as_table()) {
    n = Node::table();
    for (const auto& [key, value] : *table)
      n.members.push_back({std::string(key.str()), source_of(key.source(), file), convert(value, file)});
    // toml++ sorts keys by name; people, and the resolved case, want the order of the file.
    std::stable_sort(n.members.begin(), n.members.end(),
                     [](const Member& a, const Member& b) { return is_before(a.key_source, b.key_source); });
  } else if (const toml::array* array = from.as_array()) {
    n = Node::array();
    for (const toml::node& item : *array) n.items.push_back(convert(item, file));
  } else if (const auto* text = from.as_string()) {
    n = Node::of(text->get());
  } else if (const auto* integer = from.as_integer()) {
    n.kind = Node::Kind::integer;
    n.integer = integer->get();
    n.number = static_cast<double>(n.integer);
  } else if (const auto* number = from.as_floating_point()) {
    n = Node::of(number->get());
  } else if (const auto* boolean = from.as_boolean()) {
    n = Node::of(boolean->get());
  } else {
    n.kind = Node::Kind::other;
    n.text = "a date or time of day";
  }
  n.source = source_of(from.source(), file);
  return n;
}

std::vector<std::string> split_path(const std::string& path) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  while (true) {
    const std::size_t dot = path.find('.', begin);
    parts.push_back(path.substr(begin, dot - begin));
    if (dot == std::string::npos) return parts;
    begin = dot + 1;
  }
}

// The value of a setting, with every position replaced by the command line.
void relocate(Node& n, const std::string& file) {
  n.source = {file, 0, 0};
  for (Node& item : n.items) relocate(item, file);
  for (Member& m : n.members) {
    m.key_source = {file, 0, 0};
    relocate(m.value, file);
  }
}

Node parse_value(const std::string& text, const std::string& origin, std::vector<Diagnostic>& diagnostics,
                 const std::string& key) {
  std::vector<Diagnostic> failures;
  Node table = parse_toml("value = " + text + "\n", origin, failures);
  Node value;
  if (failures.empty() && table.members.size() == 1) {
    value = std::move(table.members.front().value);
  } else if (text.find_first_of("[]{}\"'\n=") != std::string::npos) {
    diagnostics.push_back(
        {origin, 0, 0, key, "the value is not TOML", "a number, true or false, a text, [list]"});
    value = Node::of(text);
  } else {
    value = Node::of(text);
  }
  relocate(value, origin);
  return value;
}

// The element of a list that a part of a path names; null if there is none.
Node* find_item(Node& list, const std::string& part) {
  std::size_t number = 0;
  const auto [end, failure] = std::from_chars(part.data(), part.data() + part.size(), number);
  if (failure == std::errc{} && end == part.data() + part.size())
    return number >= 1 && number <= list.items.size() ? &list.items[number - 1] : nullptr;
  for (Node& item : list.items)
    if (const Node* name = item.find("name"); name && name->is(Node::Kind::text) && name->text == part)
      return &item;
  return nullptr;
}

std::string item_names(const Node& list) {
  std::string text = "1 to " + std::to_string(list.items.size());
  for (const Node& item : list.items)
    if (const Node* name = item.find("name"); name && name->is(Node::Kind::text)) text += ", " + name->text;
  return text;
}

// A case file that may be meant where a folder was given.
std::filesystem::path case_in(const std::filesystem::path& folder) {
  std::error_code failure;
  std::vector<std::filesystem::path> found;
  for (const auto& entry : std::filesystem::directory_iterator(folder, failure))
    if (entry.path().extension() == ".toml") found.push_back(entry.path());
  return found.empty() ? folder / "case.toml" : *std::min_element(found.begin(), found.end());
}

}  // namespace

Node parse_toml(const std::string& text, const std::string& file, std::vector<Diagnostic>& diagnostics) {
  try {
    return convert(toml::parse(std::string_view(text), std::string_view(file)), file);
  } catch (const toml::parse_error& e) {
    const Source at = source_of(e.source(), file);
    diagnostics.push_back({file, at.line, at.column, "", "not TOML: " + std::string(e.description()), ""});
    return Node::table();
  }
}

std::string read_text_file(const std::string& path) {
  std::error_code failure;
  const auto status = std::filesystem::status(path, failure);
  if (!std::filesystem::exists(status)) throw InputError(path + ": no such file");
  if (std::filesystem::is_directory(status))
    throw InputError(path + ": is a folder; allowed: a case file, such as " + case_in(path).string());
  const auto size = std::filesystem::file_size(path, failure);
  if (!failure && size > kMaxFileSize)
    throw InputError(path + ": " + std::to_string(size >> 20) + " MiB; allowed: at most 16 MiB");
  std::ifstream stream(path, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  if (!stream) throw InputError(path + ": cannot be read");
  return text;
}

void apply_setting(Node& document, const std::string& setting, std::vector<Diagnostic>& diagnostics) {
  const std::size_t equals = setting.find('=');
  const std::string origin = "--set " + setting;
  if (equals == std::string::npos || equals == 0) {
    diagnostics.push_back({origin, 0, 0, "", "no key and value", "--set key=value"});
    return;
  }
  const std::string path = setting.substr(0, equals);
  const bool removes = equals + 1 == setting.size();  // "key=": as if the case did not give it
  Node value = removes ? Node() : parse_value(setting.substr(equals + 1), origin, diagnostics, path);
  Node* at = &document;
  const std::vector<std::string> parts = split_path(path);
  std::string walked;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const bool last = i + 1 == parts.size();
    const auto fail = [&](const std::string& problem, const std::string& allowed) {
      diagnostics.push_back({origin, 0, 0, path, problem, allowed});
    };
    if (parts[i].empty()) return fail("a part of the key is empty", "parts joined by single dots");
    if (at->is(Node::Kind::array)) {
      Node* item = find_item(*at, parts[i]);
      if (!item) return fail(walked + " has no element \"" + parts[i] + "\"", item_names(*at));
      if (last && removes) {
        at->items.erase(at->items.begin() + (item - at->items.data()));
        return;
      }
      if (last) *item = std::move(value);
      at = item;
    } else if (at->is(Node::Kind::table)) {
      Node* next = at->find(parts[i]);
      if (last && removes) {
        if (!next) return fail("is not there to be removed", "a key that the case gives");
        std::erase_if(at->members, [&](const Member& m) { return m.key == parts[i]; });
        return;
      }
      if (last) {
        at->set(parts[i], std::move(value));
        return;
      }
      if (!next) {
        Node made = Node::table();
        made.source = {origin, 0, 0};
        next = &at->set(parts[i], std::move(made));
      }
      at = next;
    } else {
      return fail(walked + " is " + at->description() + ", it has no parts", "");
    }
    walked += (walked.empty() ? "" : ".") + parts[i];
  }
}

}  // namespace polder::app
