// Declarations of keys. Each key is declared once: its name, its type with unit and range (a Codec), the
// member it fills, and one sentence. The declaration reads, checks, documents, echoes and gives the JSON
// Schema. The default is the value the member has in a freshly made object, so it too is written down once.
#pragma once

#include <concepts>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/nearest.hpp"
#include "app/reader.hpp"

namespace polder::app {

struct TableText;

// How a key's tables are written: [key], [[key]], [key.NAME].
enum class Nest { none, one, list, named };

// A type of value: how it is read, written and described.
template <class V>
struct Codec {
  std::string type;     // "pressure [Pa]"
  std::string allowed;  // range or choices; may be empty
  Node schema;          // JSON Schema
  std::function<bool(const Node&, const std::string& key, V&, Reader&)> read;
  std::function<Node(const V&, const coupling::Scene&)> write;
  std::shared_ptr<const TableText> table;  // keys inside, for tables
  Nest nest = Nest::none;

  std::string description() const { return allowed.empty() ? type : type + ", " + allowed; }
};

// What people are told about a key.
struct KeyText {
  std::string name, type, allowed, sentence;
  std::string fallback;    // default as it would be written; empty: none
  std::string applies_to;  // `model = "mohr-coulomb"`; empty: always
  bool required = false;
  Node schema;
  std::shared_ptr<const TableText> table;
  Nest nest = Nest::none;

  std::string description() const { return allowed.empty() ? type : type + ", " + allowed; }
};

struct TableText {
  std::vector<KeyText> keys;
};

inline std::string key_path(const std::string& table, const std::string& name) {
  return table.empty() ? name : table + "." + name;
}

template <class T>
class Table {
 public:
  class Entry {
   public:
    Entry& required() {
      text.required = true;
      text.fallback.clear();
      return *this;
    }
    // The member's value before reading is no default a user could rely on.
    Entry& without_default() {
      text.fallback.clear();
      return *this;
    }
    // The key counts only where `applies`; elsewhere it is an error, never silently ignored. `discriminator`
    // is the key that decides, `condition` says so in words.
    Entry& only_with(std::string key, std::string condition, std::function<bool(const T&)> test) {
      discriminator = std::move(key);
      text.applies_to = std::move(condition);
      applies = std::move(test);
      return *this;
    }

   private:
    friend class Table;
    KeyText text;
    std::string discriminator;
    std::function<bool(const T&)> applies;
    std::function<bool(const Node&, const std::string&, T&, Reader&)> read;
    std::function<std::optional<Node>(const T&, const coupling::Scene&)> write;
  };

  template <class V, class Base>
  requires std::derived_from<T, Base> Entry& add(std::string name, const Codec<V>& codec, V Base::*member,
                                                 std::string sentence) {
    Entry& e = declare(std::move(name), codec, std::move(sentence));
    // In place: while a table is read, what it already holds decides how the rest is read (the space of the
    // grid).
    e.read = [codec, member](const Node& n, const std::string& key, T& t, Reader& reader) {
      return codec.read(n, key, t.*member, reader);
    };
    // What is empty and is so by default is not echoed: an empty polygon is no polygon.
    const T fresh{};
    const V& unset = fresh.*member;
    const bool without = is_unset(codec, unset);
    e.write = [codec, member, without](const T& t, const coupling::Scene& scene) -> std::optional<Node> {
      return present(codec.write(t.*member, scene), without);
    };
    set_fallback(e, codec, unset);
    return e;
  }

  // A member that may be absent has no default.
  template <class V, class Base>
  requires std::derived_from<T, Base> Entry& add(std::string name, const Codec<V>& codec,
                                                 std::optional<V> Base::*member, std::string sentence) {
    Entry& e = declare(std::move(name), codec, std::move(sentence));
    e.read = [codec, member](const Node& n, const std::string& key, T& t, Reader& reader) {
      V v{};
      if (!codec.read(n, key, v, reader)) return false;
      t.*member = std::move(v);
      return true;
    };
    e.write = [codec, member](const T& t, const coupling::Scene& scene) -> std::optional<Node> {
      if (!(t.*member)) return std::nullopt;
      return codec.write(*(t.*member), scene);
    };
    return e;
  }

  template <class V>
  Entry& add(std::string name, const Codec<V>& codec, std::function<V(const T&)> get,
             std::function<void(T&, V)> set, std::string sentence) {
    Entry& e = declare(std::move(name), codec, std::move(sentence));
    e.read = [codec, get, set](const Node& n, const std::string& key, T& t, Reader& reader) {
      V v = get(t);
      const bool good = codec.read(n, key, v, reader);
      set(t, std::move(v));
      return good;
    };
    e.write = [codec, get](const T& t, const coupling::Scene& scene) -> std::optional<Node> {
      return codec.write(get(t), scene);
    };
    set_fallback(e, codec, get(T{}));
    return e;
  }

  // A second way to give what another key holds: it is read, but the resolved case has the other key.
  template <class V>
  Entry& add_alternative(std::string name, const Codec<V>& codec, std::function<void(T&, V)> set,
                         std::string sentence) {
    Entry& e = declare(std::move(name), codec, std::move(sentence));
    e.read = [codec, set](const Node& n, const std::string& key, T& t, Reader& reader) {
      V v{};
      if (!codec.read(n, key, v, reader)) return false;
      set(t, std::move(v));
      return true;
    };
    e.write = [](const T&, const coupling::Scene&) { return std::optional<Node>(); };
    return e;
  }

  // A key that is known but belongs to something this version does not have.
  void later(std::string name, std::string what) { later_.push_back({std::move(name), std::move(what)}); }

  // A check of several keys together, after all have been read.
  void check(std::function<void(T&, const std::string& key, Reader&)> f) { checks_.push_back(std::move(f)); }

  bool read(const Node& node, const std::string& path, T& out, Reader& reader) const {
    if (!node.is(Node::Kind::table)) {
      reader.error(path, "expected a table, found " + node.description(), "keys " + join(names()));
      return false;
    }
    report_unknown(node, path, reader);
    for (const Entry& e : entries_) {
      const std::string key = key_path(path, e.text.name);
      const Node* value = node.find(e.text.name);
      const bool decided = e.discriminator.empty() || !reader.failed(key_path(path, e.discriminator));
      const bool applies = !decided || !e.applies || e.applies(out);
      if (value) {
        reader.mark(key, value->source);
        if (!applies)
          reader.error(key, "does not apply here", "only with " + e.text.applies_to);
        else
          e.read(*value, key, out, reader);
      } else if (e.text.required && decided && applies) {
        reader.error(key, "missing", missing_text(e.text, key));
      }
    }
    for (const auto& c : checks_) c(out, path, reader);
    return !reader.failed(path);
  }

  Node write(const T& value, const coupling::Scene& scene) const {
    Node table = Node::table();
    for (const Entry& e : entries_) {
      if (e.applies && !e.applies(value)) continue;
      if (std::optional<Node> n = e.write(value, scene)) table.set(e.text.name, std::move(*n));
    }
    return table;
  }

  std::shared_ptr<const TableText> text() const {
    auto t = std::make_shared<TableText>();
    for (const Entry& e : entries_) t->keys.push_back(e.text);
    return t;
  }

  std::vector<std::string> names() const {
    std::vector<std::string> all;
    for (const Entry& e : entries_) all.push_back(e.text.name);
    return all;
  }

 private:
  template <class V>
  Entry& declare(std::string name, const Codec<V>& codec, std::string sentence) {
    // Entries are kept in a list whose elements never move, so that required() can be said afterwards.
    Entry& e = entries_.emplace_back();
    e.text.name = std::move(name);
    e.text.type = codec.type;
    e.text.allowed = codec.allowed;
    e.text.sentence = std::move(sentence);
    e.text.schema = codec.schema;
    e.text.table = codec.table;
    e.text.nest = codec.nest;
    return e;
  }

  static std::string missing_text(const KeyText& text, const std::string& key) {
    switch (text.nest) {
      case Nest::one:
        return "[" + key + "]";
      case Nest::list:
        return "[[" + key + "]]";
      case Nest::named:
        return "[" + key + ".NAME]";
      case Nest::none:
        break;
    }
    return text.description();
  }

  template <class V>
  static bool is_unset(const Codec<V>& codec, const V& value) {
    return is_empty(codec.write(value, default_scene()));
  }

  template <class V>
  static void set_fallback(Entry& e, const Codec<V>& codec, const V& value) {
    if (codec.nest != Nest::none) return;
    const Node n = codec.write(value, default_scene());
    if (!is_empty(n)) e.text.fallback = to_toml_value(n);
  }

  static bool is_empty(const Node& n) {
    return (n.is(Node::Kind::text) && n.text.empty()) || (n.is(Node::Kind::array) && n.items.empty()) ||
           (n.is(Node::Kind::table) && n.members.empty());
  }

  static std::optional<Node> present(Node n, bool only_if_not_empty) {
    if (only_if_not_empty && is_empty(n)) return std::nullopt;
    return n;
  }

  void report_unknown(const Node& node, const std::string& path, Reader& reader) const {
    for (const Member& m : node.members) {
      bool known = false;
      for (const Entry& e : entries_) known = known || e.text.name == m.key;
      if (known) continue;
      const std::string key = key_path(path, m.key);
      reader.mark(key, m.key_source);
      bool is_later = false;
      for (const Later& l : later_) {
        if (l.name != m.key) continue;
        reader.error(key, "not in this version (" + l.what + ")", join(names()));
        is_later = true;
      }
      if (!is_later) reader.error(key, "unknown key" + did_you_mean(m.key, names()), join(names()));
    }
  }

  struct Later {
    std::string name, what;
  };
  std::deque<Entry> entries_;
  std::vector<Later> later_;
  std::vector<std::function<void(T&, const std::string&, Reader&)>> checks_;
};

// ---- tables as values
// -------------------------------------------------------------------------------------------------

template <class U>
Codec<U> one_table(const Table<U>& table) {
  Codec<U> c;
  c.type = "table";
  c.table = table.text();
  c.nest = Nest::one;
  c.read = [&table](const Node& n, const std::string& key, U& u, Reader& r) {
    return table.read(n, key, u, r);
  };
  c.write = [&table](const U& u, const coupling::Scene& s) { return table.write(u, s); };
  return c;
}

// [[key]]; every element is kept, also one with errors, so that numbers in messages are those of the file.
template <class U>
Codec<std::vector<U>> list_of_tables(const Table<U>& table) {
  Codec<std::vector<U>> c;
  c.type = "list of tables";
  c.table = table.text();
  c.nest = Nest::list;
  c.read = [&table](const Node& n, const std::string& key, std::vector<U>& list, Reader& reader) {
    bool all_tables = n.is(Node::Kind::array);
    for (const Node& item : n.items) all_tables = all_tables && item.is(Node::Kind::table);
    if (!all_tables) {
      reader.error(key, "expected a list of tables, found " + n.description(), "[[" + key + "]]");
      return false;
    }
    bool good = true;
    for (std::size_t i = 0; i < n.items.size(); ++i) {
      const std::string item = key + "." + std::to_string(i + 1);
      reader.mark(item, n.items[i].source);
      U u{};
      good = table.read(n.items[i], item, u, reader) && good;
      list.push_back(std::move(u));
    }
    return good;
  };
  c.write = [&table](const std::vector<U>& list, const coupling::Scene& s) {
    Node n = Node::array();
    for (const U& u : list) n.items.push_back(table.write(u, s));
    return n;
  };
  return c;
}

// [key.NAME]; the name goes into a member.
template <class U>
Codec<std::vector<U>> named_tables(const Table<U>& table, std::string U::*name) {
  Codec<std::vector<U>> c;
  c.type = "tables by name";
  c.table = table.text();
  c.nest = Nest::named;
  c.read = [&table, name](const Node& n, const std::string& key, std::vector<U>& list, Reader& reader) {
    if (!n.is(Node::Kind::table)) {
      reader.error(key, "expected tables by name, found " + n.description(), "[" + key + ".NAME]");
      return false;
    }
    bool good = true;
    for (const Member& m : n.members) {
      const std::string item = key + "." + m.key;
      reader.mark(item, m.key_source);
      if (!is_identifier(m.key)) {
        reader.error(key, "\"" + m.key + "\" is not a name", "letters, digits, _ and -");
        good = false;
        continue;
      }
      U u{};
      u.*name = m.key;
      good = table.read(m.value, item, u, reader) && good;
      list.push_back(std::move(u));
    }
    return good;
  };
  c.write = [&table, name](const std::vector<U>& list, const coupling::Scene& s) {
    Node n = Node::table();
    for (const U& u : list) n.set(u.*name, table.write(u, s));
    return n;
  };
  return c;
}

}  // namespace polder::app
