// JSON for summary.json and index files: built as a tree, written with its keys in the order they were set.
//
// Numbers are written with the fewest digits that read back to the same double; NaN and infinities, which
// JSON does not have, become null. Text is UTF-8; quotes, backslashes and control characters are escaped, and
// bytes that are not UTF-8 are replaced, so the result is valid JSON whatever goes in.
#pragma once

#include <concepts>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace polder {

class Json {
 public:
  using Member = std::pair<std::string, Json>;

  Json() = default;  // null
  Json(bool value) : value_(value) {}
  Json(double value) : value_(value) {}
  template <std::integral T>
  requires(!std::same_as<T, bool>) Json(T value) : value_(make_integer(value)) {}
  Json(const char* text) : value_(std::string(text)) {}
  Json(std::string text) : value_(std::move(text)) {}
  Json(std::string_view text) : value_(std::string(text)) {}

  static Json object() { return Json(std::vector<Member>{}); }
  static Json array() { return Json(std::vector<Json>{}); }
  template <class Range>
  static Json array_of(const Range& values) {
    Json all = array();
    for (const auto& value : values) all.push_back(Json(value));
    return all;
  }

  // Member of an object, added at the end if it is new; null turns into an object. The reference is good
  // until the next member is added.
  Json& operator[](std::string_view key);
  // Next item of an array; null turns into an array.
  void push_back(Json item);

  // Indented by two spaces a level, ending with a new line.
  std::string text() const;

 private:
  using Integer = std::variant<std::int64_t, std::uint64_t>;
  template <class T>
  static Integer make_integer(T value) {
    if constexpr (std::signed_integral<T>)
      return static_cast<std::int64_t>(value);
    else
      return static_cast<std::uint64_t>(value);
  }
  explicit Json(std::vector<Member> members) : value_(std::move(members)) {}
  explicit Json(std::vector<Json> items) : value_(std::move(items)) {}
  void write(std::string& out, int level) const;

  std::variant<std::monostate, bool, double, Integer, std::string, std::vector<Json>, std::vector<Member>>
      value_;
};

}  // namespace polder
