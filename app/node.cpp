#include "app/node.hpp"

#include "core/units.hpp"

namespace polder::app {

Node Node::of(bool value) {
  Node n;
  n.kind = Kind::boolean;
  n.boolean = value;
  return n;
}

Node Node::of(int value) {
  Node n;
  n.kind = Kind::integer;
  n.integer = value;
  n.number = value;
  return n;
}

Node Node::of(double value) {
  Node n;
  n.kind = Kind::number;
  n.number = value;
  return n;
}

Node Node::of(std::string value) {
  Node n;
  n.kind = Kind::text;
  n.text = std::move(value);
  return n;
}

Node Node::array(std::vector<Node> items) {
  Node n;
  n.kind = Kind::array;
  n.items = std::move(items);
  return n;
}

Node Node::inline_table() {
  Node n;
  n.on_one_line = true;
  return n;
}

const Node* Node::find(std::string_view key) const {
  for (const Member& m : members)
    if (m.key == key) return &m.value;
  return nullptr;
}

Node* Node::find(std::string_view key) {
  return const_cast<Node*>(static_cast<const Node*>(this)->find(key));
}

Node& Node::set(std::string key, Node value) {
  if (Node* present = find(key)) return *present = std::move(value);
  const Source source = value.source;
  members.push_back({std::move(key), source, std::move(value)});
  return members.back().value;
}

Node Node::with_comment(std::string c) && {
  comment = std::move(c);
  return std::move(*this);
}

std::string Node::description() const {
  switch (kind) {
    case Kind::boolean:
      return boolean ? "true" : "false";
    case Kind::integer:
      return "the number " + std::to_string(integer);
    case Kind::number:
      return "the number " + format_number(number);
    case Kind::text:
      return "the text \"" + text + "\"";
    case Kind::array:
      return "a list of " + std::to_string(items.size());
    case Kind::table:
      return "a table";
    case Kind::other:
      return text;
  }
  return {};
}

}  // namespace polder::app
