// The table of formulations and quantities that vary in time. See scene.hpp.
#include "coupling/scene.hpp"

#include <algorithm>

namespace polder::coupling {

double TimeTable::at(double t) const {
  if (t <= time.front()) return value.front();
  if (t >= time.back()) return value.back();
  const auto after = std::upper_bound(time.begin(), time.end(), t);
  const std::size_t i = static_cast<std::size_t>(after - time.begin());
  const double share = (t - time[i - 1]) / (time[i] - time[i - 1]);
  return value[i - 1] + share * (value[i] - value[i - 1]);
}

const std::vector<Formulation>& formulations() {
  using C = WaterCarrier;
  using I = RelativeInertia;
  using P = PressureMethod;
  using S = SaturationKind;
  static const std::vector<Formulation> table{
      {"dry", C::none, I::neglected, P::projected, S::saturated, true,
       "Sulsky et al. 1994; Bardenhagen & Kober 2004"},
      {"one-layer", C::cells, I::neglected, P::projected, S::saturated, true,
       "MPM-FDM of Higo et al. 2010, 2015, with projected pressure"},
      {"higo", C::cells, I::neglected, P::compressible, S::unsaturated, true,
       "MPM-FDM of Higo et al. 2010, 2015 with explicit pressure"},
      {"u-p", C::skeleton, I::neglected, P::compressible, S::saturated, true,
       "Zhang et al. 2009; Zabala & Alonso 2011"},
      {"v-w", C::skeleton, I::kept, P::compressible, S::saturated, true,
       "Jassim et al. 2013; sequence of Verruijt 2010"},
      {"three-phase", C::skeleton, I::neglected, P::compressible, S::three_phase, false, "Yerro et al. 2015"},
      {"two-layer", C::particles, I::kept, P::projected, S::saturated, true, "Bandara & Soga 2015"},
      {"two-layer-darcy", C::particles, I::neglected, P::projected, S::saturated, true, "Abe et al. 2014"},
      {"mixture", C::particles, I::kept, P::projected, S::saturated, true,
       "Mackenzie-Helnwein et al. 2010; Shin 2010", true},
  };
  return table;
}

const Formulation* find_formulation(const std::string& name) {
  for (const Formulation& f : formulations())
    if (f.name == name) return &f;
  return nullptr;
}

bool Scene::unsaturated() const {
  const Formulation* f = find_formulation(formulation);
  if (f == nullptr || f->carrier != WaterCarrier::cells) return false;
  return std::any_of(materials.begin(), materials.end(), [](const Material& m) { return m.retains(); });
}

bool Scene::layered() const {
  const Formulation* f = find_formulation(formulation);
  return f != nullptr && f->carrier == WaterCarrier::particles;
}

bool Scene::compressible() const {
  const Formulation* f = find_formulation(formulation);
  if (f == nullptr || f->carrier == WaterCarrier::none) return false;
  return f->pressure == PressureMethod::compressible ||
         (f->chooses_pressure() && numerics.pressure == PressureMethod::compressible);
}

bool Scene::dispersed() const {
  const Formulation* f = find_formulation(formulation);
  return f != nullptr && f->dispersed;
}

bool Scene::fluidises() const {
  return std::any_of(materials.begin(), materials.end(),
                     [](const Material& m) { return m.fluidisation_porosity > 0; });
}

bool Scene::retains_water() const {
  return layered() && water.saturation_above > 0 && !water.phreatic.empty();
}

bool Scene::drag_follows_flow() const {
  return std::any_of(materials.begin(), materials.end(),
                     [](const Material& m) { return m.porosity > 0 && m.drag_law != DragLaw::darcy; });
}

bool Scene::on_points() const {
  const Formulation* f = find_formulation(formulation);
  return f != nullptr && f->carrier == WaterCarrier::skeleton;
}

bool Scene::kozeny_carman() const {
  return std::any_of(materials.begin(), materials.end(), [](const Material& m) { return m.kozeny_carman; });
}

std::vector<mpm::MaterialParameters> Scene::skeleton_materials() const {
  return {materials.begin(), materials.end()};
}

}  // namespace polder::coupling
