// A tree of values with the places they were written at: what a case file is before anybody knows what its
// keys mean, and what a scene becomes before it is written as TOML or JSON.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace polder::app {

// Where a value was written. line and column count from 1, 0 = unknown (a value of the command line).
struct Source {
  std::string file;
  int line = 0;
  int column = 0;
};

struct Member;

struct Node {
  enum class Kind { boolean, integer, number, text, array, table, other };

  Kind kind = Kind::table;
  bool boolean = false;
  long long integer = 0;
  double number = 0;  // also set for integers
  std::string text;   // text; for `other` what it is
  std::vector<Node> items;
  std::vector<Member> members;  // in the order of the file
  Source source;
  std::string comment;       // written behind the value
  bool on_one_line = false;  // a table written as { key = value }, without a heading of its own

  static Node of(bool value);
  static Node of(int value);
  static Node of(double value);
  static Node of(std::string value);
  static Node of(const char* value) { return of(std::string(value)); }
  static Node array(std::vector<Node> items = {});
  static Node table() { return {}; }
  static Node inline_table();

  bool is(Kind k) const { return kind == k; }
  bool is_number() const { return kind == Kind::number || kind == Kind::integer; }
  const Node* find(std::string_view key) const;
  Node* find(std::string_view key);
  Node& set(std::string key, Node value);  // appends, or replaces the value of an existing key
  Node with_comment(std::string c) &&;

  // For messages: `the text "abc"`, `the number 3`, `a table`.
  std::string description() const;
};

struct Member {
  std::string key;
  Source key_source;
  Node value;
};

// TOML of a table: keys first, then its tables, then its lists of tables. Reading it gives the same tree.
std::string to_toml(const Node& table);
// One value on one line, as it would stand behind "key = ".
std::string to_toml_value(const Node& value);
// JSON, indented by two blanks. Infinite numbers have no JSON form and become null.
std::string to_json(const Node& value);

}  // namespace polder::app
