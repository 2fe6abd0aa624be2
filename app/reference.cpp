// The reference of the case file, drawn from its declarations: Markdown for people, JSON Schema for editors.
#include "app/case.hpp"
#include "app/case_keys.hpp"

namespace polder::app {
namespace {

constexpr const char* kIntroduction =
    "# The case file\n\n"
    "A case is one TOML file. Numbers are in SI units; a plain angle is in degrees. A text with a unit is "
    "accepted wherever "
    "a number is due: `\"13 h\"`, `\"2.7 kPa\"`, `\"30.8 deg\"`, `\"0.4 m/day\"`, `\"18 kN/m3\"`; its "
    "dimension is checked. "
    "Stress is positive in tension, pore pressure in compression. The last axis points up: y in 2D, z in "
    "3D.\n\n"
    "A quantity in time is a number, or `{ time = [0, \"2 h\"], value = [0.5, 2.5] }`: linear between the "
    "entries, constant "
    "outside them. A strength or an angle mobilised by plastic deviatoric strain is a number; "
    "`{ peak, residual, rate }` for residual + (peak - residual) exp(-rate strain); "
    "`{ peak, residual, strain_peak, strain_residual }` or `{ strain = [...], value = [...] }` for a "
    "piecewise linear "
    "curve. Sides of the grid are called left, right, bottom and top, in 3D also front (lower y) and back; a "
    "part of a side "
    "is `{ side = \"left\", from = [0, 0], to = [0, 2] }`.\n\n"
    "`polder run CASE --set key=value` replaces any key; elements of lists are named by number or name: "
    "`--set grid.cell=0.05`, `--set stage.2.duration=\"20 s\"`, `--set material.sand.young=\"20 MPa\"`; "
    "nothing behind the = "
    "removes the key or the element: `--set boundary.base.coefficient=`.\n\n"
    "This page is the output of `polder schema`; `polder schema --json` gives a JSON Schema.\n";

std::string cell_text(std::string text) {
  std::string out;
  for (const char c : text) out += c == '|' ? std::string("\\|") : std::string(1, c);
  return out;
}

void write_rows(const TableText& table, const std::string& prefix, std::string& out) {
  for (const KeyText& k : table.keys) {
    if (k.table && k.nest != Nest::one) continue;
    if (k.table) {
      write_rows(*k.table, prefix + k.name + ".", out);
      continue;
    }
    std::string meaning = k.sentence;
    if (!k.applies_to.empty()) meaning += " Only with " + k.applies_to + ".";
    const std::string fallback = k.required ? "required" : k.fallback.empty() ? "" : "`" + k.fallback + "`";
    out += "| `" + prefix + k.name + "` | " + cell_text(k.description()) + " | " + fallback + " | " +
           cell_text(meaning) + " |\n";
  }
}

std::string rows(const TableText& table) {
  std::string out = "\n| key | type and range | default | meaning |\n|---|---|---|---|\n";
  write_rows(table, "", out);
  return out;
}

Node schema_of(const TableText& table);

Node schema_of(const KeyText& k) {
  Node n = Node::table();
  if (!k.table) {
    n = k.schema;
  } else if (k.nest == Nest::one) {
    n = schema_of(*k.table);
  } else if (k.nest == Nest::list) {
    n.set("type", Node::of("array"));
    n.set("items", schema_of(*k.table));
  } else {
    n.set("type", Node::of("object"));
    n.set("additionalProperties", schema_of(*k.table));
  }
  std::string text = k.sentence;
  if (!k.table) text += " (" + k.description() + ")";
  if (!k.fallback.empty()) text += " Default: " + k.fallback + ".";
  if (!k.applies_to.empty()) text += " Only with " + k.applies_to + ".";
  n.set("description", Node::of(text));
  return n;
}

Node schema_of(const TableText& table) {
  Node properties = Node::table(), required = Node::array();
  for (const KeyText& k : table.keys) {
    properties.set(k.name, schema_of(k));
    // A key that is required only in some tables is left to the reader.
    if (k.required && k.applies_to.empty()) required.items.push_back(Node::of(k.name));
  }
  Node n = Node::table();
  n.set("type", Node::of("object"));
  n.set("properties", std::move(properties));
  if (!required.items.empty()) n.set("required", std::move(required));
  n.set("additionalProperties", Node::of(false));
  return n;
}

}  // namespace

std::string case_reference() {
  const auto text = case_keys().text();
  std::string out = kIntroduction;
  TableText top;
  for (const KeyText& k : text->keys)
    if (!k.table) top.keys.push_back(k);
  out += "\n## Top of the file\n" + rows(top);
  for (const KeyText& k : text->keys) {
    if (!k.table) continue;
    const std::string heading = k.nest == Nest::list    ? "[[" + k.name + "]]"
                                : k.nest == Nest::named ? "[" + k.name + ".NAME]"
                                                        : "[" + k.name + "]";
    out += "\n## " + heading + "\n\n" + k.sentence + (k.required ? " Required." : "") + "\n" + rows(*k.table);
  }
  out += "\n## Formulations\n\n| name | in this version | after |\n|---|---|---|\n";
  for (const auto& f : coupling::formulations())
    out += "| `" + f.name + "` | " + (f.available ? "yes" : "no") + " | " + f.source + " |\n";
  return out;
}

std::string case_json_schema() {
  Node schema = Node::table();
  schema.set("$schema", Node::of("https://json-schema.org/draft/2020-12/schema"));
  schema.set("title", Node::of("Polder case file"));
  const Node keys = schema_of(*case_keys().text());
  for (const Member& m : keys.members) schema.set(m.key, m.value);
  return to_json(schema);
}

}  // namespace polder::app
