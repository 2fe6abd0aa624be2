#include "mpm/material/make_law.hpp"

#include "core/error.hpp"
#include "mpm/material/elastic.hpp"

namespace polder::POLDER_SIMD_NAMESPACE {

template <int D>
std::unique_ptr<Law<D>> make_law(const mpm::MaterialParameters& material, bool plastic) {
  if (material.model == mpm::MaterialModel::linear_elastic || !plastic)
    return std::make_unique<LinearElastic<D>>(material);
  throw InputError("material " + material.name + ": this model is not available");
}

template std::unique_ptr<Law<2>> make_law<2>(const mpm::MaterialParameters&, bool);
template std::unique_ptr<Law<3>> make_law<3>(const mpm::MaterialParameters&, bool);

}  // namespace polder::POLDER_SIMD_NAMESPACE
