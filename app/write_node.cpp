// Trees of values as TOML (the resolved case) and as JSON (the schema for editors).
#include <cmath>
#include <cstdio>

#include "app/node.hpp"
#include "core/units.hpp"

namespace polder::app {
namespace {

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    switch (c) {
      case '"':
        out += "\\\"";
        break;
      case '\\':
        out += "\\\\";
        break;
      case '\n':
        out += "\\n";
        break;
      case '\r':
        out += "\\r";
        break;
      case '\t':
        out += "\\t";
        break;
      default:
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) {
          char code[8];
          std::snprintf(code, sizeof code, "\\u%04x", static_cast<unsigned>(static_cast<unsigned char>(c)));
          out += code;
        } else {
          out += c;
        }
    }
  }
  return out + '"';
}

std::string toml_key(const std::string& key) {
  bool bare = !key.empty();
  for (const char c : key)
    bare = bare && ((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
                    c == '-');
  return bare ? key : quoted(key);
}

bool has_heading(const Node& n) {
  return n.is(Node::Kind::table) && !n.on_one_line;
}

bool is_table_list(const Node& n) {
  if (!n.is(Node::Kind::array) || n.items.empty()) return false;
  for (const Node& item : n.items)
    if (!item.is(Node::Kind::table)) return false;
  return true;
}

// Whether a table is written under a heading of its own; tables inside a [[list]] stay on one line.
void write_table(const Node& table, const std::string& path, bool inside_list, std::string& out) {
  for (const Member& m : table.members) {
    const bool heading = !inside_list && (has_heading(m.value) || is_table_list(m.value));
    if (heading) continue;
    out += toml_key(m.key) + " = " + to_toml_value(m.value);
    if (!m.value.comment.empty()) out += "  # " + m.value.comment;
    out += '\n';
  }
  if (inside_list) return;
  for (const Member& m : table.members) {
    const std::string name = path.empty() ? toml_key(m.key) : path + "." + toml_key(m.key);
    if (has_heading(m.value)) {
      bool only_tables = !m.value.members.empty();
      for (const Member& inner : m.value.members) only_tables = only_tables && has_heading(inner.value);
      if (!only_tables) out += "\n[" + name + "]\n";
      write_table(m.value, name, false, out);
    } else if (is_table_list(m.value)) {
      for (const Node& item : m.value.items) {
        out += "\n[[" + name + "]]\n";
        write_table(item, name, true, out);
      }
    }
  }
}

std::string json_number(double value) {
  return std::isfinite(value) ? format_number(value) : "null";
}

void write_json(const Node& n, const std::string& indent, std::string& out) {
  const std::string deeper = indent + "  ";
  switch (n.kind) {
    case Node::Kind::boolean:
      out += n.boolean ? "true" : "false";
      break;
    case Node::Kind::integer:
      out += std::to_string(n.integer);
      break;
    case Node::Kind::number:
      out += json_number(n.number);
      break;
    case Node::Kind::text:
    case Node::Kind::other:
      out += quoted(n.text);
      break;
    case Node::Kind::array: {
      out += '[';
      for (std::size_t i = 0; i < n.items.size(); ++i) {
        if (i > 0) out += ", ";
        write_json(n.items[i], deeper, out);
      }
      out += ']';
      break;
    }
    case Node::Kind::table: {
      out += '{';
      bool first = true;
      for (const Member& m : n.members) {
        out += first ? "\n" : ",\n";
        first = false;
        out += deeper + quoted(m.key) + ": ";
        write_json(m.value, deeper, out);
      }
      out += n.members.empty() ? "}" : "\n" + indent + "}";
      break;
    }
  }
}

}  // namespace

std::string to_toml_value(const Node& n) {
  switch (n.kind) {
    case Node::Kind::boolean:
      return n.boolean ? "true" : "false";
    case Node::Kind::integer:
      return std::to_string(n.integer);
    case Node::Kind::number:
      return format_number(n.number);
    case Node::Kind::text:
      return quoted(n.text);
    case Node::Kind::other:
      return n.text;
    case Node::Kind::array: {
      std::string out = "[";
      for (std::size_t i = 0; i < n.items.size(); ++i) out += (i > 0 ? ", " : "") + to_toml_value(n.items[i]);
      return out + "]";
    }
    case Node::Kind::table: {
      if (n.members.empty()) return "{}";
      std::string out = "{";
      bool first = true;
      for (const Member& m : n.members) {
        out += (first ? " " : ", ") + toml_key(m.key) + " = " + to_toml_value(m.value);
        first = false;
      }
      return out + " }";
    }
  }
  return {};
}

std::string to_toml(const Node& table) {
  std::string out;
  write_table(table, "", false, out);
  return out;
}

std::string to_json(const Node& value) {
  std::string out;
  write_json(value, "", out);
  return out + "\n";
}

}  // namespace polder::app
