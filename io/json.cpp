#include "io/json.hpp"

#include <charconv>
#include <cmath>
#include <cstdio>
#include <stdexcept>

namespace polder {
namespace {

// Length of the well-formed UTF-8 sequence at the start of `text` (Unicode 15, table 3-7), 0 if there is
// none.
std::size_t utf8_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u; };
  const auto trails = [&](std::size_t i) { return byte(i) >= 0x80 && byte(i) <= 0xBF; };
  const unsigned lead = byte(0);
  if (lead < 0x80) return 1;
  if (lead >= 0xC2 && lead <= 0xDF) return trails(1) ? 2 : 0;
  if (lead >= 0xE0 && lead <= 0xEF) {
    if (lead == 0xE0 && byte(1) < 0xA0) return 0;  // written longer than needed
    if (lead == 0xED && byte(1) > 0x9F) return 0;  // half of a UTF-16 pair
    return trails(1) && trails(2) ? 3 : 0;
  }
  if (lead >= 0xF0 && lead <= 0xF4) {
    if (lead == 0xF0 && byte(1) < 0x90) return 0;
    if (lead == 0xF4 && byte(1) > 0x8F) return 0;  // beyond U+10FFFF
    return trails(1) && trails(2) && trails(3) ? 4 : 0;
  }
  return 0;
}

void write_text(std::string& out, std::string_view text) {
  out += '"';
  while (!text.empty()) {
    const std::size_t length = utf8_length(text);
    const char c = text.front();
    if (length == 0)
      out += "\\ufffd";
    else if (length > 1)
      out += text.substr(0, length);
    else if (c == '"' || c == '\\')
      (out += '\\') += c;
    else if (c == '\n')
      out += "\\n";
    else if (c == '\t')
      out += "\\t";
    else if (c == '\r')
      out += "\\r";
    else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) {
      char code[8];
      std::snprintf(code, sizeof code, "\\u%04x", static_cast<unsigned>(c));
      out += code;
    } else
      out += c;
    text.remove_prefix(length == 0 ? 1 : length);
  }
  out += '"';
}

template <class Number>
void write_number(std::string& out, Number value) {
  char digits[32];
  const auto end = std::to_chars(digits, digits + sizeof digits, value).ptr;
  out.append(digits, end);
}

void new_line(std::string& out, int level) {
  out += '\n';
  out.append(static_cast<std::size_t>(level) * 2, ' ');
}

template <class... Cases>
struct Overloaded : Cases... {
  using Cases::operator()...;
};
template <class... Cases>
Overloaded(Cases...) -> Overloaded<Cases...>;

}  // namespace

Json& Json::operator[](std::string_view key) {
  if (std::holds_alternative<std::monostate>(value_)) value_ = std::vector<Member>{};
  auto* members = std::get_if<std::vector<Member>>(&value_);
  if (members == nullptr) throw std::logic_error("JSON: a member is set in something that is not an object");
  for (Member& member : *members) {
    if (member.first == key) return member.second;
  }
  return members->emplace_back(std::string(key), Json()).second;
}

void Json::push_back(Json item) {
  if (std::holds_alternative<std::monostate>(value_)) value_ = std::vector<Json>{};
  auto* items = std::get_if<std::vector<Json>>(&value_);
  if (items == nullptr) throw std::logic_error("JSON: an item is added to something that is not an array");
  items->push_back(std::move(item));
}

void Json::write(std::string& out, int level) const {
  std::visit(
      Overloaded{
          [&](std::monostate) { out += "null"; },
          [&](bool value) { out += value ? "true" : "false"; },
          [&](double value) {
            if (std::isfinite(value))
              write_number(out, value);
            else
              out += "null";
          },
          [&](const Integer& value) { std::visit([&](auto number) { write_number(out, number); }, value); },
          [&](const std::string& text) { write_text(out, text); },
          [&](const std::vector<Json>& items) {
            if (items.empty()) return void(out += "[]");
            out += '[';
            for (std::size_t i = 0; i < items.size(); ++i) {
              if (i > 0) out += ',';
              new_line(out, level + 1);
              items[i].write(out, level + 1);
            }
            new_line(out, level);
            out += ']';
          },
          [&](const std::vector<Member>& members) {
            if (members.empty()) return void(out += "{}");
            out += '{';
            for (std::size_t i = 0; i < members.size(); ++i) {
              if (i > 0) out += ',';
              new_line(out, level + 1);
              write_text(out, members[i].first);
              out += ": ";
              members[i].second.write(out, level + 1);
            }
            new_line(out, level);
            out += '}';
          },
      },
      value_);
}

std::string Json::text() const {
  std::string out;
  write(out, 0);
  out += '\n';
  return out;
}

}  // namespace polder
