// Where water enters and leaves, and lines inside the soil that take, give or stop it.
#include "app/case_keys.hpp"
#include "app/codecs.hpp"

namespace polder::app {

using coupling::WaterBoundary;
using coupling::WaterLine;

namespace {

constexpr Dimension kArealRate{0, 2, -1};  // [m2/s]
constexpr const char* kSurface = "surface";

// A side of the grid or a part of it, as elsewhere; or the soil's surface, which is no side.
Codec<Place> water_place() {
  const Codec<Place> side = place(false);
  Codec<Place> c = side;
  c.type += ", or \"surface\", { side = \"surface\", from, to } for the soil's surface in a box";
  c.allowed = "surface, " + side.allowed;
  c.read = [side](const Node& n, const std::string& key, Place& p, Reader& reader) {
    p = {};
    if (n.is(Node::Kind::text) && n.text == kSurface) return true;
    if (n.is(Node::Kind::table)) {
      const Node* named = n.find("side");
      if (named == nullptr && n.find("from") != nullptr) {
        reader.error(key, "a part of what", "side = \"surface\" or a side of the grid, from and to");
        return false;
      }
      if (named != nullptr && named->is(Node::Kind::text) && named->text == kSurface) {
        Node rest = Node::table();
        for (const Member& m : n.members)
          if (m.key != "side") rest.set(m.key, m.value);
        if (rest.members.empty()) return true;
        return side.read(rest, key, p, reader);
      }
    }
    return side.read(n, key, p, reader);
  };
  c.write = [side](const Place& p, const coupling::Scene& scene) {
    if (p.side) return side.write(p, scene);
    if (!p.segment) return Node::of(kSurface);
    Node part = side.write(p, scene), whole = Node::inline_table();
    whole.set("side", Node::of(kSurface));
    for (const Member& m : part.members) whole.set(m.key, m.value);
    return whole;
  };
  return c;
}

}  // namespace

const Table<WaterBoundary>& water_keys() {
  using Kind = WaterBoundary::Kind;
  static const Table<WaterBoundary> table = [] {
    using W = WaterBoundary;
    Table<W> t;
    t.add("name", identifier(), &W::name, "Name in messages and results; default: water-1, water-2, ...");
    t.add<Place>(
         "where", water_place(),
         [](const W& w) {
           Place p;
           if (w.side != W::kOnSurface) p.side = w.side;
           if (w.from && w.to) p.segment = {*w.from, *w.to};
           return p;
         },
         [](W& w, Place p) {
           w.side = p.side.value_or(W::kOnSurface);
           w.from.reset();
           w.to.reset();
           if (p.segment) {
             w.from = (*p.segment)[0];
             w.to = (*p.segment)[1];
           }
         },
         "A side of the grid or a part of it; \"surface\", the soil's own surface, or the part of it in a "
         "box.")
        .required();
    t.add("kind",
          choice<Kind>({{"head", Kind::head},
                        {"pressure", Kind::pressure},
                        {"impermeable", Kind::impermeable},
                        {"surface", Kind::surface},
                        {"flux", Kind::flux},
                        {"rain", Kind::rain},
                        {"evaporation", Kind::evaporation},
                        {"seepage-face", Kind::seepage_face}}),
          &W::kind,
          "head: hydrostatic below a water level, above it a seepage face (impermeable without retention "
          "curves); "
          "pressure: one pore pressure; impermeable: no flow; surface: a side as the soil's free surface, "
          "the pressure "
          "of open water or none; flux: a rate of inflow; rain: as much of a rate as the soil takes, the "
          "rest runs off; "
          "evaporation: a rate of outflow down to limit_suction; seepage-face: water may leave, none enters.")
        .required();
    t.add("head", time_table(dimension::kLength), &W::value,
          "Water level, a height in the grid's coordinates.")
        .required()
        .only_with("kind", "kind = \"head\"", [](const W& w) { return w.kind == Kind::head; });
    t.add("pressure", time_table(dimension::kPressure), &W::value, "Pore pressure.")
        .required()
        .only_with("kind", "kind = \"pressure\"", [](const W& w) { return w.kind == Kind::pressure; });
    t.add("rate", time_table(dimension::kVelocity), &W::value,
          "Water that enters (flux, rain) or leaves (evaporation) an area in a time; of rain and evaporation "
          "the area "
          "in plan.")
        .required()
        .only_with("kind", "kind = \"flux\", \"rain\" or \"evaporation\"", [](const W& w) {
          return w.kind == Kind::flux || w.kind == Kind::rain || w.kind == Kind::evaporation;
        });
    t.add("limit_suction", number(dimension::kPressure, kPositive), &W::limit_suction,
          "Suction at which the soil is as dry as the air above it.")
        .required()
        .only_with("kind", "kind = \"evaporation\"", [](const W& w) { return w.kind == Kind::evaporation; });
    return t;
  }();
  return table;
}

const Table<WaterLine>& water_line_keys() {
  using Kind = WaterLine::Kind;
  static const Table<WaterLine> table = [] {
    using W = WaterLine;
    Table<W> t;
    t.add("name", identifier(), &W::name,
          "Name in messages and results; default: water_line-1, water_line-2, ...");
    t.add("kind", choice<Kind>({{"well", Kind::well}, {"drain", Kind::drain}, {"sheet", Kind::sheet}}),
          &W::kind,
          "well: gives or takes a rate of water along its length; drain: takes water where its pressure "
          "exceeds that "
          "of the drain; sheet: lets no water through.")
        .required();
    t.add("line", points(2), &W::line, "Corners of the polyline.").required();
    t.add("rate", time_table(kArealRate), &W::rate,
          "Water that the whole well gives (positive) or takes (negative), per metre of thickness [m2/s].")
        .required()
        .only_with("kind", "kind = \"well\"", [](const W& w) { return w.kind == Kind::well; });
    t.add("pressure", number(dimension::kPressure), &W::limit_pressure,
          "Of a drain: the pressure in it, 0 unless given. Of a well: the pressure in it at which it takes "
          "or gives no "
          "more; without it there is no limit.")
        .only_with("kind", "kind = \"well\" or \"drain\"", [](const W& w) { return w.kind != Kind::sheet; });
    return t;
  }();
  return table;
}

}  // namespace polder::app
