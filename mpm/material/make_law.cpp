#include "mpm/material/make_law.hpp"

#include "core/error.hpp"
#include "mpm/material/material.hpp"
#include "mpm/material/mohr_coulomb.hpp"
#include "mpm/material/neo_hookean.hpp"
#include "mpm/material/von_mises.hpp"

namespace polder::POLDER_SIMD_NAMESPACE {
namespace {

void refuse_unsound(const mpm::MaterialParameters& material) {
  const auto problems = mpm::check_parameters(material);
  if (!problems.empty())
    throw InputError("material " + material.name + ": " + problems.front().key + ": " +
                     problems.front().problem + "; allowed: " + problems.front().allowed);
}

template <int D>
std::unique_ptr<Law<D>> make_mohr_coulomb(const mpm::MaterialParameters& m, const mpm::StateLayout& layout) {
  const int capillary_index = layout.capillary_factor;
  if (m.scatter.cohesion || m.scatter.friction)
    return std::make_unique<MohrCoulombLaw<D, ScatteredStrength>>(m, capillary_index, layout.cohesion_factor,
                                                                  layout.friction_factor);
  const bool angles = mpm::compile_curve(m.friction).varies() || mpm::compile_curve(m.dilation).varies();
  if (angles) return std::make_unique<MohrCoulombLaw<D, MobilisedStrength<Pack>>>(m, capillary_index);
  if (mpm::compile_curve(m.cohesion).varies() || capillary_index >= 0)
    return std::make_unique<MohrCoulombLaw<D, MobilisedStrength<double>>>(m, capillary_index);
  return std::make_unique<MohrCoulombLaw<D, ConstantStrength>>(m);
}

}  // namespace

template <int D>
std::unique_ptr<Law<D>> make_law(const mpm::MaterialParameters& material, bool plastic) {
  refuse_unsound(material);
  const mpm::StateLayout layout = mpm::state_layout(material, D);
  using Model = mpm::MaterialModel;
  if (material.model == Model::neo_hookean) return std::make_unique<NeoHookean<D>>(material);
  if (plastic && material.model == Model::mohr_coulomb) return make_mohr_coulomb<D>(material, layout);
  if (plastic && material.model == Model::von_mises)
    return std::make_unique<VonMisesLaw<D>>(material, layout.peak_strength);
  if (plastic && material.model == Model::tresca)
    return std::make_unique<MohrCoulombLaw<D, UndrainedStrength>>(material, layout.peak_strength);
  return std::make_unique<LinearElastic<D>>(material);
}

template std::unique_ptr<Law<2>> make_law<2>(const mpm::MaterialParameters&, bool);
template std::unique_ptr<Law<3>> make_law<3>(const mpm::MaterialParameters&, bool);

}  // namespace polder::POLDER_SIMD_NAMESPACE
