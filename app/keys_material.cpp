// Materials and the pore water.
#include <algorithm>
#include <cmath>

#include "app/case_keys.hpp"
#include "app/codecs.hpp"
#include "app/digits.hpp"
#include "app/permeability.hpp"

namespace polder::app {

using coupling::BishopFactor;
using coupling::DragLaw;
using coupling::Material;
using coupling::Scene;
using coupling::WaterSpec;
using mpm::MaterialModel;
using mpm::Mobilised;

namespace {

// A velocity (hydraulic conductivity) or an area (intrinsic permeability); the unit tells which.
Codec<double> conductivity() {
  const Codec<double> velocity = number(dimension::kVelocity, kNotNegative);
  Codec<double> c;
  c.type = "hydraulic conductivity [m/s], or intrinsic permeability as a text in m2";
  c.allowed = velocity.allowed;
  c.schema = velocity.schema;
  c.read = [velocity](const Node& n, const std::string& key, double& value, Reader& reader) {
    if (n.is(Node::Kind::text)) {
      const Quantity q = parse_quantity(n.text);
      if (q.error.empty() && q.has_unit && q.dimension == dimension::kArea) {
        if (!kNotNegative.contains(q.value)) {
          reader.error(key, "\"" + n.text + "\" is out of range", "area [m2], " + kNotNegative.text());
          return false;
        }
        value = conductivity_of(q.value, reader.scene.water);
        return true;
      }
      if (q.error.empty() && q.has_unit && q.dimension != dimension::kVelocity) {
        reader.error(key,
                     "\"" + n.text + "\" is " + dimension_phrase(q.dimension) +
                         ", a velocity (hydraulic conductivity) or an area (intrinsic permeability) is due",
                     "a number in m/s, or a text with a unit (m/s, m/day, m2)");
        return false;
      }
    }
    return velocity.read(n, key, value, reader);
  };
  c.write = [](const double& value, const Scene& scene) {
    return Node::of(value).with_comment("m/s; intrinsic permeability " +
                                        digits(permeability_of(value, scene.water), 6) + " m2");
  };
  return c;
}

double value_at(const Mobilised& m, double strain) {
  if (m.kind == Mobilised::Kind::exponential)
    return m.residual + (m.peak - m.residual) * std::exp(-m.rate * strain);
  if (strain <= m.strain.front()) return m.value.front();
  for (std::size_t i = 1; i < m.strain.size(); ++i)
    if (strain <= m.strain[i]) {
      const double share = (strain - m.strain[i - 1]) / (m.strain[i] - m.strain[i - 1]);
      return m.value[i - 1] + share * (m.value[i] - m.value[i - 1]);
    }
  return m.value.back();
}

// More dilation than friction would let plastic flow create energy.
void check_dilation(const Material& m, const std::string& path, Reader& reader) {
  const std::string key = key_path(path, "dilation");
  if (m.model != MaterialModel::mohr_coulomb || reader.failed(key_path(path, "friction")) ||
      reader.failed(key))
    return;
  std::vector<double> strains{0};
  for (const Mobilised* curve : {&m.friction, &m.dilation}) {
    strains.insert(strains.end(), curve->strain.begin(), curve->strain.end());
    if (curve->kind == Mobilised::Kind::exponential)
      for (const double share : {0.25, 0.5, 1.0, 2.0, 4.0, 40.0}) strains.push_back(share / curve->rate);
  }
  for (const double strain : strains) {
    const double dilation = value_at(m.dilation, strain), friction = value_at(m.friction, strain);
    if (dilation <= friction * (1 + 1e-12)) continue;
    const auto degrees = [](double angle) {
      return format_number(std::round(angle / kDegree * 1e6) / 1e6) + " deg";
    };
    reader.error(key,
                 "dilation " + degrees(dilation) + " exceeds friction " + degrees(friction) +
                     " at plastic strain " + format_number(strain),
                 "at most the friction angle");
    return;
  }
}

void check_density(Material&, const std::string& path, Reader& reader) {
  const std::string density = key_path(path, "density_solid"), weight = key_path(path, "unit_weight");
  if (reader.given(density) && reader.given(weight))
    reader.error(weight, "density_solid and unit_weight contradict each other", "one of them");
  if (!reader.given(density) && !reader.given(weight))
    reader.error(density, "missing", "density [kg/m3], greater than 0; or unit_weight");
}

}  // namespace

const Table<Material>& material_keys() {
  static const Table<Material> table = [] {
    using M = Material;
    const auto mohr_coulomb = [](const M& m) { return m.model == MaterialModel::mohr_coulomb; };
    const auto undrained = [](const M& m) {
      return m.model == MaterialModel::von_mises || m.model == MaterialModel::tresca;
    };
    const std::string with_mohr_coulomb = "model = \"mohr-coulomb\"";
    const std::string with_undrained = "model = \"von-mises\" or \"tresca\"";
    const Range friction_range{.min = 0, .max = 90, .max_open = true};
    const Range dilation_range{.min = -90, .max = 90, .min_open = true, .max_open = true};
    Range strength_range = kNotNegative;
    strength_range.infinite = true;
    Table<M> t;
    t.add("model",
          choice<MaterialModel>({{"linear-elastic", MaterialModel::linear_elastic},
                                 {"neo-hookean", MaterialModel::neo_hookean},
                                 {"mohr-coulomb", MaterialModel::mohr_coulomb},
                                 {"von-mises", MaterialModel::von_mises},
                                 {"tresca", MaterialModel::tresca}}),
          &M::model, "Constitutive law of the skeleton.")
        .required();
    t.add("porosity", number(dimension::kNone, {.min = 0, .max = 1, .max_open = true}), &M::porosity,
          "Initial volume of pores in a volume of soil; 0 for a material without pores.");
    t.add("density_solid", number(dimension::kDensity, kPositive), &M::density_solid,
          "Density of the grains; of the bulk material where porosity is 0.")
        .without_default();
    t.add_alternative<double>(
        "unit_weight", number(dimension::kUnitWeight, kPositive),
        [](M& m, double weight) { m.density_solid = weight / (kStandardGravity * (1 - m.porosity)); },
        "Dry unit weight, instead of density_solid = unit_weight / (9.81 (1 - porosity)).");
    t.add("young", number(dimension::kPressure, kPositive), &M::young, "Young's modulus, drained.")
        .required();
    t.add("poisson", number(dimension::kNone, {.min = -1, .max = 0.5, .min_open = true, .max_open = true}),
          &M::poisson, "Poisson's ratio, drained.")
        .required();
    t.add("friction", mobilised(dimension::kAngle, friction_range), &M::friction, "Friction angle.")
        .only_with("model", with_mohr_coulomb, mohr_coulomb)
        .required();
    t.add("dilation", mobilised(dimension::kAngle, dilation_range), &M::dilation,
          "Dilation angle; negative: contraction.")
        .only_with("model", with_mohr_coulomb, mohr_coulomb);
    t.add("cohesion", mobilised(dimension::kPressure, kNotNegative), &M::cohesion, "Effective cohesion.")
        .only_with("model", with_mohr_coulomb, mohr_coulomb);
    t.add("capillary_cohesion", mobilised(dimension::kPressure, kNotNegative), &M::capillary_cohesion,
          "Cohesion added where a particle is unsaturated; lost when water arrives.")
        .only_with("model", with_mohr_coulomb, mohr_coulomb);
    t.add("tension_cutoff", number(dimension::kPressure, strength_range), &M::tension_cutoff,
          "Largest tensile principal effective stress; limited by the apex of the yield surface.")
        .only_with("model", with_mohr_coulomb, mohr_coulomb);
    t.add("shear_strength", number(dimension::kPressure, kPositive), &M::shear_strength,
          "Peak undrained shear strength at strength_datum: sqrt(J2) (von-mises) or (sigma_1 - sigma_3)/2 "
          "(tresca).")
        .only_with("model", with_undrained, undrained)
        .required();
    t.add("strength_gradient", number(dimension::kUnitWeight, kNotNegative), &M::strength_gradient,
          "Growth of the peak strength with depth below strength_datum.")
        .only_with("model", with_undrained, undrained);
    t.add("strength_datum", number(dimension::kLength), &M::strength_datum,
          "Height at which the strength is shear_strength.")
        .only_with("model", with_undrained, undrained);
    t.add("residual_strength", number(dimension::kPressure, kNotNegative), &M::residual_strength,
          "Strength below which softening does not go.")
        .only_with("model", with_undrained, undrained);
    t.add("softening_modulus", number(dimension::kPressure, {.max = 0}), &M::softening_modulus,
          "Change of the strength with accumulated plastic deviatoric strain; 0: perfectly plastic.")
        .only_with("model", with_undrained, undrained);
    const auto permeable = [](const M& m) { return !m.drag_of_grains(); };
    const auto granular = [](const M& m) { return m.drag_of_grains(); };
    const std::string with_grains = "drag_law = \"ergun\", \"gidaspow\" or \"di-felice\"";
    t.add("drag_law",
          choice<DragLaw>({{"darcy", DragLaw::darcy},
                           {"forchheimer", DragLaw::forchheimer},
                           {"ergun", DragLaw::ergun},
                           {"gidaspow", DragLaw::gidaspow},
                           {"di-felice", DragLaw::di_felice}}),
          &M::drag_law,
          "Drag between grains and water: Darcy's law; Forchheimer's, with a part that grows with velocity; "
          "of beds of grains (ergun), of beds and suspensions (gidaspow, di-felice).");
    t.add("conductivity", conductivity(), &M::hydraulic_conductivity,
          "Saturated hydraulic conductivity k, or intrinsic permeability kappa, k = kappa density 9.81 / "
          "viscosity.")
        .only_with("drag_law", "drag_law = \"darcy\" or \"forchheimer\"", permeable);
    t.add("forchheimer", number(Dimension{0, -2, 2}, kPositive), &M::forchheimer,
          "Coefficient b of the hydraulic gradient q / k + b q^2 at a specific discharge q.")
        .without_default()
        .required()
        .only_with("drag_law", "drag_law = \"forchheimer\"",
                   [](const M& m) { return m.drag_law == DragLaw::forchheimer; });
    t.add("grain_diameter", number(dimension::kLength, kPositive), &M::grain_diameter,
          "Diameter of the grains; with the water's viscosity and density it sets their drag.")
        .without_default()
        .required()
        .only_with("drag_law", with_grains, granular);
    t.add("fluidisation_porosity", number(dimension::kNone, {.min = 0, .max = 1, .max_open = true}),
          &M::fluidisation_porosity,
          "Porosity above which grains that have lost their effective stress are out of contact, until it "
          "falls to this value again; 0: never. Needs a drag law of grains. In formulation mixture grains "
          "need not "
          "have lost it.")
        .only_with("model", with_mohr_coulomb, mohr_coulomb);
    t.add("anisotropy", numbers(dimension::kNone, kPositive), &M::anisotropy,
          "Factors on the conductivity along the axes of the grid, e.g. [1, 0.1]; without it 1.");
    t.add("kozeny_carman", boolean(), &M::kozeny_carman,
          "true: the conductivity follows the porosity, as n^3 / (1 - n)^2.")
        .only_with("drag_law", "drag_law = \"darcy\"",
                   [](const M& m) { return m.drag_law == DragLaw::darcy; });
    const auto retains = [](const M& m) { return m.retains(); };
    t.add("retention", retention(), &M::retention,
          "Degree of saturation and relative conductivity against suction. A case with a retention curve "
          "computes "
          "unsaturated flow; a soil without one is saturated at any pressure.");
    t.add("bishop",
          choice<BishopFactor>({{"saturation", BishopFactor::saturation},
                                {"effective-saturation", BishopFactor::effective_saturation},
                                {"none", BishopFactor::none}}),
          &M::bishop,
          "Share chi of the suction in the effective stress (Bishop 1959): (S - S_r) / (1 - S_r), S or 0. S "
          "times the "
          "suction grows without bound as soil dries.")
        .only_with("retention", "retention", retains);
    t.add(
         "capillary_suction", number(dimension::kPressure, kNotNegative), &M::capillary_suction,
         "Suction at which all of capillary_cohesion acts; below it a proportional part. 0: all of it at any "
         "suction.")
        .only_with("retention", "retention", retains);
    t.check(check_density);
    t.check(check_dilation);
    t.check([](M& m, const std::string& path, Reader& reader) {
      if (m.residual_strength > m.shear_strength && !reader.failed(path))
        reader.error(key_path(path, "residual_strength"), "exceeds shear_strength",
                     "at most " + format_number(m.shear_strength) + " Pa");
    });
    return t;
  }();
  return table;
}

const Table<WaterSpec>& pore_water_keys() {
  static const Table<WaterSpec> table = [] {
    using W = WaterSpec;
    Range stiffness = kPositive;
    stiffness.infinite = true;
    const auto with_line = [](const W& w) { return !w.phreatic.empty(); };
    Table<W> t;
    t.add("density", number(dimension::kDensity, kPositive), &W::density, "Density of the water.");
    t.add("bulk_modulus", number(dimension::kPressure, stiffness), &W::bulk_modulus,
          "Bulk modulus of the water; inf: incompressible. Formulation higo needs a finite one, and its step "
          "shortens with the root of it or more.");
    t.add(
        "viscosity", number(dimension::kViscosity, kPositive), &W::viscosity,
        "Dynamic viscosity; turns intrinsic permeability into hydraulic conductivity, and acts in drag laws "
        "of grains and where water is viscous.");
    t.add("viscous", boolean(), &W::viscous,
          "true: water with particles of its own resists shear by its viscosity, so that it can stick to "
          "walls.");
    t.add("phreatic", section_points(2), &W::phreatic,
          "Phreatic line, from left to right; the soil below it is saturated. Without it all soil is. In 3D "
          "it is the same at every y.");
    t.add("saturation_above", number(dimension::kNone, {.min = 0, .max = 1}), &W::saturation_above,
          "Degree of saturation of the soil above the phreatic line.")
        .only_with("phreatic", "phreatic", with_line);
    t.add("suction_above", number(dimension::kPressure, kNotNegative), &W::suction_above,
          "Suction of the soil above the phreatic line.")
        .only_with("phreatic", "phreatic", with_line);
    t.add("initial_saturation",
          number(dimension::kNone, {.min = 0, .max = 1, .min_open = true, .max_open = true}),
          &W::initial_saturation,
          "With retention curves: degree of saturation at the start, above the reach of the water table; "
          "without it "
          "suction is hydrostatic.");
    t.add("initial",
          choice<W::Initial>({{"zero", W::Initial::zero},
                              {"hydrostatic", W::Initial::hydrostatic},
                              {"steady", W::Initial::steady},
                              {"field", W::Initial::field}}),
          &W::initial,
          "Initial pore pressure in saturated soil: zero, hydrostatic below the phreatic line (or the soil's "
          "surface, or the open water on it), the steady state of the boundaries at time 0, or the field "
          "given by initial_pressure, "
          "initial_gradient and initial_datum.");
    const auto field = [](const W& w) { return w.initial == W::Initial::field; };
    t.add("initial_pressure", number(dimension::kPressure), &W::initial_pressure,
          "Initial pore pressure at the height initial_datum.")
        .only_with("initial", "initial = \"field\"", field);
    t.add("initial_gradient", number(dimension::kUnitWeight), &W::initial_gradient,
          "Change of the initial pore pressure with height.")
        .only_with("initial", "initial = \"field\"", field);
    t.add("initial_datum", number(dimension::kLength), &W::initial_datum,
          "Height at which the initial pore pressure is initial_pressure.")
        .only_with("initial", "initial = \"field\"", field);
    t.add("outside_level", time_table(dimension::kLength), &W::outside_level,
          "Level of open water above the soil's surface: it loads the surface it covers.");
    t.check([](W& w, const std::string& path, Reader& reader) {
      const std::string key = key_path(path, "suction_above");
      if (w.suction_above > 0 && w.saturation_above == 0 && !reader.failed(path))
        reader.error(key, "suction without water: saturation_above is 0", "saturation_above greater than 0");
    });
    return t;
  }();
  return table;
}

}  // namespace polder::app
