// Retention curves: how much water a soil holds, and how well it conducts, at a given suction.
#include "app/case_keys.hpp"
#include "app/codecs.hpp"
#include "fdm/soil_catalogue.hpp"

namespace polder::app {

using fdm::Retention;
using Model = Retention::Model;

namespace {

constexpr Dimension kPerLength{0, -1, 0};
constexpr Dimension kPerPressure{-1, 1, 2};
constexpr double kWaterUnitWeight = 9810;  // turns a suction given as a pressure into a head [N/m3]

// A suction head [m]; as a text also a pressure.
Codec<double> suction(const Range& range) {
  const Codec<double> head = number(dimension::kLength, range);
  Codec<double> c = head;
  c.type = "suction head [m], or suction as a text in kPa";
  c.read = [head, range](const Node& n, const std::string& key, double& value, Reader& reader) {
    if (n.is(Node::Kind::text)) {
      const Quantity q = parse_quantity(n.text);
      if (q.error.empty() && q.has_unit && q.dimension == dimension::kPressure) {
        value = q.value / kWaterUnitWeight;
        if (range.contains(value)) return true;
        reader.error(key, "\"" + n.text + "\" is out of range", range.text());
        return false;
      }
    }
    return head.read(n, key, value, reader);
  };
  return c;
}

// 1/m of suction head; as a text also 1/kPa of suction.
Codec<double> per_suction() {
  const Codec<double> per_length = number(kPerLength, kPositive);
  Codec<double> c = per_length;
  c.type = "per suction head [1/m], or per suction as a text in 1/kPa";
  c.read = [per_length](const Node& n, const std::string& key, double& value, Reader& reader) {
    if (n.is(Node::Kind::text)) {
      const Quantity q = parse_quantity(n.text);
      if (q.error.empty() && q.has_unit && q.dimension == kPerPressure) {
        value = q.value * kWaterUnitWeight;
        if (kPositive.contains(value)) return true;
        reader.error(key, "\"" + n.text + "\" is out of range", kPositive.text());
        return false;
      }
    }
    return per_length.read(n, key, value, reader);
  };
  return c;
}

const Table<Retention>& retention_keys() {
  static const Table<Retention> table = [] {
    using R = Retention;
    const auto is = [](Model m) { return [m](const R& r) { return r.model == m; }; };
    const auto either = [](Model a, Model b) {
      return [a, b](const R& r) { return r.model == a || r.model == b; };
    };
    const Range share{.min = 0, .max = 1};
    Range pore_size = kPositive;
    Table<R> t;
    t.add("model",
          choice<Model>({{"van-genuchten", Model::van_genuchten},
                         {"brooks-corey", Model::brooks_corey},
                         {"gardner", Model::gardner},
                         {"haverkamp", Model::haverkamp},
                         {"tabulated", Model::tabulated}}),
          &R::model,
          "Retention curve and relative conductivity: van Genuchten 1980 with Mualem 1976; Brooks and Corey "
          "1964; "
          "Gardner 1958 (exponential); Haverkamp et al. 1977; a table.")
        .required();
    t.add("residual", number(dimension::kNone, {.min = 0, .max = 1, .max_open = true}), &R::residual,
          "Residual degree of saturation.")
        .only_with("model", "a model other than \"tabulated\"",
                   [](const R& r) { return r.model != Model::tabulated; });
    t.add("maximum", number(dimension::kNone, {.min = 0, .max = 1, .min_open = true}), &R::maximum,
          "Degree of saturation at zero suction; less than 1 where air stays trapped.");
    t.add("alpha", per_suction(), &R::alpha, "Scale of the suction.")
        .required()
        .only_with("model", "model = \"van-genuchten\" or \"gardner\"",
                   either(Model::van_genuchten, Model::gardner));
    t.add("n", number(dimension::kNone, {.min = 1, .min_open = true}), &R::n,
          "Shape of van Genuchten's curve.")
        .required()
        .only_with("model", "model = \"van-genuchten\"", is(Model::van_genuchten));
    t.add("m", number(dimension::kNone, kNotNegative), &R::m, "Second shape of it; 0: 1 - 1/n.")
        .only_with("model", "model = \"van-genuchten\"", is(Model::van_genuchten));
    t.add("connectivity", number(dimension::kNone), &R::connectivity,
          "Exponent l of the effective saturation in the relative conductivity; 0.5 after Mualem.")
        .only_with("model", "model = \"van-genuchten\" or \"brooks-corey\"",
                   either(Model::van_genuchten, Model::brooks_corey));
    t.add("entry_head", suction(kPositive), &R::entry_head, "Suction at which air enters.")
        .required()
        .only_with("model", "model = \"brooks-corey\"", is(Model::brooks_corey));
    t.add("lambda", number(dimension::kNone, pore_size), &R::lambda, "Pore-size index of Brooks and Corey.")
        .required()
        .only_with("model", "model = \"brooks-corey\"", is(Model::brooks_corey));
    const auto haverkamp = [&](const char* name, double R::Haverkamp::*member, const char* sentence) {
      t.add<double>(
           name, number(dimension::kNone, kPositive), [member](const R& r) { return r.haverkamp.*member; },
           [member](R& r, double v) { r.haverkamp.*member = v; }, sentence)
          .required()
          .only_with("model", "model = \"haverkamp\"", is(Model::haverkamp));
    };
    haverkamp("saturation_factor", &R::Haverkamp::saturation_factor,
              "a of S_e = a / (a + h^b), with the suction head h in m.");
    haverkamp("saturation_exponent", &R::Haverkamp::saturation_exponent, "b of the same.");
    haverkamp("conductivity_factor", &R::Haverkamp::conductivity_factor,
              "A of k_r = A / (A + h^B), with the suction head h in m.");
    haverkamp("conductivity_exponent", &R::Haverkamp::conductivity_exponent, "B of the same.");
    t.add("suction_head", numbers(dimension::kLength, kNotNegative), &R::suction_head,
          "Suction heads of the table, ascending.")
        .required()
        .only_with("model", "model = \"tabulated\"", is(Model::tabulated));
    t.add("saturation", numbers(dimension::kNone, share), &R::saturation, "Degrees of saturation at them.")
        .required()
        .only_with("model", "model = \"tabulated\"", is(Model::tabulated));
    t.add("relative_conductivity", numbers(dimension::kNone, share), &R::relative_conductivity,
          "Relative conductivities at them.")
        .required()
        .only_with("model", "model = \"tabulated\"", is(Model::tabulated));
    t.check([](R& r, const std::string& path, Reader& reader) {
      if (reader.failed(path)) return;
      for (const std::string& fault : fdm::faults(r))
        reader.error(path, fault, "a falling curve between its residual and its maximum");
    });
    return t;
  }();
  return table;
}

}  // namespace

Codec<Retention> retention() {
  const Codec<Retention> table = one_table(retention_keys());
  std::vector<std::string> names;
  for (const fdm::CatalogueSoil& s : fdm::soil_catalogue()) names.push_back(s.name);
  const Codec<std::string> name = word(names);
  Codec<Retention> c = table;
  c.type = "table, or the name of a soil of the catalogue";
  c.allowed = "";
  c.read = [table, name](const Node& n, const std::string& key, Retention& r, Reader& reader) {
    if (!n.is(Node::Kind::text)) return table.read(n, key, r, reader);
    std::string soil;
    if (!name.read(n, key, soil, reader)) return false;
    r = fdm::find_soil(soil)->retention;
    return true;
  };
  c.write = [table](const Retention& r, const coupling::Scene& scene) {
    if (r.model == Model::saturated) return Node::table();
    return table.write(r, scene);
  };
  return c;
}

}  // namespace polder::app
